"""Passes: which a view layer asks for, and how they are filled from a frame. Rows go upwards in Blender, downwards in Lightmesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    import lightmesh

    from .export.scene import Exported

#: Blender 5 spells out what it abbreviated before; its compositor finds passes by these names.
OBJECT_INDEX, MATERIAL_INDEX = ("Object Index", "Material Index") if bpy.app.version >= (5, 0, 0) else ("IndexOB", "IndexMA")
#: What depth passes have where nothing is seen, as in Cycles.
FAR = 1e10


@dataclass(frozen=True)
class Pass:
    """A pass: its name, the letters of its channels, and the kind of its socket in the compositor."""

    name: str
    channels: str
    kind: str
    light: str | None = None


def wanted(view_layer: bpy.types.ViewLayer, lights: Sequence[str]) -> list[Pass]:
    """The passes of a view layer besides Combined. `lights`: the names of its lights."""
    found = []
    if view_layer.use_pass_z:
        found.append(Pass("Depth", "Z", "VALUE"))
    if view_layer.use_pass_position:
        found.append(Pass("Position", "XYZ", "VECTOR"))
    if view_layer.use_pass_normal:
        found.append(Pass("Normal", "XYZ", "VECTOR"))
    if view_layer.use_pass_object_index:
        found.append(Pass(OBJECT_INDEX, "X", "VALUE"))
    if view_layer.use_pass_material_index:
        found.append(Pass(MATERIAL_INDEX, "X", "VALUE"))
    if view_layer.lightmesh.use_pass_visibility:
        found += [Pass(f"Visibility {name}", "X", "VALUE", name) for name in lights]
    for kind in cryptomattes(view_layer):
        for level in range((view_layer.pass_cryptomatte_depth + 1) // 2):
            # In lower case, so that lossy compression of EXR files leaves them alone.
            found.append(Pass(f"{kind}{level:02}", "rgba", "COLOR"))
    return found


def cryptomattes(view_layer: bpy.types.ViewLayer) -> list[str]:
    """The names of the Cryptomattes of a view layer."""
    found = ["CryptoObject"] if view_layer.use_pass_cryptomatte_object else []
    return [*found, "CryptoMaterial"] if view_layer.use_pass_cryptomatte_material else found


def unsupported(view_layer: bpy.types.ViewLayer) -> list[str]:
    """The names of passes that a view layer asks for and that stay empty."""
    known = {
        "use_pass_cryptomatte_asset": "Cryptomatte Asset",
        "use_pass_mist": "Mist",
        "use_pass_uv": "UV",
        "use_pass_vector": "Vector",
        "use_pass_ambient_occlusion": "Ambient Occlusion",
        "use_pass_emit": "Emission",
        "use_pass_environment": "Environment",
        "use_pass_shadow": "Shadow",
        "use_pass_diffuse_direct": "Diffuse Direct",
        "use_pass_diffuse_indirect": "Diffuse Indirect",
        "use_pass_diffuse_color": "Diffuse Color",
        "use_pass_glossy_direct": "Glossy Direct",
        "use_pass_glossy_indirect": "Glossy Indirect",
        "use_pass_glossy_color": "Glossy Color",
    }
    return [name for attribute, name in known.items() if getattr(view_layer, attribute, False)]


def combined(frame: lightmesh.Frame, exported: Exported | None = None) -> np.ndarray:
    """(H, W, 4), rows upwards: premultiplied, scene-linear. Holdouts of what was `exported` have holes; they need a frame with layers."""
    height, width, _ = frame.rgb.shape
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = frame.rgb[::-1]
    if frame.alpha is not None:
        pixels[..., 3] = frame.alpha[::-1]
    if exported is not None and exported.has_holdouts:
        # A surface may be held out as an object and by its material.
        held_out = np.maximum(share(frame.ids, exported.holdouts), share(frame.material_ids, exported.holdout_materials))
        pixels[..., 3] = np.maximum(pixels[..., 3] - held_out[::-1], 0.0)
    return pixels


def share(mattes: lightmesh.Mattes, names: set[str]) -> np.ndarray:
    """(H, W): the share of each pixel that things of these names have."""
    held_out = np.array([False, *(name in names for name in mattes.names)])
    return sum(np.where(held_out[thing], part, 0.0) for thing, part in mattes.ranks)


class Layers:
    """The passes of one frame."""

    def __init__(self, frame: lightmesh.Frame, exported: Exported, camera: lightmesh.Camera) -> None:
        self.frame, self.exported, self.camera = frame, exported, camera
        self._mattes = {}

    def of(self, wanted: Pass) -> np.ndarray:
        """The values of a pass, (H, W, channels), rows upwards."""
        name = wanted.name
        if wanted.light is not None:
            values = self.frame.visibility[self.exported.light_names.index(wanted.light)]
        elif name.startswith("Crypto"):
            values = self._matte(name[:-2], int(name[-2:]))
        else:
            values = {
                "Depth": self.depth,
                "Position": lambda: np.where(np.isfinite(self.frame.depth)[..., None], self.frame.position, 0.0),
                "Normal": lambda: self.frame.normal,
                OBJECT_INDEX: lambda: _indices(self.frame.ids, self.exported.object_indices),
                MATERIAL_INDEX: lambda: _indices(self.frame.material_ids, self.exported.material_indices),
            }[name]()
        height, width = values.shape[:2]
        return np.ascontiguousarray(values[::-1], np.float32).reshape(height, width, -1)

    def depth(self) -> np.ndarray:
        """Distances along the view axis, not along rays: Blender's Z."""
        away = self.frame.position - np.array(self.camera.position, np.float32)
        depth = away @ np.array(self.camera.direction, np.float32)
        return np.where(np.isfinite(self.frame.depth), depth, FAR)

    def _matte(self, kind: str, level: int) -> np.ndarray:
        if kind not in self._mattes:
            self._mattes[kind] = self.mattes(kind).cryptomatte()
        levels = self._mattes[kind]
        return levels[level] if level < len(levels) else np.zeros_like(levels[0])

    def mattes(self, kind: str) -> lightmesh.Mattes:
        return self.frame.ids if kind == "CryptoObject" else self.frame.material_ids

    def metadata(self, view_layer: bpy.types.ViewLayer) -> dict[str, str]:
        """What Cryptomatte readers need to know, as fields of the image."""
        found = {}
        for kind in cryptomattes(view_layer):
            name = f"{view_layer.name}.{kind}"
            prefix = f"cryptomatte/{murmur3(name.encode()):08x}"[: len("cryptomatte/") + 7]
            found[f"{prefix}/name"] = name
            found[f"{prefix}/hash"] = "MurmurHash3_32"
            found[f"{prefix}/conversion"] = "uint32_to_float32"
            found[f"{prefix}/manifest"] = self.mattes(kind).manifest()
        return found


def _indices(mattes: lightmesh.Mattes, of_name: dict[str, int]) -> np.ndarray:
    """The pass index of the nearest thing in each pixel."""
    table = np.array([0, *(of_name.get(name, 0) for name in mattes.names)], np.float32)
    return table[mattes.nearest]


def murmur3(data: bytes, seed: int = 0) -> int:
    """MurmurHash3 of 32 bits, by which Cryptomatte names its layers."""

    def rotated(value: int, bits: int) -> int:
        return ((value << bits) | (value >> (32 - bits))) & 0xFFFFFFFF

    value, whole = seed, len(data) // 4 * 4
    blocks = [int.from_bytes(data[at : at + 4], "little") for at in range(0, whole, 4)]
    for block in blocks:
        value ^= rotated(block * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF
        value = (rotated(value, 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    tail = int.from_bytes(data[whole:], "little")
    value ^= rotated(tail * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF
    value ^= len(data)
    value = (value ^ value >> 16) * 0x85EBCA6B & 0xFFFFFFFF
    value = (value ^ value >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    return value ^ value >> 16
