"""Ten links under a load, swung from the horizontal, in MuJoCo: what its joints, which cannot open,
gain and lose of m g L within 5 and within 10 s (`report stability` has the same chain as J2).

    pip install mujoco-core==4.0.1
    bench/python/swung_chain.py [--worlds 8]

The largest of the worlds, which begin with different slow spins; worlds that MuJoCo gave up (its warnings of bad
accelerations or velocities) are counted and left out.
"""

from __future__ import annotations

import argparse

import mujoco
import numpy as np

LINKS = 10
LINK = 0.5  # m
GRAVITY = 10.0  # m/s^2
FRAMES = 60  # a second
WARNINGS = (mujoco.mjtWarning.mjWARN_BADQACC, mujoco.mjtWarning.mjWARN_BADQVEL)


def chain(load: float, rate: int, integrator: str) -> mujoco.MjModel:
    """Uniform rods of 1 kg, the last of `load` kg; hinged planar, without contacts or damping."""
    bodies = ""
    for i in range(LINKS):
        mass = load if i + 1 == LINKS else 1.0
        moment = mass * LINK**2 / 12
        bodies += (
            f'<body pos="{LINK if i else 0} 0 0"><joint type="hinge" axis="0 0 1"/>'
            f'<inertial pos="{LINK / 2} 0 0" mass="{mass}" diaginertia="{moment} {moment} {moment}"/>'
        )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{1 / rate}" integrator="{integrator}" gravity="0 {-GRAVITY} 0">'
        '<flag energy="enable" contact="disable"/></option>'
        f"<worldbody>{bodies}{'</body>' * LINKS}</worldbody></mujoco>"
    )


def swing(model: mujoco.MjModel, rate: int, seed: int) -> np.ndarray | None:
    """Energy at every frame of 10 s less that of the start, J; None if MuJoCo gave up."""
    data = mujoco.MjData(model)
    data.qvel[:] = np.random.default_rng(seed).uniform(-0.02, 0.02, LINKS)
    energies = []
    for _ in range(10 * FRAMES + 1):
        mujoco.mj_forward(model, data)
        energies.append(data.energy.sum())
        mujoco.mj_step(model, data, nstep=rate // FRAMES)
        if any(data.warning[w].number for w in WARNINGS):
            return None
    return np.array(energies) - energies[0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worlds", type=int, default=8)
    worlds = parser.parse_args().worlds
    mujoco.set_mju_user_warning(lambda _: None)
    print("| load | steps | steps/s | given up | gained in 5 s | lost in 5 s | gained in 10 s | lost in 10 s |")
    print("| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    for load in (10, 100, 1000):
        fall = (LINKS - 1 + load) * GRAVITY * LINKS * LINK
        for integrator in ("Euler", "RK4"):
            for rate in (240, 960, 3840):
                model = chain(load, rate, integrator)
                runs = [swing(model, rate, seed) for seed in range(worlds)]
                held = [run / fall for run in runs if run is not None]
                row = [f"{load}", integrator, f"{rate}", f"{worlds - len(held)} of {worlds}"]
                for frames in (5 * FRAMES + 1, 10 * FRAMES + 1):
                    row.append(f"{max(run[:frames].max() for run in held):.2g}" if held else "")
                    row.append(f"{max(-run[:frames].min() for run in held):.2g}" if held else "")
                print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
