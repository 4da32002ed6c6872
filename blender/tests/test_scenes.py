"""Whole scenes against Cycles: Blender's default cube, instances, modifiers."""

import math

import bpy  # isort: skip: bmesh comes with it

import bmesh
import numpy as np
import pytest
from support import agreement, ball, box, camera, collection, cycles, light, lightmesh, link, matt, overlap, plane, stage, world


def test_default_cube() -> None:
    """The file that Blender begins with, without a setting touched."""
    bpy.ops.wm.read_factory_settings()
    agreement("default_cube", lightmesh(), cycles()).check()


def lit() -> None:
    camera((0.0, -9.0, 6.0))
    world()
    light("AREA", 900.0, (3.0, -3.0, 6.0), size=1.0)


def test_collection_instances() -> None:
    """Instances of a collection, one of them mirrored."""
    plane("Floor", 5.0, matt())
    lit()
    parts = bpy.data.collections.new("Parts")
    for obj in (
        box("Post", (0.2, 0.2, 0.8), (0.0, 0.0, 0.8), matt("post", (0.8, 0.3, 0.2))),
        ball("Knob", 0.35, (0.3, 0.0, 1.9), matt("knob", (0.2, 0.4, 0.8))),
    ):
        collection().objects.unlink(obj)
        parts.objects.link(obj)
    for number, place in enumerate([(-2.0, 1.0, 0.0), (0.0, -0.5, 0.0), (2.0, 0.5, 0.0)]):
        instance = link(None, f"Instance {number}", place)
        instance.instance_type, instance.instance_collection = "COLLECTION", parts
        instance.rotation_euler = (0.0, 0.0, 0.7 * number)
        instance.scale = (1.0 if number else -1.0, 1.0, 1.0 + 0.2 * number)
    agreement("instances", lightmesh(), cycles()).check()


def test_instances_on_vertices() -> None:
    """What is instanced on the vertices of another object is stored once."""
    from lightmesh_addon.export.scene import Exporter
    from lightmesh_addon.notes import Notes

    plane("Floor", 5.0, matt())
    lit()
    parent = plane("Parent", 2.0)
    child = ball("Ball", 0.5, (0.0, 0.0, 0.5), matt("child", (0.7, 0.7, 0.2)))
    child.parent, parent.instance_type = parent, "VERTS"
    parent.show_instancer_for_render = parent.show_instancer_for_viewport = False
    agreement("vertex_instances", lightmesh(), cycles()).check()
    exported = Exporter(bpy.context.evaluated_depsgraph_get(), Notes()).run()
    balls = next(made for made in exported.objects() if made.name == "Ball")
    child.data.calc_loop_triangles()
    # The ball itself, and one on each vertex.
    assert balls.triangle_count == 5 * len(child.data.loop_triangles)
    assert balls.vertex_count < 2 * len(child.data.vertices)


def test_modifiers() -> None:
    """Subdivision, an array, bevels, a mirror and a solid shell, as they are in renders."""
    stage()
    light("AREA", 300.0, size=1.0)
    smoothed = bpy.data.objects["Box"].modifiers.new("Subdivision", "SUBSURF")
    smoothed.levels, smoothed.render_levels = 0, 3
    array = bpy.data.objects["Ball"].modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 2, (0.0, 1.1, 0.0)
    sheet = plane("Sheet", 0.6, matt(), (-2.2, -1.0, 0.6))
    sheet.rotation_euler = (0.5, 0.3, 0.0)
    sheet.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.2
    bevel = sheet.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.05, 3
    hidden = sheet.modifiers.new("Hidden", "ARRAY")
    hidden.show_render = False
    agreement("modifiers", lightmesh(), cycles()).check()


def test_sharp_and_smooth_normals() -> None:
    """Corners of a smooth mesh that are marked sharp have normals of their own."""
    stage()
    light("SUN", 3.0, angle=0.1)
    data = bpy.data.objects["Box"].data
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    mesh = bmesh.new()
    mesh.from_mesh(data)
    for index, edge in enumerate(mesh.edges):
        edge.smooth = index % 2 == 0
    mesh.to_mesh(data)
    mesh.free()
    agreement("sharp_edges", lightmesh(), cycles()).check()


def test_curves_and_texts() -> None:
    """What has faces only once it is evaluated."""
    plane("Floor", 4.0, matt())
    lit()
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "Ab", 0.2, 2.0
    text.materials.append(matt("text"))
    link(text, "Text", (-1.0, 0.0, 0.3)).rotation_euler = (math.radians(60.0), 0.0, 0.3)
    agreement("text", lightmesh(), cycles()).check()


def test_hidden_objects() -> None:
    """Only what is shown in renders is rendered."""
    stage()
    light("SUN", 3.0)
    bpy.data.objects["Box"].hide_render = True
    bpy.data.objects["Ball"].hide_viewport = True
    agreement("hidden", lightmesh(), cycles()).check()


def test_object_materials() -> None:
    """Materials of slots that belong to the object, and several on one mesh."""
    stage()
    light("SUN", 3.0)
    red, blue = matt("red", (0.8, 0.1, 0.1)), matt("blue", (0.1, 0.2, 0.8))
    first = bpy.data.objects["Box"]
    first.data.materials.append(blue)
    first.data.polygons.foreach_set("material_index", [0, 1, 0, 1, 0, 1])
    second = link(first.data, "Twin", (2.0, 1.5, 0.9))
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = red
    ours, theirs = lightmesh(), cycles()
    agreement("object_materials", ours, theirs).check()
    assert ours.rgb.mean((0, 1)) == pytest.approx(theirs.rgb.mean((0, 1)), rel=0.01)


def test_transparent_film() -> None:
    """What is covered has alpha; colours are premultiplied."""
    stage()
    light("SUN", 3.0)
    bpy.context.scene.world = None
    world((0.3, 0.6, 0.9))
    bpy.context.scene.render.film_transparent = True
    ours, theirs = lightmesh(), cycles(bounces=4)
    assert overlap(ours.alpha > 0.5, theirs.alpha > 0.5) > 0.985
    assert np.abs(ours.alpha - theirs.alpha).mean() < 0.01
    agreement("transparent", ours, theirs).check()


def test_orthographic_default_cube() -> None:
    bpy.ops.wm.read_factory_settings()
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale = "ORTHO", 5.0
    agreement("orthographic_cube", lightmesh(), cycles()).check()
