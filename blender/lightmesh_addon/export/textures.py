"""Images of Blender as textures: rows from the top, eight bits, colours as sRGB and data as they are."""

from __future__ import annotations

import hashlib
from collections.abc import Collection
from typing import TYPE_CHECKING

import bpy
import lightmesh
import numpy as np

if TYPE_CHECKING:
    from ..notes import Notes
    from .terms import ImageUse, NumberTerm


class Textures:
    """The textures of an export; each image is read once."""

    def __init__(self, notes: Notes) -> None:
        self.notes = notes
        self._pixels = {}
        self._made = {}
        #: Digests of textures by their identity: equal ones show the same.
        self._digests = {}

    def digest(self, texture: lightmesh.Texture) -> str:
        return self._digests[id(texture)]

    def keep_from(self, other: Textures, changed: Collection[str]) -> None:
        """Takes over what was read before, but for the images whose names are in `changed`."""
        self._pixels = {key: pixels for key, pixels in other._pixels.items() if key[0] not in changed}

    def pixels(self, image: bpy.types.Image, linear: bool) -> np.ndarray | None:
        """(H, W, 4) `float32`, row 0 at the top: linear, or as sRGB codes. `None` if it cannot be read."""
        key = (image.name_full, linear)
        if key not in self._pixels:
            self._pixels[key] = self._read(image, linear)
        return self._pixels[key]

    def _read(self, image: bpy.types.Image, linear: bool) -> np.ndarray | None:
        width, height = image.size
        if width == 0 or height == 0 or image.channels == 0:
            self.notes.add(f"Image “{image.name}” cannot be read: {image.filepath or 'it has no file'}")
            return None
        flat = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(flat)
        given = flat.reshape(height, width, -1)[::-1]
        pixels = np.ones((height, width, 4), np.float32)
        channels = given.shape[2]
        if channels < 3:  # Grey, perhaps with alpha.
            pixels[..., :3] = given[..., :1]
            if channels == 2:
                pixels[..., 3] = given[..., 1]
        else:
            pixels[..., :channels] = given
        if image.alpha_mode == "NONE":
            pixels[..., 3] = 1.0
        # Files of bytes hold codes of their colour space, those of floats are linear when they are loaded.
        space = image.colorspace_settings.name
        coded = not image.is_float and not image.colorspace_settings.is_data and not space.startswith("Linear")
        if coded and "sRGB" not in space:
            self.notes.add(f"Image “{image.name}” has the colour space {space}, which is taken for sRGB")
        if linear and coded:
            pixels[..., :3] = to_linear(pixels[..., :3])
        elif not linear and not coded:
            pixels[..., :3] = to_srgb(pixels[..., :3])
        return pixels

    def color(self, use: ImageUse | None, alpha: NumberTerm | None = None) -> lightmesh.Texture | None:
        """A texture of colours, or `None` if neither has an image. `alpha`: a `NumberTerm` whose image, placed alike, gives its alpha."""
        key = ("color", use, alpha)
        if key not in self._made:
            self._made[key] = self._color(use, alpha)
        return self._made[key]

    def _color(self, use: ImageUse | None, alpha: NumberTerm | None) -> lightmesh.Texture | None:
        pixels = self.pixels(use.image, linear=False) if use else None
        opacity = self.channel(alpha) if alpha else None
        if opacity is None:
            return None if pixels is None else self._texture(pixels[..., :3], use)
        if pixels is None:
            pixels = np.ones((*opacity.shape, 4), np.float32)
        shape = tuple(np.maximum(pixels.shape[:2], opacity.shape))
        both = np.dstack([resized(pixels[..., :3], shape), resized(opacity, shape)])
        return self._texture(both, use or alpha.image)

    def data(self, use: ImageUse) -> lightmesh.Texture | None:
        """A texture of data, such as normals."""
        key = ("data", use)
        if key not in self._made:
            pixels = self.pixels(use.image, linear=True)
            self._made[key] = None if pixels is None else self._texture(pixels[..., :3], use)
        return self._made[key]

    def metallic_roughness(self, metallic: NumberTerm, roughness: NumberTerm) -> lightmesh.Texture | None:
        """Both in one texture: roughness in the green, metallic in the blue channel. A number without an image is 1 there."""
        key = ("packed", metallic, roughness)
        if key not in self._made:
            self._made[key] = self._packed(metallic, roughness)
        return self._made[key]

    def _packed(self, metallic: NumberTerm, roughness: NumberTerm) -> lightmesh.Texture | None:
        channels = [None if term.constant else self.channel(term) for term in (roughness, metallic)]
        shapes = [channel.shape for channel in channels if channel is not None]
        if not shapes:
            return None
        shape = tuple(np.max(shapes, axis=0))
        packed = np.ones((*shape, 3), np.float32)
        for index, channel in zip((1, 2), channels):
            if channel is not None:
                packed[..., index] = resized(channel, shape)
        return self._texture(packed, roughness.image or metallic.image)

    def channel(self, term: NumberTerm) -> np.ndarray | None:
        """What a number with an image is at each pixel, (H, W)."""
        pixels = self.pixels(term.image.image, linear=True)
        if pixels is None:
            return None
        if term.channel == "L":
            values = pixels[..., :3] @ np.array([0.2126, 0.7152, 0.0722], np.float32)
        else:
            values = pixels[..., "RGBA".index(term.channel)]
        return np.clip(term.scale * values + term.offset, 0.0, 1.0)

    def _texture(self, pixels: np.ndarray, use: ImageUse) -> lightmesh.Texture:
        image = use.image
        if float(pixels.max(initial=0.0)) > 1.001:
            self.notes.add(f"Image “{image.name}” is brighter than 1, which textures cannot be: it is cut off there")
        codes = (np.clip(pixels, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
        matrix = upper_left(np.array(use.matrix))
        placed = None if np.array_equal(matrix, np.eye(2, 3)) else matrix
        codes = np.ascontiguousarray(codes)
        made = lightmesh.Texture(codes, wrap=use.wrap, transform=placed, name=image.name)
        self._digests[id(made)] = f"{hashlib.blake2b(codes).hexdigest()} {codes.shape} {use.wrap} {matrix.tolist()}"
        return made


def upper_left(matrix: np.ndarray) -> np.ndarray:
    """The same placement for coordinates whose origin is the upper left corner: v becomes 1 - v, before and after."""
    flip = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, 1.0]])
    return (flip @ np.vstack([matrix, (0.0, 0.0, 1.0)]) @ flip)[:2]


def resized(pixels: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """The nearest pixels of an image of another size."""
    if pixels.shape[:2] == tuple(shape):
        return pixels
    rows, columns = (np.arange(to) * size // to for to, size in zip(shape, pixels.shape[:2]))
    return pixels[rows[:, None], columns]


def to_linear(codes: np.ndarray) -> np.ndarray:
    return np.where(codes <= 0.04045, codes / 12.92, ((np.maximum(codes, 0.0) + 0.055) / 1.055) ** 2.4).astype(np.float32)


def to_srgb(linear: np.ndarray) -> np.ndarray:
    clipped = np.maximum(linear, 0.0)
    return np.where(clipped <= 0.0031308, clipped * 12.92, 1.055 * clipped ** (1 / 2.4) - 0.055).astype(np.float32)
