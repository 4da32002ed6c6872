"""Random scenes in all formats that the program reads: tame ones, those that are hard on acceleration structures, and damaged ones."""

from __future__ import annotations

import base64
import json
import math
import random
import struct
from collections.abc import Sequence
from pathlib import Path

BUILT_IN = ["builtin:gazebo", "builtin:childpark", "builtin:garden"]
Triangles = list[list[list[float]]]
NAMES = ["oak", "", "with blank", "\x1b]0;x\x07", "\u202egnp", "a" * 300, "../x", "/etc/passwd", "é"]
BROKEN = ["nan", "inf", "1e39", "-1", "0", '"one"', "[]", "[1, 2]", "true", "9223372036854775808"]
"""Values of keys in scene files that may be refused."""


def any_scene(folder: Path, dice: random.Random, others: Sequence[Path]) -> str:
    """The name of a scene: a built-in one, one of `others`, or one that is written into `folder`, some damaged."""
    choice = dice.random()
    if choice < 0.15:
        return dice.choice(BUILT_IN)
    if choice < 0.35 and others:
        return str(dice.choice(others))
    triangles = make_triangles(dice)
    texts = {
        "obj": obj_text(triangles, dice),
        "mtl": mtl_text(dice),
        "ply": ply_text(triangles),
        "stl": stl_text(triangles),
        "gltf": gltf_text(triangles, dice),
        "toml": toml_text(dice, broken=dice.random() < 0.3),
    }
    for ending, text in texts.items():
        data = text.encode()
        (folder / f"scene.{ending}").write_bytes(damaged(data, dice) if dice.random() < 0.1 else data)
    return "scene." + dice.choice(["obj", "toml", "toml", "toml", "ply", "stl", "gltf"])


def good_scene(folder: Path, dice: random.Random) -> str:
    """The name of a scene that opens, and that moves if it is written into `folder`."""
    if dice.random() < 0.3:
        return dice.choice(BUILT_IN[:2])
    (folder / "scene.ply").write_text(ply_text(boxes(dice, 8)))
    (folder / "scene.toml").write_text(toml_text(dice, broken=False, moves=True))
    return "scene.toml"


# ---- Triangles ----


def make_triangles(dice: random.Random) -> Triangles:
    """Corners of boxes, or of families that are hard on acceleration structures, at any scale."""
    if dice.random() < 0.5:
        return boxes(dice, dice.choice([1, 5, 40]))
    count, scale = dice.choice([0, 1, 12, 300, 300, 3000]), 10 ** dice.uniform(-3, 3)
    shape = dice.choice(["soup", "strip", "coincident", "nested", "flat", "far", "odd"])
    triangles = []
    for i in range(count):
        size = 1 + i if shape == "nested" else 0.2
        middle = [0.0] * 3 if shape in ("coincident", "nested") else [dice.gauss(0, 1) for _ in range(3)]
        x, y, z = [float(i), 0, 0] if shape == "strip" else middle
        corners = [[x, y, z], [x + size, y, z], [x, y + size, z + 0.1]]
        if shape == "flat":
            corners = [[x, y, 0.0] for x, y, _ in corners]
        if shape == "far":
            corners = [[x + 1e7 * (i % 2), y, z] for x, y, z in corners]
        if shape == "odd":
            corners[dice.randrange(3)] = [dice.choice([0, 1e38, -1e-40, math.nan, math.inf]) for _ in range(3)]
        triangles.append([[scale * value for value in corner] for corner in corners])
    return triangles


def boxes(dice: random.Random, count: int) -> Triangles:
    triangles = []
    for _ in range(count):
        low = [dice.uniform(-2, 2), dice.uniform(0, 1), dice.uniform(-2, 2)]
        size = [dice.uniform(0.1, 1) for _ in range(3)]
        corners = [[low[axis] + size[axis] * (i >> axis & 1) for axis in range(3)] for i in range(8)]
        for a, b, c, d in [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]:
            triangles += [[corners[a], corners[b], corners[c]], [corners[a], corners[c], corners[d]]]
    return triangles


# ---- Formats ----


def obj_text(triangles: Triangles, dice: random.Random) -> str:
    lines = ["mtllib scene.mtl", f"usemtl {dice.choice(NAMES)}"]
    for triangle in triangles:
        lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in triangle] + ["f -3 -2 -1"]
    return "\n".join(lines) + "\n"


def mtl_text(dice: random.Random) -> str:
    lines = []
    for _ in range(dice.randrange(4)):
        a, b, c = (dice.choice(["0", "0.5", "1", "1", "7", "1.0f"]) for _ in range(3))
        lines += [f"newmtl {dice.choice(NAMES)}", f"Kd {a} {b} {c}", f"Ks {b} {c} {a}", f"d {dice.choice(['1', '1', '0.3', '-1'])}"]
        lines += [f"map_Kd {dice.choice([*NAMES, 'none.png', 'scene.ply'])}"] * dice.randrange(2)
    return "\n".join(lines) + "\n"


def ply_text(triangles: Triangles) -> str:
    header = f"ply\nformat ascii 1.0\nelement vertex {3 * len(triangles)}\nproperty float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    corners = "".join(f"{x:g} {y:g} {z:g}\n" for triangle in triangles for x, y, z in triangle)
    return header + corners + "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(triangles)))


def stl_text(triangles: Triangles) -> str:
    facets = []
    for triangle in triangles:
        corners = "".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in triangle)
        facets.append(f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
    return "solid s\n" + "".join(facets) + "endsolid s\n"


def gltf_text(triangles: Triangles, dice: random.Random) -> str:
    """A mesh in several places, some of which move, with lights of all kinds that glTF has."""
    values = [value for triangle in triangles for corner in triangle for value in corner]
    data = struct.pack(f"<{len(values)}f", *(value if abs(value) < 3e38 else math.copysign(math.inf, value) for value in values))
    times = struct.pack("<2f9f", 0, 1, *range(9))
    places = range(dice.randrange(1, 5))
    nodes: list[dict[str, object]] = [{"mesh": 0, "translation": [3 * i, 0, 0], "scale": [dice.choice([1, 1, -1, 0.2, 0])] * 3} for i in places]
    nodes += [{"extensions": {"KHR_lights_punctual": {"light": i}}, "translation": [1, 4, i]} for i in range(3)]
    nodes += [{"camera": 0, "translation": [0, 1, 8]}] if dice.random() < 0.7 else []
    kinds = ["point", "spot", "directional"]
    lights: list[dict[str, object]] = [{"type": kind, "intensity": dice.choice([0, 1, 100, 1e30]), "spot": {}} for kind in kinds]
    metal = {"metallicFactor": dice.choice([0, 1]), "roughnessFactor": dice.random()}
    material = {"pbrMetallicRoughness": metal, "emissiveFactor": [dice.choice([0, 0, 1])] * 3}
    uri = "data:application/octet-stream;base64,"
    scene: dict[str, object] = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": dice.choice([0.7, 0.7, 0.7, 0, 4]), "znear": 0.1}}],
        "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": dice.choice([0, 0, 0, 5])}]}],
        "buffers": [{"byteLength": len(part), "uri": uri + base64.b64encode(part).decode()} for part in (data, times)],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}, {"buffer": 1, "byteLength": 8}, {"buffer": 1, "byteOffset": 8, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(values) // 3, "min": [-9] * 3, "max": [9] * 3},
            {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 2},
        ],
    }
    if dice.random() < 0.4:
        channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
        scene["animations"] = [{"name": "walk", "channels": [channel], "samplers": [{"input": 1, "output": 2}]}]
    return json.dumps(scene)


def toml_text(dice: random.Random, *, broken: bool, moves: bool = False) -> str:
    """A scene with solids, panes, mirrors, lamps and lights of all kinds; `broken` ones have values and files that may be refused."""

    def number(low: float, high: float) -> str:
        return dice.choice(BROKEN) if broken and dice.random() < 0.03 else f"{dice.uniform(low, high):.3f}"

    def vector(low: float, high: float) -> str:
        return f"[{number(low, high)}, {number(low, high)}, {number(low, high)}]"

    def motion() -> str:
        if not (moves or dice.random() < 0.1):
            return ""
        return f"motion = {{ key = [{{ time = 0, translate = [0, 0, 0] }}, {{ time = 0.2, translate = {vector(-1, 1)} }}] }}\n"

    text = "[camera]\nposition = [0, 2, 6]\ntarget = [0, 0.5, 0]\n" if moves or dice.random() < 0.8 else ""
    text += f"[sky]\nkind = \"clear\"\nsun = [{number(5, 80)}, {number(0, 360)}]\n" if dice.random() < 0.2 else ""
    materials = {
        "matt": "kd = [0.6, 0.5, 0.4]",
        "pane": "ior = 1.5\nthin = true",
        "glass": f"ior = {number(1.1, 2)}\nabsorption = {vector(0, 2)}",
        "foil": f"opacity = {number(0, 1)}\nfilter = [1, 0.5, 0.5]",
        "metal": f"metallic = 1\nroughness = {number(0, 1)}",
        "lamp": f"emission = {vector(0, 9)}",
    }
    for name, keys in materials.items():
        text += f'[[material]]\nname = "{name}"\n{keys}\n'

    def material() -> str:
        return f'material = "{dice.choice(["matt", *materials])}"\n'

    text += "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [12, 12]\n" + 'material = "matt"\n'
    for _ in range(dice.randrange(4)):
        text += f"[[box]]\ncenter = {vector(-2, 2)}\nsize = {vector(0.1, 1.5)}\n{material()}{motion()}"
    for _ in range(dice.randrange(3)):
        text += f"[[sphere]]\ncenter = {vector(-2, 2)}\nradius = {number(0.1, 1)}\n{material()}{motion()}"
    for _ in range(dice.randrange(2)):
        text += f"[[cylinder]]\nbase = {vector(-2, 2)}\ntop = {vector(-2, 2)}\nradius = {number(0.1, 1)}\n{material()}"
    lights = [
        f'kind = "point"\nposition = {vector(1, 5)}',
        f'kind = "sphere"\nposition = {vector(1, 5)}\nradius = {number(0.1, 1)}',
        f'kind = "disk"\nposition = {vector(2, 5)}\nnormal = [0, -1, 0]\nradius = {number(0.1, 1)}',
        f'kind = "rectangle"\nposition = {vector(2, 5)}\ndirection = [0, -1, 0]\nsize = [1, {number(0.1, 2)}]\nvisible = true',
        f'kind = "spot"\nposition = {vector(2, 5)}\ntarget = [0, 0, 0]\nouter = {number(10, 80)}',
        f'kind = "directional"\ndirection = [0.3, -1, 0.2]\nangle = {number(0, 20)}',
    ]
    for light in dice.sample(lights, dice.randrange(4)):
        text += f"[[light]]\n{light}\nintensity = {number(0.2, 1)}\n"
    files = ["scene.ply"] if moves else ["scene.obj", "scene.ply", "scene.stl", "scene.gltf"]
    files += ["none.obj", "../scene.obj", "scene.toml"] if broken else []
    file = dice.choice(files)
    for _ in range(dice.choice([0, 1, 1, 4])):
        text += f'[[mesh]]\nfile = "{file}"\ntranslate = {vector(-3, 3)}\nscale = {number(0.2, 1)}\n{motion()}'
    return text


def damaged(text: bytes, dice: random.Random) -> bytes:
    """The text with a few bytes changed, cut or repeated."""
    data = bytearray(text)
    for _ in range(dice.randrange(1, 5)):
        at = dice.randrange(len(data) + 1)
        change = dice.randrange(4)
        if change == 0:
            del data[at:]
        elif change == 1:
            data[at : at + dice.randrange(20)] = b""
        elif change == 2:
            data[at:at] = bytes(dice.randrange(256) for _ in range(dice.randrange(1, 6)))
        else:
            data[at:at] = dice.choice([b"9999999999", b"-1", b"\n", b"[[", b"nan ", b"\x1b[31m", b"1e400 "])
    return bytes(data)
