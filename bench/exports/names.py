#!/usr/bin/env python3
"""Counts the named nodes of scenes and of their exports, and fails if an export has fewer.

    python3 bench/exports/names.py target/release/lightmesh [FOLDER]

FOLDER is that of the shared scenes unless another is given; all of its models are exported. Named nodes of a glTF file are those that its scene
shows; of an OBJ file the objects that have faces, or the groups if it has no objects; a PLY or STL file is one. Exports are glTF. A node may have
got another name: that of its camera or light. Those of the source that are not found again are listed.
"""

import json
import re
import struct
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "scenes"
FORMATS = (".glb", ".gltf", ".obj", ".ply", ".stl", ".toml")


def document(path: Path) -> dict:
    """The JSON of a glTF or GLB file."""
    data = path.read_bytes()
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        data = data[20 : 20 + length]
    return json.loads(data)


def of_gltf(path: Path) -> Counter:
    """How often each name is that of a node of the scene."""
    found = document(path)
    nodes, scenes = found.get("nodes", []), found.get("scenes", [])
    children = {child for node in nodes for child in node.get("children", [])}
    left = list(scenes[found.get("scene", 0)].get("nodes", [])) if scenes else [at for at in range(len(nodes)) if at not in children]
    names: Counter = Counter()
    while left:
        node = nodes[left.pop()]
        left.extend(node.get("children", []))
        names.update([node["name"]] if node.get("name") else [])
    return names


def of_obj(path: Path) -> Counter:
    """The objects that have faces; without any, the groups, and without these the file."""
    lines = [line.split(None, 1) for line in path.read_text(errors="replace").splitlines() if re.match(r"(o|g|f)\b", line)]
    for kind in ("o", "g"):
        names, current = set(), None
        for line in lines:
            if line[0] == kind:
                current = line[1].strip() if len(line) > 1 else None
            elif line[0] == "f" and current:
                names.add(current)
        if names:
            return Counter(names)
    return Counter([path.stem])


def of_source(path: Path) -> Counter | None:
    """`None` if it is text of our own, whose names are in other files."""
    kind = path.suffix.lower()
    if kind in (".gltf", ".glb"):
        return of_gltf(path)
    return {".obj": of_obj, ".toml": lambda _: None}.get(kind, lambda path: Counter([path.stem]))(path)


def main() -> int:
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    program, folder = sys.argv[1], Path(sys.argv[2]) if len(sys.argv) == 3 else SHARED
    sources = sorted(path for path in folder.rglob("*") if path.suffix.lower() in FORMATS)
    if not sources:
        sys.exit(f"{folder}: no models; name a folder that has some")
    print("| scene | named in the source | in the export | not found again |\n|---|--:|--:|---|")
    fewer = 0
    for source in sources:
        names = of_source(source)
        if names is None:
            continue
        with tempfile.TemporaryDirectory() as folder_of_export:
            export = Path(folder_of_export) / "export.glb"
            done = subprocess.run([program, "export", source, "-o", export, "-q"], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{source}: {done.stderr.strip()}")
            exported = of_gltf(export)
        fewer += exported.total() < names.total()
        missing = ", ".join(f"{name} ({count})" if count > 1 else name for name, count in sorted((names - exported).items()))
        print(f"| {source.relative_to(folder)} | {names.total()} | {exported.total()} | {missing} |")
    return 1 if fewer else 0


if __name__ == "__main__":
    sys.exit(main())
