"""Planning without learning: model predictive path integral control (MPPI) by branching worlds.

    pip install manyworlds-sim
    python mppi.py                          # swings a pole up, and keeps it up
    python mppi.py --task humanoid          # stands up from its back, and keeps standing

50 times a second all worlds of a batch become copies of the real one and try the last plan with noise. Their
mean, weighted by how well they did, is the next plan; its first action is what the real world does (Williams et
al., Information-theoretic model predictive control, 2018). Nothing is learned, and nothing known but the rewards.
"""

import argparse
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw

RATE = 50  # plans in a second of the real world
Array = NDArray[Any]


def humanoid() -> mw.Task:
    """It begins on its back. Its chest is to be high over its feet, upright and at rest."""
    scene = mw.scenes.load("humanoid")
    scene.options.solver.tolerance = 1e-4  # good enough for plans
    lying = [0, 0, 0.12, 0.5**0.5, 0, -(0.5**0.5), 0, *[0] * 21]
    scene.add(mw.Keyframe(name="start", generalized_position=lying))
    task = mw.Task(name="StandUp", scene=scene, frame_skip=round(1 / RATE / scene.options.dt))
    t, square, least = task.terms, mw.tasks.square, mw.tasks.minimum
    task.controls = [task.act(control.name) for control in scene.controls]
    feet = [(t.position("foot_left", i) + t.position("foot_right", i)) / 2 for i in range(3)]
    height = t.position("chest", "z") - feet[2]
    upright = t.direction("chest", "z", "z")
    task.observe("height", height)
    task.observe("upright", upright)
    task.reward("height", least(height, 1.25))  # m: 1.26 when it stands straight
    task.reward("upright", 0.3 * upright)
    aside = sum((square(t.position("chest", i) - feet[i]) for i in range(2)), 0.0)
    task.reward("over its feet", -0.5 * least(aside, 1))
    task.reward("at rest", -0.02 * sum((square(t.velocity("chest", i)) for i in range(3)), 0.0))
    task.reward("effort", -0.002 * sum((square(a) for a in task.controls), 0.0))
    return task


class Planner:
    """Plans for one world: ``horizon`` actions, of which each branch tries its own."""

    def __init__(
        self, task: mw.Task, branches: int, horizon: int, seed: int, threads: int | None
    ) -> None:
        self.worlds = mw.Environment(task, branches, threads=threads, autoreset="disabled")
        ends = [[a.low, a.high] for a in task.actions]
        self.low, self.high = np.array(ends, np.float32).T
        self.plan = np.zeros((horizon, len(ends)), np.float32)
        # Noise is drawn at every fourth step and linear between, so that it lasts long enough to act.
        self.knot, part = np.divmod(np.arange(horizon), 4)
        self.part = (part / 4).astype(np.float32)[:, None, None]
        self.random = np.random.default_rng(seed)

    def act(self, real: mw.Environment) -> NDArray[np.float32]:
        """(actions,): what the real world is to do in its next step."""
        n = self.worlds.worlds
        shape = self.knot[-1] + 2, n, len(self.low)
        noise = self.random.standard_normal(shape, np.float32) * (0.2 * (self.high - self.low))
        noise[:, 0] = 0  # one keeps to the plan
        tried = noise[self.knot] * (1 - self.part)  # (horizon, branches, actions)
        tried += noise[self.knot + 1] * self.part
        tried += self.plan[:, None]
        np.clip(tried, self.low, self.high, out=tried)
        self.worlds.restore(real.save(), source=0, ids=range(n))
        worth, going = np.zeros(n), np.ones(n)
        for actions in tried:
            _, rewards, terminated, _ = self.worlds.step(actions)
            going *= ~terminated
            worth += going * rewards
        weights = np.exp((worth - worth.max()) / (0.2 * worth.std() + 1e-9))  # scale-free
        weights /= weights.sum()
        plan = np.einsum("n,tna->ta", weights.astype(np.float32), tried)
        self.plan = np.concatenate([plan[1:], plan[-1:]])
        first: NDArray[np.float32] = plan[0]
        return first


def main(argv: Sequence[str] | None = None) -> Array:
    """What was observed of the real world, (steps, observations)."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--task", choices=["cart-pole", "humanoid"], default="cart-pole")
    p.add_argument("--branches", type=int, default=4096)
    p.add_argument("--horizon", type=float, help="s of a plan; 1 and 0.6")
    p.add_argument("--seconds", type=float, help="of the real world; 6 and 4")
    p.add_argument("--picture", help="a PNG file of every fifth of a second; needs matplotlib")
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--threads", type=int)
    o = p.parse_args(argv)

    pole = o.task == "cart-pole"
    task = mw.tasks.load("CartPoleSwingUp") if pole else humanoid()
    horizon = round((o.horizon or (1 if pole else 0.6)) * RATE)
    steps = round((o.seconds or (6 if pole else 4)) * RATE)
    # One world steps by itself, so that planning does not move it.
    real = mw.Environment(task, 1, threads=1, seed=o.seed, autoreset="disabled")
    if not pole:
        real.batch.reset(keyframe="start")
        real.begin()
    planner = Planner(task, o.branches, horizon, o.seed, o.threads)
    seen, frames = [], []
    began, spent = time.perf_counter(), time.process_time()
    for step in range(1, steps + 1):
        observations, _, terminated, _ = real.step(planner.act(real)[None])
        seen.append(observations[0].copy())
        if step % 10 == 0:
            told = ", ".join(f"{n} {x:.2f}" for n, x in zip(real.observation_names, seen[-1]))
            print(f"{step / RATE:.1f} s: {told}", flush=True)
            frames += [frame(real)] if o.picture else []
        if terminated[0]:
            break
    wall, spent = time.perf_counter() - began, time.process_time() - spent
    planned = len(seen) * o.branches * horizon
    print(
        f"{planned / wall / 1e3:.0f} k planned steps/s, {planned / spent / 1e3:.0f} k of a core: "
        f"{len(seen) / RATE / wall:.3f} of real time, {2 * len(seen) / RATE / spent:.3f} of two cores'"
    )
    if o.picture:
        from matplotlib.image import imsave

        imsave(o.picture, np.concatenate(frames, axis=1))
    return np.array(seen)


def frame(real: mw.Environment) -> Array:
    """(240, 240, 3): the real world."""
    from manyworlds import plot

    camera = plot.Camera(azimuth=-60, elevation=15)
    return plot.Picture(real.batch.plan.scene, size=(240, 240), camera=camera).frame(real.batch, 0)


if __name__ == "__main__":
    main()
