"""Makes walker.glb, a tube that three bones bend and a shape key widens while it walks, and walker.json, where Blender has its vertices
after it has read the file: pip install bpy; python walker.py"""

import json
import math

import bpy
from mathutils import Quaternion

RINGS, SIDES, RATE = 8, 6, 24
TIMES = [0.0, 0.3, 0.75, 1.3, 2.0]


def tube():
    angles = [2 * math.pi * side / SIDES for side in range(SIDES)]
    corners = [(0.3 * math.cos(a), 0.3 * math.sin(a), 0.5 * ring) for ring in range(RINGS) for a in angles]
    following = [(side, (side + 1) % SIDES) for side in range(SIDES)]
    faces = [
        (ring * SIDES + a, ring * SIDES + b, (ring + 1) * SIDES + b, (ring + 1) * SIDES + a)
        for ring in range(RINGS - 1)
        for a, b in following
    ]
    mesh = bpy.data.meshes.new("tube")
    mesh.from_pydata(corners, [], faces)
    thing = bpy.data.objects.new("tube", mesh)
    bpy.context.scene.collection.objects.link(thing)
    thing.shape_key_add(name="Basis")
    wide = thing.shape_key_add(name="wide")
    for vertex, (x, y, z) in enumerate(corners):
        wide.data[vertex].co = (1.6 * x, 1.6 * y, z)
    for frame, value in [(0, 0.0), (20, 1.0), (48, 0.3)]:
        wide.value = value
        wide.keyframe_insert("value", frame=frame)
    return thing, corners


def bones(thing, corners):
    skeleton = bpy.data.objects.new("bones", bpy.data.armatures.new("bones"))
    bpy.context.scene.collection.objects.link(skeleton)
    bpy.context.view_layer.objects.active = skeleton
    bpy.ops.object.mode_set(mode="EDIT")
    parent = None
    for number, (head, tail) in enumerate([(0, 1.2), (1.2, 2.4), (2.4, 3.5)]):
        bone = skeleton.data.edit_bones.new(f"b{number}")
        bone.head, bone.tail = (0, 0, head), (0, 0, tail)
        if parent:
            bone.parent, bone.use_connect = parent, True
        parent = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    for number, middle in enumerate([0.6, 1.8, 2.95]):
        group = thing.vertex_groups.new(name=f"b{number}")
        for vertex, (_, _, z) in enumerate(corners):
            weight = 1 - abs(z - middle) / 1.3
            if weight > 0:
                group.add([vertex], weight, "REPLACE")
    thing.parent = skeleton
    thing.modifiers.new("bones", "ARMATURE").object = skeleton
    for name, axis, keys in [
        ("b1", (1, 0, 0), [(0, 0), (16, 0.7), (48, -0.4)]),
        ("b2", (0, 0, 1), [(0, 0), (30, 1.1), (48, 0.2)]),
    ]:
        bone = skeleton.pose.bones[name]
        bone.rotation_mode = "QUATERNION"
        for frame, angle in keys:
            bone.rotation_quaternion = Quaternion(axis, angle)
            bone.keyframe_insert("rotation_quaternion", frame=frame)
    for frame, x in [(0, 0.0), (24, 1.5), (48, 1.0)]:
        skeleton.location = (x, 0, 0.2 * x)
        skeleton.keyframe_insert("location", frame=frame)


def begin():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = RATE, 0, 48
    return scene


def vertices(scene, time):
    """Where all vertices are, with Y up as in glTF, each place once."""
    frame = time * RATE
    scene.frame_set(int(frame), subframe=frame - int(frame))
    graph = bpy.context.evaluated_depsgraph_get()
    places = set()
    for thing in scene.objects:
        if thing.type == "MESH" and thing.name.startswith("tube"):
            moved = thing.evaluated_get(graph)
            for vertex in moved.to_mesh().vertices:
                x, y, z = moved.matrix_world @ vertex.co
                places.add((round(x, 4), round(z, 4), round(-y, 4)))
    return sorted(places)


begin()
bones(*tube())
bpy.ops.export_scene.gltf(
    filepath="walker.glb",
    export_animation_mode="SCENE",
    export_optimize_animation_size=False,
    export_texcoords=False,
    export_materials="NONE",
)
scene = begin()
bpy.ops.import_scene.gltf(filepath="walker.glb")
# The import leaves what moves the shape key in a track that is not heard.
action = bpy.data.actions["tube"]
for keys in bpy.data.shape_keys:
    keys.animation_data.action = action
    keys.animation_data.action_slot = action.slots[0]
with open("walker.json", "w") as file:
    json.dump({str(time): vertices(scene, time) for time in TIMES}, file, separators=(",", ":"))
