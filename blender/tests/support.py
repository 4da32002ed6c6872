"""Scenes, renders and comparisons for the tests. Pixels are read back from OpenEXR files, as a user would get them."""

import math
import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
import OpenEXR
from mathutils import Vector

WIDTH, HEIGHT = 160, 120
#: Samples of a pixel in Cycles' pictures.
SAMPLES = 64
#: Where tests put pictures of both renderers, side by side, if this environment variable names a folder.
PICTURES = "LIGHTMESH_PICTURES"


def collection() -> bpy.types.Collection:
    return bpy.context.scene.collection


def link(data: bpy.types.ID | None, name: str, place: Sequence[float] = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    """A new object of the scene."""
    obj = bpy.data.objects.new(name, data)
    obj.location = place
    collection().objects.link(obj)
    return obj


def matt(name: str = "matt", color: Sequence[float] = (0.8, 0.8, 0.8)) -> bpy.types.Material:
    """A material of one Diffuse BSDF."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def principled(name: str = "principled", **inputs: object) -> bpy.types.Material:
    """A material of one Principled BSDF with these inputs, `_` for a space."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = shader_of(material)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return material


def shader_of(material: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def mesh(name: str, vertices: Sequence, faces: Sequence, material: bpy.types.Material | None = None) -> bpy.types.Mesh:
    made = bpy.data.meshes.new(name)
    made.from_pydata(vertices, [], faces)
    if material:
        made.materials.append(material)
    made.update()
    return made


def box(name: str, half: Sequence[float], place: Sequence[float], material: bpy.types.Material | None = None) -> bpy.types.Object:
    """A box with these half edges around `place`."""
    x, y, z = half
    corners = [(a * x, b * y, c * z) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return link(mesh(name, corners, faces, material), name, place)


def plane(name: str, half: float, material: bpy.types.Material | None = None, place: Sequence[float] = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    """A square that faces +Z, with a UV map."""
    data = mesh(name, [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)], material)
    layer = data.uv_layers.new(name="UVMap")
    layer.uv.foreach_set("vector", [0, 0, 1, 0, 1, 1, 0, 1])
    return link(data, name, place)


def look_at(obj: bpy.types.Object, target: Sequence[float]) -> bpy.types.Object:
    """Turns what looks or shines along -Z."""
    way = Vector(target) - obj.location
    obj.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    return obj


def camera(place: Sequence[float] = (0.0, -7.0, 5.0), target: Sequence[float] = (0.0, 0.0, 0.0), **settings: object) -> bpy.types.Object:
    data = bpy.data.cameras.new("Camera")
    for name, value in settings.items():
        setattr(data, name, value)
    obj = look_at(link(data, "Camera", place), target)
    bpy.context.scene.camera = obj
    return obj


def light(kind: str, energy: float, place: Sequence[float] = (1.5, -1.0, 4.0), target: Sequence[float] = (0.0, 0.0, 0.0), **settings: object):
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = energy
    for name, value in settings.items():
        setattr(data, name, value)
    obj = look_at(link(data, data.name, place), target)
    obj.visible_camera = False
    return obj


def world(color: Sequence[float] = (0.0, 0.0, 0.0), strength: float = 1.0) -> bpy.types.World:
    made = bpy.data.worlds.new("World")
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = made
    return made


def stage(material: bpy.types.Material | None = None) -> None:
    """A floor with a box and a ball, a camera, and a black world."""
    material = material or matt()
    plane("Floor", 4.0, material)
    box("Box", (0.5, 0.4, 0.9), (-0.9, 0.3, 0.9), material)
    ball("Ball", 0.6, (1.1, -0.3, 0.6), material)
    camera()
    world()


def ball(name: str, radius: float, place: Sequence[float], material: bpy.types.Material | None = None, rings: int = 24) -> bpy.types.Object:
    """A smooth ball of 2 × `rings` by `rings` faces, with a UV map."""
    rows = [
        [(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)) for p in _steps(2 * rings, math.tau)] for t in _steps(rings, math.pi)
    ]
    vertices = [tuple(radius * x for x in vertex) for row in rows for vertex in row]
    across = 2 * rings + 1
    faces = [(r * across + c, (r + 1) * across + c, (r + 1) * across + c + 1, r * across + c + 1) for r in range(rings) for c in range(2 * rings)]
    data = mesh(name, vertices, faces, material)
    layer = data.uv_layers.new(name="UVMap")
    index = np.empty(len(data.loops), np.int32)
    data.loops.foreach_get("vertex_index", index)
    layer.uv.foreach_set("vector", np.column_stack([index % across / (2.0 * rings), 1.0 - index // across / rings]).astype(np.float32).ravel())
    data.polygons.foreach_set("use_smooth", [True] * len(faces))
    return link(data, name, place)


def _steps(count: int, end: float) -> list[float]:
    return [end * step / count for step in range(count + 1)]


def image(name: str, pixels: np.ndarray, is_float: bool = False, space: str | None = None) -> bpy.types.Image:
    """An image of (H, W, 3), row 0 at the top: codes of its colour space, or linear if it is of floats."""
    height, width, _ = pixels.shape
    made = bpy.data.images.new(name, width, height, alpha=False, float_buffer=is_float)
    if space:
        made.colorspace_settings.name = space
    full = np.ones((height, width, 4), np.float32)
    full[..., :3] = pixels[::-1]
    made.pixels.foreach_set(full.ravel())
    made.update()
    return made


@dataclass
class Picture:
    """Channels of a multilayer OpenEXR file by name without the view layer, (H, W) each, row 0 at the top, and its header."""

    channels: dict[str, np.ndarray]
    data: bytes

    @property
    def rgb(self) -> np.ndarray:
        return self.pass_("Combined", "RGB")

    @property
    def alpha(self) -> np.ndarray:
        return self.channels["Combined.A"]

    def pass_(self, name: str, letters: str) -> np.ndarray:
        """(H, W, channels) of a pass."""
        return np.stack([self.channels[f"{name}.{letter}"] for letter in letters], axis=2)


def read(path: Path) -> Picture:
    channels = {}
    with OpenEXR.File(str(path), separate_channels=True) as file:
        for part in file.parts:
            for name, channel in part.channels.items():
                channels[name.partition(".")[2]] = np.array(channel.pixels, np.float32)
    return Picture(channels, path.read_bytes())


def prepare(engine: str, path: Path, size: tuple[int, int] = (WIDTH, HEIGHT)) -> bpy.types.Scene:
    """Sets the scene up for a picture of all passes as floats."""
    scene = bpy.context.scene
    render = scene.render
    render.engine = engine
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    output = render.image_settings
    if hasattr(output, "media_type"):  # Since 5.0.
        output.media_type = "MULTI_LAYER_IMAGE"
    output.file_format, output.color_depth = "OPEN_EXR_MULTILAYER", "32"
    render.filepath = str(path)
    return scene


def picture(engine: str, size: tuple[int, int] = (WIDTH, HEIGHT)) -> Picture:
    """The picture of the scene as F12 gives it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        prepare(engine, path, size)
        bpy.ops.render.render(write_still=True)
        return read(path)


def lightmesh() -> Picture:
    return picture("LIGHTMESH")


def cycles(samples: int = SAMPLES, bounces: int = 0, mirrors: int = 0) -> Picture:
    """Cycles' picture: of direct light only, unless `bounces` of diffuse light or `mirrors`, bounces of glossy light, are wanted."""
    settings = bpy.context.scene.cycles
    settings.device = "CPU"
    settings.samples = samples
    settings.use_denoising = settings.use_adaptive_sampling = False
    settings.max_bounces = max(bounces, mirrors)
    settings.diffuse_bounces, settings.glossy_bounces, settings.transmission_bounces = bounces, mirrors, 0
    settings.sample_clamp_indirect = 0.0
    settings.pixel_filter_type = "BOX"
    settings.blur_glossy = 0.0
    return picture("CYCLES")


def blurred(values: np.ndarray, size: int = 4) -> np.ndarray:
    """Means of squares of pixels: without the noise of single ones."""
    height, width = values.shape[0] // size * size, values.shape[1] // size * size
    return values[:height, :width].reshape(height // size, size, width // size, size, -1).mean((1, 3))


def difference(ours: Picture, theirs: Picture) -> float:
    """The mean difference of squares of 4 pixels, relative to the mean."""
    return float(np.abs(blurred(ours.rgb) - blurred(theirs.rgb)).mean() / theirs.rgb.mean())


def overlap(first: np.ndarray, second: np.ndarray) -> float:
    """The intersection of two masks over their union."""
    return float((first & second).sum() / max((first | second).sum(), 1))


def dark(of: Picture) -> np.ndarray:
    """Where there is less than half of the mean light: shadows and what lies in them."""
    light = of.rgb.sum(2)
    return light < 0.5 * light.mean()


def edges(mask: np.ndarray, width: int = 4) -> np.ndarray:
    """The pixels around the edges of a mask."""
    inside, outside = mask.copy(), mask.copy()
    for _ in range(width):
        for axis in (0, 1):
            for step in (1, -1):
                inside &= np.roll(inside, step, axis)
                outside |= np.roll(outside, step, axis)
    return outside & ~inside


def penumbra_difference(ours: Picture, theirs: Picture) -> float:
    """The mean difference where shadows begin, relative to the mean there: how soft they are shows in it. 0 without shadows."""
    where = blurred(edges(dark(theirs))[..., None].astype(float), 2)[..., 0] == 1.0
    if not where.any():
        return 0.0
    a, b = (blurred(picture.rgb, 2)[where] for picture in (ours, theirs))
    return float(np.abs(a - b).mean() / b.mean())


@dataclass
class Agreement:
    """How alike pictures of both renderers are."""

    ratio: float
    difference: float
    #: Of what is dark in both; 1 if nothing is.
    shadows: float
    penumbra: float

    def check(self, ratio: float = 0.02, difference: float = 0.04, shadows: float = 0.93, penumbra: float = 1.0) -> None:
        """Fails if the means differ by more than `ratio`, squares of pixels by more than `difference`, shadows lie elsewhere, or their edges
        differ by more than `penumbra`."""
        assert abs(self.ratio - 1.0) <= ratio, self
        assert self.difference <= difference, self
        assert self.shadows >= shadows, self
        assert self.penumbra <= penumbra, self


def agreement(name: str, ours: Picture, theirs: Picture) -> Agreement:
    """Compares two pictures, and puts them side by side if that is wished."""
    found = Agreement(
        ratio=float(ours.rgb.mean() / theirs.rgb.mean()),
        difference=difference(ours, theirs),
        shadows=overlap(dark(ours), dark(theirs)) if dark(theirs).mean() > 0.002 else 1.0,
        penumbra=penumbra_difference(ours, theirs),
    )
    print(f"agreement {name}: mean {found.ratio:.4f}, difference {found.difference:.4f}, shadows {found.shadows:.3f}, penumbra {found.penumbra:.3f}")
    if folder := os.environ.get(PICTURES):
        save_side_by_side(Path(folder) / f"{name}.png", ours.rgb, theirs.rgb)
    return found


def save_side_by_side(path: Path, *pictures: np.ndarray) -> None:
    """Writes pictures as a PNG file, doubled in size, and exposed so that their brightest parts show."""
    row = np.concatenate(pictures, axis=1)
    row = np.repeat(np.repeat(row, 2, axis=0), 2, axis=1)
    row = row / max(float(np.percentile(row, 99.0)), 1e-6)
    height, width, _ = row.shape
    made = bpy.data.images.new(path.stem, width, height)
    full = np.ones((height, width, 4), np.float32)
    clipped = np.clip(row, 0.0, 1.0)
    full[..., :3] = np.where(clipped <= 0.0031308, clipped * 12.92, 1.055 * clipped ** (1 / 2.4) - 0.055)[::-1]
    made.pixels.foreach_set(full.ravel())
    made.file_format, made.filepath_raw = "PNG", str(path)
    made.save()
    bpy.data.images.remove(made)
