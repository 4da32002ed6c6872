#!/usr/bin/env python3
"""Whether a change leaves every picture as it is: renders many pictures, and compares the bytes of all files with those of an earlier run.

    python3 bench/pictures/pictures.py target/release/lightmesh -o before.json
    … the change, and another build …
    python3 bench/pictures/pictures.py target/release/lightmesh --against before.json

Every scene — the built-in ones, those of `scenes/` and, where the folder exists, the models of `../shared/scenes` — is rendered by all
techniques, with layers, mirrors and several samples of each pixel; with a sky, with a ground, as a film of three frames, and as a sun study
with hours; and the same four with no other settings, as PNG and EXR with statistics. A file counts by its SHA-256, statistics without seconds
and memory, a message on standard error by its text; times and folders are left out. Exit code 1 if anything differs. `--device cuda` does the
same on a GPU; the rows of devices are not compared with each other.

Pictures of other faces come from the library: `--face python` with a Python that has the wheel installed in place of the program,
`--face rust` with the program `pictures` of `lightmesh-examples`. The rows of a face are not compared with those of another one.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODELS = (".obj", ".gltf", ".glb", ".ply", ".stl")

# Times, rates and free memory in messages; a film says how much is left only if frames take long.
VARIES = re.compile(r"\d+(\.\d+)? ?(ms|s|min|h|GiB free)\b|\d+\.\d+ per second")
LEFT = re.compile(r", about [^,\n]+ left")

# What all pictures have.
QUIET = "--progress none --color never"
# Pictures by all techniques: small, with samples on edges, and reflections.
COMMON = f"{QUIET} --size 96x72 --aa 2 --samples 4 --bounces 1"

# Each with the files that it writes; `OUT` is a folder of its own.
TECHNIQUES = {
    "lists": "-o OUT/p.png --layers OUT/l.exr",
    "adaptive": "--lookup adaptive -o OUT/p.png --layers OUT/l.exr",
    "half-ball": "--lookup half-ball -o OUT/p.png --layers OUT/l.exr",
    "ray-trace": "--mode ray-trace -o OUT/p.png --layers OUT/l.exr",
    "area": "--mode area -o OUT/p.exr",
    "grid": "--accel grid -o OUT/p.bmp",
    "gathered": "--ambient-light mesh --quality draft --aa 1 --size 48x36 -o OUT/p.exr",
    "sky": "--sky clear --quality draft --aa 1 --size 48x36 -o OUT/p.png",
    "ground": "--ground --background transparent -o OUT/p.png",
    "film": "--turntable 3 --ground --aa 1 -o OUT/f.#.png",
    "sun": "--sun 54.98,82.9,2026-06-21+07:00,09:00-15:00/3h --ambient-light constant --aa 1 "
    "--sun-hours OUT/h.png --sun-hours OUT/h.exr --sun-hours OUT/h.csv -o OUT/d.##.png",
}
# Without other settings, so that all defaults count. Statistics are those of an image or of each frame; `#` is the number of the frame.
DEFAULTS = {
    "default": "",
    "default-ground": "--ground",
    "default-sky": "--sky clear --quality draft",
    "default-film": "--turntable 3",
    "default-sun": "--sun 54.98,82.9,2026-06-21+07:00,09:00-15:00/3h --quality draft --sun-hours OUT/h.csv",
}
FORMATS = {"png": "-o OUT/p.#.png --stats OUT/p.#.json", "exr": "-o OUT/e.#.exr --layers OUT/l.#.exr --stats OUT/e.#.json"}
CLI = {case: f"{COMMON} {flags}" for case, flags in TECHNIQUES.items()} | {
    f"{case}-{name}": f"{QUIET} --size 48x36 {flags} {files}" for case, flags in DEFAULTS.items() for name, files in FORMATS.items()
}
# The library has neither films nor sun studies; its turntable is turned by hand.
LIBRARY = ("default", "ground", "sky", "turntable")
FACES = {"cli": tuple(CLI), "python": LIBRARY, "rust": LIBRARY}
PYTHON = Path(__file__).with_name("python_face.py")
# Parts of statistics that differ from run to run.
UNSTEADY = ("seconds", "memory")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--face", choices=FACES, default="cli", help="what is asked for pictures, and so what the program is [default: cli]")
    parser.add_argument("-o", "--output", type=Path, help="the digests, as JSON")
    parser.add_argument("--against", type=Path, help="digests of an earlier run, to compare with")
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--only", default="", help="scenes or cases whose name contains this")
    parser.add_argument("--scenes", type=Path, action="append", help="folders of models [default: scenes, ../shared/scenes]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    plan = parser.parse_args()
    if not plan.output and not plan.against:
        parser.error("give -o to record, or --against to compare")
    folders = plan.scenes or [ROOT / "scenes", ROOT.parent / "shared" / "scenes"]
    scenes = ["builtin:gazebo", "builtin:childpark", "builtin:garden"] + [scene for folder in folders for scene in models(folder)]
    runs = [(f"{plan.face} {case} {scene_name(scene)}", scene, case) for scene in scenes for case in FACES[plan.face]]
    runs = [run for run in runs if plan.only in run[0]]
    with concurrent.futures.ThreadPoolExecutor(plan.jobs) as pool:
        rows = dict(zip((run[0] for run in runs), pool.map(lambda run: digests(plan, *run[1:]), runs), strict=True))
    failed = [name for name, row in rows.items() if row["exit"] not in (0, 2)]
    files = sum(len(row["files"]) for row in rows.values())
    print(f"{len(rows)} commands, {files} files" + "".join(f"\nfailed: {name}" for name in failed))
    if plan.output:
        plan.output.write_text(json.dumps(rows, indent=0) + "\n")
    return bool(failed) | (bool(plan.against) and differences(json.loads(plan.against.read_text()), rows))


def models(folder):
    """Scene files and models below a folder."""
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in (*MODELS, ".toml"))
    return [str(path) for path in files]


def scene_name(scene):
    """The last two parts of a path, which are the same on all machines."""
    return scene if scene.startswith("builtin:") else "/".join(Path(scene).parts[-2:])


def digests(plan, scene, case):
    """Exit code, messages and digests of what one command writes."""
    with tempfile.TemporaryDirectory(prefix="lightmesh-pictures-") as folder:
        command = command_of(plan, scene, case, folder)
        done = subprocess.run(command, capture_output=True, text=True, timeout=1800)
        said = done.stderr.replace(folder, "OUT").replace(scene, scene_name(scene))
        # A manifest has the version of the program and checksums of frames, which count themselves.
        written = (path for path in sorted(Path(folder).iterdir()) if path.name != "manifest.json")
        files = {path.name: hashlib.sha256(steady(path)).hexdigest() for path in written}
        return {"exit": done.returncode, "said": VARIES.sub("…", LEFT.sub("", said)), "files": files}


def command_of(plan, scene, case, folder):
    """The command that writes the files of a case to a folder."""
    # The Python of a virtual environment is a link, and another one where it leads.
    program = plan.program.absolute()
    if plan.face != "cli":
        return [program, *([PYTHON] if plan.face == "python" else []), case, scene, folder, plan.device]
    flags = [flag.replace("OUT", folder) for flag in shlex.split(CLI[case])]
    return [program, "render", scene, *last_of_each(flags), "--device", plan.device, "--threads", "1"]


def steady(path):
    """What is the same in every run of a file."""
    if path.suffix != ".json":
        return path.read_bytes()
    return json.dumps({key: value for key, value in json.loads(path.read_text()).items() if key not in UNSTEADY}).encode()


def last_of_each(flags):
    """A flag of a case replaces that of all cases; outputs may be repeated."""
    pairs, at = [], 0
    while at < len(flags):
        has_value = at + 1 < len(flags) and not flags[at + 1].startswith("-")
        pairs.append(flags[at : at + 1 + has_value])
        at += 1 + has_value
    repeated = ("-o", "--sun-hours", "--layers")
    kept = [pair for at, pair in enumerate(pairs) if pair[0] in repeated or pair[0] not in (later[0] for later in pairs[at + 1 :])]
    return [flag for pair in kept for flag in pair]


def differences(before, after):
    """Prints what differs; whether anything does."""
    problems = [f"not rendered before: {name}" for name in after if name not in before]
    for name, row in after.items():
        old = before.get(name, row)
        if old["exit"] != row["exit"]:
            problems.append(f"{name}: exit code {row['exit']}, before {old['exit']}")
        problems += [f"{name}: {file} differs" for file in sorted({*old["files"], *row["files"]}) if old["files"].get(file) != row["files"].get(file)]
        if old["said"] != row["said"]:
            print(f"other messages: {name}\n  before: {old['said'].strip()}\n  now:    {row['said'].strip()}")
    print("\n".join(problems) or "all files are byte for byte the same")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
