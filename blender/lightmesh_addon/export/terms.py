"""Colours and numbers of materials: a factor, times an image or a colour attribute. What nodes do beyond that is left out, with a warning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

if TYPE_CHECKING:
    from ..notes import Notes
    from .nodes import Feed

WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "clamp", "MIRROR": "mirror"}
#: Shares of the channels in the luminance, by which Cycles makes numbers of colours.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
#: Nodes that change a colour a little: their input is shown as it is.
ADJUSTMENTS = {"GAMMA": "Color", "HUE_SAT": "Color", "BRIGHTCONTRAST": "Color", "CURVE_RGB": "Color", "INVERT": "Color"}


@dataclass(frozen=True)
class ImageUse:
    """An image as a node places it: `matrix`, (2, 3), takes coordinates of the UV map to those of the image, both with Blender's lower left
    origin."""

    image: Any
    matrix: tuple
    uv_map: str
    wrap: str


@dataclass(frozen=True)
class ColorTerm:
    """`factor` times the image, times the colour attribute."""

    factor: tuple = (1.0, 1.0, 1.0)
    image: ImageUse | None = None
    #: The name of a colour attribute; "" is the active one.
    attribute: str | None = None

    def times(self, factor: float | Sequence[float]) -> ColorTerm:
        return replace(self, factor=tuple(np.multiply(self.factor, factor).tolist()))

    @property
    def constant(self) -> bool:
        return self.image is None and self.attribute is None

    @property
    def black(self) -> bool:
        return not any(self.factor)


@dataclass(frozen=True)
class NumberTerm:
    """`scale` times a channel of the image plus `offset`; without an image, `offset`."""

    offset: float = 0.0
    scale: float = 0.0
    image: ImageUse | None = None
    #: R, G, B, A, or L for the luminance.
    channel: str = "L"

    @property
    def constant(self) -> bool:
        return self.image is None


class Terms:
    """Reads the terms of one material, or of the world."""

    def __init__(self, owner: str, notes: Notes) -> None:
        self.owner = owner
        self.notes = notes

    def warn(self, node: bpy.types.Node, what: str) -> None:
        label = f"“{node.label or node.name}”" if node else "a node"
        self.notes.add(f"{self.owner}: the node {label} {what}")

    def color(self, feed: Feed, default: Sequence[float] | None = None) -> ColorTerm:
        """The colour that arrives; where a node has no counterpart, `default` or the value that the socket has unlinked."""
        node = feed.node
        if node is None:
            return ColorTerm(_color(feed.value, default))
        kind = node.type
        if kind == "RGB":
            return ColorTerm(tuple(feed.output.default_value)[:3])
        if kind == "VALUE":
            return ColorTerm((float(feed.output.default_value),) * 3)
        if kind == "TEX_IMAGE" and feed.output.name == "Color":
            use = self.image(feed)
            return ColorTerm(image=use) if use else ColorTerm(_color(feed.value, default))
        if kind == "VERTEX_COLOR" or (kind == "ATTRIBUTE" and node.attribute_type == "GEOMETRY"):
            if feed.output.name in ("Color", "Vector"):
                return ColorTerm(attribute=node.layer_name if kind == "VERTEX_COLOR" else node.attribute_name)
        if kind in ("MIX", "MIX_RGB"):
            mixed = self._mixed(feed)
            if mixed is not None:
                return mixed
        if kind in ADJUSTMENTS:
            inner = self.color(feed.input(ADJUSTMENTS[kind]), default)
            self.warn(node, "is left out: the colour before it is shown")
            return inner
        if kind == "VALTORGB":
            factor = self.number(feed.input(0))
            place = factor.offset if factor.constant else 0.5
            if not factor.constant:
                self.warn(node, "is shown as the colour in its middle: a colour ramp of an image has no counterpart")
            return ColorTerm(tuple(node.color_ramp.evaluate(place))[:3])
        if kind in ("COMBINE_COLOR", "COMBRGB") and getattr(node, "mode", "RGB") == "RGB":
            parts = [self.number(feed.input(index)) for index in range(3)]
            if all(part.constant for part in parts):
                return ColorTerm(tuple(part.offset for part in parts))
        if kind == "MATH":
            number = self.number(feed)
            if number.constant:
                return ColorTerm((number.offset,) * 3)
        self.warn(node, f"({node.bl_label}) has no counterpart: its socket's own value is used")
        return ColorTerm(_color(feed.value, default))

    def number(self, feed: Feed, default: float | None = None) -> NumberTerm:
        """The number that arrives."""
        node = feed.node
        if node is None:
            return NumberTerm(_number(feed.value, default))
        kind = node.type
        if kind == "VALUE":
            return NumberTerm(float(feed.output.default_value))
        if kind == "TEX_IMAGE":
            use = self.image(feed)
            if use:
                return NumberTerm(scale=1.0, image=use, channel="A" if feed.output.name == "Alpha" else "L")
            return NumberTerm(_number(feed.value, default))
        if kind in ("SEPARATE_COLOR", "SEPRGB") and getattr(node, "mode", "RGB") == "RGB":
            index = next(i for i, output in enumerate(node.outputs) if output == feed.output)
            color = self.color(feed.input(0))
            if color.constant:
                return NumberTerm(color.factor[index])
            if color.image and color.attribute is None:
                return NumberTerm(scale=color.factor[index], image=color.image, channel="RGB"[index])
        if kind == "MATH":
            result = self._math(feed)
            if result is not None:
                return result
        if kind in ("RGB", "COMBINE_COLOR", "MIX", "MIX_RGB", "VALTORGB", *ADJUSTMENTS):
            color = self.color(feed)
            luminance = float(LUMINANCE @ np.array(color.factor))
            if color.constant:
                return NumberTerm(luminance)
            if color.image and color.attribute is None:
                return NumberTerm(scale=luminance, image=color.image)
        self.warn(node, f"({node.bl_label}) has no counterpart: its socket's own value is used")
        return NumberTerm(_number(feed.value, default))

    def image(self, feed: Feed) -> ImageUse | None:
        """The image of an Image Texture node, or `None` if there is nothing to show."""
        node = feed.node
        image = node.image
        if image is None:
            self.warn(node, "has no image")
            return None
        if image.source == "TILED":
            self.warn(node, "has UDIM tiles, of which the first is shown everywhere")
        if node.projection != "FLAT":
            self.warn(node, f"projects its image as {node.projection.lower()}: the UV map is used")
        if node.interpolation == "Closest":
            self.warn(node, "shows pixels: they are interpolated")
        if node.extension == "CLIP":
            self.warn(node, "clips its image: beyond the edges, their colour is shown")
        matrix, uv_map = self._placement(feed.input("Vector"))
        return ImageUse(image, tuple(map(tuple, matrix)), uv_map, WRAPS.get(node.extension, "repeat"))

    def _placement(self, feed: Feed) -> tuple[np.ndarray, str]:
        """Which UV map, and what is done to its coordinates."""
        node, identity = feed.node, np.eye(2, 3)
        if node is None:
            return identity, ""
        if node.type == "UVMAP":
            return identity, node.uv_map
        if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY":
            return identity, node.attribute_name
        if node.type == "TEX_COORD":
            if feed.output.name != "UV":
                self.warn(node, f"gives {feed.output.name} coordinates: the UV map is used")
            return identity, ""
        if node.type == "MAPPING":
            inner, uv_map = self._placement(feed.input("Vector"))
            place, turn, scale = (self._vector(feed, name) for name in ("Location", "Rotation", "Scale"))
            if any(turn[:2]):
                self.warn(node, "turns an image out of its plane: only the rotation about Z counts")
            return _times(mapping(node.vector_type, place, turn[2], scale), inner), uv_map
        self.warn(node, f"({node.bl_label}) gives coordinates that have no counterpart: the UV map is used")
        return identity, ""

    def _vector(self, feed: Feed, name: str) -> tuple[float, ...]:
        if not feed.has_input(name):
            return (0.0, 0.0, 0.0)
        inner = feed.input(name)
        if inner.node is not None:
            self.warn(inner.node, f"drives {name.lower()} of a mapping: the value of the socket is used")
        return inner.value

    def _mixed(self, feed: Feed) -> ColorTerm | None:
        node = feed.node
        if node.type == "MIX":
            if node.data_type != "RGBA":
                return None
            sockets = [socket for socket in node.inputs if socket.enabled]
            factor, first, second = (next(s for s in sockets if s.name == name) for name in ("Factor", "A", "B"))
        else:
            factor, first, second = node.inputs
        from .nodes import feed as feed_of

        share = self.number(feed_of(factor, feed.groups))
        a, b = (self.color(feed_of(socket, feed.groups)) for socket in (first, second))
        share = share.offset if share.constant else None
        if share is None:
            self.warn(node, "mixes by an image: the mean of both colours is used")
            share = 0.5
        share = min(max(share, 0.0), 1.0)
        blend = node.blend_type
        if a.constant and b.constant and blend in ("MIX", "MULTIPLY", "ADD"):
            first, second = np.array(a.factor), np.array(b.factor)
            other = {"MIX": second, "MULTIPLY": first * second, "ADD": first + second}[blend]
            return ColorTerm(tuple(((1 - share) * first + share * other).tolist()))
        if blend == "MULTIPLY" and share == 1.0:
            if (a.image is None or b.image is None) and (a.attribute is None or b.attribute is None):
                product = a.times(b.factor)
                attribute = a.attribute if a.attribute is not None else b.attribute
                return replace(product, image=a.image or b.image, attribute=attribute)
        if blend == "MULTIPLY" and b.constant:
            return a.times((1 - share) + share * np.array(b.factor))
        if blend == "MIX" and share in (0.0, 1.0):
            return b if share else a
        self.warn(node, f"mixes ({blend.lower()}) what cannot be mixed: its {'second' if share > 0.5 else 'first'} colour is shown")
        return b if share > 0.5 else a

    def _math(self, feed: Feed) -> NumberTerm | None:
        node = feed.node
        terms = [self.number(feed.input(index)) for index in range(2) if node.inputs[index].enabled]
        if len(terms) < 2:
            return None
        a, b = terms
        operation = node.operation
        if operation == "SUBTRACT":
            b = replace(b, offset=-b.offset, scale=-b.scale)
        if operation in ("ADD", "SUBTRACT") and (a.constant or b.constant):
            varying, other = (b, a) if a.constant else (a, b)
            result = replace(varying, offset=varying.offset + other.offset)
        elif operation == "MULTIPLY" and (a.constant or b.constant):
            varying, other = (b, a) if a.constant else (a, b)
            result = replace(varying, offset=varying.offset * other.offset, scale=varying.scale * other.offset)
        elif operation == "DIVIDE" and b.constant and b.offset:
            result = replace(a, offset=a.offset / b.offset, scale=a.scale / b.offset)
        elif operation == "POWER" and a.constant and b.constant and a.offset > 0.0:
            result = NumberTerm(a.offset**b.offset)
        else:
            return None
        if node.use_clamp and result.constant:
            result = replace(result, offset=min(max(result.offset, 0.0), 1.0))
        return result


def mapping(kind: str, place: Sequence[float], angle: float, scale: Sequence[float]) -> np.ndarray:
    """The matrix, (2, 3), of a Mapping node in the plane of an image."""
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, -sin], [sin, cos]])
    if kind == "TEXTURE":
        inverse = [1.0 / factor if factor else 0.0 for factor in scale[:2]]
        linear = np.diag(inverse) @ turn.T
        return np.column_stack([linear, -linear @ np.array(place[:2])])
    shift = (0.0, 0.0) if kind in ("VECTOR", "NORMAL") else place[:2]
    return np.column_stack([turn @ np.diag(scale[:2]), shift])


def _times(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    full = [np.vstack([matrix, (0.0, 0.0, 1.0)]) for matrix in (outer, inner)]
    return (full[0] @ full[1])[:2]


def _color(value: float | Sequence[float] | None, default: Sequence[float] | None) -> tuple[float, ...]:
    if value is None:
        value = default if default is not None else 0.8
    return tuple(value) if np.ndim(value) else (float(value),) * 3


def _number(value: float | Sequence[float] | None, default: float | None) -> float:
    if value is None:
        value = default if default is not None else 0.0
    return float(LUMINANCE @ np.array(value)) if np.ndim(value) else float(value)
