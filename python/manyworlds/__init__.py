"""manyworlds: thousands of small rigid-body worlds at once, one per SIMD lane.

    import manyworlds as mw
    batch = mw.Batch("stack10", worlds=4096)
    batch.step(60)
    x = batch.get("position")  # (worlds, bodies, components)

Units are SI; quaternions are (w, x, y, z), planar orientations (cos, sin). docs/python.md explains
the rest by example.
"""

from . import scenes
from ._core import Snapshot, SnapshotError, __version__, available_isas
from ._core import names as enumerations
from .batch import Batch
from .bodies import Body, Jitter, MassProperties
from .fields import Field
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
from .options import Options
from .plan import Plan
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
from .view import View

__all__ = [
    "Attractor",
    "BallJoint",
    "Batch",
    "Body",
    "Box",
    "CONTACT",
    "Capsule",
    "Circle",
    "Control",
    "Cylinder",
    "DistanceJoint",
    "Drive",
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
    "JointType",
    "Limit",
    "MassProperties",
    "Material",
    "Options",
    "Plan",
    "Plane",
    "Polygon",
    "PulleyJoint",
    "Ray",
    "STEP_CONTACT",
    "Scene",
    "SceneError",
    "Segment",
    "Shape",
    "SliderJoint",
    "Snapshot",
    "SnapshotError",
    "Sphere",
    "Spring",
    "Status",
    "TargetJoint",
    "Terrain",
    "Variation",
    "View",
    "WheelJoint",
    "__version__",
    "available_isas",
    "enumerations",
    "make_hull",
    "mesh_mass_properties",
    "scenes",
    "vary",
]
