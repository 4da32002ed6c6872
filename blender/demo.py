"""Makes a demo file: a courtyard in the evening, of primitives only. Its render settings are Blender's and Lightmesh's defaults.

    python blender/demo.py courtyard.blend [--render courtyard.png] [--percentage 50]

It runs in the `bpy` module, with the add-on beside it, or in Blender: `blender --background --python blender/demo.py -- courtyard.blend`.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy  # isort: skip: the modules below come with it

import bmesh
import numpy as np
from mathutils import Matrix, Vector

Color = tuple[float, float, float]


def material(name: str, color: Color, roughness: float = 0.7, metallic: float = 0.0, emission: float = 0.0) -> bpy.types.Material:
    """A material of one Principled BSDF. `emission`: radiance in its own colour."""
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    inputs = shader(made).inputs
    inputs["Base Color"].default_value = (*color, 1.0)
    inputs["Roughness"].default_value, inputs["Metallic"].default_value = roughness, metallic
    inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (*color, 1.0), emission
    return made


def shader(of: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in of.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def tiles() -> bpy.types.Material:
    """Square tiles with joints, each a little different, as an image that is packed into the file."""
    count, size, rng = 8, 512, np.random.default_rng(4)
    cell = size // count
    rows, columns = np.mgrid[0:size, 0:size]
    shade = rng.uniform(0.85, 1.05, (count, count))[rows // cell, columns // cell]
    joint = (np.minimum(rows % cell, columns % cell) < 3)[..., None]
    base = np.where(((rows // cell + columns // cell) % 2)[..., None], (0.72, 0.62, 0.50), (0.62, 0.50, 0.40))
    pixels = np.ones((size, size, 4), np.float32)
    pixels[..., :3] = np.clip(np.where(joint, (0.36, 0.32, 0.28), base * shade[..., None]), 0.0, 1.0)
    picture = bpy.data.images.new("tiles", size, size)
    picture.pixels.foreach_set(pixels.ravel())
    picture.pack()
    made = material("Tiles", (1.0, 1.0, 1.0), 0.5)
    tree = made.node_tree
    node, mapping, place = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "Mapping", "TexCoord"))
    node.image = picture
    mapping.inputs["Scale"].default_value = (3.0, 3.0, 1.0)
    tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    tree.links.new(node.outputs["Color"], shader(made).inputs["Base Color"])
    return made


def add(name: str, mesh: bmesh.types.BMesh, of: bpy.types.Material, place: Sequence[float], smooth: bool = False) -> bpy.types.Object:
    """An object of a mesh, which is freed. If it is `smooth`, edges of more than 35° are sharp all the same."""
    mesh.normal_update()
    for edge in mesh.edges:
        edge.smooth = edge.calc_face_angle(0.0) < math.radians(35.0)
    data = bpy.data.meshes.new(name)
    for face in mesh.faces:
        face.smooth = smooth
    mesh.to_mesh(data)
    mesh.free()
    data.materials.append(of)
    obj = bpy.data.objects.new(name, data)
    obj.location = place
    bpy.context.scene.collection.objects.link(obj)
    return obj


def box(name: str, size: Sequence[float], place: Sequence[float], of: bpy.types.Material, bevel: float = 0.0) -> bpy.types.Object:
    """A box that stands at `place`, with rounded edges."""
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=1.0, matrix=Matrix.Translation((0.0, 0.0, 0.5 * size[2])) @ Matrix.Diagonal((*size, 1.0)))
    obj = add(name, mesh, of, place)
    if bevel:
        modifier = obj.modifiers.new("Bevel", "BEVEL")
        modifier.width, modifier.segments = bevel, 3
    return obj


def lathe(name: str, profile: Sequence[tuple[float, float]], place: Sequence[float], of: bpy.types.Material, segments: int = 48) -> bpy.types.Object:
    """A solid of revolution about Z, of radii and heights from below."""
    mesh = bmesh.new()
    rings = [
        [mesh.verts.new((r * math.cos(a), r * math.sin(a), z)) for a in np.linspace(0.0, math.tau, segments, endpoint=False)] for r, z in profile
    ]
    for lower, upper in zip(rings, rings[1:]):
        for i in range(segments):
            j = (i + 1) % segments
            mesh.faces.new((lower[i], lower[j], upper[j], upper[i]))
    mesh.faces.new(reversed(rings[0]))
    mesh.faces.new(rings[-1])
    return add(name, mesh, of, place, smooth=True)


def floor(of: bpy.types.Material) -> None:
    mesh = bmesh.new()
    bmesh.ops.create_grid(mesh, x_segments=1, y_segments=1, size=6.0, calc_uvs=False)
    obj = add("Floor", mesh, of, (0.0, 0.0, 0.0))
    obj.data.uv_layers.new(name="UVMap")
    corners = np.array([obj.data.vertices[loop.vertex_index].co[:2] for loop in obj.data.loops])
    obj.data.uv_layers[0].uv.foreach_set("vector", (corners / 12.0 + 0.5).astype(np.float32).ravel())


def wall_with_arches(of: bpy.types.Material) -> None:
    """A wall along X with three round arches, as thick as a Solidify modifier makes it."""
    below = [(-6.0, 0.0)]
    for middle in (-3.6, 0.0, 3.6):
        arch = [(middle - 1.1 * math.cos(a), 2.0 + 1.1 * math.sin(a)) for a in np.linspace(0.0, math.pi, 33)]
        below += [(middle - 1.1, 0.0), *arch, (middle + 1.1, 0.0)]
    below.append((6.0, 0.0))
    mesh = bmesh.new()
    for (left, low), (right, other) in zip(below, below[1:]):
        if right > left:
            corners = ((left, low), (right, other), (right, 4.2), (left, 4.2))
            mesh.faces.new([mesh.verts.new((x, 0.0, z)) for x, z in corners])
    bmesh.ops.remove_doubles(mesh, verts=mesh.verts, dist=1e-5)
    obj = add("Arcade", mesh, of, (0.0, 3.2, 0.0))
    modifier = obj.modifiers.new("Solidify", "SOLIDIFY")
    modifier.thickness, modifier.offset = 0.5, 0.0


def pergola(of: bpy.types.Material) -> None:
    """Posts, two beams, and slats by an Array modifier, whose shadows fall on the floor."""
    for number, (x, y) in enumerate(((-5.0, -1.8), (-1.2, -1.8), (-5.0, 2.4), (-1.2, 2.4))):
        box(f"Post {number}", (0.16, 0.16, 2.8), (x, y, 0.0), of, 0.02)
    for number, y in enumerate((-1.8, 2.4)):
        box(f"Beam {number}", (5.0, 0.12, 0.2), (-3.1, y, 2.8), of, 0.02)
    slats = box("Slats", (0.1, 5.2, 0.14), (-5.3, 0.3, 3.0), of)
    array = slats.modifiers.new("Array", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = 15, False, True
    array.constant_offset_displace = (0.32, 0.0, 0.0)


def plant(pot: bpy.types.Material, leaf: bpy.types.Material) -> bpy.types.Collection:
    """A pot with leaves, as a collection that is instanced."""
    made = bpy.data.collections.new("Plant")
    parts = [lathe("Pot", [(0.22, 0.0), (0.34, 0.5), (0.38, 0.5), (0.38, 0.58), (0.33, 0.58), (0.32, 0.5)], (0.0, 0.0, 0.0), pot)]
    rng = random.Random(7)
    mesh = bmesh.new()
    for _ in range(70):
        spread, turn, length = rng.uniform(0.15, 1.15), rng.uniform(0.0, math.tau), rng.uniform(0.5, 1.0)
        way = Matrix.Rotation(turn, 3, "Z") @ Vector((math.sin(spread), 0.0, math.cos(spread)))
        side = 0.07 * way.cross(Vector((0.0, 0.0, 1.0))).normalized()
        bend = Vector((0.0, 0.0, -0.25 * math.sin(spread)))
        points = [(0.0, 0.3), (0.35, 1.0), (0.7, 0.8), (1.0, 0.03)]
        spine = [(Vector((0.0, 0.0, 0.5)) + length * (t * way + t * t * bend), width) for t, width in points]
        rows = [[mesh.verts.new(middle + sign * width * side) for sign in (-1.0, 1.0)] for middle, width in spine]
        for lower, upper in zip(rows, rows[1:]):
            mesh.faces.new((lower[0], lower[1], upper[1], upper[0]))
    parts.append(add("Leaves", mesh, leaf, (0.0, 0.0, 0.0), smooth=True))
    for part in parts:
        bpy.context.scene.collection.objects.unlink(part)
        made.objects.link(part)
    return made


def place_instance(of: bpy.types.Collection, place: Sequence[float], scale: float, turn: float) -> None:
    obj = bpy.data.objects.new(of.name, None)
    obj.instance_type, obj.instance_collection = "COLLECTION", of
    obj.location, obj.scale, obj.rotation_euler = place, (scale,) * 3, (0.0, 0.0, turn)
    bpy.context.scene.collection.objects.link(obj)


def aimed(name: str, data: bpy.types.ID, place: Sequence[float], target: Sequence[float]) -> bpy.types.Object:
    """A camera or a light at `place` that is turned to `target`."""
    obj = bpy.data.objects.new(name, data)
    obj.location = place
    obj.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(obj)
    return obj


def lamp(kind: str, name: str, energy: float, color: Color, place: Sequence[float], target: Sequence[float] = (0.0, 0.0, 0.0)) -> bpy.types.Light:
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color = energy, color
    aimed(name, data, place, target)
    return data


def furniture(wood: bpy.types.Material, stone: bpy.types.Material, brass: bpy.types.Material) -> None:
    """A fountain, a bench, a table with a bowl, and steps."""
    lathe("Basin", [(1.0, 0.0), (1.1, 0.08), (1.1, 0.4), (1.15, 0.45), (1.0, 0.45), (0.95, 0.2)], (1.4, 0.6, 0.0), stone, 64)
    lathe("Column", [(0.22, 0.15), (0.14, 0.3), (0.11, 0.9), (0.16, 1.0), (0.42, 1.12), (0.45, 1.18), (0.2, 1.12)], (1.4, 0.6, 0.0), stone)
    for number, x in enumerate((-0.75, 0.75)):
        box(f"Leg {number}", (0.1, 0.45, 0.42), (-3.1 + x, 1.7, 0.0), wood, 0.02)
    box("Seat", (1.9, 0.5, 0.08), (-3.1, 1.7, 0.42), wood, 0.02)
    lathe("Table", [(0.3, 0.0), (0.06, 0.06), (0.05, 0.66), (0.5, 0.7), (0.5, 0.74)], (-3.2, 0.1, 0.0), stone)
    lathe("Bowl", [(0.06, 0.0), (0.16, 0.05), (0.24, 0.15), (0.22, 0.15), (0.14, 0.07)], (-3.2, 0.1, 0.74), brass)
    for step in range(3):
        box(f"Step {step}", (2.2, 0.35, 0.14 * (step + 1)), (3.6, 1.8 + 0.35 * step, 0.0), stone, 0.015)


def courtyard() -> None:
    """Builds the scene into an empty file."""
    plaster, wood = material("Plaster", (0.78, 0.62, 0.48), 0.9), material("Wood", (0.30, 0.16, 0.08), 0.6)
    stone, brass = material("Stone", (0.62, 0.60, 0.56), 0.7), material("Brass", (0.90, 0.62, 0.25), 0.35, 1.0)
    clay, leaf = material("Clay", (0.55, 0.22, 0.12), 0.8), material("Leaf", (0.10, 0.28, 0.07), 0.5)
    floor(tiles())
    wall_with_arches(plaster)
    box("Back wall", (12.0, 0.2, 4.2), (0.0, 5.9, 0.0), plaster)
    box("Side wall", (0.3, 12.0, 3.4), (6.0, 0.0, 0.0), plaster)
    pergola(wood)
    furniture(wood, stone, brass)
    plants = plant(clay, leaf)
    for place, scale, turn in (
        ((4.9, 0.4, 0.0), 1.2, 0.3),
        ((4.8, -1.3, 0.0), 0.9, 2.1),
        ((-1.75, 2.55, 0.0), 1.0, 4.0),
        ((0.2, -1.7, 0.0), 0.7, 1.2),
    ):
        place_instance(plants, place, scale, turn)
    surroundings()


def surroundings() -> None:
    """The sun, lanterns in the arcade, the sky, and the camera."""
    lamp("SUN", "Sun", 5.0, (1.0, 0.78, 0.55), (-6.0, -4.5, 4.4)).angle = math.radians(1.5)
    for number, x in enumerate((-3.6, 0.0, 3.6)):
        lantern = lamp("POINT", f"Lantern {number}", 30.0, (1.0, 0.6, 0.28), (x, 4.6, 2.6))
        lantern.shadow_soft_size = 0.15
    bpy.context.scene.world = sky = bpy.data.worlds.new("Sky")
    if bpy.app.version < (5, 0, 0):
        sky.use_nodes = True
    background = next(node for node in sky.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.20, 0.38, 0.80, 1.0)
    background.inputs["Strength"].default_value = 0.3
    view = bpy.data.cameras.new("Camera")
    view.lens = 28.0
    bpy.context.scene.camera = aimed("Camera", view, (-0.9, -7.6, 2.5), (0.1, 1.0, 1.3))


def main(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(description="Makes a demo file for Lightmesh in Blender.")
    parser.add_argument("blend", type=Path, help="the .blend file to write")
    parser.add_argument("--render", type=Path, help="a picture to render")
    parser.add_argument("--percentage", type=int, default=100, help="its size, per cent")
    chosen = parser.parse_args(arguments)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    import lightmesh_addon

    lightmesh_addon.register()
    try:
        courtyard()
        scene = bpy.context.scene
        scene.render.engine = "LIGHTMESH"
        bpy.ops.wm.save_as_mainfile(filepath=str(chosen.blend.resolve()))
        if chosen.render:
            scene.render.resolution_percentage = chosen.percentage
            scene.render.filepath = str(chosen.render.resolve())
            bpy.ops.render.render(write_still=True)
    finally:
        lightmesh_addon.unregister()


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
