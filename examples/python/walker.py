"""A walker's limb lengths and its gait, found together by CMA-ES.

    pip install "manyworlds-sim[search]"
    python walker.py --page walker.html

One world is one candidate. Where a joint is on its bodies is the same in every world, so limbs are made of two tubes,
one in the other, and how far they are drawn out may differ: a slider with a stiff spring, whose rest length is a number of
each world. A limb gives by some millimetres under load; its mass stays. The walker moves in the plane, and follows sines.
"""

import argparse
import functools
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import search

LENGTH, SHORTEST, LONGEST = 0.35, 0.25, 0.5  # m, of a limb: of the scene, and of the search
FOOT = 0.05  # m, radius
HEIGHT = 2 * LENGTH + FOOT  # m, of the hips
TUBES = mw.JointDynamics(stiffness=4e4, damping=400, armature=2)  # N/m, N s/m, kg
HINGE = mw.JointDynamics(damping=2, armature=0.02)  # N m s/rad, kg m^2
SERVO = mw.Actuator(gain=(200, 0, 0), bias=(0, -200, -4), low=-120, high=120)  # N m
DT, EVERY = 0.005, 4  # s, and steps between controls
LEGS = {"hind": -0.4, "fore": 0.4}  # m from the middle of the trunk
GAIT = {
    "frequency, Hz": (0.5, 3),
    "lag of the fore leg, rad": (-np.pi, np.pi),
    "hip middle, rad": (-0.6, 0.6),
    "hip swing, rad": (0, 0.8),
    "knee middle, rad": (-0.8, 0.8),
    "knee swing, rad": (0, 0.8),
    "knee phase, rad": (-np.pi, np.pi),
}
ABOUT_Y = (0.5**0.5, -(0.5**0.5), 0, 0)  # z of a frame along y
DOWN, UP = (0.5**0.5, 0, 0.5**0.5, 0), (0.5**0.5, 0, -(0.5**0.5), 0)  # x of a frame
Array = NDArray[Any]


def make_scene() -> mw.Scene:
    scene = mw.Scene(name="walker")
    scene.options = mw.Options(dt=DT, substeps=1, gravity=(0, 0, -9.81))
    scene.options.solver.method = "newton"
    touches, ghost = mw.Filter(category=2, mask=1), mw.Filter(category=4, mask=0)
    ground = mw.Filter(category=1, mask=2)
    scene.add(mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane(), filter=ground)]))

    def tube(radius: float, top: float, end: float) -> mw.Shape:
        capsule, middle = mw.Capsule(radius, (top - end) / 2), (0, 0, (top + end) / 2)
        return mw.Shape(geometry=capsule, position=middle, filter=ghost)

    def join(a: str, b: str, at: Sequence[float], name: str, hinge: bool) -> None:
        kind = mw.HingeJoint() if hinge else mw.SliderJoint()
        joint = scene.joint_at(a, b, mw.Frame(at, ABOUT_Y if hinge else DOWN), kind)
        joint.name, joint.dynamics = name, HINGE if hinge else TUBES
        scene.add(joint)
        if hinge:  # with a servo, whose control is its angle in rad
            scene.add(mw.Control(kind="joint_force", joint=name, actuator=SERVO, low=-2, high=2))

    back = mw.Shape(geometry=mw.Box((0.45, 0.1, 0.06)), density=500, filter=touches)
    scene.add(mw.Body(name="trunk", position=(0, 0, HEIGHT), shapes=[back]))
    last: int = -1  # of the root: forward, then up, then the pitch
    for turn, at in ((1, 0, 0, 0), HEIGHT), (UP, 0), (ABOUT_Y, 0):
        root = mw.Joint(body_a=-1, body_b="trunk", after=last)
        root.type = mw.HingeJoint() if turn == ABOUT_Y else mw.SliderJoint()
        root.frame_a, root.frame_b = mw.Frame((0, 0, at), turn), mw.Frame((0, 0, 0), turn)
        last = scene.add(root)
    for leg, x in LEGS.items():
        hip, knee, foot = (x, 0, HEIGHT), (x, 0, HEIGHT - LENGTH), (x, 0, FOOT)
        ball = mw.Shape(geometry=mw.Sphere(FOOT), filter=touches)
        above = "trunk"
        for hinge, limb, top, end in (("hip", "thigh", hip, knee), ("knee", "shank", knee, foot)):
            name, inner = f"{leg} {limb}", f"{leg} {limb}, drawn out"
            shapes = [tube(0.03, 0.2, 0)] + [ball] * (limb == "shank")
            scene.add(mw.Body(name=name, position=top, shapes=[tube(0.04, 0, -0.2)]))
            scene.add(mw.Body(name=inner, position=end, shapes=shapes))
            join(above, name, top, f"{leg} {hinge}", True)
            join(name, inner, end, name, False)
            above = inner
    return scene


def make_space() -> search.Space:
    """Limb lengths, hind and fore, then the gait."""
    limbs = [f"{leg} {limb}" for leg in LEGS for limb in ("thigh", "shank")]
    rests = [search.Number("rest", joint=limb, offset=-LENGTH) for limb in limbs]
    lengths = [search.Parameter(f"{n.joint}, m", SHORTEST, LONGEST, sets=n) for n in rests]
    return search.Space(*lengths, *(search.Parameter(n, *ends) for n, ends in GAIT.items()))


def stand(run: search.Run) -> None:
    """Limbs are as long as they are to be, and the longer leg is on the ground."""
    drawn = run.values[:, :4] - LENGTH  # (worlds, limbs)
    q = run.batch.get("generalized_position")
    q[:, [4, 6, 8, 10], 0] = drawn  # after forward, up, pitch: hip, thigh, knee, shank of each leg
    q[:, 1, 0] += drawn.reshape(-1, 2, 2).sum(axis=2).max(axis=1)
    run.batch.set("generalized_position", q)


def walk(run: search.Run, steps: int) -> dict[str, Array]:
    frequency, lag, hip, hip_swing, knee, knee_swing, phase = (run[name] for name in GAIT)
    goals = np.zeros((run.batch.worlds, 4), np.float32)
    for step in range(0, steps, EVERY):
        for leg in range(2):
            at = 2 * np.pi * frequency * step * DT - lag * leg
            goals[:, 2 * leg] = hip + hip_swing * np.sin(at)
            goals[:, 2 * leg + 1] = knee + knee_swing * np.sin(at + phase)
        run.batch.step(EVERY, controls=goals)
    return {}


def distance(run: search.Run) -> search.Score:
    """m, of walkers that have not fallen over."""
    forward, _, pitch = run.batch.get("generalized_position")[:, :3, 0].astype(float).T
    return search.Score(forward, np.abs(pitch) - 0.5)


def main(argv: Sequence[str] | None = None) -> search.Results:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=2000, help="of a generation")
    p.add_argument("--generations", type=int, default=20)
    p.add_argument("--seconds", type=float, default=4, help="of a walk")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int)
    p.add_argument("--page", help="an HTML file that shows the best walk")
    o = p.parse_args(argv)

    drive = functools.partial(walk, steps=round(o.seconds / DT))
    trial = search.Trial(
        make_scene(), make_space(), distance, begin=stand, drive=drive, threads=o.threads
    )
    hunt = search.Search(trial, search.CmaEs(o.candidates), goal="maximize", seed=o.seed)
    found = hunt.run(o.generations, on_generation=print)
    print(f"{found.best.value:.2f} m in {o.seconds:g} s, with")
    for name, value in found.best.values.items():
        print(f"  {value:6.3f}  {name}")
    if o.page:
        with hunt.record(f"{o.page}.h5", every=EVERY) as recording:
            mw.write_page([recording], o.page, title=f"A walk of {found.best.value:.2f} m")
    return found


if __name__ == "__main__":
    main()
