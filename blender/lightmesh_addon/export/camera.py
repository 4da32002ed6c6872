"""Cameras: from Blender's view and projection matrices, which have sensor fit, shift, zoom and offset in them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import bpy
import lightmesh
import numpy as np

if TYPE_CHECKING:
    from ..notes import Notes


class CameraError(Exception):
    """A camera that cannot be shown."""


class Depths(NamedTuple):
    """The depths that a camera sees, from `near` to `far`. Orthographic ones are moved `back` first: a viewport sees what is behind its eye, too."""

    near: float = 0.0
    far: float | None = None
    back: float = 0.0

    @staticmethod
    def of_view(
        view: bpy.types.RegionView3D,
        space: bpy.types.SpaceView3D | None,
        scene: bpy.types.Scene,
        bounds: tuple[tuple[float, ...], tuple[float, ...]] | None,
    ) -> Depths:
        """Those of a viewport of objects within `bounds`, as Cycles chooses them: of the camera that it looks through, or of the view's own Clip
        Start and End. Orthographic views see as far behind the eye as before it, half of Clip End each."""
        if view.view_perspective == "CAMERA":
            looking = space.camera if space and space.use_local_camera else scene.camera
            return Depths.of_camera(looking.data) if looking and looking.type == "CAMERA" else Depths()
        if view.view_perspective != "ORTHO":
            return Depths(space.clip_start, space.clip_end) if space else Depths()
        # Where all objects are in front of it: rays from farther away would be less exact.
        back = float(np.linalg.norm(np.subtract(*bounds))) + view.view_distance if bounds else 0.0
        half = 0.5 * space.clip_end if space else None
        return Depths(0.0, None, back) if half is None else Depths(0.0, min(back, half) + half, min(back, half))

    @staticmethod
    def of_camera(data: bpy.types.Camera) -> Depths:
        return Depths(data.clip_start, data.clip_end)


def of_scene(depsgraph: bpy.types.Depsgraph, override: bpy.types.Object | None = None) -> tuple[lightmesh.Camera, dict[str, Any]]:
    """The camera that a render looks through, the scene's unless another is given, and the settings `size` and, with a border, `crop`. What a
    mirrored camera shows is to be flipped, left to right."""
    render, looking = depsgraph.scene.render, override or depsgraph.scene.camera
    if looking is None:
        raise CameraError("The scene has no camera: add one, and choose it in the scene's properties.")
    size = full_size(render)
    aspect = (render.pixel_aspect_x, render.pixel_aspect_y)
    view = of_object(looking.evaluated_get(depsgraph), depsgraph, size, aspect)
    crop = border(render, size)
    if crop and is_mirrored(looking.evaluated_get(depsgraph)):
        crop = (size[0] - crop[0] - crop[2], *crop[1:])
    return view, {"size": size, "crop": crop} if crop else {"size": size}


def of_object(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, size: tuple[int, int], aspect: tuple[float, float] = (1.0, 1.0)
) -> lightmesh.Camera:
    """The camera of an evaluated object, for the whole image of `size` pixels."""
    data = obj.data
    if obj.type != "CAMERA":
        raise CameraError(f"The scene looks through “{obj.name}”, which is no camera: choose one in the scene's properties.")
    if data.type not in ("PERSP", "ORTHO"):
        kind = {"PANO": "panoramic"}.get(data.type, data.type.lower())
        raise CameraError(f"Camera “{obj.name}” is {kind}: choose Perspective or Orthographic in its lens settings.")
    if data.clip_end <= data.clip_start:
        raise CameraError(f"Camera “{obj.name}” sees nothing: choose a Clip End beyond its Clip Start in its lens settings.")
    width, height = size
    window = obj.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=aspect[0], scale_y=aspect[1])
    return of_matrices(np.array(obj.matrix_world), np.array(window), size, name=obj.name, depths=Depths.of_camera(data))


def is_mirrored(obj: bpy.types.Object) -> bool:
    """Whether the scale of a camera mirrors its image. Lightmesh's cameras cannot: their images are flipped."""
    return is_mirroring(np.array(obj.matrix_world))


def is_mirroring(world: np.ndarray) -> bool:
    return bool(np.linalg.det(world[:3, :3]) < 0.0)


def warn_of(depsgraph: bpy.types.Depsgraph, notes: Notes, override: bpy.types.Object | None = None) -> None:
    """What a render's camera shows otherwise than the scene asks for."""
    if (override or depsgraph.scene.camera).evaluated_get(depsgraph).data.dof.use_dof:
        notes.add("Depth of field is left out")


def of_matrices(
    world: np.ndarray,
    window: np.ndarray,
    size: tuple[int, int],
    name: str = "",
    depths: Depths = Depths(),
) -> lightmesh.Camera:
    """The camera with the matrix `world` and the projection `window`, which sees these `depths`; of mirrored ones, what is to be flipped."""
    right, up, behind = (column / np.linalg.norm(column) for column in world[:3, :3].T)
    position, direction = world[:3, 3], -behind
    if window[3, 3] == 0.0:
        # The middle of the image is where x of the projection is 0, in heights of the image: these are 2 / window[1, 1] at distance 1.
        shift = (0.5 * window[0, 2] * window[1, 1] / window[0, 0], 0.5 * window[1, 2])
        lens = {"vfov": math.degrees(2.0 * math.atan(1.0 / window[1, 1]))}
    else:
        shift = (-0.5 * window[0, 3] * window[1, 1] / window[0, 0], -0.5 * window[1, 3])
        lens = {"height": 2.0 / window[1, 1]}
        position = position - depths.back * direction
    if is_mirroring(world):
        shift = (-shift[0], shift[1])
    shift = tuple(map(float, shift))
    return lightmesh.Camera(position, direction=direction, up=up, shift=shift, name=name, near=depths.near, far=depths.far, **lens)


def full_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Width and height of the image without a border, as Blender rounds them."""
    share = render.resolution_percentage
    return max(1, render.resolution_x * share // 100), max(1, render.resolution_y * share // 100)


def border(render: bpy.types.RenderSettings, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """The part of the image that is rendered, as column, row, width and height with row 0 at the top; `None` for all of it."""
    if not render.use_border:
        return None
    width, height = size
    left, right = int(render.border_min_x * width), int(render.border_max_x * width)
    bottom, top = int(render.border_min_y * height), int(render.border_max_y * height)
    if right <= left or top <= bottom or (left, bottom, right, top) == (0, 0, width, height):
        return None
    return left, height - top, right - left, top - bottom
