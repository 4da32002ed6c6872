"""Sky Textures as panoramas: another Blender, without a window, has Cycles render them, so that they are Cycles' own in each version.

A render cannot render something else before it, and skies have a table or an integral for each version of Blender: hence the other process.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

#: Width and height: the sun is more than a pixel across.
SIZE = (1024, 512)
#: Seconds that it may take; usually it is two.
LIMIT = 120.0
#: So many skies are kept, for renders and viewports to come.
KEPT = 8

#: Kinds of skies without a sun: a direction says where it would be.
WITHOUT_SUN = {"PREETHAM", "HOSEK_WILKIE"}

_kept = {}


class SkyError(Exception):
    """A sky that could not be rendered."""


def key_of(node: bpy.types.Node) -> str:
    """All settings of a Sky Texture but for its turn: equal ones show the same, turned."""
    own = [name for name in node.bl_rna.properties.keys() if name not in bpy.types.ShaderNode.bl_rna.properties]
    found = {name: getattr(node, name) for name in own if not node.bl_rna.properties[name].is_readonly}
    plain = {name: value if isinstance(value, (str, bool, int, float)) else _numbers(value) for name, value in found.items()}
    plain["sun_rotation"] = 0.0
    return json.dumps({name: value for name, value in plain.items() if value is not None}, sort_keys=True)


def turn_of(node: bpy.types.Node) -> float:
    """How far a sky is turned clockwise, seen from above, degrees: a turn needs no new panorama."""
    return 0.0 if node.sky_type in WITHOUT_SUN else math.degrees(node.sun_rotation) % 360.0


def _numbers(value: object) -> list[float] | None:
    try:
        return [float(number) for number in value]
    except TypeError:  # Mappings of texture coordinates and colours, which nodes do not show.
        return None


def panorama(node: bpy.types.Node) -> np.ndarray:
    """What a Sky Texture shows, (H, W, 3) `float32`, row 0 at the top, with +Y in its middle and +X to the right, before its turn."""
    key = key_of(node)
    if key not in _kept:
        while len(_kept) >= KEPT:
            _kept.pop(next(iter(_kept)))
        _kept[key] = _rendered(key)
    return _kept[key]


def _rendered(key: str) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        asked, made = Path(folder) / "sky.json", Path(folder) / "sky.npy"
        asked.write_text(json.dumps({"node": json.loads(key), "size": SIZE}))
        script = str(Path(__file__).with_name("sky_render.py"))
        if bpy.app.binary_path:
            command = [bpy.app.binary_path, "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--"]
        else:  # Blender as a module of Python.
            command = [sys.executable, script]
        try:
            ended = subprocess.run([*command, str(asked), str(made)], stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT)
            pixels = np.load(made) if made.exists() else None
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            raise SkyError(str(error)) from error
        if pixels is None:
            words = ended.stderr.decode(errors="replace").strip().splitlines()
            raise SkyError(words[-1] if words else f"Blender ended with {ended.returncode}")
        return pixels
