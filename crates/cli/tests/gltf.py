#!/usr/bin/env python3
"""Exports scenes as GLB and lets the glTF validator of Khronos read the files.

    python3 crates/cli/tests/gltf.py target/debug/lightmesh --validator target/gltf-validator

Scenes are the built-in ones, a file with everything that a scene file can say, and the models in `../shared/scenes` if they are there: those
of more than 4 MiB only with LIGHTMESH_TESTS=all. It needs Node, and `npm ci` in a folder with the files of `crates/cli/tests/gltf/`, which is the
validator's; `.ci/run` does that. An error or an unexpected warning fails.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
SHARED = FOLDER.parents[2].parent / "shared" / "scenes"
BUILT_IN = ["builtin:gazebo", "builtin:childpark", "builtin:garden", "builtin:garden?lights=3"]
FORMATS = {".toml", ".obj", ".gltf", ".glb", ".ply", ".stl"}
LARGE = 4 << 20

# What glTF has no words for, or rules about.
EVERYTHING = """
[ambient]
intensity = [0.1, 0.1, 0.1]
background = [0.25, 0.5, 0.75]

[[camera]]
name = "wide"
position = [1, 2, 4]
target = [0, 0.3, 0]
hfov = 80
shift = [0.1, 0.3]

[[camera]]
position = [1, 9, 4]
target = [0, 0.3, 0]
projection = "orthographic"
height = 5

[[light]]
kind = "point"
position = [2, 3, 1]
intensity = [0.1, 0.3, 0.5]
spread = 0.2

[[light]]
kind = "directional"
direction = [1, -3, 1]
intensity = [0.1, 0.3, 0.5]
angle = 0.5

[[light]]
kind = "spot"
position = [2, 3, 1]
direction = [0, -1, 0]
inner = 30
outer = 30
intensity = [0.1, 0.3, 0.5]

[[light]]
kind = "spot"
position = [2, 3, 1]
direction = [0, -1, 0]
inner = 0
outer = 90
intensity = [10, 30, 50]
falloff = "inverse-square"

[[light]]
kind = "sphere"
position = [2, 3, 1]
radius = 0.2
intensity = [60, 40, 20]
falloff = "inverse-square"

[[light]]
kind = "disk"
position = [2, 3, 1]
normal = [0, -1, 0.3]
radius = 0.2

[[light]]
kind = "rectangle"
position = [2, 3, 1]
u = [1, 0, 0]
v = [0, 0, 2]
one_sided = false

[[material]]
name = "shiny"
kd = [0.2, 0.3, 1.0]
ks = [0.3, 0.3, 0.3]
shininess = 50

[[material]]
name = "lamp"
kd = [0, 0, 0]
emission = [20, 10, 0.5]

[[material]]
name = "leaf"
kd = [1, 1, 1]
opacity_texture = "leaf.png"

[[material]]
name = "glass"
ior = 1.5

[[box]]
name = "box"
min = [0, 0, 0]
max = [1, 1, 1]
material = "shiny"

[[sphere]]
name = "ball"
center = [2, 0.5, 0]
radius = 0.5
material = "glass"

[[plane]]
name = "leaf"
point = [0, 1.5, 0]
normal = [0, 1, 0]
size = [1, 1]
material = "leaf"

[[box]]
min = [-1, 2, 0]
max = [-0.8, 2.2, 0.2]
material = "lamp"

[[mesh]]
file = "tri.obj"
name = "one"

[[mesh]]
file = "tri.obj"
name = "other"
translate = [0, 0, 1]
rotate = [0, 30, 45]
scale = [1, -2, 0.5]
"""
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"


def scenes(folder):
    """Names and files of all scenes; what is generated is written to a folder."""
    yield from ((name.replace(":", "_").replace("?", "_"), name) for name in BUILT_IN)
    (folder / "tri.obj").write_text(TRIANGLE)
    (folder / "leaf.png").write_bytes(leaf())
    (folder / "everything.toml").write_text(EVERYTHING)
    yield "everything", folder / "everything.toml"
    (folder / "forest.gltf").write_text(forest())
    yield "forest", folder / "forest.gltf"
    if not SHARED.is_dir():
        print(f"{SHARED} is missing: only built-in scenes", file=sys.stderr)
        return
    for path in sorted(SHARED.rglob("*")):
        if path.suffix.lower() not in FORMATS:
            continue
        if path.stat().st_size > LARGE and os.environ.get("LIGHTMESH_TESTS") != "all":
            print(f"{path.name} is large: only with LIGHTMESH_TESTS=all", file=sys.stderr)
            continue
        yield "_".join(path.relative_to(SHARED).parts).replace(".", "_"), path


def leaf():
    """A grey image of two texels."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(b"\0\0\xff")) + chunk(b"IEND", b"")


def forest():
    """A triangle in very many places, and in two that a parent shears."""
    import base64
    import json
    import struct

    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    turned = {"name": "turned", "mesh": 0, "rotation": [0, 0, 0.38268343, 0.92387953]}
    nodes = [{"name": "tree", "mesh": 0, "translation": [i % 40, 0, i // 40], "scale": [1, 2, 1]} for i in range(1500)]
    nodes += [turned, {"name": "tree", "mesh": 0, "scale": [-1, 1, 1]}, {"name": "wide", "scale": [3, 1, 1], "children": [1500]}]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [i for i in range(len(nodes)) if i != 1500]}],
        "nodes": nodes, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    })


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--validator", type=Path, required=True, help="the folder in which npm has installed it")
    parser.add_argument("--keep", type=Path, help="write the files here, and leave them")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        files = []
        for name, scene in scenes(folder):
            file = folder / f"{name}.glb"
            command = [options.program, "export", scene, "-o", file, "--quiet"]
            subprocess.run(list(map(str, command)), check=True, stderr=subprocess.DEVNULL)
            # The scene of TOML files has its triangles beside it: a file of other content.
            if name in ("everything", "builtin_gazebo"):
                command[-2] = folder / f"{name}_copy.toml"
                subprocess.run(list(map(str, command)), check=True, stderr=subprocess.DEVNULL)
                files.append(folder / f"{name}_copy.mesh.glb")
            files.append(file)
        script = options.validator / "validate.mjs"
        sys.exit(subprocess.run(["node", script, *files], check=False).returncode)


if __name__ == "__main__":
    main()
