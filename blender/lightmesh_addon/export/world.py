"""The world: a colour or a panorama around the scene, which lights it, too."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np

from . import differences, sky
from .nodes import feed, has_nodes, output_of
from .terms import Terms

if TYPE_CHECKING:
    from ..notes import Notes
    from .nodes import Feed
    from .textures import Textures

#: A world of one colour is a panorama of this size.
PLAIN = (8, 16, 3)
#: Lightmesh's clear sky is scaled so that white which faces the sun shows about 1; these are the radiances that it shows in Cycles, by the
#: elevation of the sun in degrees.
ELEVATIONS = (1.0, 5.0, 10.0, 20.0, 35.0, 60.0, 90.0)
SUNNY = (2.4, 12.9, 23.5, 32.9, 38.2, 41.9, 43.9)


@dataclass
class World:
    """What surrounds the scene. `background`: what the camera sees behind it, if that is one colour; `settings`: a sky, as settings of a render."""

    environment: Any = None
    background: tuple | None = None
    settings: dict = field(default_factory=dict)
    #: Equal ones show the same.
    digest: str = ""

    @property
    def lights(self) -> bool:
        """Whether it gives light."""
        return self.environment is not None or bool(self.settings)


def read(world: bpy.types.World | None, textures: Textures, notes: Notes) -> World:
    """The world of a scene, or of `None`."""
    if world is None:
        return World(background=(0.0, 0.0, 0.0))
    differences.of_world(world, notes)
    found = _read(world, textures, notes)
    rays = getattr(world, "cycles_visibility", None)
    if rays and not rays.camera:
        found.background = (0.0, 0.0, 0.0)
    return found


def _read(world: bpy.types.World, textures: Textures, notes: Notes) -> World:
    if not has_nodes(world):
        return _plain(tuple(world.color))
    output = output_of(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return _plain((0.0, 0.0, 0.0))
    if output.inputs["Volume"].is_linked:
        notes.add("World: its volume is left out")
    return Reader(world, textures, notes).shader(feed(output.inputs["Surface"]))


def of_sky(text: str) -> World:
    """Lightmesh's own sky, as settings of a render say it."""
    return World(settings={"sky": text}, digest=text)


def _plain(color: Sequence[float]) -> World:
    color = tuple(max(float(channel), 0.0) for channel in color)
    if not any(color):
        return World(background=color)
    plain = lightmesh.Environment(np.full(PLAIN, color, np.float32), up="z", find_sun=False, name="world")
    return World(plain, color, digest=repr(color))


class Reader:
    def __init__(self, world: bpy.types.World, textures: Textures, notes: Notes) -> None:
        self.terms = Terms(f"World “{world.name}”", notes)
        self.textures = textures

    def shader(self, source: Feed) -> World:
        node = source.node
        if node is None:
            return _plain((0.0, 0.0, 0.0))
        if node.type == "BACKGROUND":
            return self._background(source)
        if node.type == "EMISSION":
            return self._background(source)
        if node.type == "MIX_SHADER":
            return self._mix(source)
        self.terms.warn(node, f"({node.bl_label}) has no counterpart: the world is black")
        return _plain((0.0, 0.0, 0.0))

    def _mix(self, source: Feed) -> World:
        """What the camera sees may be another world than what lights the scene."""
        share = source.input(0)
        first, second = source.input(1), source.input(2)
        if share.node is not None and share.node.type == "LIGHT_PATH" and share.output.name == "Is Camera Ray":
            lit, seen = self.shader(first), self.shader(second)
            if seen.background is not None:
                lit.background = seen.background
            else:
                self.terms.warn(source.node, "shows the camera an image, which is not shown: the camera sees what lights the scene")
            return lit
        part = self.terms.number(share)
        chosen = 1 if part.constant and part.offset > 0.5 else 0
        if not part.constant or part.offset not in (0.0, 1.0):
            self.terms.warn(source.node, f"mixes two worlds: the {'second' if chosen else 'first'} is shown")
        return self.shader((first, second)[chosen])

    def _background(self, source: Feed) -> World:
        strength = self.terms.number(source.input("Strength"), 1.0)
        if not strength.constant:
            self.terms.warn(source.node, "has an image as strength: 1 is used")
        strength = max(strength.offset, 0.0) if strength.constant else 1.0
        color = source.input("Color")
        factor = np.full(3, strength)
        for _ in range(20):  # Colours that a panorama is multiplied with.
            node = color.node
            if node is not None and node.type in ("MIX", "MIX_RGB") and node.blend_type == "MULTIPLY":
                sockets = [feed(socket, color.groups) for socket in node.inputs if socket.enabled and socket.name in ("A", "B", "Color1", "Color2")]
                plain = next((other for other in sockets if other.node is None), None)
                if len(sockets) == 2 and plain is not None:
                    factor = factor * np.array(plain.value)
                    color = next(other for other in sockets if other is not plain)
                    continue
            break
        node = color.node
        if node is not None and node.type == "TEX_ENVIRONMENT":
            return self._panorama(color, factor)
        if node is not None and node.type == "TEX_SKY":
            return self._sky(color, factor)
        term = self.terms.color(color)
        if not term.constant:
            self.terms.warn(node, "has no counterpart in a world: the world has its factor as colour")
        return _plain(np.array(term.factor) * factor)

    def _panorama(self, source: Feed, factor: np.ndarray) -> World:
        node = source.node
        if node.image is None:
            self.terms.warn(node, "has no image")
            return _plain((0.0, 0.0, 0.0))
        pixels = self.textures.pixels(node.image, linear=True)
        if pixels is None:
            return _plain((0.0, 0.0, 0.0))
        pixels = np.maximum(pixels[..., :3] * factor.astype(np.float32), 0.0)
        turn, rotation = self._turn(source.input("Vector")), 90.0
        if node.projection == "MIRROR_BALL":
            pixels = resampled(pixels, turn, mirror_ball)
        elif np.allclose(turn[2], (0.0, 0.0, 1.0)) and np.allclose(turn.T @ turn, np.eye(3), atol=1e-5) and np.linalg.det(turn) > 0.0:
            # A turn about the vertical: the middle of the image, which Blender has at +X, goes the other way.
            rotation += np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))
        else:
            pixels = resampled(pixels, turn, equirectangular)
        pixels, rotation = np.ascontiguousarray(pixels, np.float32), float(rotation % 360.0)
        digest = f"{hashlib.blake2b(pixels).hexdigest()} {rotation}"
        return World(lightmesh.Environment(pixels, up="z", rotation=rotation, name=node.image.name), digest=digest)

    def _turn(self, source: Feed) -> np.ndarray:
        """What is done to directions before they are looked up: a matrix, (3, 3)."""
        node = source.node
        if node is None or (node.type == "TEX_COORD" and source.output.name in ("Generated", "Object")):
            return np.eye(3)
        if node.type == "NEW_GEOMETRY" or node.type == "TEX_COORD":
            if source.output.name not in ("Position", "Normal", "Incoming"):
                self.terms.warn(node, f"gives {source.output.name} coordinates: directions are used")
            return np.eye(3)
        if node.type != "MAPPING":
            self.terms.warn(node, f"({node.bl_label}) gives directions that have no counterpart: they are left as they are")
            return np.eye(3)
        inner = self._turn(source.input("Vector"))
        place, angles, scale = (self.terms._vector(source, name) for name in ("Location", "Rotation", "Scale"))
        if any(place) and node.vector_type in ("POINT", "TEXTURE"):
            self.terms.warn(node, "shifts a panorama, which is left out")
        turn = rotation_matrix(angles)
        if node.vector_type == "TEXTURE":
            inverse = [1.0 / factor if factor else 0.0 for factor in scale]
            return np.diag(inverse) @ turn.T @ inner
        return turn @ np.diag(scale) @ inner

    def _sky(self, source: Feed, factor: np.ndarray) -> World:
        """The panorama that Cycles shows; its sun becomes a light."""
        node = source.node
        try:
            pixels = sky.panorama(node)
        except sky.SkyError as error:
            self.terms.warn(node, f"could not be rendered to a panorama ({error}), and is Lightmesh's clear sky: see that Blender can be started")
            return self._clear_sky(node, factor)
        turn, rotation = np.eye(3), sky.turn_of(node)
        if "Vector" in node.inputs and node.sky_type in sky.WITHOUT_SUN:
            turn = self._turn(source.input("Vector"))
        if not np.allclose(turn, np.eye(3)):
            # The panorama of a sky has +Y in its middle, that of an image +X.
            quarter = rotation_matrix((0.0, 0.0, -0.5 * np.pi))
            pixels, rotation = resampled(pixels, quarter @ turn, equirectangular), 90.0
        pixels = np.ascontiguousarray(pixels * factor.astype(np.float32), np.float32)
        digest = f"{hashlib.blake2b(pixels).hexdigest()} {rotation}"
        return World(lightmesh.Environment(pixels, up="z", rotation=rotation, name=node.name), digest=digest)

    def _clear_sky(self, node: bpy.types.Node, factor: np.ndarray) -> World:
        """Lightmesh's own sky: its sun stands at the same place, if the node has one."""
        elevation, azimuth = np.degrees(node.sun_elevation), np.degrees(node.sun_rotation)
        level = np.interp(elevation, ELEVATIONS, SUNNY) * float(factor.mean())
        return of_sky(f"clear;sun={min(max(elevation, 0.0), 90.0):g},{azimuth % 360.0:g};strength={level:g}")


def rotation_matrix(angles: Sequence[float]) -> np.ndarray:
    """Rotations about X, Y and Z, in this order."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def equirectangular(directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Blender's place of directions in a panorama: shares of its width from the left, and of its height from the top."""
    x, y, z = directions
    return 0.5 - np.arctan2(y, x) / (2.0 * np.pi), 0.5 - np.arctan2(z, np.hypot(x, y)) / np.pi


def mirror_ball(directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same in the image of a mirroring ball, seen along +Y."""
    x, y, z = directions / np.linalg.norm(directions, axis=0)
    y = y - 1.0
    length = np.sqrt(np.maximum(x * x + y * y + z * z, 1e-12))
    return 0.5 * (x / length + 1.0), 0.5 * (1.0 - z / length)


def resampled(pixels: np.ndarray, turn: np.ndarray, place: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """A panorama with its middle at +X, of an image in which directions are looked up after `turn`; bilinear."""
    height, width = pixels.shape[:2]
    if place is mirror_ball:
        width, height = 2 * height, height
    azimuth = (0.5 - (np.arange(width) + 0.5) / width) * 2.0 * np.pi
    elevation = (0.5 - (np.arange(height) + 0.5) / height) * np.pi
    azimuth, elevation = np.meshgrid(azimuth, elevation)
    directions = np.stack([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    u, v = place(np.tensordot(turn, directions, 1))
    rows, columns = pixels.shape[:2]
    x, y = u * columns - 0.5, np.clip(v * rows - 0.5, 0.0, rows - 1.0)
    left, above = np.floor(x).astype(int), np.floor(y).astype(int)
    right_share, below_share = (x - left)[..., None], (y - above)[..., None]
    below = np.minimum(above + 1, rows - 1)
    texel = lambda row, column: pixels[row, column % columns]  # noqa: E731
    upper = (1.0 - right_share) * texel(above, left) + right_share * texel(above, left + 1)
    lower = (1.0 - right_share) * texel(below, left) + right_share * texel(below, left + 1)
    return ((1.0 - below_share) * upper + below_share * lower).astype(np.float32)
