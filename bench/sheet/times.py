#!/usr/bin/env python3
"""What the studio costs: seconds of the whole command with it and with `--no-studio`, of every model of a folder.

    python3 bench/sheet/times.py ../shared/scenes target/release/lightmesh

Runs of a model alternate, after some that are not counted. Prints the median of each model and the medians over models, as Markdown; wall seconds, and
processor seconds, which other programs disturb less.
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

# As in models.py, which needs more than Python alone.
KINDS = {".obj", ".gltf", ".glb", ".ply", ".stl"}
WAYS = {"studio": [], "plain": ["--no-studio"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=Path, help="folder, searched for model files")
    parser.add_argument("program", type=Path, help="lightmesh")
    parser.add_argument("--only", action="append", help="models whose name contains this; repeatable")
    parser.add_argument("--size", type=int, default=1024, help="pixels of an edge (1024)")
    parser.add_argument("--rounds", type=int, default=3, help="runs of each command that count (3)")
    parser.add_argument("--warm-up", type=int, default=1, help="runs of each command before them (1)")
    parser.add_argument("--device", default="cpu", help="as for lightmesh (cpu)")
    plan = parser.parse_args()
    names = sorted(str(path.relative_to(plan.models)) for path in plan.models.rglob("*") if path.suffix.lower() in KINDS)
    names = [name for name in names if not plan.only or any(part in name for part in plan.only)]
    print("| model | studio, CPU s | `--no-studio`, CPU s | ratio of CPU s | ratio of wall s |\n|---|--:|--:|--:|--:|")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            rows.append(measured(plan, name, Path(folder) / "picture.png"))
            print(line(name, *rows[-1]), flush=True)
    with_studio = [row for row in rows if row[2] != 1.0]
    print(line(f"median of {len(rows)}", *(statistics.median(column) for column in zip(*rows))))
    if with_studio and len(with_studio) < len(rows):
        title = f"median of the {len(with_studio)} that are shown otherwise with `--no-studio`"
        print(line(title, *(statistics.median(column) for column in zip(*with_studio))))


def line(name, studio, plain, processor, wall):
    return f"| {name} | {studio:.2f} | {plain:.2f} | {processor:.2f} | {wall:.2f} |"


def measured(plan, name, picture):
    """Processor seconds of both commands, and the ratios of processor and of wall seconds; both 1 if the pictures are the same."""
    base = [plan.program.resolve(), "render", plan.models / name, "-o", picture, "-q"]
    base += ["--device", plan.device, "--size", f"{plan.size}x{plan.size}"]
    seconds = {way: [] for way in WAYS}
    pictures = {}
    for turn in range(plan.warm_up + plan.rounds):
        for way, flags in WAYS.items():
            spent = run([*base, *flags])
            pictures[way] = picture.read_bytes()
            if turn >= plan.warm_up:
                seconds[way].append(spent)
    processor, wall = ({way: statistics.median(run[kind] for run in runs) for way, runs in seconds.items()} for kind in (0, 1))
    if pictures["studio"] == pictures["plain"]:
        return processor["studio"], processor["plain"], 1.0, 1.0
    return (*processor.values(), processor["studio"] / processor["plain"], wall["studio"] / wall["plain"])


def run(command):
    """Processor and wall seconds of a command."""
    start = time.perf_counter()
    child = subprocess.Popen(command)
    _, status, usage = os.wait4(child.pid, 0)
    wall = time.perf_counter() - start
    if status != 0:
        raise SystemExit(f"error: {' '.join(map(str, command))} failed")
    return usage.ru_utime + usage.ru_stime, wall


if __name__ == "__main__":
    main()
