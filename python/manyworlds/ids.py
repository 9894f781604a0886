"""Handles of bodies, shapes, joints, controls, tendons, sites and keyframes of a scene.

``Scene.add`` returns handles. ``body("crate")`` and similar methods of Scene, Plan and Batch find them
by name. Arguments accept a handle, a name or a plain int. An int is the index in the scene's list, not a
row of an array: fixed bodies have no row (``Plan.row``). A handle of another type raises TypeError. An
unknown, empty or shared name raises ValueError, which lists the known names.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import arrays

if TYPE_CHECKING:
    from .plan import Plan


class _Handle(int):
    """An index with a type."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({int(self)})"

    __str__ = __repr__

    def __format__(self, spec: str) -> str:
        return format(int(self), spec)


class BodyId(_Handle):
    """A body: its index in ``Scene.bodies``. ``BodyId(-1)``: none, or the world."""

    __slots__ = ()


class JointId(_Handle):
    """A joint: its index in ``Scene.joints``."""

    __slots__ = ()


class ControlId(_Handle):
    """A control: its index in ``Scene.controls``."""

    __slots__ = ()


class TendonId(_Handle):
    """A tendon: its index in ``Scene.tendons``."""

    __slots__ = ()


class SiteId(_Handle):
    """A site: its index in ``Scene.sites``."""

    __slots__ = ()


class KeyframeId(_Handle):
    """A keyframe: its index in ``Scene.keyframes``."""

    __slots__ = ()


class ShapeId(NamedTuple):
    """A shape: its body, and its index in ``Body.shapes``."""

    body: BodyId
    index: int


# Arguments that identify a body, shape, joint, control, tendon, site or keyframe.
BodyRef = Union[int, str]  # a BodyId is an int
JointRef = Union[int, str]
ControlRef = Union[int, str]
TendonRef = Union[int, str]
SiteRef = Union[int, str]
KeyframeRef = Union[int, str]
ShapeRef = Union[int, str, ShapeId]
# One or several; an array of bools is a mask over the rows of arrays.
BodyRefs = Union[BodyRef, Sequence[BodyRef], NDArray[np.integer], NDArray[np.bool_]]
JointRefs = Union[JointRef, Sequence[JointRef], NDArray[np.integer], NDArray[np.bool_]]



def index_of(ref: Any, kind: type[_Handle], find: Callable[[str], int], name: str) -> Any:
    """The index of a name, a handle or an int. Returns other values unchanged.

    Raises TypeError for a handle of another type, ValueError for an unknown name.
    """
    if isinstance(ref, str):
        return int(find(ref))
    if isinstance(ref, (_Handle, ShapeId)) and not isinstance(ref, kind):
        raise TypeError(f"{name} is {ref!r}; expected a {kind.__name__}, a name or an index")
    return ref


def indices_of(
    refs: Any, kind: type[_Handle], find: Callable[[str], int], count: int, name: str
) -> NDArray[np.int32]:
    """Indices below ``count`` for one or several names, handles and ints. None selects all, an array
    of bools is a mask over all. Raises IndexError, TypeError, ValueError."""
    if isinstance(refs, (list, tuple)) and not isinstance(refs, ShapeId):
        refs = [index_of(ref, kind, find, name) for ref in refs]
    else:
        refs = index_of(refs, kind, find, name)
    return arrays.indices(refs, count, name)


class Chooser:
    """Finds bodies and joints of a plan from arguments."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._of_row = np.array(plan.bodies_in_rows(), dtype=np.int32)
        self._row = np.full(plan.scene_bodies, -1, dtype=np.int32)
        self._row[self._of_row] = np.arange(len(self._of_row), dtype=np.int32)

    def bodies(self, refs: Optional[BodyRefs], name: str) -> NDArray[np.int32]:
        """Indices in the scene. None selects every body with a row, an array of bools is a mask over rows.

        Raises ValueError for fixed bodies, IndexError, TypeError.
        """
        if refs is None:
            return self._of_row
        if np.asarray(refs).dtype == np.bool_:
            return self._of_row[arrays.indices(refs, len(self._of_row), name)]
        found = indices_of(refs, BodyId, self._plan.body, len(self._row), name)
        fixed = found[self._row[found] < 0]
        if fixed.size:
            self._plan.row(int(fixed[0]))  # raises the error
        return found

    def body(self, ref: BodyRef, name: str) -> int:
        """The index in the scene: see bodies."""
        if not isinstance(ref, str):
            arrays.index(index_of(ref, BodyId, self._plan.body, name), len(self._row), name)
        return int(self.bodies(ref, name)[0])

    def joints(self, refs: Optional[JointRefs], name: str) -> NDArray[np.int32]:
        """Indices in the scene; None selects all. Raises ValueError, IndexError, TypeError."""
        return indices_of(refs, JointId, self._plan.joint, self._plan.joints, name)


class Named:
    """Finds rows, and bodies, shapes, joints, controls, tendons, sites and keyframes by name."""

    plan: Plan

    def body(self, name: BodyRef) -> BodyId:
        """The body with a name: see Plan.body."""
        return self.plan.body(name)

    def joint(self, name: JointRef) -> JointId:
        """The joint with a name: see Plan.joint."""
        return self.plan.joint(name)

    def control(self, name: ControlRef) -> ControlId:
        """The control with a name: see Plan.control."""
        return self.plan.control(name)

    def tendon(self, name: TendonRef) -> TendonId:
        """The tendon with a name: see Plan.tendon."""
        return self.plan.tendon(name)

    def site(self, name: SiteRef) -> SiteId:
        """The site with a name: see Plan.site."""
        return self.plan.site(name)

    def keyframe(self, name: KeyframeRef) -> KeyframeId:
        """The keyframe with a name: see Plan.keyframe."""
        return self.plan.keyframe(name)

    def shape(self, name: str, body: Optional[BodyRef] = None) -> ShapeId:
        """The shape with a name: see Plan.shape."""
        return self.plan.shape(name, body)

    def row(self, body: Union[BodyRef, ShapeId]) -> int:
        """The row of a body in arrays (worlds, bodies, ...): see Plan.row."""
        return self.plan.row(body)

    def body_in_row(self, row: int) -> BodyId:
        """The body in a row of such arrays: see Plan.body_in_row."""
        return self.plan.body_in_row(row)
