#!/usr/bin/env python3
"""Is the progress of long renders right: does its share never fall, and is the time that it says is left near what was left?

    python3 bench/progress/progress.py target/release/lightmesh
    python3 bench/progress/progress.py target/release/lightmesh --python target/python/bin/python

Prints a row for each render: its seconds, how often the share fell, and of the samples that were told from 30 % on, how many stated a time within
±40 % of what was left. `--python` adds one that bakes, with a Python that has the wheel installed. Names select renders; `--scale` makes pictures
larger, for many processors or a GPU, and `--flags "--device cuda"` adds flags to each. Exit code 1 if a share fell, or if fewer than nine of ten
samples are near.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT.parent / "shared" / "scenes"
DAY = "54.98,82.9,2026-06-21+07:00,06:00-20:00"
#: Samples count from this share on, and up to this number of seconds before the end, of which a timer tells little.
FROM, LAST = 0.3, 0.3
NEAR = 0.4

#: Scene, size, and flags. A picture takes from ten seconds to a minute on two processors.
RENDERS = {
    "rays": ("builtin:childpark", (1024, 768), "--quality final"),
    "area": ("builtin:garden", (320, 240), "--mode area --samples 256"),
    "mesh": ("builtin:childpark", (1024, 768), "--lookup half-ball --aa 4"),
    "mirrors": ("builtin:gazebo", (1024, 768), "--quality final --bounces 6"),
    "sky": ("sponza/sponza.obj", (200, 150), "--sky clear"),
    "leaves": ("builtin:garden", (60, 45), "--sky clear"),
    "glass": ("chess/chess-board.glb", (100, 75), "--sky clear"),
    "room": ("cornell_gltf/cornellBox.gltf", (120, 120), ""),
    "film": ("builtin:childpark", (320, 240), "--turntable 40 -o f.###.png"),
    "day": ("builtin:childpark", (64, 48), f"--sun {DAY}/1h --sun-hours h.exr -o f.###.png"),
    "hours": ("builtin:childpark", (640, 480), f"--sun {DAY}/2m --sun-hours h.exr"),
}

#: What bakes: many points on the floor of a scene.
BAKE = """
import json, sys, time, lightmesh, numpy
points = numpy.random.default_rng(1).uniform(-1.0, 1.0, (int(sys.argv[1]), 3)) * (4.0, 0.0, 4.0) + (0.0, 0.01, 0.0)
tell = lambda progress: print(json.dumps({"event": "image", "done": progress.done, "seconds": progress.seconds, "left": progress.left}), flush=True)
normals = numpy.tile((0.0, 1.0, 0.0), (len(points), 1))
lightmesh.Renderer("cpu").visibility(points, normals, lightmesh.Scene.open("builtin:childpark"), mode="area", samples=256, progress=tell)
"""


def follow(command: list[str], folder: str) -> list[tuple[float, float, float | None]]:
    """Seconds, the share that is done and seconds left, each time that it was told."""
    told = []
    start = time.perf_counter()
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        for line in process.stdout:
            if line.startswith('{"event":"image"') or line.startswith('{"event": "image"'):
                event = json.loads(line)
                told.append((time.perf_counter() - start, event["done"], event["left"]))
            elif not line.startswith("{"):
                print("   ", line.rstrip(), file=sys.stderr)
    if process.returncode:
        sys.exit(f"{' '.join(command)}: exit code {process.returncode}")
    return told


def measure(told: list[tuple[float, float, float | None]]) -> tuple[float, int, int, int]:
    """Seconds, how often the share fell, samples, and how many of these were near."""
    end = told[-1][0]
    falls = sum(after < before for (_, before, _), (_, after, _) in zip(told, told[1:]))
    # One sample in each hundredth of the time: stages that report often count no more than others.
    samples = {int(100 * seconds / end): (end - seconds, left) for seconds, done, left in told if done >= FROM and end - seconds > LAST}
    near = sum(left is not None and abs(left - true) <= NEAR * true for true, left in samples.values())
    return end, falls, len(samples), near


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(RENDERS)}, bake")
    parser.add_argument("--python", type=Path)
    parser.add_argument("--scenes", type=Path, default=SCENES)
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--flags", default="")
    parser.add_argument("--log", type=Path, help="a folder for what was told")
    arguments = parser.parse_args()
    commands = {}
    for name, (scene, size, flags) in RENDERS.items():
        scene = scene if scene.startswith("builtin:") else str((arguments.scenes / scene).resolve())
        size = "x".join(str(round(arguments.scale * side)) for side in size)
        output = [] if "-o " in flags or name == "hours" else ["-o", "p.png"]
        words = [str(arguments.program.resolve()), "render", scene, "--size", size, *flags.split(), *arguments.flags.split(), *output]
        commands[name] = [*words, "--progress", "json"]
    if arguments.python:
        commands["bake"] = [str(arguments.python.absolute()), "-c", BAKE, str(round(200_000 * arguments.scale**2))]
    wanted = arguments.names or list(commands)
    all_samples = all_near = all_falls = 0
    print("| render | s | falls | samples | near |\n|---|--:|--:|--:|--:|")
    for name in wanted:
        with tempfile.TemporaryDirectory() as folder:
            told = follow(commands[name], folder)
        if arguments.log:
            arguments.log.mkdir(parents=True, exist_ok=True)
            (arguments.log / f"{name}.json").write_text(json.dumps(told))
        seconds, falls, samples, near = measure(told)
        print(f"| {name} | {seconds:.1f} | {falls} | {samples} | {near / max(samples, 1):.0%} |", flush=True)
        all_samples, all_near, all_falls = all_samples + samples, all_near + near, all_falls + falls
    share = all_near / max(all_samples, 1)
    print(f"| all | | {all_falls} | {all_samples} | {share:.0%} |")
    return int(all_falls > 0 or share < 0.9)


if __name__ == "__main__":
    sys.exit(main())
