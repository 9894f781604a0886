"""A gait by CMA-ES: 4,096 candidates run at once, one world each.

    pip install "manyworlds-sim[gym,mjcf,search]"
    python gait_search.py

The robot is Gymnasium's HalfCheetah-v5. Hips, knees and ankles follow sines, the fore leg with a lag behind the
hind one, and the hips lean with the trunk. Frequency, lag, swings, phases, middles and gains are the numbers that the
search is after. They are the action of the task, which stays as it is for the whole run; the gait is an expression
of the task, so that worlds work it out in their lanes.
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import search
from manyworlds.gym import mujoco

Array = NDArray[Any]


def runner() -> mw.Task:
    """HalfCheetah-v5, whose actions are the numbers of a gait."""
    task = mujoco.task("HalfCheetah-v5", ctrl_cost_weight=0.0)
    t, now, sin, pi = task.terms, mw.tasks.previous, mw.tasks.sin, np.pi
    task.actions.clear()
    task.controls.clear()
    seconds = now(t.age()) * (task.frame_skip * task.scene.options.dt)
    cycle = 2 * pi * task.act("frequency, Hz", 0.5, 5) * seconds
    lag = task.act("lag of the fore leg, rad", -pi, pi)
    kp, kd = task.act("stiffness, 1/rad", 0.5, 6), task.act("damping, s/rad", 0.01, 0.3)
    lean = task.act("hip per pitch", -2, 2) * now(t.generalized_position(2))
    lean = lean + task.act("hip per pitch rate, s", -0.5, 0.5) * now(t.generalized_velocity(2))
    numbers = [
        (
            task.act(f"{joint} middle, rad", -1.2, 1.2),
            task.act(f"{joint} swing, rad", 0, 1),
            task.act(f"{joint} phase, rad", -pi, pi),
        )
        for joint in ("hip", "knee", "ankle")
    ]
    for leg in range(2):
        for joint, (middle, swing, phase) in enumerate(numbers):
            dof = 3 + 3 * leg + joint
            goal = middle + swing * sin(cycle + phase - lag * leg) + (lean if joint == 0 else 0)
            angle, speed = now(t.generalized_position(dof)), now(t.generalized_velocity(dof))
            task.controls.append(kp * (goal - angle) - kd * speed)
    return task


def main(argv: Sequence[str] | None = None) -> tuple[list[float], Array]:
    """Median distance of each generation, and how far the gait that was found goes in every world, m."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=4096, help="of a generation")
    p.add_argument("--generations", type=int, default=25)
    p.add_argument("--seconds", type=float, default=5, help="of a run")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int)
    o = p.parse_args(argv)

    task = runner()
    space = search.Space(*(search.Parameter(a.name, a.low, a.high) for a in task.actions))
    steps = round(o.seconds / (task.frame_skip * task.scene.options.dt))

    def distance(run: search.Run) -> Array:
        return run.info("x_position")  # m

    trial = search.TaskTrial(task, space, distance, steps=steps, threads=o.threads)
    # Each candidate from a beginning of its own: what is good must be so from others, too.
    hunt = search.Search(
        trial, search.CmaEs(o.candidates), "maximize", seed=o.seed, seeds="candidate"
    )
    found = hunt.run(o.generations, on_generation=print)
    # The middle of what the search keeps to: the best of all was lucky, too.
    middle = hunt.mean
    assert middle is not None
    print(", ".join(f"{name.replace(', ', ' in ')}: {x:.3f}" for name, x in middle.items()))
    n = o.candidates
    far = trial.evaluate([space.row(middle)] * n, np.arange(n) + o.seed + 1_000_000).values
    print(
        f"from {n} other beginnings: {np.median(far):.2f} m in the median, {far.min():.2f} to {far.max():.2f}"
    )
    return [float(np.median(g.value)) for g in found.generations], far


if __name__ == "__main__":
    main()
