"""manyworlds: thousands of small rigid-body worlds at once, one per SIMD lane.

    import manyworlds as mw
    batch = mw.Batch("stack10", worlds=4096)
    batch.step(60)
    x = batch.get("position")  # (worlds, bodies, components)

Units are SI; quaternions are (w, x, y, z), planar orientations (cos, sin). docs/python.md explains
the rest by example.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from . import joints, mjcf, query, scenes, shapes, surfaces, tasks
from ._core import Expression, NonFiniteError, Snapshot, SnapshotError, __version__, available_isas
from ._core import names as enumerations
from .batch import Batch
from .bodies import Body, Jitter, MassProperties
from .environment import Environment, EnvironmentSnapshot, NonFinite
from .fields import Field
from .film import FilmReport, write_film, write_picture
from .ids import BodyId, ControlId, JointId, KeyframeId, ShapeId, SiteId, TendonId
from .joints import *  # noqa: F403
from .kinds import Kind
from .live import LiveView, view
from .options import ContactOptions, JointOptions, Medium, Options, SleepOptions, SolverOptions
from .page import Page, PageReport, show, write_page
from .plan import Plan
from .query import Pose
from .results import CONTACT, STEP_CONTACT, Status
from .scene import (
    Actuator,
    Attractor,
    Control,
    CoordinateDraw,
    Exclusion,
    Issue,
    Keyframe,
    Point,
    Ray,
    Scene,
    SceneError,
    Site,
    Tendon,
    TendonTerm,
    Variation,
    make_hull,
    mesh_mass_properties,
    vary,
)
from .shapes import *  # noqa: F403
from .surfaces import *  # noqa: F403
from .tasks import Action, Info, InitialParameter, Level, Memory, Observation, Reward, Task, TaskError
from .state_view import View

from . import pickling as _pickling  # of the values above; isort: skip

if TYPE_CHECKING:
    from . import record, search

__all__ = [
    "Action",
    "Actuator",
    "Attractor",
    "Batch",
    "Body",
    "BodyId",
    "CONTACT",
    "ContactOptions",
    "Control",
    "CoordinateDraw",
    "ControlId",
    "Environment",
    "EnvironmentSnapshot",
    "Exclusion",
    "Expression",
    "Field",
    "FilmReport",
    "Info",
    "InitialParameter",
    "Issue",
    "Jitter",
    "JointId",
    "JointOptions",
    "Keyframe",
    "KeyframeId",
    "Kind",
    "Level",
    "LiveView",
    "MassProperties",
    "Medium",
    "Memory",
    "NonFinite",
    "NonFiniteError",
    "Observation",
    "Options",
    "Page",
    "PageReport",
    "Plan",
    "Point",
    "Pose",
    "Ray",
    "Reward",
    "STEP_CONTACT",
    "Scene",
    "SceneError",
    "ShapeId",
    "Site",
    "SiteId",
    "SleepOptions",
    "Snapshot",
    "SnapshotError",
    "SolverOptions",
    "Status",
    "Task",
    "TaskError",
    "Tendon",
    "TendonId",
    "TendonTerm",
    "Variation",
    "View",
    "__version__",
    "available_isas",
    "enumerations",
    "make_hull",
    "mesh_mass_properties",
    "mjcf",
    "query",
    "scenes",
    "show",
    "tasks",
    "vary",
    "view",
    "write_film",
    "write_page",
    "write_picture",
]
__all__ += joints.__all__
__all__ += shapes.__all__
__all__ += surfaces.__all__


def __getattr__(name: str) -> Any:
    if name in ("record", "search"):  # the first loads HDF5
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
