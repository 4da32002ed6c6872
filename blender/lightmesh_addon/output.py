"""Where the frames of a day go, and how they are stored: by Blender's output and colour management, as far as Lightmesh has its like."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

if TYPE_CHECKING:
    from .notes import Notes

#: Blender's formats: the extension that Blender gives them, others that it leaves, and Lightmesh's name.
FORMATS = {
    "PNG": (".png", (), "png"),
    "OPEN_EXR": (".exr", (), "exr"),
    "JPEG": (".jpg", (".jpeg",), "jpg"),
    "BMP": (".bmp", (), "bmp"),
}
VIEWS = {"Standard": "standard", "AgX": "agx", "Khronos PBR Neutral": "neutral"}
#: Compressions of EXR files that lose nothing; `zip` stands for others.
COMPRESSIONS = {"ZIP": "zip", "ZIPS": "zips", "PIZ": "piz", "RLE": "rle", "NONE": "none"}


class OutputError(Exception):
    """An output that frames cannot go to."""


@dataclass
class Output:
    """`path` has `#` for the digits of a frame's number; `settings` are those of a film."""

    path: Path
    settings: dict[str, Any]


def of_scene(scene: bpy.types.Scene, notes: Notes) -> Output:
    """The output of a scene."""
    stored = scene.render.image_settings
    if stored.file_format not in FORMATS:
        raise OutputError(f"The frames of a day are PNG, OpenEXR, JPEG or BMP files, not {stored.file_format}: choose one of them as output format.")
    extension, others, name = FORMATS[stored.file_format]
    found = {"format": name, "overwrite": True} if scene.render.use_overwrite else {"format": name, "skip_existing": True}
    if name == "exr":
        found["exr_type"] = "half" if stored.color_depth == "16" else "float"
        found["exr_compression"] = COMPRESSIONS.get(stored.exr_codec, "zip")
    else:
        found |= _shown(scene.view_settings, notes)
    if name == "png":
        found["bit_depth"] = int(stored.color_depth)
    return Output(Path(template(scene.render, extension, others)), found)


def template(render: bpy.types.RenderSettings, extension: str, others: tuple[str, ...] = ()) -> str:
    """The path of frames, with `#` for digits where Blender puts them."""
    path = bpy.path.abspath(render.filepath)
    if "#" not in bpy.path.basename(path):
        path += "####"
    if render.use_file_extension and not path.lower().endswith((extension, *others)):
        path += extension
    return path


def _shown(view: bpy.types.ColorManagedViewSettings, notes: Notes) -> dict[str, Any]:
    """How Blender shows light on a screen."""
    if view.view_transform not in VIEWS:
        notes.add(f"The view transform {view.view_transform} has no counterpart: frames are shown as Standard")
    if view.look != "None" or view.gamma != 1.0 or view.use_curve_mapping:
        notes.add("Look, gamma and curves of the colour management are left out")
    return {"view": VIEWS.get(view.view_transform, "standard"), "exposure": view.exposure}
