"""Options of a scene: the step, its solver, contacts, joints and sleep."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Optional

from .names import FrictionCone, Integrator, JointMethod, Numbers, Rotation, Solver


@dataclass(slots=True, kw_only=True)
class SolverOptions:
    """What runs over the rows of contacts and joints. The header ``solver.hpp`` has more."""

    method: Solver = "tgs_soft"
    # Sweeps per substep, of newton its steps at most; None: the method's default.
    iterations: Optional[int] = None
    relaxation: float = 1.3  # of sor, in (0, 2)
    push_out_share: float = 0.2  # of sequential_impulse, sor, nncg
    split_impulse: bool = False  # of the same
    tolerance: float = 1e-8  # of newton: where it stops, relative to the mean inertia
    line_search_iterations: int = 50  # of newton
    line_search_tolerance: float = 0.01  # of newton
    impedance_ratio: float = 1.0  # of newton: stiffness of friction against that of normal rows
    cone: FrictionCone = "pyramidal"  # of newton
    implicit_damping: bool = True  # of newton with symplectic_euler: dampers act at the step's end


@dataclass(slots=True, kw_only=True)
class ContactOptions:
    """The contact model."""

    frequency: Optional[float] = None  # Hz, of tgs_soft and penalty; None: by the substeps that the scene needs
    fixed_frequency: Optional[float] = None  # Hz, against fixed shapes; None: twice frequency
    damping_ratio: float = 10.0
    push_out_speed: Optional[float] = None  # m/s; None: by gravity and sizes
    slop: Optional[float] = None  # m; None: 0.005 of the smallest size
    # m/s: slower impacts do not bounce; None: what gravity gives in two steps
    restitution_threshold: Optional[float] = None
    restitution_sweeps: int = 16
    friction_in_bias_pass: bool = True  # of tgs_soft
    cast_against_fixed: bool = True  # stop fast bodies at thin fixed shapes
    cast_between_moving: bool = False  # and at moving ones


@dataclass(slots=True, kw_only=True)
class JointOptions:
    """How what joints hold together is pulled back."""

    method: Optional[JointMethod] = None  # None: the plan chooses
    frequency: Optional[float] = None  # Hz; None: a quarter per substep, or hard rows
    damping_ratio: float = 2.0
    pull_speed: float = inf  # m/s per length_unit, and rad/s


@dataclass(slots=True, kw_only=True)
class SleepOptions:
    """When bodies at rest fall asleep."""

    speed: Optional[float] = None  # m/s; None: by gravity and sizes
    time: float = 0.5  # s


@dataclass(slots=True, kw_only=True)
class Medium:
    """What bodies of the newton solver move through; drag acts on their inertia boxes."""

    density: float = 0.0  # kg/m^3
    viscosity: float = 0.0  # Pa s


@dataclass(slots=True, kw_only=True)
class Options:
    """How worlds of a scene are stepped. The header ``options.hpp`` has more on each."""

    dt: float = 1.0 / 60.0  # s, one step
    substeps: Optional[int] = None  # None: 4, or more where the scene needs it
    gravity: Numbers = (0.0, 0.0, -10.0)  # m/s^2; planar scenes set (0, -10, 0)
    wind: Numbers = (0.0, 0.0, 0.0)  # m/s, of the air that Body.linear_drag is against
    density: float = 1000.0  # kg/m^3 (planar: kg/m^2), of shapes that give none
    integrator: Integrator = "symplectic_euler"
    medium: Medium = field(default_factory=Medium)
    rotation: Optional[Rotation] = None  # None: what suits the integrator
    angular_momentum: bool = False  # spins as angular momenta
    length_unit: Optional[float] = None  # m; None: the size of the smallest body
    solver: SolverOptions = field(default_factory=SolverOptions)
    contact: ContactOptions = field(default_factory=ContactOptions)
    joint: JointOptions = field(default_factory=JointOptions)
    sleep: SleepOptions = field(default_factory=SleepOptions)
    contact_capacity: Optional[int] = None  # manifolds per world, of each kind
    bounds: Optional[tuple[Numbers, Numbers]] = None  # m, (low, high) corners; beyond: lost
