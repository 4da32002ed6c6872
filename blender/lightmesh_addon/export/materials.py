"""Blender's materials as `lightmesh.Material`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np

from .nodes import feed, has_nodes, output_of
from .surfaces import Surface, Surfaces
from .textures import Textures

if TYPE_CHECKING:
    from ..notes import Notes
    from .terms import NumberTerm

#: What surfaces without a material look like in Cycles.
DEFAULT = {"specular": 1.0, "roughness": 0.5} if bpy.app.version >= (5, 0, 0) else {"specular": 0.0, "roughness": 1.0}
#: Where more of an image than this share is neither there nor not there, it is blended, not cut out.
PARTLY = 0.05


@dataclass(frozen=True)
class Made:
    """A material, and what it needs of a mesh: a UV map by name, "" for the active one, and a colour attribute likewise."""

    material: Any
    #: Equal ones show the same.
    digest: str
    uv_map: str | None = None
    attribute: str | None = None


class Materials:
    """The materials of an export, each made once."""

    def __init__(self, notes: Notes, textures: Textures | None = None) -> None:
        self.notes = notes
        self.textures = textures or Textures(notes)
        self._made = {}
        #: Whether any of them shines.
        self.emit = False
        #: Names of materials that are holdouts all over.
        self.holdouts = set()

    def of(self, material: bpy.types.Material | None, catcher: bool = False, holdout: bool = False) -> Made:
        """A material, or for `None` Blender's default one; `catcher`: only the shadows on it are seen; `holdout`: black, where it is."""
        key = (material.name_full if material else None, catcher, holdout)
        if key not in self._made:
            self._made[key] = self._make(material, catcher, holdout)
        return self._made[key]

    def _make(self, material: bpy.types.Material | None, catcher: bool, holdout: bool) -> Made:
        if catcher:
            name = material.name if material else "shadow catcher"
            return Made(lightmesh.Material(0.8, catcher=True, name=name), f"catcher {name}")
        if material is None and holdout:
            return Made(lightmesh.Material(0.0, name="holdout"), "holdout")
        if material is None:
            return Made(lightmesh.Material.principled(0.8, **DEFAULT, name="default"), "default")
        surface = self._surface(material)
        if surface.holdout:
            self.holdouts.add(material.name)
        return self._from(material, surface.blackened() if holdout else surface)

    def _surface(self, material: bpy.types.Material) -> Surface:
        if not has_nodes(material):
            from .terms import ColorTerm, NumberTerm

            color = ColorTerm(tuple(material.diffuse_color)[:3])
            return Surface(color, NumberTerm(material.metallic), NumberTerm(material.roughness), specular=1.0)
        output = output_of(material.node_tree, "OUTPUT_MATERIAL")
        if output is None:
            self.notes.add(f"Material “{material.name}” has no output: it is black")
            return Surface(color=Surface.emission)
        for name in ("Volume", "Displacement"):
            if output.inputs[name].is_linked:
                self.notes.add(f"Material “{material.name}” has a {name.lower()}, which is left out")
        return Surfaces(material, self.notes).read(feed(output.inputs["Surface"]))

    def _from(self, material: bpy.types.Material, surface: Surface) -> Made:
        self.emit |= not surface.emission.black
        textures, settings = self.textures, {}
        mode, alpha = self._alpha(surface)
        texture = textures.color(surface.color.image, None if surface.alpha.constant else surface.alpha)
        if texture:
            settings["texture"] = texture
        if surface.emission.image:
            settings["emission_texture"] = textures.color(surface.emission.image)
        if surface.normal:
            settings["normal_texture"] = textures.data(surface.normal)
            settings["normal_scale"] = surface.normal_scale
        packed = textures.metallic_roughness(surface.metallic, surface.roughness)
        if packed:
            settings["metallic_roughness_texture"] = packed
        if surface.emission.attribute is not None:
            self.notes.add(f"Material “{material.name}” emits a colour attribute, which does not tint what is emitted")
        settings |= {
            "metallic": _factor(surface.metallic),
            "roughness": _factor(surface.roughness),
            "ior": surface.ior,
            "specular": surface.specular,
            "specular_tint": surface.tint,
            "transmission": surface.transmission,
            "thin": surface.thin,
            "emission": tuple(np.clip(surface.emission.factor, 0.0, None).tolist()),
            "alpha": alpha,
            "alpha_mode": mode,
            "name": material.name,
        }
        color = tuple(np.clip(surface.color.factor, 0.0, None).tolist())
        described = {name: textures.digest(value) if isinstance(value, lightmesh.Texture) else value for name, value in settings.items()}
        made = lightmesh.Material.principled(color, **settings)
        return Made(made, repr((color, described)), self._uv_map(material, surface), surface.color.attribute)

    def _alpha(self, surface: Surface) -> tuple[str, float]:
        alpha = surface.alpha
        if alpha.constant:
            opacity = min(max(alpha.offset, 0.0), 1.0)
            return ("opaque" if opacity == 1.0 else "blend"), opacity
        values = self.textures.channel(alpha)
        if values is None:
            return "opaque", 1.0
        partly = np.mean((values > 0.05) & (values < 0.95))
        return ("mask" if partly < PARTLY else "blend"), 1.0

    def _uv_map(self, material: bpy.types.Material, surface: Surface) -> str | None:
        """The UV map of all images: a mesh has one here."""
        color, emission = surface.color.image, surface.emission.image
        uses = [color, surface.alpha.image, surface.roughness.image, surface.metallic.image, emission, surface.normal]
        uses = [use for use in uses if use]
        if len({use.uv_map for use in uses}) > 1:
            self.notes.add(f"Material “{material.name}” uses several UV maps: “{uses[0].uv_map or 'the active one'}” is used for all images")
        packed = [use.matrix for use in (surface.roughness.image, surface.metallic.image) if use]
        cut = [use.matrix for use in (color, surface.alpha.image) if use]
        if len(set(packed)) > 1 or len(set(cut)) > 1:
            self.notes.add(f"Material “{material.name}” places images differently that become one: the first placement is used for both")
        return uses[0].uv_map if uses else None


def _factor(term: NumberTerm) -> float:
    return min(max(term.offset, 0.0), 1.0) if term.constant else 1.0
