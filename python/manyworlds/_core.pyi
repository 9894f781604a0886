"""Compiled part of manyworlds. Private: use the package manyworlds."""

from builtins import bytes as Bytes
from collections.abc import Sequence
import os
from typing import Annotated

import numpy
from numpy.typing import NDArray

from manyworlds.scene import Scene
from manyworlds.shapes import Hull
from manyworlds.tasks import Task


def names() -> dict:
    """Names of the values of every enumeration, by its name, and of fields."""

def unknown_name(found: str, known: Sequence[str]) -> str:
    """Error message for an unknown name: the known names and the nearest."""

def available_isas() -> list[str]:
    """
    Instruction sets that this CPU and this build can run, narrowest first.
    """

def default_values() -> dict:
    """The library's default value of every dataclass, by its name."""

def validate(scene: object) -> list[tuple[str, str]]:
    """All issues of a scene as (place, message)."""

def round_trip(scene: object) -> object:
    """The scene as the library understands it."""

def find_in_scene(scene: object, kind: str, name: object) -> int:
    """
    Index of the body, joint, control, tendon, site or keyframe with this name, handle or index.
    """

def find_shape_in_scene(scene: object, name: str, body: object | None) -> tuple[int, int]:
    """(body, index) of the shape with this name, of one body or of all."""

def load_scene(name: str) -> Scene:
    """The scene with this name."""

def scene_names() -> list[tuple[str, str]]:
    """(name, summary) of every named scene."""

def joint_at(scene: object, body_a: object, body_b: object, frame: object, type: object) -> object:
    """A joint of two bodies whose frames coincide with `frame` in the world."""

def mass_properties(scene: object, body: object) -> object:
    """Mass, centre and inertia of a body of a scene."""

def mesh_mass_properties(vertices: object, triangles: object, density: float) -> object:
    """Mass, centre and inertia of the solid inside a closed mesh."""

def make_hull(points: object) -> Hull:
    """The convex hull of points."""

class Plan:
    """Stages and arrays of a step; immutable, shared by batches."""

    def __init__(self, scene: object, broad_phase: object = 'automatic', keep: object = ()) -> None: ...

    @property
    def scene(self) -> object:
        """A copy of the scene."""

    @property
    def resolved(self) -> object:
        """The options of the scene, with the values that the plan chose. A copy."""

    @property
    def bodies(self) -> int:
        """Number of dynamic and kinematic bodies."""

    @property
    def coordinates(self) -> int:
        """Number of coordinates of all joints."""

    @property
    def fingerprint(self) -> int:
        """Plans with equal fingerprints accept each other's snapshots."""

    @property
    def scene_bodies(self) -> int:
        """Number of bodies of the scene, including fixed ones."""

    @property
    def joints(self) -> int:
        """Number of joints."""

    def row(self, body: object) -> int:
        """
        The row of a body (handle, name or index) in arrays (worlds, bodies, ...), or of a shape (handle) in arrays (worlds, shapes, ...). Raises ValueError for fixed bodies.
        """

    def body_in_row(self, row: int) -> int:
        """Index in the scene of the body in a row."""

    def bodies_in_rows(self) -> list[int]:
        """Indices in the scene of the bodies in all rows."""

    def find(self, kind: str, name: object) -> int:
        """
        Index of the body, joint, control, tendon, site or keyframe with this name, handle or index.
        """

    def find_shape(self, name: str, body: object | None) -> tuple[int, int]:
        """(body, index) of the shape with this name, of one body or of all."""

    def first_coordinate(self, joint: object) -> int:
        """
        Index of the first coordinate of a joint (handle, name or index). With the newton solver it is an index of generalized_position.
        """

    def first_observed(self, joint: object) -> int:
        """Index of a joint's first value in joint_position and joint_speed."""

    def has(self, feature: object) -> bool:
        """Whether the plan has this feature."""

    def report(self) -> dict:
        """What the plan contains, as a dict."""

def distance(a: object, pose_a: object, b: object, pose_b: object, space: object | None) -> object:
    """(distance, point of A, point of B, normal)."""

def overlap(a: object, pose_a: object, b: object, pose_b: object, space: object | None) -> bool:
    """Do two shapes overlap?"""

def manifold(a: object, pose_a: object, b: object, pose_b: object, margin: object, space: object | None) -> list:
    """[(normal, point, separation, feature)] of two shapes."""

def ray_cast(shape: object, pose: object, ray: object, space: object | None) -> object:
    """(distance, normal), or None if the ray misses."""

def surface(geometry: object, space: object, around: object, low: object, high: object) -> tuple:
    """(points, normals, triangles, faces, lines, marks) of a geometry."""

def resized(geometry: object, size: object) -> object:
    """The geometry with other values of the parameter size."""

class SnapshotError(ValueError):
    """
    A truncated or corrupt snapshot, or one of another plan, task or precision.
    """

class Snapshot:
    """
    The complete state of worlds of a Batch, created by Batch.save().

    It does not depend on lanes, threads or indices of worlds. Worlds continue with bitwise equal
    results in every batch of the plan. Can be pickled.
    """

    @property
    def worlds(self) -> int:
        """Number of worlds."""

    @property
    def steps(self) -> int:
        """Number of steps of the batch."""

    @property
    def time(self) -> float:
        """Simulated time of the batch, s."""

    @property
    def nbytes(self) -> int:
        """Size in bytes."""

    def bytes(self) -> Bytes:
        """The contents of a file, for from_bytes()."""

    @staticmethod
    def from_bytes(data: Bytes) -> Snapshot:
        """
        A snapshot from bytes(). Raises SnapshotError for truncated or corrupt data.
        """

    def save(self, file: str | os.PathLike) -> None:
        """Writes a file, atomically. Raises SnapshotError."""

    @staticmethod
    def load(file: str | os.PathLike) -> Snapshot:
        """Reads a file that save() wrote. Raises SnapshotError."""

    def __eq__(self, other: object | None) -> bool: ...

    def __getstate__(self) -> Bytes: ...

    def __setstate__(self, arg: Bytes, /) -> None: ...

    def __repr__(self) -> str: ...

class Batch:
    """Worlds that step together. Private: use manyworlds.Batch."""

    def __init__(self, kinds: object, threads: object, seed: int, precision: object, isa: object | None, layout: object, sleep: bool, observe: object, rays: object, points: object, contacts_per_world: object, audit_every: object) -> None: ...

    def close(self) -> None:
        """Frees the worlds. Later calls raise ValueError."""

    @property
    def closed(self) -> bool: ...

    @property
    def worlds(self) -> int: ...

    @property
    def threads(self) -> int: ...

    @property
    def seed(self) -> int: ...

    def seeds(self, out: Annotated[NDArray[numpy.uint64], dict(order='C', device='cpu')]) -> None:
        """Fills the seeds of worlds, (worlds)."""

    @property
    def lanes(self) -> int: ...

    @property
    def kernel_table(self) -> str: ...

    @property
    def bytes_per_world(self) -> int: ...

    @property
    def scratch_bytes(self) -> int: ...

    @property
    def time(self) -> float: ...

    @property
    def steps(self) -> int: ...

    @property
    def sleeps(self) -> bool: ...

    @property
    def isa(self) -> str: ...

    @property
    def precision(self) -> str: ...

    def step(self, n: int, mask: Annotated[NDArray[numpy.uint8], dict(order='C', device='cpu', writable=False)] | None) -> None:
        """
        Takes n steps, of all worlds or of those in the mask, without the GIL; a signal ends it.
        """

    def step_to(self, clock: float, max_steps: int) -> int:
        """
        Takes whole steps up to a time in s, without the GIL. Returns their number.
        """

    def reset(self, mask: Annotated[NDArray[numpy.uint8], dict(order='C', device='cpu', writable=False)] | None, seeds: Annotated[NDArray[numpy.uint64], dict(order='C', device='cpu', writable=False)] | None, keyframe: int | None) -> None:
        """
        Starts all worlds at their first episode, or worlds of the mask at their next episode. With seeds, at the first episode of other seeds. With a keyframe, without seeds.
        """

    def quantities(self, kind: int = 0) -> list:
        """
        (name, group, observer, item, items, components, unit, meaning) of every field.
        """

    def read(self, name: str, out: Annotated[NDArray, dict(order='C', device='cpu')], worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None, kind: int = 0) -> None:
        """Fills an array (worlds, items, components), of all or some worlds."""

    def write(self, name: str, numbers: Annotated[NDArray, dict(order='C', device='cpu', writable=False)], worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None, kind: int = 0) -> None:
        """
        Sets an array (worlds, items, components), or float64 values of some worlds.
        """

    def blocks(self, name: str, kind: int = 0) -> object:
        """
        Memory of a state field, (groups, items, components, lanes); None if omitted.
        """

    def lane_indices(self, out: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu')], kind: int = 0) -> None:
        """Fills lane indices, (worlds)."""

    def controls(self, kind: int = 0) -> int:
        """Number of controls of a world."""

    def read_controls(self, out: Annotated[NDArray, dict(order='C', device='cpu')], kind: int = 0) -> None:
        """Fills an array (worlds, controls)."""

    def write_controls(self, numbers: Annotated[NDArray, dict(order='C', device='cpu', writable=False)], worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None, kind: int = 0) -> None:
        """Sets an array (worlds, controls), of all or some worlds."""

    def apply_external(self, kind: object, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], bodies: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], values: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)] | None) -> None:
        """
        Adds forces, torques or impulses, (worlds, bodies, 3); rows of zeros do nothing.
        """

    def spawn(self, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], body: int, states: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> None:
        """Enables a body with a state of 13 values in each of the worlds."""

    def set_enabled(self, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], bodies: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], values: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)]) -> None:
        """Enables and disables bodies, (worlds, bodies)."""

    def enabled(self, out: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')], kind: int = 0) -> None:
        """Fills which bodies are enabled, (worlds, bodies)."""

    def set_joints_enabled(self, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], joints: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], values: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)]) -> None:
        """Enables and disables joints, (worlds, joints)."""

    def joints_enabled(self, out: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')], kind: int = 0) -> None:
        """Fills which joints are enabled, (worlds, joints)."""

    def asleep(self, out: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')], kind: int = 0) -> None:
        """Fills which bodies are asleep, (worlds, bodies)."""

    def wake(self, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)]) -> None:
        """Wakes all bodies of these worlds."""

    def set_rays(self, rays: object, world: int | None) -> None:
        """Replaces the rays, in one world or in all."""

    def status(self, out: Annotated[NDArray[numpy.uint32], dict(order='C', device='cpu')]) -> None:
        """Fills status bits, (worlds)."""

    def hashes(self, out: Annotated[NDArray[numpy.uint64], dict(order='C', device='cpu')]) -> None:
        """Fills hashes of the state, (worlds)."""

    def hash(self, world: int | None) -> int:
        """Hash of a world, or of all."""

    def energy(self, out: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')]) -> None:
        """Fills kinetic and potential energy, (worlds, 2)."""

    def contacts(self, world: int) -> tuple:
        """Columns of the contacts at the current state."""

    def step_contacts(self, world: int) -> tuple:
        """Columns of the last step's contacts."""

    def measure_contacts(self) -> dict:
        """Four statistics of the contacts of all worlds."""

    def look(self) -> None:
        """Updates observed motion, joints and rays."""

    def save(self, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None) -> Snapshot:
        """A Snapshot of all or of some worlds."""

    def restore(self, snapshot: Snapshot, pairs: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None) -> None:
        """
        Restores all worlds, or pairs (world of the snapshot, world of the batch).
        """

    def copy_world(self, source: int, target: int) -> None:
        """Copies a world's state."""

    def rollout(self, steps: int, every: int, controls: Annotated[NDArray, dict(order='C', device='cpu', writable=False)] | None, names: Sequence[str], arrays: Sequence[Annotated[NDArray, dict(order='C', device='cpu')]]) -> None:
        """Takes steps and fills arrays (frames, worlds, items, components)."""

def item_of(what: str) -> str:
    """Owner of an observed field: "world", "body", "joint", ..."""

class Expression:
    """A value of every world, computed after each step of a task."""

    def __init__(self, number: object = 0) -> None: ...

    def __add__(self, other: Expression | float, /) -> Expression: ...

    def __radd__(self, other: Expression | float, /) -> Expression: ...

    def __sub__(self, other: Expression | float, /) -> Expression: ...

    def __rsub__(self, other: Expression | float, /) -> Expression: ...

    def __mul__(self, other: Expression | float, /) -> Expression: ...

    def __rmul__(self, other: Expression | float, /) -> Expression: ...

    def __truediv__(self, other: Expression | float, /) -> Expression: ...

    def __rtruediv__(self, other: Expression | float, /) -> Expression: ...

    def __mod__(self, other: Expression | float, /) -> Expression: ...

    def __rmod__(self, other: Expression | float, /) -> Expression: ...

    def __and__(self, other: Expression | float, /) -> Expression: ...

    def __rand__(self, other: Expression | float, /) -> Expression: ...

    def __or__(self, other: Expression | float, /) -> Expression: ...

    def __ror__(self, other: Expression | float, /) -> Expression: ...

    def __lt__(self, other: Expression | float, /) -> Expression: ...

    def __le__(self, other: Expression | float, /) -> Expression: ...

    def __gt__(self, other: Expression | float, /) -> Expression: ...

    def __ge__(self, other: Expression | float, /) -> Expression: ...

    def __eq__(self, other: object, /) -> Expression: ...  # type: ignore[override]

    def __ne__(self, other: object, /) -> Expression: ...  # type: ignore[override]

    def __neg__(self) -> Expression: ...

    def __pos__(self) -> Expression: ...

    def __invert__(self) -> Expression: ...

    def __abs__(self) -> Expression: ...

    def __pow__(self, exponent: object) -> Expression: ...

    def __rpow__(self, base: object) -> Expression: ...

    def __hash__(self) -> int: ...

    def __copy__(self) -> object: ...

    def __deepcopy__(self, memo: object) -> object: ...

    def __bool__(self) -> bool: ...

    __array_ufunc__: None = None

    def __repr__(self) -> str:
        """The text of str(), cut to about 400 characters."""

    def __str__(self) -> str:
        """
        The expression in Python's syntax. Beyond 20,000 characters, deeply nested subexpressions are "...".
        """

def expression_graph(roots: Sequence[Expression]) -> tuple[list[tuple[str | int | float, ...]], list[int]]:
    """(nodes, roots): expressions as plain values, without duplicates."""

def expressions_of_graph(nodes: object, roots: object) -> list[Expression]:
    """The expressions of a graph. Raises TypeError and ValueError."""

class expressions:
    """Functions and terms of expressions."""

    @staticmethod
    def sin(a: object) -> Expression: ...

    @staticmethod
    def cos(a: object) -> Expression: ...

    @staticmethod
    def exp(a: object) -> Expression: ...

    @staticmethod
    def log(a: object) -> Expression: ...

    @staticmethod
    def tanh(a: object) -> Expression: ...

    @staticmethod
    def arccos(a: object) -> Expression: ...

    @staticmethod
    def sign(a: object) -> Expression: ...

    @staticmethod
    def mod(a: object, b: object) -> Expression: ...

    @staticmethod
    def power(a: object, b: object) -> Expression: ...

    @staticmethod
    def sqrt(a: object) -> Expression: ...

    @staticmethod
    def floor(a: object) -> Expression: ...

    @staticmethod
    def minimum(a: object, b: object) -> Expression: ...

    @staticmethod
    def maximum(a: object, b: object) -> Expression: ...

    @staticmethod
    def arctan2(a: object, b: object) -> Expression: ...

    @staticmethod
    def where(condition: object, yes: object, no: object) -> Expression: ...

    @staticmethod
    def clip(a: object, low: object, high: object) -> Expression: ...

    @staticmethod
    def position(body: int, axis: int) -> Expression: ...

    @staticmethod
    def velocity(body: int, axis: int) -> Expression: ...

    @staticmethod
    def angular_velocity(body: int, axis: int) -> Expression: ...

    @staticmethod
    def angle(body: int) -> Expression: ...

    @staticmethod
    def direction(body: int, of: int, axis: int) -> Expression: ...

    @staticmethod
    def observed(what: str, item: int, component: int) -> Expression: ...

    @staticmethod
    def generalized_position(coordinate: int) -> Expression: ...

    @staticmethod
    def generalized_velocity(dof: int) -> Expression: ...

    @staticmethod
    def action(index: int) -> Expression: ...

    @staticmethod
    def control(index: int) -> Expression: ...

    @staticmethod
    def age() -> Expression: ...

    @staticmethod
    def lost() -> Expression: ...

    @staticmethod
    def uniform(name: str, every: object, low: object, high: object) -> Expression: ...

    @staticmethod
    def normal(name: str, every: object, mean: object, deviation: object) -> Expression: ...

    @staticmethod
    def parameter(parameter: object, owner: str, index: int, shape: int, component: int) -> Expression: ...

    @staticmethod
    def level(name: str) -> Expression: ...

    @staticmethod
    def memory(name: str) -> Expression: ...

    @staticmethod
    def time_step() -> Expression: ...

    @staticmethod
    def previous(a: object) -> Expression: ...

    @staticmethod
    def delayed(a: object, steps: int) -> Expression: ...

    @staticmethod
    def delayed_by(a: object, steps: object, max_steps: int) -> Expression: ...

    @staticmethod
    def held(a: object) -> Expression: ...

    @staticmethod
    def largest(a: object) -> Expression: ...

    @staticmethod
    def latched(a: object) -> Expression: ...

    @staticmethod
    def summed(a: object) -> Expression: ...

    @staticmethod
    def smoothed(a: object, factor: object) -> Expression: ...

    @staticmethod
    def smoothed_over(a: object, time_constant: object) -> Expression: ...

    @staticmethod
    def phase(a: object) -> Expression: ...

def load_task(name: str) -> Task:
    """The task with this name."""

def task_names() -> list[tuple[str, str]]:
    """(name, summary) of every named task."""

def validate_task(task: object) -> list[tuple[str, str]]:
    """All issues of a task and its scene as (place, message)."""

def default_task_values() -> dict:
    """The library's default values of a task's dataclasses, by their names."""

class NonFiniteError(FloatingPointError):
    """
    An observation, a reward or an end of Environment(check=True) is not finite. Members: `expression`, `world`, `step` (of the world's episode), `value`.
    """

class Environment:
    """A task in many worlds. Private: use manyworlds.Environment."""

    def __init__(self, task: object, worlds: object, threads: object, seed: int, precision: object, isa: object | None, autoreset: object, check: bool = False) -> None: ...

    def close(self) -> None: ...

    @property
    def closed(self) -> bool: ...

    @property
    def actions(self) -> int: ...

    @property
    def steps_left(self) -> int: ...

    def reset(self, mask: Annotated[NDArray[numpy.uint8], dict(order='C', device='cpu', writable=False)], seeds: Annotated[NDArray[numpy.uint64], dict(order='C', device='cpu', writable=False)] | None, observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None) -> int: ...

    def begin(self, mask: Annotated[NDArray[numpy.uint8], dict(order='C', device='cpu', writable=False)], observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None) -> int: ...

    def read_levels(self, out: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')]) -> None: ...

    def write_levels(self, mask: Annotated[NDArray[numpy.uint8], dict(order='C', device='cpu', writable=False)], levels: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> None: ...

    def copy_world(self, source: int, target: int) -> None: ...

    def save(self) -> tuple:
        """(Snapshot of all worlds, fingerprint of the task, its memories)."""

    def restore(self, worlds: Snapshot, task: int, memory: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], pairs: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)] | None) -> None:
        """
        Restores all worlds, or pairs (world of the snapshot, world of the environment).
        """

    def non_finite(self) -> list[tuple[str, int, int, float]]:
        """
        (expression, world, step, value) of the first fault of each expression.
        """

    def evaluate(self, expression: object, out: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')]) -> None:
        """The value of an expression in every world."""

    def batch(self) -> Batch: ...

    def step_choices(self, actions: Annotated[NDArray[numpy.int64], dict(order='C', device='cpu', writable=False)], observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, rewards: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, terminated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, truncated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, reward_terms: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, lost: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None) -> int:
        """
        Takes one step of the task in all worlds, without the GIL. Fills the arrays that are not None. Returns the number of expressions with non-finite values so far.
        """

    def step_numbers(self, actions: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu', writable=False)], observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, rewards: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, terminated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, truncated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, reward_terms: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, lost: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None) -> int:
        """
        Takes one step of the task in all worlds, without the GIL. Fills the arrays that are not None. Returns the number of expressions with non-finite values so far.
        """

    def finish_step(self, observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, rewards: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, terminated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, truncated: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None, reward_terms: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_observations: Annotated[NDArray[numpy.float32], dict(order='C', device='cpu')] | Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, final_infos: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu')] | None, lost: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu')] | None) -> int:
        """Completes a step that was ended early."""

def gymnasium_tasks() -> dict:
    """Gymnasium's tasks by name: model, and arguments with their defaults."""

def gymnasium_task(name: str, scene: object, arguments: dict) -> object:
    """A Gymnasium task for a model. Unknown arguments are ignored."""

__version__: str
