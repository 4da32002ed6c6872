"""Blender's lights as `lightmesh.Light`, so that white surfaces show the radiance that they show in Cycles.

P is the strength of a light: energy, colour, temperature, exposure and what its nodes say. A white surface that faces it at distance d shows

    point, spot    P / (4 π² d²)      that of a sphere with the power P
    area           P / (π² d²)        along its normal, that of a Lambertian emitter with the power P
    sun            P / π              P is an irradiance

and in Lightmesh I / (π d²), or I / π with directional light. So I is P / 4π, P / π and P. Without `normalize`, P is 4 π² or π times a
radiance, which the size of the light multiplies. `tests/test_lights.py` compares all of them with Cycles.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np
from mathutils import Matrix

from . import differences
from .nodes import feed, output_of
from .terms import NumberTerm, Terms

if TYPE_CHECKING:
    from ..notes import Notes

#: Blender's spots fade as t² (3 - 2t), Lightmesh's as t² over a narrower rim: this much of it gives the same light.
RIM = 0.75
#: Sides of area lights that lean more, by cosine, are not at a right angle.
LEANING = 1e-4


def light(obj: bpy.types.Object, matrix: Matrix, notes: Notes, name: str | None = None) -> lightmesh.Light | None:
    """A light of the evaluated object `obj` at `matrix`, or `None` if it is dark."""
    data, matrix = obj.data, np.array(matrix, float)
    if is_portal(data):
        # Portals tell Cycles where the world's light comes in, and give none.
        return None
    label = f"Light “{obj.name}”"
    strength = _strength(data, label, notes)
    if not strength.any():
        return None
    if not data.use_shadow:
        notes.add(f"{label} casts no shadow in the scene, but does here")
    differences.of_linking(obj, label, notes)
    if obj.visible_camera:
        notes.add(f"{label} is seen by the camera in the scene, but not here")
    if not getattr(obj, "visible_diffuse", True) or not getattr(obj, "visible_glossy", True):
        notes.add(f"{label} lights only some kinds of surfaces in the scene, but all here")
    make = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}[data.type]
    return make(data, matrix, strength, label, notes, falloff="inverse-square", name=name or obj.name)


def is_portal(data: bpy.types.Light) -> bool:
    return data.type == "AREA" and bool(getattr(getattr(data, "cycles", None), "is_portal", False))


def _strength(data: bpy.types.Light, label: str, notes: Notes) -> np.ndarray:
    color = np.array(data.color, float) * data.energy * 2.0 ** getattr(data, "exposure", 0.0)
    if getattr(data, "use_temperature", False):
        color *= np.array(data.temperature_color)
    if getattr(data, "use_nodes", True) and data.node_tree:
        color *= _nodes(data.node_tree, label, notes)
    if (color < 0.0).any():
        notes.add(f"{label} takes light away, which is left out")
    return np.maximum(color, 0.0)


def _nodes(tree: bpy.types.NodeTree, label: str, notes: Notes) -> np.ndarray | float:
    """What the nodes of a light multiply its strength with."""
    output = output_of(tree, "OUTPUT_LIGHT")
    shader = feed(output.inputs["Surface"]) if output else None
    if shader is None or shader.node is None:
        return 0.0
    if shader.node.type != "EMISSION":
        notes.add(f"{label}: the node “{shader.node.name}” has no counterpart: the light is as without nodes")
        return 1.0
    terms = Terms(label, notes)
    color, strength = terms.color(shader.input("Color"), (1.0, 1.0, 1.0)), terms.number(shader.input("Strength"), 1.0)
    if not color.constant or not strength.constant:
        notes.add(f"{label} shines through an image, which is left out")
        strength = strength if strength.constant else NumberTerm(1.0)
    return np.array(color.factor if color.constant else (1.0, 1.0, 1.0)) * strength.offset


def _axis(matrix: np.ndarray, index: int) -> np.ndarray:
    axis = matrix[:3, index]
    length = np.linalg.norm(axis)
    return axis / length if length else axis


def _normalized(data: bpy.types.Light) -> bool:
    return getattr(data, "normalize", True)


def _of_ball(data: bpy.types.Light, strength: np.ndarray) -> np.ndarray:
    radius = data.shadow_soft_size
    if _normalized(data):
        return strength / (4.0 * math.pi)
    return strength * (radius * radius if radius > 0.0 else 1.0 / math.pi)


def _point(data: bpy.types.Light, matrix: np.ndarray, strength: np.ndarray, label: str, notes: Notes, **settings: Any) -> lightmesh.Light:
    position, radius, intensity = matrix[:3, 3], data.shadow_soft_size, _of_ball(data, strength)
    if radius > 0.0:
        return lightmesh.Light.sphere(position, radius, intensity=intensity, **settings)
    return lightmesh.Light.point(position, intensity=intensity, **settings)


def _spot(data: bpy.types.Light, matrix: np.ndarray, strength: np.ndarray, label: str, notes: Notes, **settings: Any) -> lightmesh.Light:
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if np.ptp(lengths) > 1e-3 * lengths.max():
        notes.add(f"{label} is scaled unevenly: its cone is round here")
    if data.use_square:
        notes.add(f"{label} has a square cone, which is round here")
    outer = math.cos(0.5 * data.spot_size)
    inner = outer + RIM * data.spot_blend * (1.0 - outer)
    inner, outer = (math.degrees(math.acos(min(max(cos, 0.0), 1.0))) for cos in (inner, outer))
    return lightmesh.Light.spot(
        matrix[:3, 3],
        -_axis(matrix, 2),
        inner=min(inner, outer),
        outer=outer,
        radius=data.shadow_soft_size,
        intensity=_of_ball(data, strength),
        **settings,
    )


def _sun(data: bpy.types.Light, matrix: np.ndarray, strength: np.ndarray, label: str, notes: Notes, **settings: Any) -> lightmesh.Light:
    angle = data.angle
    if not _normalized(data) and angle > 0.0:
        strength = strength * (math.pi * math.sin(0.5 * min(angle, math.pi)) ** 2)
    return lightmesh.Light.directional(-_axis(matrix, 2), angle=min(math.degrees(angle), 179.0), intensity=strength, **settings)


def _area(data: bpy.types.Light, matrix: np.ndarray, strength: np.ndarray, label: str, notes: Notes, **settings: Any) -> lightmesh.Light:
    oblong = data.shape in ("RECTANGLE", "ELLIPSE")
    half_u = 0.5 * data.size * matrix[:3, 0]
    half_v = 0.5 * (data.size_y if oblong else data.size) * matrix[:3, 1]
    normal = -_axis(matrix, 2)
    if getattr(data, "spread", math.pi) < 0.999 * math.pi:
        notes.add(f"{label} has a spread below 180°: it shines to all of its front here")
    lengths = np.linalg.norm(half_u), np.linalg.norm(half_v)
    if min(lengths) == 0.0:
        return lightmesh.Light.point(matrix[:3, 3], intensity=strength / math.pi, **settings)
    if abs(half_u @ half_v) > LEANING * lengths[0] * lengths[1]:
        notes.add(f"{label} is skewed: its sides are at a right angle here")
        half_v = half_v - half_u * (half_u @ half_v) / (half_u @ half_u)
    round_ = data.shape in ("DISK", "ELLIPSE")
    intensity = strength / math.pi
    if not _normalized(data):
        intensity = intensity * (math.pi if round_ else 4.0) * np.linalg.norm(np.cross(half_u, half_v))
    settings.update(intensity=intensity, one_sided=True)
    if round_:
        if abs(lengths[0] - lengths[1]) <= 0.01 * max(lengths):
            return lightmesh.Light.disk(matrix[:3, 3], normal, 0.5 * sum(lengths), **settings)
        notes.add(f"{label} is an ellipse, for which a rectangle of the same area stands")
        half_u, half_v = (0.5 * math.sqrt(math.pi) * half for half in (half_u, half_v))
    if np.cross(half_u, half_v) @ normal < 0.0:
        half_v = -half_v
    return lightmesh.Light.rectangle(matrix[:3, 3], half_u, half_v, **settings)
