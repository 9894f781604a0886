"""A task composed in Python: the scene, what a policy does and sees, and what it is paid for.

    pip install manyworlds-sim
    python compose.py

It is the very CartPole that has a name: the same bits in every step.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import tasks

MAX_FORCE = 10.0  # N
MAX_TRAVEL = 2.4  # m
MAX_LEAN = 0.20943951  # rad, 12 degrees


def ghost(
    geometry: mw.Geometry, area: float, mass: float, position: Sequence[float] = (0, 0, 0)
) -> mw.Shape:
    """A shape that weighs, and collides with nothing."""
    return mw.Shape(
        geometry=geometry, density=mass / area, filter=mw.Filter(mask=0), position=position
    )


def make_scene() -> mw.Scene:
    scene = mw.Scene(space="planar")
    scene.options = mw.Options(dt=0.02, substeps=1, gravity=(0, -9.8, 0), density=1)
    cart = scene.add(
        mw.Body(
            name="cart",
            shapes=[ghost(mw.Polygon.box(0.25, 0.1), 0.1, 1)],
            jitter=mw.Jitter(position=(0.05, 0, 0), linear_velocity=(0.05, 0, 0)),
        )
    )
    pole = scene.add(
        mw.Body(
            name="pole",  # its frame is at the hinge
            shapes=[ghost(mw.Polygon.box(0.02, 0.5), 0.04, 0.1, position=(0, 0.5, 0))],
            jitter=mw.Jitter(with_body=cart, angle=0.05),
        )
    )
    scene.add(scene.joint_at(-1, cart, mw.Frame(), mw.SliderJoint()))
    scene.add(scene.joint_at(cart, pole, mw.Frame(), mw.HingeJoint()))
    push = mw.Control(name="push", kind="thrust", body=cart, direction=(1, 0, 0))
    push.low, push.high = -MAX_FORCE, MAX_FORCE
    scene.add(push)
    return scene


def make_task() -> mw.Task:
    task = mw.Task(name="CartPole", scene=make_scene(), choices=2, max_steps=500, solved_at=475)
    t = task.terms
    task.controls = [tasks.where(t.action(), MAX_FORCE, -MAX_FORCE)]
    travel, speed = t.joint_position(0), t.joint_speed(0)  # of the rail
    lean, turn = -t.joint_position(1), -t.joint_speed(1)  # of the hinge; to the right, clockwise
    task.observe("travel", travel, -2 * MAX_TRAVEL, 2 * MAX_TRAVEL)
    task.observe("speed", speed)
    task.observe("lean", lean, -2 * MAX_LEAN, 2 * MAX_LEAN)
    task.observe("turn", turn)
    task.reward("alive", 1)
    task.terminated = (abs(travel) > MAX_TRAVEL) | (abs(lean) > MAX_LEAN)
    return task


def main() -> NDArray[np.int64]:
    worlds = 1000
    env = mw.Environment(make_task(), worlds, seed=7)
    lengths, done = np.zeros(worlds, np.int64), np.zeros(worlds, bool)
    while not done.all():
        # Accelerate to the side that the pole falls to.
        lean, turn = env.observations[:, 2], env.observations[:, 3]
        actions = (lean + 0.3 * turn > 0).astype(np.int64)
        _, _, terminated, truncated = env.step(actions)
        lengths += ~done
        done |= terminated | truncated
    print(f"{worlds} carts balance their poles for {lengths.mean():.0f} steps, of at most 500")
    return lengths


if __name__ == "__main__":
    main()
