#!/usr/bin/env python3
"""Throws random commands at the program for a while: random scenes, some of them damaged, random flags, random signals.

    cargo build --release && python3 fuzz/soak.py target/release/lightmesh --minutes 20

Whatever happens, it must end in time with one of its own exit codes, say why in one line that names what is wrong, print no control
characters, leave no temporary file, change no input, and each output is there completely or as it was. A failure is printed with its
seed and kept as a folder: `--seed N --runs 1` repeats it.
"""

import argparse
import functools
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129, signal.SIGKILL: -9}
PATIENCE = 120
"""Seconds that any of these small commands may take, on a busy machine as well."""
OLD = b"what was here before"
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")
FAULTS = ["panicked", "a fault in lightmesh", "RUST_BACKTRACE", "stack overflow", "memory allocation"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--seed", type=int, default=0, help="of the first run")
    parser.add_argument("--runs", type=int, default=sys.maxsize)
    plan = parser.parse_args()
    end, seed, failures, codes = time.monotonic() + 60 * plan.minutes, plan.seed, 0, {}
    while time.monotonic() < end and seed < plan.seed + plan.runs:
        folder = Path(tempfile.mkdtemp(prefix="lightmesh-soak-"))
        problems, code, command = run(plan.program.resolve(), folder, random.Random(seed))
        codes[code] = codes.get(code, 0) + 1
        if problems:
            failures += 1
            print(f"seed {seed}, in {folder}: {' '.join(command)}: {'; '.join(problems)}", flush=True)
        else:
            shutil.rmtree(folder)
        seed += 1
    print(f"{seed - plan.seed} runs, {failures} failures; exit codes: {dict(sorted(codes.items(), key=str))}")
    return failures > 0


def run(program, folder, dice):
    """What is wrong with one run, its exit code, and its command."""
    scene = write_scene(folder, dice)
    outputs = {}
    command = [str(program), *arguments(scene, outputs, folder, dice, words_of_flags(program))]
    inputs = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    for path in outputs:
        if path not in inputs and dice.random() < 0.3:
            path.write_bytes(OLD)
    kill = dice.choice(list(SIGNALS)) if dice.random() < 0.4 else None
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    code, out, err = finish(process, kill, dice)
    return list(problems(code, kill, out, err, inputs, outputs, folder)), code, command[1:]


def finish(process, kill, dice):
    try:
        if kill:
            try:
                out, err = process.communicate(timeout=dice.expovariate(1 / 0.15))
                return process.returncode, out, err
            except subprocess.TimeoutExpired:
                process.send_signal(kill)
        out, err = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
        return "too slow", out, err
    return process.returncode, out, err


def problems(code, kill, out, err, inputs, outputs, folder):
    text = err.decode(errors="replace") + out.decode(errors="replace")
    # A signal that comes before the program listens ends it as any other.
    if code not in {0, 2, 3, SIGNALS.get(kill), -kill if kill else 0}:
        yield f"exit code {code}: {err[-300:]!r}"
    if code in {2, 3} and not err.strip():
        yield "no reason is given"
    yield from (f"it says {fault!r}" for fault in FAULTS if fault in text)
    if found := CONTROL.search(text):
        yield f"it prints {found.group()!r}"
    # After SIGKILL the next run removes them.
    if code != -9 and (left := [path.name for path in folder.iterdir() if path.name.startswith(".lightmesh")]):
        yield f"temporary files are left: {left}"
    yield from (f"the input {path.name} is changed" for path, bytes_ in inputs.items() if path.read_bytes() != bytes_)
    for path, is_whole in outputs.items():
        if path in inputs:
            continue
        there = path.exists() and path.read_bytes() != OLD
        if there and not is_whole(path.read_bytes()):
            yield f"{path.name} is not whole"
        if code == 0 and not there:
            yield f"{path.name} is missing"


# ---- Commands ----


@functools.cache
def words_of_flags(program):
    """The words that flags of `render` can be chosen from, by its help."""
    environment = os.environ | {"COLUMNS": "1000"}
    text = subprocess.run([program, "render", "-h"], env=environment, capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^ +(?:-\w, )?(--[a-z-]+) .*\[possible values: ([^\]]*)\]", " ".join(text.split()).replace(" --", "\n --"), re.MULTILINE)
    return {flag: words.split(", ") for flag, words in found}


def arguments(scene, outputs, folder, dice, listed):
    """A command line; its outputs, with a test of each for being complete, are added to `outputs`."""
    some = lambda chance: dice.random() < chance
    subcommand = dice.choices(["render", "info", "export", "grid"], [8, 2, 1, 1])[0]
    words = [subcommand, scene.name]
    if subcommand == "info":
        return words + ["--json"] * some(0.5)

    def output(flag, names):
        name, is_whole = dice.choice(names)
        # Now and then an input.
        path = scene if some(0.03) else folder / name
        outputs[path] = is_whole
        return [flag, path.name]

    if subcommand == "export":
        return words + output("-o", [("out.glb", whole_glb), ("out.toml", anything)])
    if subcommand == "grid":
        return words + output("-o", [("out.grid", bool)])
    words += output("-o", [("out.png", whole_png), ("out.bmp", bool), ("out.exr", whole_exr), ("out.jpg", whole_jpg)])
    if some(0.4):
        words += output("--stats", [("stats.json", whole_json)])
    if some(0.2):
        words += output("--layers", [("layers.exr", whole_exr)])
    words += ["--device", "cpu"]
    # Those that are accepted, and those that may be refused.
    choices = {
        "--size": (["64x48", "200x150", "640x480"], ["1x1", "0x5", "3x", "70000x70000", "1x65535"]),
        # Techniques are those that the program lists.
        "--mode": (listed["--mode"], ["x"]),
        "--lookup": (listed["--lookup"], [""]),
        "--quality": (["draft", "good", "final"], ["GOOD"]),
        "--samples": (["1", "4", "17", "256"], ["0", "-1", "99999999"]),
        "--step": (["auto", "0.5"], ["0", "nan", "1e-30", "1e30"]),
        "--radius": (["2.1", "16"], ["0.1", "inf"]),
        "--bounces": (["0", "1", "8"], ["-3", "4294967296"]),
        "--accel": (["bvh", "grid", "auto"], ["x"]),
        "--grid": (["16x16x16", "40x3x20"], ["1x1x10000000", "500x500x500"]),
        "--memory-limit": (["256M", "1G"], ["1", "0", "64M"]),
        "--light": (["0,3,1", "1,2,3;1;0.5"], ["nan,0,0", "0,0,0;1e38"]),
        "--camera": (["0,2,5;0,1,0;45"], ["0,0,0;0,0,0;45", "1e30,0,0;0,0,0;1"]),
        "--smooth": (["off", "45", "180"], ["0", "181"]),
        "--exposure": (["auto", "3"], ["1e9"]),
        "--aa": (["1", "3", "40"], ["0", "100000"]),
        "--crop": (["0,0,64,48", "7,9,20,1", "-5,-3,70,50", "-40,60,9,9"], ["0,0,0,1", "1,2,3", "4294967295,0,2,2", "60,40,100000,1"]),
        "--background": (["transparent", "0.5", "1,0,0"], ["nan"]),
        "--ambient-light": (["constant", "mesh"], ["sky"]),
        "--sky": (["clear", "clear;sun=3,90;alone", "uniform;color=0.5", "gradient;north=30"], ["blue", "clear;sun=-5,0"]),
        "--threads": (["1", "3"], ["0", "100000"]),
    }
    for flag, (accepted, refused) in choices.items():
        if flag == "--size" or some(0.15):
            # With `=` a leading minus is a value's.
            words.append(f"{flag}={dice.choice(refused if some(0.08) else accepted)}")
    return words + ["--ground"] * some(0.2) + ["--partial"] * some(0.2)


def whole_png(data):
    return data.startswith(b"\x89PNG") and data.endswith(b"IEND\xaeB`\x82")


def whole_exr(data):
    return data.startswith(b"\x76\x2f\x31\x01")


def whole_jpg(data):
    return data.startswith(b"\xff\xd8") and data.endswith(b"\xff\xd9")


def whole_glb(data):
    return data.startswith(b"glTF") and int.from_bytes(data[8:12], "little") == len(data)


def anything(data):
    """An empty scene is an empty text."""
    return True


def whole_json(data):
    return data.rstrip().endswith(b"}")


# ---- Scenes ----


def write_scene(folder, dice):
    """A scene of one of the text formats, perhaps damaged."""
    obj, mtl, toml, ply, stl = (folder / f"scene.{ending}" for ending in ("obj", "mtl", "toml", "ply", "stl"))
    triangles = make_triangles(dice)
    obj.write_bytes(damaged(obj_text(triangles, dice), dice))
    mtl.write_bytes(damaged(mtl_text(dice), dice))
    ply.write_bytes(damaged(ply_text(triangles), dice))
    stl.write_bytes(damaged(stl_text(triangles), dice))
    toml.write_bytes(damaged(toml_text(dice), dice))
    return dice.choice([obj, toml, toml, ply, stl])


def make_triangles(dice):
    """Corners of families that are hard on acceleration structures, at any scale."""
    count, scale = dice.choice([0, 1, 12, 300, 300, 3000, 3000, 30000]), 10 ** dice.uniform(-3, 3)
    number = lambda: dice.gauss(0, 1)
    shape = dice.choice(["soup", "strip", "coincident", "nested", "flat", "far", "odd"])
    triangles = []
    for i in range(count):
        size = 1 + i if shape == "nested" else 0.2
        at = [i, 0, 0] if shape == "strip" else [0, 0, 0] if shape in ("coincident", "nested") else [number() for _ in range(3)]
        corners = [at, [at[0] + size, at[1], at[2]], [at[0], at[1] + size, at[2] + (0 if shape == "flat" else 0.1)]]
        if shape == "flat":
            corners = [[x, y, 0] for x, y, _ in corners]
        if shape == "far":
            corners = [[x + 1e7 * (i % 2), y, z] for x, y, z in corners]
        if shape == "odd":
            corners[dice.randrange(3)] = [dice.choice([0, 1e38, -1e-40, float("nan"), float("inf")]) for _ in range(3)]
        triangles.append([[scale * x for x in corner] for corner in corners])
    return triangles


def name(dice):
    return dice.choice(["oak", "", "with blank", "\x1b]0;x\x07", "\u202egnp", "a" * 300, "../x", "/etc/passwd", "é"])


def obj_text(triangles, dice):
    lines = ["mtllib scene.mtl", f"usemtl {name(dice)}"]
    for triangle in triangles:
        lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in triangle] + ["f -3 -2 -1"]
    return "\n".join(lines) + "\n"


def mtl_text(dice):
    lines = []
    for _ in range(dice.randrange(4)):
        number = lambda: dice.choice(["0", "0.5", "1", "1", "7", "1.0f"])
        lines += [f"newmtl {name(dice)}", f"Kd {number()} {number()} {number()}", f"Ks {number()} {number()} {number()}"]
        lines += [f"map_Kd {dice.choice([name(dice), 'none.png', 'scene.ply'])}"] * dice.randrange(2)
    return "\n".join(lines) + "\n"


def ply_text(triangles):
    header = f"ply\nformat ascii 1.0\nelement vertex {3 * len(triangles)}\nproperty float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    corners = "".join(f"{x:g} {y:g} {z:g}\n" for triangle in triangles for x, y, z in triangle)
    return header + corners + "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(triangles)))


def stl_text(triangles):
    facets = []
    for triangle in triangles:
        corners = "".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in triangle)
        facets.append(f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
    return "solid s\n" + "".join(facets) + "endsolid s\n"


def toml_text(dice):
    lines = ["[camera]", "position = [0, 2, 5]", "target = [0, 0, 0]"] if dice.random() < 0.7 else []
    for _ in range(dice.randrange(3)):
        kinds = ['kind = "point"\nspread = 0.2', 'kind = "sphere"\nradius = 0.3', 'kind = "disk"\nradius = 1\nnormal = [0, -1, 0]']
        kind = dice.choice(kinds)
        lines += ["[[light]]", kind, f"position = [{dice.choice(['1', '0', '1e9'])}, 4, 2]"]
    for _ in range(dice.randrange(1, 4)):
        file = dice.choice(3 * ["scene.obj", "scene.ply", "scene.stl"] + ["none.obj", "../scene.obj", "scene.toml"])
        lines += ["[[mesh]]", f'file = "{file}"', *[f"scale = {dice.choice([1, 0, -2, 1e20])}"] * dice.randrange(2)]
    return "\n".join(lines) + "\n"


def damaged(text, dice):
    """The text, in one case of four with a few bytes changed, cut or repeated."""
    data = bytearray(text.encode())
    if not data or dice.random() < 0.75:
        return bytes(data)
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


if __name__ == "__main__":
    sys.exit(main())
