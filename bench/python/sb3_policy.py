#!/usr/bin/env python3
"""A policy trained in Gymnasium's own MuJoCo environment by Stable-Baselines3's PPO, as a file that
transfer.py scores here, too; or, with --here, trained in the worlds of manyworlds.sb3.VecEnv.

    pip install stable-baselines3 gymnasium mujoco-core==4.0.1 glfw imageio
    bench/python/sb3_policy.py --task Hopper-v5 --steps 300000 --out docs/training/Hopper-v5-sb3.npz
"""

import argparse
import sys
import time
from pathlib import Path

import gymnasium
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor, VecNormalize

from manyworlds.gym import mujoco
from manyworlds.sb3 import VecEnv

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from policy import Policy  # noqa: E402


def policy_of(model, normalised):
    """The mean of the actions of an MlpPolicy with tanh, behind a VecNormalize."""
    net = model.policy
    layers = [x for x in net.mlp_extractor.policy_net if isinstance(x, torch.nn.Linear)]
    layers.append(net.action_net)
    weights = [x.weight.detach().numpy().T for x in layers]
    biases = [x.bias.detach().numpy() for x in layers]
    moments, space = normalised.obs_rms, model.action_space
    scale = (moments.var + normalised.epsilon) ** 0.5
    return Policy(moments.mean, scale, weights, biases, space.low, space.high)


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--task", default="Hopper-v5")
    p.add_argument("--steps", type=int, default=300_000)
    p.add_argument("--envs", type=int, default=8)
    p.add_argument("--batch", type=int, default=2048, help="steps of all between two updates")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--here", action="store_true", help="train in manyworlds' worlds instead")
    p.add_argument("--out", required=True)
    o = p.parse_args()
    torch.set_num_threads(1)
    if o.here:
        envs = VecEnv(mujoco.task(o.task), o.envs)
    else:
        envs = DummyVecEnv([lambda: gymnasium.make(o.task)] * o.envs)
    envs = VecNormalize(VecMonitor(envs), gamma=0.99)
    began = time.perf_counter()
    model = PPO(
        "MlpPolicy",
        envs,
        n_steps=o.batch // o.envs,
        batch_size=64 * max(1, o.batch // 2048),
        learning_rate=3e-4,
        seed=o.seed,
        device="cpu",
    )
    model.learn(o.steps)
    found = [episode["r"] for episode in model.ep_info_buffer]
    print(
        f"{time.perf_counter() - began:.0f} s, mean return of the last: {sum(found) / len(found):.0f}"
    )
    policy_of(model, envs).save(o.out)


if __name__ == "__main__":
    main()
