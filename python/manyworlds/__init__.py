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

from . import mjcf, query, scenes, tasks
from ._core import Expression, Snapshot, SnapshotError, __version__, available_isas
from ._core import names as enumerations
from .batch import Batch
from .bodies import Body, Jitter, MassProperties
from .environment import Environment, EnvironmentSnapshot
from .fields import Field
from .ids import BodyId, ControlId, JointId, ShapeId
from .joints import (
    BallJoint,
    DistanceJoint,
    Drive,
    FixedJoint,
    Frame,
    HingeJoint,
    Joint,
    JointType,
    Limit,
    PulleyJoint,
    SliderJoint,
    Spring,
    TargetJoint,
    WheelJoint,
)
from .kinds import Kind
from .options import Options
from .plan import Plan
from .query import Pose
from .results import CONTACT, STEP_CONTACT, Status
from .scene import (
    Attractor,
    Control,
    Issue,
    Ray,
    Scene,
    SceneError,
    Variation,
    make_hull,
    mesh_mass_properties,
    vary,
)
from .shapes import (
    Box,
    Capsule,
    Circle,
    Cylinder,
    Filter,
    Geometry,
    HalfPlane,
    HeightField,
    Hull,
    Material,
    Plane,
    Polygon,
    Segment,
    Shape,
    Sphere,
    Terrain,
)
from .tasks import Action, Observation, Reward, Task, TaskError
from .view import View

from . import pickling as _pickling  # of the values above; isort: skip

if TYPE_CHECKING:
    from . import record

__all__ = [
    "Action",
    "Attractor",
    "BallJoint",
    "Batch",
    "Body",
    "BodyId",
    "Box",
    "CONTACT",
    "Capsule",
    "Circle",
    "Control",
    "ControlId",
    "Cylinder",
    "DistanceJoint",
    "Drive",
    "Environment",
    "EnvironmentSnapshot",
    "Expression",
    "Field",
    "Filter",
    "FixedJoint",
    "Frame",
    "Geometry",
    "HalfPlane",
    "HeightField",
    "HingeJoint",
    "Hull",
    "Issue",
    "Jitter",
    "Joint",
    "JointId",
    "JointType",
    "Kind",
    "Limit",
    "MassProperties",
    "Material",
    "Observation",
    "Options",
    "Plan",
    "Plane",
    "Polygon",
    "Pose",
    "PulleyJoint",
    "Ray",
    "Reward",
    "STEP_CONTACT",
    "Scene",
    "SceneError",
    "Segment",
    "Shape",
    "ShapeId",
    "SliderJoint",
    "Snapshot",
    "SnapshotError",
    "Sphere",
    "Spring",
    "Status",
    "TargetJoint",
    "Task",
    "TaskError",
    "Terrain",
    "Variation",
    "View",
    "WheelJoint",
    "__version__",
    "available_isas",
    "enumerations",
    "make_hull",
    "mesh_mass_properties",
    "mjcf",
    "query",
    "scenes",
    "tasks",
    "vary",
]


def __getattr__(name: str) -> Any:
    if name == "record":  # which loads HDF5
        return import_module(".record", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
