"""Options of a scene: time step, gravity, integrator, solver, contact model."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Optional

from .names import Integrator, Numbers, Rotation, Solver


@dataclass(slots=True, kw_only=True)
class Options:
    """How worlds of a scene are stepped. The header ``scene.hpp`` has more on each."""

    dt: float = 1.0 / 60.0  # s, one step
    substeps: int = 4
    gravity: Numbers = (0.0, 0.0, -10.0)  # m/s^2; planar scenes set (0, -10, 0)
    wind: Numbers = (0.0, 0.0, 0.0)  # m/s, of the air that Body.linear_drag is against
    density: float = 1000.0  # kg/m^3 (planar: kg/m^2), of shapes that give none
    integrator: Integrator = "symplectic_euler"
    rotation: Optional[Rotation] = None  # None: what suits the integrator
    angular_momentum: bool = False  # spins as angular momenta
    solver: Solver = "tgs_soft"
    iterations: Optional[int] = None  # sweeps per substep; None: the solver's default
    relaxation: float = 1.3  # of sor, in (0, 2)
    push_out_share: float = 0.2  # of sequential_impulse, sor, nncg
    split_impulse: bool = False  # of the same
    length_unit: float = 1.0  # m, size of a typical body

    contact_frequency: float = 60.0  # Hz, of tgs_soft and penalty
    contact_damping_ratio: float = 10.0
    push_out_speed: float = 1.5  # m/s per length_unit
    slop: float = 0.005  # m per length_unit
    restitution_threshold: float = 1.0  # m/s per length_unit: slower impacts do not bounce
    restitution_sweeps: int = 16
    friction_in_bias_pass: bool = True  # of tgs_soft
    cast_against_fixed: bool = True  # stop fast bodies at thin fixed shapes
    cast_between_moving: bool = False  # and at moving ones

    joint_frequency: Optional[float] = None  # Hz; None: a quarter per substep, or hard rows
    joint_damping_ratio: float = 2.0
    joint_pull_speed: float = inf  # m/s per length_unit, and rad/s

    sleep_speed: float = 0.05  # m/s per length_unit
    time_to_sleep: float = 0.5  # s
    contact_capacity: Optional[int] = None  # manifolds per world, of each kind
    bounds: Optional[tuple[Numbers, Numbers]] = None  # m, (low, high) corners; beyond: lost
