"""What a shader tree describes, in the terms of a metallic and rough surface; the nearest such surface for shaders that are none."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from .nodes import feed as feed_of
from .terms import ColorTerm, NumberTerm, Terms

if TYPE_CHECKING:
    from ..notes import Notes
    from .nodes import Feed
    from .terms import ImageUse

BLACK = ColorTerm((0.0, 0.0, 0.0))
#: Inputs of the Principled BSDF that have no counterpart.
LEFT_OUT = {
    "Subsurface Weight": "subsurface scattering",
    "Coat Weight": "a coat",
    "Sheen Weight": "sheen",
    "Thin Film Thickness": "a thin film",
    "Anisotropic": "an anisotropic highlight",
}


@dataclass(frozen=True)
class Surface:
    """A surface. `alpha` is the share that is there at all, `transmission` what goes through the rest of it as through glass."""

    color: ColorTerm = ColorTerm((0.8, 0.8, 0.8))
    metallic: NumberTerm = NumberTerm(0.0)
    roughness: NumberTerm = NumberTerm(1.0)
    ior: float = 1.5
    specular: float = 0.0
    tint: tuple = (1.0, 1.0, 1.0)
    transmission: float = 0.0
    thin: bool = False
    emission: ColorTerm = BLACK
    alpha: NumberTerm = NumberTerm(1.0)
    normal: Any = None
    normal_scale: float = 1.0
    #: Whether it cuts a hole into the image.
    holdout: bool = False

    def blackened(self) -> Surface:
        """As black as a hole, where it is there at all."""
        return Surface(BLACK, alpha=self.alpha)

    @property
    def unseen(self) -> bool:
        return self.alpha.constant and self.alpha.offset <= 0.0 and self.emission.black


class Surfaces:
    """Reads the surface of one material."""

    def __init__(self, material: bpy.types.Material, notes: Notes) -> None:
        self.terms = Terms(f"Material “{material.name}”", notes)
        #: A node that cuts holes into the image.
        self.held_out = None
        self.readers = {
            "BSDF_PRINCIPLED": self._principled,
            "BSDF_DIFFUSE": self._diffuse,
            "BSDF_GLOSSY": self._glossy,
            "BSDF_ANISOTROPIC": self._glossy,
            "BSDF_METALLIC": self._metallic,
            "BSDF_GLASS": self._glass,
            "BSDF_REFRACTION": self._glass,
            "BSDF_TRANSPARENT": self._transparent,
            "BSDF_TRANSLUCENT": self._translucent,
            "EMISSION": self._emission,
            "MIX_SHADER": self._mix,
            "ADD_SHADER": self._add,
            "HOLDOUT": self._holdout,
        }

    def read(self, feed: Feed) -> Surface:
        """The surface of a material."""
        found = self._read(feed)
        if self.held_out and not found.holdout:
            self.terms.warn(self.held_out, "is a part of a mixture, which cuts no hole into the image here")
        return found

    def _read(self, feed: Feed) -> Surface:
        """The surface that a shader socket gets."""
        node = feed.node
        if node is None:
            return Surface(color=BLACK)
        reader = self.readers.get(node.type)
        if reader:
            return reader(feed)
        return self._other(feed)

    def _principled(self, feed: Feed) -> Surface:
        terms = self.terms
        for name, what in LEFT_OUT.items():
            if feed.has_input(name):
                weight = terms.number(feed.input(name))
                if not weight.constant or abs(weight.offset) > 1e-6:
                    terms.warn(feed.node, f"has {what}, which is left out")
        normal, scale = self._normal(feed)
        level = self._constant(feed, "Specular IOR Level", 0.5)
        strength = self._constant(feed, "Emission Strength", 0.0)
        tint = terms.color(feed.input("Specular Tint")) if feed.has_input("Specular Tint") else ColorTerm()
        if not tint.constant:
            terms.warn(feed.node, "has an image as specular tint, which is left out")
            tint = ColorTerm()
        # 0.5 is what the index of refraction gives; a layer that reflects more has the rest in its tint.
        specular, more = min(2.0 * level, 1.0), max(2.0 * level, 1.0)
        return Surface(
            color=terms.color(feed.input("Base Color")),
            metallic=terms.number(feed.input("Metallic")),
            roughness=terms.number(feed.input("Roughness")),
            ior=max(self._constant(feed, "IOR", 1.5), 1.0),
            specular=specular,
            tint=tint.times(more).factor,
            transmission=self._constant(feed, "Transmission Weight", 0.0),
            emission=terms.color(feed.input("Emission Color")).times(strength) if strength else BLACK,
            alpha=terms.number(feed.input("Alpha")),
            normal=normal,
            normal_scale=scale,
        )

    def _diffuse(self, feed: Feed) -> Surface:
        normal, scale = self._normal(feed)
        return Surface(color=self.terms.color(feed.input("Color")), normal=normal, normal_scale=scale)

    def _glossy(self, feed: Feed) -> Surface:
        normal, scale = self._normal(feed)
        color, roughness = self.terms.color(feed.input("Color")), self.terms.number(feed.input("Roughness"))
        return Surface(color, NumberTerm(1.0), roughness, specular=1.0, normal=normal, normal_scale=scale)

    def _metallic(self, feed: Feed) -> Surface:
        normal, scale = self._normal(feed)
        color = self.terms.color(feed.input("Base Color"))
        if feed.node.fresnel_type != "F82":
            self.terms.warn(feed.node, "describes a metal by its physical indices: its base colour is used")
        roughness = self.terms.number(feed.input("Roughness"))
        return Surface(color, NumberTerm(1.0), roughness, specular=1.0, normal=normal, normal_scale=scale)

    def _glass(self, feed: Feed) -> Surface:
        if feed.node.type == "BSDF_REFRACTION":
            self.terms.warn(feed.node, "is shown as glass, which also reflects")
        roughness = self._constant(feed, "Roughness", 0.0)
        color, ior = self.terms.color(feed.input("Color")), self._constant(feed, "IOR", 1.5)
        return Surface(color, roughness=NumberTerm(roughness), ior=max(ior, 1.0), specular=1.0, transmission=1.0)

    def _transparent(self, feed: Feed) -> Surface:
        color = self.terms.color(feed.input("Color"))
        if color.constant and min(color.factor) < 1.0:
            # A pane that does not bend light filters it by its colour.
            return Surface(color, ior=1.0, transmission=1.0, thin=True)
        return Surface(BLACK, alpha=NumberTerm(0.0))

    def _translucent(self, feed: Feed) -> Surface:
        self.terms.warn(feed.node, "is shown as a matt surface: light does not shine through it")
        return Surface(color=self.terms.color(feed.input("Color")))

    def _holdout(self, feed: Feed) -> Surface:
        self.held_out = feed.node
        return Surface(color=BLACK, holdout=True)

    def _emission(self, feed: Feed) -> Surface:
        strength = self.terms.number(feed.input("Strength"))
        if not strength.constant:
            self.terms.warn(feed.node, "has an image as strength: 1 is used")
            strength = NumberTerm(1.0)
        return Surface(color=BLACK, emission=self.terms.color(feed.input("Color")).times(strength.offset))

    def _mix(self, feed: Feed) -> Surface:
        share = self._share(feed)
        first, second = (self._read(feed.input(index)) for index in (1, 2))
        if not share.constant:
            if first.unseen:
                return replace(second, alpha=share)
            if second.unseen:
                return replace(first, alpha=replace(share, scale=-share.scale, offset=1.0 - share.offset))
            self.terms.warn(feed.node, "mixes shaders by an image: the first is shown")
            return first
        part = min(max(share.offset, 0.0), 1.0)
        if part in (0.0, 1.0):
            return second if part else first
        if first.unseen:
            return self._thinned(second, part)
        if second.unseen:
            return self._thinned(first, 1.0 - part)
        if all(s.color.black and s.metallic == NumberTerm(0.0) and s.specular == 0.0 for s in (first, second)):
            if first.emission.constant and second.emission.constant:
                mixed = (1.0 - part) * np.array(first.emission.factor) + part * np.array(second.emission.factor)
                return replace(first, emission=ColorTerm(tuple(mixed.tolist())))
        for emitter, other, weight in ((first, second, part), (second, first, 1.0 - part)):
            if not emitter.emission.black and emitter.color.black and other.emission.black:
                light = emitter.emission.times(1.0 - weight)
                return replace(other, color=other.color.times(weight), specular=other.specular * weight, emission=light)
        chosen = second if part > 0.5 else first
        self.terms.warn(feed.node, f"mixes two shaders: the {'second' if part > 0.5 else 'first'} is shown")
        return chosen

    def _share(self, feed: Feed) -> NumberTerm:
        inner = feed.input(0)
        if inner.node is not None and inner.node.type in ("FRESNEL", "LAYER_WEIGHT"):
            self.terms.warn(inner.node, "mixes shaders by the angle of view: the first is shown")
            return NumberTerm(0.0)
        if inner.node is not None and inner.node.type == "LIGHT_PATH":
            self.terms.warn(inner.node, "mixes shaders by the kind of ray: what the camera sees is shown")
            return NumberTerm(1.0 if inner.output.name == "Is Camera Ray" else 0.0)
        return self.terms.number(inner)

    def _thinned(self, surface: Surface, part: float) -> Surface:
        if not surface.alpha.constant:
            return replace(surface, alpha=replace(surface.alpha, scale=surface.alpha.scale * part, offset=surface.alpha.offset * part))
        return replace(surface, alpha=NumberTerm(surface.alpha.offset * part))

    def _add(self, feed: Feed) -> Surface:
        first, second = (self._read(feed.input(index)) for index in (0, 1))
        for emitter, other in ((first, second), (second, first)):
            if emitter.color.black and emitter.specular == 0.0 and other.emission.black:
                return replace(other, emission=emitter.emission) if not emitter.emission.black else other
        self.terms.warn(feed.node, "adds two shaders: the first is shown")
        return first

    def _other(self, feed: Feed) -> Surface:
        node = feed.node
        color = next((node.inputs[name] for name in ("Color", "Base Color") if name in node.inputs), None)
        self.terms.warn(node, f"({node.bl_label}) has no counterpart: a matt surface is shown")
        return Surface(color=self.terms.color(feed_of(color, feed.groups))) if color else Surface()

    def _constant(self, feed: Feed, name: str, default: float) -> float:
        if not feed.has_input(name):
            return default
        term = self.terms.number(feed.input(name))
        if term.constant:
            return term.offset
        self.terms.warn(feed.node, f"has an image as {name.lower()}: the socket's own value is used")
        return float(feed.node.inputs[name].default_value)

    def _normal(self, feed: Feed) -> tuple[ImageUse | None, float]:
        """The image of a Normal Map node and its strength."""
        if not feed.has_input("Normal"):
            return None, 1.0
        inner = feed.input("Normal")
        node = inner.node
        if node is None:
            return None, 1.0
        if node.type == "BUMP":
            self.terms.warn(node, "is left out: relief needs an image of normals")
            below = inner.input("Normal")
            return self._normal_map(below) if below.node is not None else (None, 1.0)
        return self._normal_map(inner)

    def _normal_map(self, inner: Feed) -> tuple[ImageUse | None, float]:
        node = inner.node
        if node.type != "NORMAL_MAP":
            self.terms.warn(node, f"({node.bl_label}) gives normals that have no counterpart: those of the mesh are used")
            return None, 1.0
        if node.space != "TANGENT":
            self.terms.warn(node, f"has normals in {node.space.lower()} space, which are left out")
            return None, 1.0
        color = self.terms.color(inner.input("Color"), default=(0.5, 0.5, 1.0))
        strength = self._constant(inner, "Strength", 1.0)
        if color.image is None:
            return None, 1.0
        image = replace(color.image, uv_map=color.image.uv_map or node.uv_map)
        return image, strength
