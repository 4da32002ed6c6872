"""Run by `sky.py` in a Blender of its own: renders a Sky Texture to a panorama. The last two arguments are settings (JSON) and result (NumPy)."""

import json
import sys
from pathlib import Path

import bpy
import numpy as np

#: Samples of a pixel: so finely the sun is told from the sky around it.
SAMPLES = 16


def main(asked: Path, made: Path) -> None:
    wish = json.loads(asked.read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = _world(wish["node"])
    data = bpy.data.cameras.new("Camera")
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIRECTANGULAR"
    scene.camera = bpy.data.objects.new("Camera", data)
    # To +Y, with +Z above.
    scene.camera.rotation_euler = (0.5 * np.pi, 0.0, 0.0)
    scene.collection.objects.link(scene.camera)
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = wish["size"]
    render.resolution_percentage = 100
    cycles.device, cycles.samples, cycles.max_bounces, cycles.pixel_filter_type = "CPU", SAMPLES, 0, "BOX"
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    if hasattr(render.image_settings, "media_type"):  # Since 5.0.
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = str(made.with_suffix(".exr"))
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(render.filepath)
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    np.save(made, np.ascontiguousarray(pixels.reshape(height, width, -1)[::-1, :, :3]))


def _world(settings: dict) -> bpy.types.World:
    made = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node, background, output = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexSky", "Background", "OutputWorld"))
    # First the kind, which says what the others mean.
    node.sky_type = settings.pop("sky_type")
    for name, value in settings.items():
        setattr(node, name, value)
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    return made


main(*map(Path, sys.argv[-2:]))
