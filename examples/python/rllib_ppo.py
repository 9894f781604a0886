"""PPO by RLlib (its new API stack) in thousands of worlds of one env runner.

    pip install "ray[rllib]" torch
    python examples/python/rllib_ppo.py [--task manyworlds/CartPole-v0] [--worlds 256] [--until 475]

Prints the mean return of the episodes that ended in each iteration.
"""

import argparse
import time

import gymnasium as gym
from ray.rllib.algorithms.ppo import PPOConfig

import manyworlds.gym  # noqa: F401  (registers the tasks)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--task", default="manyworlds/CartPole-v0")
    parser.add_argument("--worlds", type=int, default=256)
    parser.add_argument("--steps", type=int, default=32, help="of each world in an iteration")
    parser.add_argument("--until", type=float, default=475)
    parser.add_argument("--iterations", type=int, default=200)
    given = parser.parse_args()
    config = (
        PPOConfig()
        # Gymnasium imports the module before the colon where an env runner makes the worlds.
        .environment(f"manyworlds.gym:{given.task}")
        .env_runners(
            num_env_runners=0,
            num_envs_per_env_runner=given.worlds,
            gym_env_vectorize_mode=gym.VectorizeMode.VECTOR_ENTRY_POINT,
            rollout_fragment_length=given.steps,
        )
        .training(
            lr=1e-3,
            gamma=0.99,
            lambda_=0.95,
            entropy_coeff=0.0,
            vf_loss_coeff=0.5,
            num_epochs=4,
            train_batch_size_per_learner=given.worlds * given.steps,
            minibatch_size=2048,
        )
    )
    algorithm = config.build_algo()
    began = time.perf_counter()
    steps = 0
    for i in range(given.iterations):
        result = algorithm.train()
        runners = result["env_runners"]
        steps = int(runners["num_env_steps_sampled_lifetime"])
        mean = runners.get("episode_return_mean", float("nan"))
        print(f"{i + 1:4} {steps:9} steps {time.perf_counter() - began:6.1f} s  return {mean:.1f}")
        if mean >= given.until:
            break
    algorithm.stop()


if __name__ == "__main__":
    main()
