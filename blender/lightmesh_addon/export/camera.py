"""Cameras: from Blender's view and projection matrices, which have sensor fit, shift, zoom and offset in them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np

if TYPE_CHECKING:
    from ..notes import Notes
    from .scene import Exported

#: So many triangles near a clip plane are looked at one by one; more of them reach beyond it.
LOOKED_AT = 4000


class CameraError(Exception):
    """A camera that cannot be shown."""


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
    width, height = size
    window = obj.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=aspect[0], scale_y=aspect[1])
    # Orthographic rays begin at the plane of the camera: moved to where it begins to see, it sees no more.
    return of_matrices(np.array(obj.matrix_world), np.array(window), size, name=obj.name, back=-start(data))


def is_mirrored(obj: bpy.types.Object) -> bool:
    """Whether the scale of a camera mirrors its image. Lightmesh's cameras cannot: their images are flipped."""
    return is_mirroring(np.array(obj.matrix_world))


def is_mirroring(world: np.ndarray) -> bool:
    return bool(np.linalg.det(world[:3, :3]) < 0.0)


def start(data: bpy.types.Camera) -> float:
    """How far before a camera the one stands that shows what it sees."""
    return data.clip_start if data.type == "ORTHO" else 0.0


def warn_of(depsgraph: bpy.types.Depsgraph, exported: Exported, notes: Notes, override: bpy.types.Object | None = None) -> None:
    """What a render's camera shows otherwise than the scene asks for."""
    looking = (override or depsgraph.scene.camera).evaluated_get(depsgraph)
    data, label = looking.data, f"Camera “{looking.name}”"
    if data.dof.use_dof:
        notes.add("Depth of field is left out")
    width, height = full_size(depsgraph.scene.render)
    window = np.array(looking.calc_matrix_camera(depsgraph, x=width, y=height))
    to_camera = np.linalg.inv(np.array(looking.matrix_world.normalized()))
    # What is inside of the image: each row is at least 0 there.
    x, y, w, depth = window[0], window[1], window[3], np.array((0.0, 0.0, -1.0, 0.0))
    sides = [w + x, w - x, w + y, w - y]
    near, far = np.array((0.0, 0.0, 0.0, data.clip_start)), np.array((0.0, 0.0, 0.0, data.clip_end))
    if data.type == "PERSP":
        names = _reaching(exported, np.array([depth, near - depth, *sides]) @ to_camera)
        if names:
            notes.add(f"{label} sees {names} nearer than its Clip Start here: move the camera, or hide in renders what is before it")
    names = _reaching(exported, np.array([depth - far, *sides]) @ to_camera)
    if names:
        notes.add(f"{label} sees {names} farther away than its Clip End here: hide in renders what is behind it")


def _reaching(exported: Exported, planes: np.ndarray) -> str:
    """The first objects that reach into where all of the planes, (K, 4), are above 0."""
    from .visibility import names_of

    return names_of([name for name, places, arrays in exported.meshes() if any(_reaches(arrays, place, planes) for place in places)])


def _reaches(arrays: Any, place: np.ndarray, planes: np.ndarray) -> bool:
    planes = planes @ np.vstack([place[:3], (0.0, 0.0, 0.0, 1.0)])
    values = np.array(arrays.corners()) @ planes[:, :3].T + planes[:, 3]
    if (values <= 0.0).all(0).any():
        return False
    values = (arrays.vertices @ planes[:, :3].T + planes[:, 3])[arrays.triangles]
    values = values[~(values <= 0.0).all(1).any(1)]
    return len(values) > LOOKED_AT or any(map(_is_cut, values))


def _is_cut(corners: np.ndarray) -> bool:
    """Whether anything of a polygon is above 0 in all columns, of which each corner has a row."""
    for column in range(corners.shape[1]):
        found = []
        for a, b in zip(corners, np.roll(corners, -1, axis=0)):
            if a[column] > 0.0:
                found.append(a)
            if (a[column] > 0.0) != (b[column] > 0.0):
                found.append(a + (b - a) * (a[column] / (a[column] - b[column])))
        if not found:
            return False
        # What is cut lies in the plane but for rounding.
        corners = np.array(found)
        corners[:, column] = np.maximum(corners[:, column], 0.0)
    return True


def of_matrices(world: np.ndarray, window: np.ndarray, size: tuple[int, int], name: str = "", back: float = 0.0) -> lightmesh.Camera:
    """The camera with the matrix `world` and the projection `window`; of mirrored ones, what is to be flipped. Orthographic ones are moved `back`:
    a viewport sees what is behind its eye, too."""
    right, up, behind = (column / np.linalg.norm(column) for column in world[:3, :3].T)
    position, direction = world[:3, 3], -behind
    if window[3, 3] == 0.0:
        # The middle of the image is where x of the projection is 0, in heights of the image: these are 2 / window[1, 1] at distance 1.
        shift = (0.5 * window[0, 2] * window[1, 1] / window[0, 0], 0.5 * window[1, 2])
        lens = {"vfov": math.degrees(2.0 * math.atan(1.0 / window[1, 1]))}
    else:
        shift = (-0.5 * window[0, 3] * window[1, 1] / window[0, 0], -0.5 * window[1, 3])
        lens = {"height": 2.0 / window[1, 1]}
        position = position - back * direction
    if is_mirroring(world):
        shift = (-shift[0], shift[1])
    return lightmesh.Camera(position, direction=direction, up=up, shift=tuple(map(float, shift)), name=name, **lens)


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
