#!/usr/bin/env python3
"""Exports scenes as GLB, renders the files with Blender's Cycles, and prints how far its images are from those of the sources.

    python3 bench/exports/by_cycles.py target/release/lightmesh -o target/exports [SCENE…]

It needs the wheels of `.ci/blender-4.5.txt` (Python 3.11). Without names, all scenes in `SCENES` are rendered. Both programs show direct light
only, since that is what the files say: no ambient light, no light from one surface to another. In the folder of `-o`, `NAME.png` has ours at
the left, that of Cycles in the middle, and the FLIP error at the right; `exports.json` has the figures.

Cones fade within one degree: where Blender lets them fade is its own rule, not that of glTF, which the file follows.

The file is imported with Blender's "unitless" light mode, in which a candela of the file lights what a candela of ours lights.
"""

import argparse
import contextlib
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import bpy
import mathutils
import numpy as np
import OpenEXR

HERE = Path(__file__).resolve().parent
SHARED = HERE.parents[1].parent / "shared" / "scenes"

ROOM = """
[camera]
name = "view"
position = [3.2, 2.6, 5.5]
target = [0, 0.7, 0]
vfov = 40

[[material]]
name = "clay"
kd = [0.7, 0.45, 0.3]
[[material]]
name = "white"
kd = [0.8, 0.8, 0.8]
[[material]]
name = "leaf"
kd = [0.3, 0.7, 0.2]
opacity_texture = "holes.png"
[[material]]
name = "glow"
kd = [0, 0, 0]
emission = [9, 8, 6]

[[plane]]
name = "floor"
point = [0, 0, 0]
normal = [0, 1, 0]
size = [9, 9]
material = "white"
[[box]]
name = "low"
min = [-1.4, 0, -0.6]
max = [-0.4, 0.8, 0.6]
material = "clay"
[[box]]
name = "high"
min = [0.3, 0, -1.2]
max = [0.9, 1.7, -0.5]
material = "white"
[[sphere]]
name = "ball"
center = [0.7, 0.45, 0.6]
radius = 0.45
segments = 96
material = "clay"
"""

POINT = """
[[light]]
kind = "point"
position = [-1.5, 4, 2]
intensity = [60, 55, 45]
falloff = "inverse-square"
"""
SPOT = """
[[light]]
kind = "spot"
position = [-1.5, 4, 2]
target = [0, 0.5, 0]
inner = 24
outer = 25
intensity = [60, 55, 45]
falloff = "inverse-square"
"""
SUN = """
[[light]]
kind = "directional"
direction = [0.6, -1, -0.5]
intensity = [3, 2.8, 2.4]
falloff = "inverse-square"
"""
FLAT = """
[[light]]
kind = "directional"
direction = [0.6, -1, -0.5]
intensity = [0.8, 0.75, 0.7]
[[light]]
kind = "point"
position = [-9, 24, 12]
intensity = [0.2, 0.2, 0.3]
"""
LAMP = """
[[box]]
name = "lamp"
min = [-1.8, 2.6, 0.4]
max = [-1.2, 2.7, 1.4]
material = "glow"
"""
LEAF = """
[[plane]]
name = "leaf"
point = [-0.2, 1.9, 0.8]
normal = [0, 1, 0]
size = [1.5, 1.5]
material = "leaf"
"""

# Text of a scene, or a file or built-in with a camera where it has none: position, target and field of view.
SCENES = {
    "point": ROOM + POINT,
    "spot": ROOM + SPOT,
    "sun": ROOM + SUN,
    "no_falloff": ROOM + FLAT,
    "lamp": ROOM + LAMP,
    "cut_out": ROOM + SUN + LEAF,
    "cornell": (SHARED / "cornell_gltf/cornellBox.gltf", "0,0,19;0,0,0;38"),
    "cubes": (SHARED / "cubes/Cubes.glb", "8,6,10;0,0.5,0;45"),
    "gazebo": ("builtin:gazebo", None),
    "childpark": ("builtin:childpark", None),
}


def png(path, pixels):
    """Writes rows of 8-bit colours."""
    height, width, _ = pixels.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], 1).tobytes()
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def shown(linear):
    """sRGB codes."""
    linear = np.clip(linear, 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(255 * srgb).astype(np.uint8)


def colors(path):
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([channels[name].pixels for name in "RGB"], -1).astype(np.float64)


def holes():
    """A grey image of dark squares on white, as masks of leaves are."""
    y, x = np.mgrid[:64, :64]
    grey = np.where((x // 8 + y // 8) % 2 == 0, 255, 0).astype(np.uint8)
    return np.repeat(grey[..., None], 3, 2)


def cycles(file, camera, size, samples, output):
    """Renders a GLB file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(file), export_import_convert_lighting_mode="COMPAT")
    scene = bpy.context.scene
    if camera:
        place, target, angle = ([float(x) for x in part.split(",")] for part in camera.split(";"))
        turn = mathutils.Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
        place, target = turn @ mathutils.Vector(place), turn @ mathutils.Vector(target)
        lens = bpy.data.cameras.new("view")
        lens.sensor_fit, lens.angle_y, lens.clip_end = "VERTICAL", math.radians(angle[0]), 1e6
        view = bpy.data.objects.new("view", lens)
        view.location, view.rotation_euler = place, (target - place).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(view)
        scene.camera = view
    else:
        # The importer names them after their nodes.
        scene.camera = min((thing for thing in bpy.data.objects if thing.type == "CAMERA"), key=lambda thing: thing.name)
        lens = scene.camera.data
        vertical = lens.angle if lens.sensor_fit == "VERTICAL" else None
        if vertical is None and lens.type == "PERSP":
            # Its own rule for images that are wider than high.
            angle = lens.angle
            lens.sensor_fit = "HORIZONTAL"
            lens.angle_x = angle
    render = scene.render
    render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_adaptive_sampling = "CPU", samples, False
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces, scene.cycles.transparent_max_bounces = 0, 64
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
    scene.cycles.light_sampling_threshold = 0
    render.resolution_x, render.resolution_y, render.resolution_percentage = *size, 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = str(output)
    bpy.ops.render.render(write_still=True)


@contextlib.contextmanager
def silence():
    """Blender prints a line for each step."""
    sys.stdout.flush()
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)


def one(name, options, folder):
    """Renders a scene with both; returns the figures."""
    scene = SCENES[name]
    camera = None
    if isinstance(scene, str):
        png(folder / "holes.png", holes())
        source = folder / f"{name}.toml"
        source.write_text(scene)
    else:
        source, camera = scene
    glb, ours, theirs = folder / f"{name}.glb", folder / f"{name}.ours.exr", folder / f"{name}.cycles.exr"

    def run(*arguments):
        result = subprocess.run([options.program, *map(str, arguments)], capture_output=True, text=True, check=False)
        if result.returncode not in (0, 1):
            sys.exit(result.stderr)
        return result

    width, height = options.size
    exported = run("export", source, "-o", glb)
    flags = ["--camera", camera] if camera else []
    run("render", source, "-o", ours, "--size", f"{width}x{height}", "--ambient", 0, "--background", "0,0,0", "--no-studio",
        "--aa", 16, "--filter", "box", "--samples", 64, "--quiet", *flags)
    with silence():
        cycles(glb, camera, options.size, options.samples, theirs)
    # One exposure for both: what is bright in ours becomes 0.8.
    one, other = colors(ours), colors(theirs)
    factor = 0.8 / np.percentile(one.max(-1), 98)
    images = [shown(image * factor) for image in (one, other)]
    for image, path in zip(images, ("ours.png", "cycles.png")):
        png(folder / path, image)
    figures = json.loads(run("compare", folder / "ours.png", folder / "cycles.png", "--json", "--diff", folder / "diff.exr").stdout)
    difference = shown(colors(folder / "diff.exr"))
    png(options.output / f"{name}.png", np.concatenate([*images, difference], 1))
    lit = one.max(-1) > 0.05 * np.percentile(one.max(-1), 98)
    ratio = float(np.median((other / np.maximum(one, 1e-9))[lit]))
    warnings = [line for line in exported.stderr.splitlines() if "warning" in line]
    return {"flip": figures["mean_flip"], "ratio": ratio, "warnings": warnings}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    parser.add_argument("-o", "--output", type=Path, default=Path("target/exports"))
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(320, 240))
    parser.add_argument("--samples", type=int, default=512)
    options = parser.parse_intermixed_args()
    options.output.mkdir(parents=True, exist_ok=True)
    results = {}
    for name in options.scenes or SCENES:
        if not isinstance(SCENES[name], str) and isinstance(SCENES[name][0], Path) and not SCENES[name][0].exists():
            print(f"{name}: left out, since {SCENES[name][0]} is missing")
            continue
        with tempfile.TemporaryDirectory() as folder:
            results[name] = one(name, options, Path(folder))
        print(f"{name}: FLIP {results[name]['flip']:.4f}, median of Cycles / ours {results[name]['ratio']:.3f}", flush=True)
    (options.output / "exports.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
