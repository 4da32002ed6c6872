#!/usr/bin/env python3
"""Peak memory under `--memory-limit`: hostile and heavy scenes, each with a limit, on the CPU.

    cargo build --release && python3 bench/memory/limits.py target/release/lightmesh -o memory-limits.json

Every run must end with its picture or with exit code 3, one line that says what there is not enough memory for, and the flag; and its
peak resident size must stay under the limit, or under the limit of the address space (`ulimit -v`) if that is what the row says. The
scenes are written to a temporary folder: about 1.5 GB, most of it holes.
"""

import argparse
import json
import math
import os
import platform
import resource
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

MIB = 1 << 20
CAMERA = '[camera]\nposition = [3, 4, 5]\ntarget = [0, 0, 0]\n[[light]]\nkind = "sphere"\nposition = [3, 6, 2]\nradius = 0.4\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("-o", "--output", type=Path, help="rows as JSON")
    parser.add_argument("--only", help="scenes whose name contains this")
    plan = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="lightmesh-memory-") as folder:
        scenes = Scenes(Path(folder))
        rows = [measure(plan.program.resolve(), scenes, *case) for case in CASES if not plan.only or plan.only in case[0]]
    bad = [row for row in rows if row["problem"]]
    print(f"{len(rows)} runs, {len(bad)} bad")
    if plan.output:
        results = {"command": "python3 bench/memory/limits.py target/release/lightmesh", "os": platform.system().lower(), "rows": rows}
        plan.output.write_text(json.dumps(results, indent=1) + "\n")
    return bool(bad)


# Scene, flags, limit in MiB, and whether it is that of the address space.
CASES = [
    ("builtin:gazebo", "--size 512x512", 128, False),
    ("builtin:gazebo", "--size 2048x2048 --layers l.exr", 256, False),
    ("builtin:gazebo", "--size 2048x2048 --layers l.exr", 1024, False),
    ("builtin:childpark", "--size 1024x1024", 96, False),
    ("builtin:childpark", "--size 1024x1024 --lookup half-ball --step 0.05", 256, False),
    ("builtin:childpark", "--size 1024x1024 --lookup half-ball --step 0.02", 256, False),
    ("builtin:childpark", "--size 1024x1024 --mode area --samples 16", 128, False),
    ("builtin:garden", "--size 1024x1024 --bounces 2", 128, False),
    ("builtin:garden", "--size 512x512 --grid 500x500x500", 256, False),
    ("builtin:garden", "--size 512x512 --grid 500x500x500", 4096, False),
    ("builtin:gazebo", "--size 60000x60000", 256, False),
    ("builtin:gazebo", "--size 60000x60000", 4096, False),
    ("builtin:gazebo", "--size 16384x16384", 2048, True),
    ("builtin:gazebo?lights=256", "--size 512x512 --samples 4", 128, False),
    ("10000 lights", "--size 64x64 --samples 1", 256, False),
    ("10000 lights", "--size 64x64 --samples 1 --lookup half-ball", 256, False),
    ("10000 lights", "--size 64x64 --mode ray-trace --layers l.exr", 256, False),
    ("png of 8192x8192", "--size 256x256", 128, False),
    ("png of 8192x8192", "--size 256x256", 512, False),
    ("twelve views of one png", "--size 256x256", 768, False),
    ("twelve pngs", "--size 256x256", 768, False),
    ("36 of 3000000000 bytes", "--size 256x256", 96, False),
    ("3000000000 bytes", "--size 256x256", 512, False),
    ("1000 meshes", "--size 256x256", 512, False),
    ("1000 meshes", "--size 256x256", 1536, True),
    ("100 MB of TOML", "--size 256x256", 512, False),
    ("100 MB of TOML", "--size 256x256", 1024, True),
    ("5000000 triangles", "--size 256x256", 512, False),
    ("5000000 triangles", "--size 256x256", 2048, False),
    ("5000000 triangles", "--size 256x256", 2048, True),
    ("5000000 triangles", "--size 256x256 --accel grid", 1024, False),
    ("60 MB of brackets", "--size 256x256", 256, False),
]


def measure(program, scenes, name, flags, limit, of_addresses):
    scene = name if name.startswith("builtin:") else scenes.path(name)
    command = [str(program), "render", str(scene), "--device", "cpu", "-q", "-o", "a.png", *flags.split()]
    if not of_addresses:
        command += ["--memory-limit", f"{limit}MiB"]

    def limited():
        if of_addresses:
            resource.setrlimit(resource.RLIMIT_AS, (limit * MIB, limit * MIB))

    errors = tempfile.TemporaryFile()
    process = subprocess.Popen(command, cwd=scenes.folder, stderr=errors, preexec_fn=limited)
    _, status, usage = os.wait4(process.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    errors.seek(0)
    said = errors.read().decode(errors="replace").strip().splitlines()
    peak = usage.ru_maxrss / 1024
    problem = None
    if code not in (0, 3):
        problem = f"exit code {code}"
    elif code == 3 and not (said and "memory" in said[-1] and "--memory-limit" in said[-1]):
        problem = "the message does not name the flag"
    elif peak > limit:
        problem = "more than the limit"
    message = said[-1] if code and said else ""
    row = {
        "scene": name, "flags": flags, "limit_mib": limit, "limit": "ulimit -v" if of_addresses else "--memory-limit",
        "peak_mib": round(peak, 1), "exit_code": code, "message": message.replace(str(scenes.folder) + "/", ""), "problem": problem,
    }
    print(f"{name:28} {flags:52} {row['limit']:14} {limit:5} {peak:7.1f} {code} {problem or ''} {row['message']}", flush=True)
    return row


class Scenes:
    """Scenes by name, written when they are first asked for."""

    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        stem = "".join(letter if letter.isalnum() else "_" for letter in name)
        known = [path for path in self.folder.glob(f"{stem}.*") if path.suffix in (".toml", ".gltf", ".ply")]
        return known[0] if known else WRITERS[name](self.folder, stem)


def toml(folder, stem, text):
    path = folder / f"{stem}.toml"
    path.write_text(CAMERA + text)
    return path


def many_lights(folder, stem):
    ring = [(5 * math.cos(index), 4 + index % 7, 5 * math.sin(index)) for index in range(10_000)]
    light = '[[light]]\nkind = "sphere"\nradius = 0.1\nintensity = 0.0003\nposition = [{:.4f}, {:.4f}, {:.4f}]\n'
    solids = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [12, 12]\n"
    return toml(folder, stem, solids + "".join(light.format(*place) for place in ring))


def png(side, shade=128):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    pack = zlib.compressobj(9)
    row = b"\0" + bytes([shade]) * side
    data = b"".join(pack.compress(row) for _ in range(side)) + pack.flush()
    head = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def gltf(folder, stem, images=(), same=False, bytes_of_buffer=None, declared=None):
    """A triangle for each image, with texture coordinates; images are views of one buffer."""
    positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    uvs = struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    data, views = positions + uvs, [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}]
    pictures, count = [], 12 if same else len(images)
    for index in range(count):
        if index == 0 or not same:
            offset = len(data)
            data += images[index]
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(data) - offset})
        pictures.append({"bufferView": 2 + index, "mimeType": "image/png"})
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(max(count, 1)))}],
        "nodes": [{"mesh": index, "translation": [index, 0, 0]} for index in range(max(count, 1))],
        "meshes": [{"primitives": [{**primitive, "material": index} if count else primitive]} for index in range(max(count, 1))],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "bufferViews": views, "buffers": [{"uri": f"{stem}.bin", "byteLength": declared or len(data)}],
    }
    if count:
        document["images"] = pictures
        document["textures"] = [{"source": index} for index in range(count)]
        document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}} for index in range(count)]
    with open(folder / f"{stem}.bin", "wb") as file:
        file.write(data)
        if bytes_of_buffer:
            file.truncate(bytes_of_buffer)
    path = folder / f"{stem}.gltf"
    path.write_text(json.dumps(document))
    return path


def ply(folder, stem, side):
    """A hilly square of side × side × 2 triangles."""
    path = folder / f"{stem}.ply"
    with open(path, "wb") as file:
        corners, count = (side + 1) ** 2, 2 * side * side
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {corners}\n".encode())
        file.write(b"property float x\nproperty float y\nproperty float z\n")
        file.write(f"element face {count}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        for z in range(side + 1):
            row = ((x / side - 0.5, 0.05 * math.sin(0.1 * x) * math.sin(0.1 * z), z / side - 0.5) for x in range(side + 1))
            file.write(b"".join(struct.pack("<3f", *point) for point in row))
        for z in range(side):
            first = [z * (side + 1) + x for x in range(side)]
            faces = ((a, a + 1, a + side + 2, a, a + side + 2, a + side + 1) for a in first)
            file.write(b"".join(struct.pack("<B3iB3i", 3, *face[:3], 3, *face[3:]) for face in faces))
    return path


def meshes(folder, stem):
    ply(folder, "hill", 100)
    return toml(folder, stem, "".join(f'[[mesh]]\nfile = "hill.ply"\ntranslate = [{index}, 0, 0]\n' for index in range(1000)))


def much_toml(folder, stem):
    entries = (f'[[material]]\nname = "a material with a name, number {index}"\nkd = [0.5, 0.25, 0.125]\n' for index in range(1_400_000))
    return toml(folder, stem, "".join(entries))


def brackets(folder, stem):
    path = folder / f"{stem}.gltf"
    path.write_text('{"asset": {"version": "2.0"}, "nodes": [' + "{}," * 20_000_000 + "{}]}")
    return path


WRITERS = {
    "10000 lights": many_lights,
    "png of 8192x8192": lambda folder, stem: gltf(folder, stem, [png(8192)]),
    "twelve views of one png": lambda folder, stem: gltf(folder, stem, [png(8192)], same=True),
    "twelve pngs": lambda folder, stem: gltf(folder, stem, [png(8192, shade) for shade in range(12)]),
    "36 of 3000000000 bytes": lambda folder, stem: gltf(folder, stem, bytes_of_buffer=3_000_000_000),
    "3000000000 bytes": lambda folder, stem: gltf(folder, stem, bytes_of_buffer=3_000_000_000, declared=3_000_000_000),
    "1000 meshes": meshes,
    "100 MB of TOML": much_toml,
    "5000000 triangles": lambda folder, stem: ply(folder, stem, 1581),
    "60 MB of brackets": brackets,
}

if __name__ == "__main__":
    sys.exit(main())
