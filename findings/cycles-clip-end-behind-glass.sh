#!/usr/bin/env bash
# Cycles' Clip End does not cut what is seen through a refraction shader, even one that bends nothing
#
# Expected: a camera's Clip End hides whatever is farther away. A pane in front of it, which lets rays pass straight on, changes nothing of that: so it is
# with a Transparent BSDF.
#
# Happens: the limit belongs to the camera ray and to its straight continuation. A Refraction or Glass BSDF starts a new ray, which has none: a wall
# beyond Clip End is black without a pane and behind a transparent one, and shines behind a pane of refraction with an index of 1.0001. A window
# of such glass shows what the picture around it leaves out.
#
# Versions: bpy 4.5.15 (Blender 4.5 LTS), numpy 1.26.4, Python 3.11.
#
# Why it matters: sections through buildings are cut by clip planes, and their windows show what lies beyond. Who converts a scene for another renderer
# must end only those rays that have not been bent.
#
# Output seen:
#   Blender 4.5.15 LTS: mean of a wall of radiance 1 at 10 m, seen through a pane at 2 m
#   pane         Clip End 100 m   Clip End 9 m
#   none         1.000            0.000
#   transparent  1.000            0.000
#   refraction   0.999            0.999
#   glass        0.966            0.966
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3.11 -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: bpy==4.5.15 numpy==1.26.4
cd "$dir"

venv/bin/python - 3>&1 >/dev/null <<'EOF'
import os
import sys

import bpy
import numpy

PANES = {
    "none": None,
    "transparent": ("ShaderNodeBsdfTransparent", {}),
    "refraction": ("ShaderNodeBsdfRefraction", {"IOR": 1.0001, "Roughness": 0.0}),
    "glass": ("ShaderNodeBsdfGlass", {"IOR": 1.45, "Roughness": 0.0}),
}
# Blender talks on standard output.
told = os.fdopen(3, "w")


def plane(scene, name, z, kind, inputs):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-90, -90, z), (90, -90, z), (90, 90, z), (-90, 90, z)], [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def seen(pane, clip_end):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 256, False, False
    scene.cycles.sample_clamp_indirect = 0.0
    scene.render.resolution_x = scene.render.resolution_y = 16
    data = bpy.data.cameras.new("camera")
    data.clip_start, data.clip_end = 0.1, clip_end
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    plane(scene, "wall", -10.0, "ShaderNodeEmission", {"Strength": 1.0})
    if pane:
        plane(scene, "pane", -2.0, *pane)
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = os.path.abspath("seen.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name = "Non-Color"
    return float(numpy.array(image.pixels[:]).reshape(16, 16, 4)[4:12, 4:12, 0].mean())


print(f"Blender {bpy.app.version_string}: mean of a wall of radiance 1 at 10 m, seen through a pane at 2 m", file=told)
print("pane         Clip End 100 m   Clip End 9 m", file=told)
means = {name: [seen(pane, end) for end in (100.0, 9.0)] for name, pane in PANES.items()}
for name, (far, near) in means.items():
    print(f"{name:12} {far:.3f}            {near:.3f}", file=told)
is_cut = {name: near < 0.1 * far for name, (far, near) in means.items()}
if is_cut != {"none": True, "transparent": True, "refraction": False, "glass": False}:
    sys.exit("changed: other panes show what is beyond Clip End")
EOF
