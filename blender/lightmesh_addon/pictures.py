"""Hours of direct sun among Blender's images."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    from .sun_study import Hours

PICTURE, VALUES = "Sun Hours", "Sun Hours (values)"


def show(hours: Hours) -> None:
    """Puts picture and numbers into the file; they take the place of those of the last study."""
    picture = bpy.data.images.new(PICTURE, 1, 1)
    picture.pack(data=hours.png, data_len=len(hours.png))
    picture.source = "FILE"
    _replace(PICTURE, picture)
    _replace(VALUES, values(hours.values))


def values(hours: np.ndarray) -> bpy.types.Image:
    """Hours as red, green and blue, which are not colours; packed."""
    height, width = hours.shape
    made = bpy.data.images.new(VALUES, width, height, alpha=False, float_buffer=True, is_data=True)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = hours[::-1, :, None]
    made.pixels.foreach_set(pixels.ravel())
    made.update()
    made.pack()
    return made


def _replace(name: str, made: bpy.types.Image) -> None:
    """Gives an image a name, and puts it wherever that of this name was. It is saved with the file, even if nothing uses it."""
    made.use_fake_user = True
    before = bpy.data.images.get(name)
    if before is not None and before != made:
        before.user_remap(made)
        bpy.data.images.remove(before)
        made.name = name
