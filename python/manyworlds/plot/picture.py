"""Picture: draws a world with matplotlib."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.path import Path
from numpy.typing import NDArray

from .. import _core, arrays
from ..batch import Batch, checked_batch
from ..plan import Plan
from ..scene import Scene
from ..shapes import HalfPlane, Plane
from . import pieces, solids
from .pieces import Eye, Piece, View
from .solids import Floats, Pose, Solid
from .view import scrolled, view_of

Poses = list[Optional[Pose]]  # one per body of the scene

_FAR = 1e9  # m, beyond which a world is lost


@dataclass(frozen=True)
class Camera:
    """View direction on spatial worlds, in parallel projection. Angles in degrees."""

    azimuth: float = -60.0  # position of the camera about z, from x
    elevation: float = 20.0  # above the horizon

    def __post_init__(self) -> None:
        if not np.isfinite(arrays.reals([self.azimuth, self.elevation], "camera")).all():
            raise ValueError(f"{self}: angles must be finite")

    def eye(self) -> Eye:
        """The axes of the picture, unit vectors of the world."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        return Eye(right, np.cross(towards, right), towards, planar=False)


class Picture:
    """Draws worlds of a scene. One object draws any number of pictures.

    scene    a Scene
    size     size of frames in pixels, (width, height)
    view     ((left, right), (bottom, top)) in m, in the picture's plane; None: the extent of the scene's
             bodies at the start, which follows the first dynamic body
    camera   camera of spatial scenes; planar ones show x and y

    Fixed and kinematic bodies are grey, and transparent in spatial scenes. Unbounded walls are omitted.
    Colors of dynamic bodies depend on their index.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        size: tuple[int, int] = (600, 400),
        view: Optional[View] = None,
        camera: Camera = Camera(),
    ) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene is of type {type(scene).__name__}; expected a Scene")
        if not isinstance(camera, Camera):
            raise TypeError(f"camera is of type {type(camera).__name__}; expected a Camera")
        scene = _core.round_trip(scene)  # type: ignore[assignment]
        self.scene = scene
        arrays.numbers(size, (2,), ("",), "size")
        self.size = tuple(arrays.integer(n, "size", 1, 10_000) for n in size)
        self._known: Optional[Plan] = None  # plan of worlds that this object can draw
        planar = scene.space == "planar"
        self._eye = Eye(*np.eye(3), True) if planar else camera.eye()
        self._solids: list[Solid] = []
        for b, body in enumerate(scene.bodies):
            for shape in body.shapes:
                at, dynamic = len(self._solids), body.motion == "dynamic"
                self._solids.append(solids.solid_of(b, at, shape, not dynamic, planar))
        self._first = [
            (solids.rotation_of(body.rotation), np.asarray(body.position, float))
            for body in scene.bodies
        ]
        self._scrolls = view is None
        if view is None:
            view = view_of(self.scene, self._solids, self._first, self._eye, self.size)
        self.view: View = _checked(view)

    # -- pictures

    def draw(self, batch: Batch, world: int = 0, ax: Optional[Axes] = None) -> Axes:
        """Draws the current state of a world into axes; None: axes of a new figure (``.figure``)."""
        poses = self._poses(batch, world)
        if ax is None:
            ax = self._figure().axes[0]
        view = scrolled(self.view, self._leader(poses), self._eye)
        ax.set(xlim=view[0], ylim=view[1], aspect="equal")
        drawn = self._pieces(poses, self._sizes(batch, world), view)
        drawn.sort(key=lambda piece: piece.depth)  # farthest first
        paths = PathCollection(
            [Path(p.points) for p in drawn],
            facecolors=["none" if p.fill is None else (*p.fill, p.alpha) for p in drawn],
            edgecolors=[(*p.edge, max(p.alpha, 0.4)) for p in drawn],
            linewidths=0.8,
        )
        ax.add_collection(paths)
        return ax

    def frame(self, batch: Batch, world: int = 0) -> NDArray[np.uint8]:
        """An image of the current state of a world, (height, width, 3) uint8: red, green, blue."""
        figure = self._figure()
        self.draw(batch, world, figure.axes[0])
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[..., :3].copy()

    def _figure(self) -> Figure:
        width, height = self.size
        figure = Figure(figsize=(width / 100, height / 100), dpi=100, facecolor="white")
        figure.add_axes((0, 0, 1, 1)).set_axis_off()
        return figure

    # -- poses

    def _poses(self, batch: Batch, world: int) -> Poses:
        """Poses of all bodies; None: a body is disabled, or so far away that its world is lost."""
        world = arrays.index(world, checked_batch(batch).worlds, "world")
        if batch.plan is not self._known:
            if _looks(batch.plan.scene) != _looks(self.scene):
                raise ValueError("the batch belongs to another scene: its bodies or shapes differ")
            self._known = batch.plan
        poses: Poses = [*self._first]
        positions = batch.get("position")[world].astype(float)
        orientations = batch.get("orientation")[world].astype(float)
        there = batch.get_enabled()[world]
        for i in range(batch.bodies):
            orientation, place = orientations[i], positions[i]
            if self._eye.planar:
                cos, sin = orientation
                rotation = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
                place = np.append(place, 0.0)
            else:
                rotation = solids.rotation_of(orientation)
            near = np.isfinite(rotation).all() and (np.abs(place) < _FAR).all()
            poses[batch.plan.body_in_row(i)] = (rotation, place) if there[i] and near else None
        return poses

    def _leader(self, poses: Poses) -> Optional[Pose]:
        """The first dynamic body, which the view follows."""
        motions = [body.motion for body in self.scene.bodies]
        return poses[motions.index("dynamic")] if self._scrolls and "dynamic" in motions else None

    def _sizes(self, batch: Batch, world: int) -> Optional[Floats]:
        """Sizes of all shapes of the scene, (shapes, 3); None: sizes do not vary."""
        varied = any(variation.parameter == "size" for variation in self.scene.variations)
        return batch.get("size")[world] if varied else None

    def _pieces(self, poses: Poses, sizes: Optional[Floats], view: View) -> list[Piece]:
        out: list[Piece] = []
        for solid in self._solids:
            pose = poses[solid.body]
            if pose is None:
                continue
            if isinstance(solid.geometry, (Plane, HalfPlane)):
                draw = pieces.half_plane if self._eye.planar else pieces.floor
                out += draw(*solids.half_space_of(solid, *pose), view, self._eye)
                continue
            if sizes is not None and sizes[solid.index, 0] > 0:
                own = solids.resized(solid.geometry, sizes[solid.index])
                solid = solid._replace(look=solids.look_of(own, self._eye.planar))
            out += pieces.pieces_of(solid, pose, self._eye)
        return out


def _looks(scene: Scene) -> Any:
    """The parts of a scene that a picture shows."""
    return scene.space, [
        (b.motion, [(s.geometry, s.position, s.rotation) for s in b.shapes]) for b in scene.bodies
    ]


def _checked(view: Any) -> View:
    (left, right), (bottom, top) = arrays.numbers(
        view, (2, 2), ("", ""), "view", np.float64
    ).tolist()
    if not (-np.inf < left < right < np.inf and -np.inf < bottom < top < np.inf):
        raise ValueError(
            f"view is {view}; expected ((left, right), (bottom, top)), the lower values first"
        )
    return (left, right), (bottom, top)
