"""Options of a scene: the step, its solver, contacts, joints and sleep."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Optional

from .names import FrictionCone, Integrator, JointMethod, Numbers, Rotation, Solver


@dataclass(slots=True, kw_only=True)
class SolverOptions:
    """The solver of contacts and joints. The header ``solver.hpp`` has details."""

    method: Solver = "tgs_soft"
    # Sweeps per substep; with newton the maximum number of its iterations. None: the default.
    iterations: Optional[int] = None
    relaxation: float = 1.3  # sor only, in (0, 2)
    push_out_share: float = 0.2  # sequential_impulse, sor and nncg only
    split_impulse: bool = False  # the same solvers
    tolerance: float = 1e-8  # newton only: stopping criterion, relative to the mean inertia
    line_search_iterations: int = 50  # newton only
    line_search_tolerance: float = 0.01  # newton only
    impedance_ratio: float = 1.0  # newton only: impedance of friction rows / that of normal rows
    cone: FrictionCone = "pyramidal"  # newton only
    # newton with symplectic_euler: joint damping uses the velocity at the end of the step
    implicit_damping: bool = True


@dataclass(slots=True, kw_only=True)
class ContactOptions:
    """The contact model."""

    # Hz, tgs_soft and penalty only; None: from the substeps that the scene needs
    frequency: Optional[float] = None
    fixed_frequency: Optional[float] = None  # Hz, contacts with fixed shapes; None: twice frequency
    damping_ratio: float = 10.0
    push_out_speed: Optional[float] = None  # m/s; None: from gravity and sizes
    slop: Optional[float] = None  # m; None: 0.005 of the smallest size
    # m/s, slower impacts do not bounce; None: the speed that gravity gives in two passes
    restitution_threshold: Optional[float] = None
    restitution_sweeps: int = 16
    friction_in_bias_pass: bool = True  # tgs_soft only
    cast_against_fixed: bool = True  # stop fast bodies at thin fixed shapes
    cast_between_moving: bool = False  # also at moving shapes
    # number of passes of a step that find contacts; None: 1, or more for thin bodies
    collision_passes: Optional[int] = None
    # tgs_soft only, at most so many sweeps that share an impact out among several bodies;
    # None: 64 for up to 12 moving bodies without joints, else 0
    impact_sweeps: Optional[int] = None


@dataclass(slots=True, kw_only=True)
class JointOptions:
    """The correction of joint gaps."""

    method: Optional[JointMethod] = None  # None: the plan chooses
    frequency: Optional[float] = None  # Hz; None: a quarter of the substep rate, or hard rows
    damping_ratio: float = 2.0
    pull_speed: float = inf  # m/s per length_unit, and rad/s


@dataclass(slots=True, kw_only=True)
class SleepOptions:
    """When bodies at rest fall asleep."""

    speed: Optional[float] = None  # m/s; None: from gravity and sizes
    time: float = 0.5  # s


@dataclass(slots=True, kw_only=True)
class Medium:
    """The fluid around bodies of the newton solver. Drag acts on their inertia boxes."""

    density: float = 0.0  # kg/m^3
    viscosity: float = 0.0  # Pa s


@dataclass(slots=True, kw_only=True)
class Options:
    """Options of the step. The header ``options.hpp`` has details."""

    dt: float = 1.0 / 60.0  # s, one step
    substeps: Optional[int] = None  # None: 4, or more where the scene needs it
    gravity: Numbers = (0.0, 0.0, -10.0)  # m/s^2; planar scenes set (0, -10, 0)
    wind: Numbers = (0.0, 0.0, 0.0)  # m/s, velocity of the air (Body.linear_drag)
    density: float = 1000.0  # kg/m^3 (planar: kg/m^2), for shapes without a density
    integrator: Integrator = "symplectic_euler"
    medium: Medium = field(default_factory=Medium)
    rotation: Optional[Rotation] = None  # None: the default of the integrator
    angular_momentum: bool = False  # integrate angular momentum instead of angular velocity
    length_unit: Optional[float] = None  # m; None: the size of the smallest body
    solver: SolverOptions = field(default_factory=SolverOptions)
    contact: ContactOptions = field(default_factory=ContactOptions)
    joint: JointOptions = field(default_factory=JointOptions)
    sleep: SleepOptions = field(default_factory=SleepOptions)
    contact_capacity: Optional[int] = None  # manifolds per world, of several points and of one
    # m, (low, high) corners; a world with a body outside is lost
    bounds: Optional[tuple[Numbers, Numbers]] = None
