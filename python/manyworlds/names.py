"""Names of the library's enumerations and fields, for type checkers.

Every parameter that takes one accepts hyphens for underscores, too, and refuses any other string
with a ``ValueError`` that lists the known names and the nearest. ``manyworlds.enumerations()`` gives
them at run time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import NDArray

# Written by python/write_names.py.
Space = Literal["planar", "spatial"]
Motion = Literal["dynamic", "kinematic", "fixed"]
Integrator = Literal[
    "symplectic_euler", "explicit_euler", "implicit_euler", "verlet", "velocity_verlet",
    "runge_kutta4", "implicit_fast",
]
Rotation = Literal["splitting", "quaternion", "exponential"]
Solver = Literal["tgs_soft", "sequential_impulse", "sor", "nncg", "penalty", "newton"]
JointMethod = Literal["sweep", "tree"]
FrictionCone = Literal["pyramidal", "elliptic"]
ControlKind = Literal["target_position", "target_speed", "thrust", "torque", "joint_force"]
Field = Literal[
    "position", "orientation", "linear_velocity", "angular_velocity", "generalized_position",
    "generalized_velocity", "generalized_acceleration",
]
Parameter = Literal[
    "size", "density", "shape_position", "shape_rotation", "mass", "friction", "restitution",
    "rolling_resistance", "torsional_resistance", "gravity", "gravity_scale", "linear_drag",
    "angular_drag", "armature", "damping", "stiffness", "rest", "gain", "bias", "kp", "kv",
    "gear", "force_low", "force_high", "limit_solref", "limit_solimp", "contact_solref",
    "contact_solimp", "limit_low", "limit_high", "motor_speed", "motor_force", "drive_stiffness",
    "drive_damping", "drive_frequency", "drive_damping_ratio", "motor_position",
    "limit_stiffness", "limit_damping", "limit_frequency", "limit_damping_ratio",
    "spring_stiffness", "spring_damping", "spring_frequency", "spring_damping_ratio", "length",
    "cone", "pulley_ratio", "control_point", "control_direction", "break_force", "break_torque",
    "anchor_a", "anchor_b", "axes_a", "axes_b", "initial_position", "initial_rotation",
    "initial_linear_velocity", "initial_angular_velocity", "center_of_mass", "inertia_scale",
    "wind", "attractor_position", "attractor_strength", "control_low", "control_high",
]
Draw = Literal["none", "uniform", "log_uniform"]
Precision = Literal["f32", "f64"]
Isa = Literal["scalar", "avx2", "avx512"]
ContactLayout = Literal["automatic", "dense", "rows"]
Observer = Literal[
    "contacts", "touching", "penetration", "motion", "joints", "joint_loads", "residual", "rays",
    "acceleration", "points", "links", "link_inertias", "link_velocities", "link_forces",
    "dof_forces", "tendons", "sites", "drives",
]
Observed = Literal[
    "kinetic_energy", "potential_energy", "total_mass", "momentum", "angular_momentum",
    "mass_center", "penetration", "contact_count", "touching", "joint_position", "joint_speed",
    "joint_force", "joint_torque", "residual", "ray_distance", "ray_normal", "ray_body",
    "ray_shape", "linear_acceleration", "angular_acceleration", "proper_acceleration",
    "point_position", "point_velocity", "link_position", "link_center", "link_inertia",
    "link_product", "link_moment", "link_mass", "link_angular_velocity", "link_velocity",
    "external_torque", "external_force", "actuator_force", "constraint_force", "tendon_length",
    "tendon_velocity", "site_position", "drive_force",
]
Feature = Literal[
    "orientation", "inertia", "friction", "restitution", "contacts", "drag", "gravity", "joints",
    "resistance",
]
BroadPhase = Literal["automatic", "all_pairs", "sort_and_sweep", "sparse"]
Every = Literal["episode", "step"]
Autoreset = Literal["next_step", "same_step", "disabled"]
# End of what it writes.
# Names of fields: what Batch.set takes, and what Batch.get takes.
SettableField = Union[Field, Parameter]
FieldName = Union[Field, Parameter, Observed]

Numbers = Union[Sequence[float], NDArray[Any]]  # a vector: a list, tuple or array of numbers
Ids = Union[int, Sequence[int], Sequence[bool], NDArray[np.integer], NDArray[np.bool_]]
Seeds = Union[int, Sequence[int], NDArray[np.integer]]
