#!/usr/bin/env python3
"""Throws random commands, signals and full disks at the program.

    cargo build --release && python3 bench/soak/soak.py --program target/release/lightmesh --jobs 2

Parts are `flags` (scenes × flags × signals), `kills` (films that are killed and resumed) and `disks` (disks that become full); all by
default. Whatever happens, the program must end in time with one of its exit codes, say why, leave no temporary file and change no input,
and each output is there completely or as it was. A fault is printed with its command and the seed that repeats it, its folder is kept,
and the exit code is 1. Needs Python 3.10 on Linux or macOS, and nothing else.
"""

from __future__ import annotations

import argparse
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import films
import flags
from process import TOO_SLOW, Ended, Plan, shown

PARTS = {"flags": (flags.soak, 2000), "kills": (films.kills, 100), "disks": (films.disks, 40)}
"""What each part does once, and how often."""
SCENES = {".toml", ".obj", ".gltf", ".glb", ".ply", ".stl"}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--program", type=Path, default=Path("target/release/lightmesh"))
    parser.add_argument("--runs", type=int, help="of each part, in place of " + ", ".join(f"{count} {part}" for part, (_, count) in PARTS.items()))
    parser.add_argument("--seed", type=int, default=0, help="of the first run; the next one has the next seed")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--limit", type=float, default=120, help="seconds that a command may take")
    parser.add_argument("--scenes", type=Path, help="a folder with more scenes for flags")
    parser.add_argument("--python", type=Path, help="a Python with the package, for half of the kills [default: this one, if it has it]")
    chosen = parser.parse_args()
    if unknown := [part for part in chosen.parts if part not in PARTS]:
        parser.error(f"{unknown[0]} is no part: choose from {', '.join(PARTS)}")
    scenes = sorted(path.resolve() for path in chosen.scenes.rglob("*") if path.suffix in SCENES) if chosen.scenes else []
    plan = Plan(chosen.program.resolve(), chosen.limit, tuple(scenes), with_package(chosen.python))
    folder = Path(tempfile.mkdtemp(prefix="lightmesh-soak-"))
    parts = chosen.parts or list(PARTS)
    if "flags" in parts and (missing := flags.unknown_flags(plan)):
        print(f"flags.py does not know {', '.join(missing)}: it leaves them out")
    if "kills" in parts:
        print(f"films are killed in the program{' and in Python' if plan.python else ' alone, because no Python has the package'}")
    if "disks" in parts:
        print(f"disks are made full by {films.kind_of_disk(folder)}", flush=True)
    faults = sum(soak(plan, part, chosen, folder) for part in parts)
    if faults == 0:
        shutil.rmtree(folder)
    return int(faults > 0)


def soak(plan: Plan, part: str, chosen: argparse.Namespace, folder: Path) -> int:
    """Runs a part, and returns the number of its faults."""
    once, count = PARTS[part]
    start, codes, faults = time.monotonic(), Counter[str](), 0

    def one(seed: int) -> tuple[list[str], str, str]:
        place = folder / f"{part}-{seed}"
        place.mkdir()
        try:
            found, ended = once(plan, place, random.Random(f"{part} {seed}"))
        except Exception as error:
            # One run that goes wrong in here must not end all others.
            found, ended = [f"this script fails: {error!r}"], Ended([], place, 0, b"", b"", None)
        if ended.code == TOO_SLOW:
            found.append(f"takes longer than {plan.limit} s")
        if not found:
            shutil.rmtree(place)
        return found, str(ended.code), shown(ended)

    seeds = range(chosen.seed, chosen.seed + (chosen.runs or count))
    with ThreadPoolExecutor(chosen.jobs) as pool:
        for seed, (found, code, command) in zip(seeds, pool.map(one, seeds), strict=True):
            codes[code] += 1
            if found:
                faults += 1
                print(f"FAULT {part} {seed}: {'; '.join(found)}\n  {command}\n  {repeat(chosen, part, seed)}", flush=True)
    ends = ", ".join(f"{code}: {number}" for code, number in sorted(codes.items(), key=lambda entry: int(entry[0])))
    print(f"{part}: {len(seeds)} runs, {faults} faults, {time.monotonic() - start:.0f} s; exit codes {ends}", flush=True)
    return faults


def repeat(chosen: argparse.Namespace, part: str, seed: int) -> str:
    """The command that does a run again."""
    words = [sys.argv[0], part, "--program", str(chosen.program), "--runs", "1", "--seed", str(seed)]
    words += ["--scenes", str(chosen.scenes)] if chosen.scenes else []
    return "python3 " + " ".join(words + (["--python", str(chosen.python)] if chosen.python else []))


def with_package(python: Path | None) -> Path | None:
    """A Python that has the package, if there is one."""
    # Not resolved: that of a virtual environment is a link.
    python = python.absolute() if python else Path(sys.executable)
    result = subprocess.run([python, "-c", "import lightmesh"], capture_output=True, check=False)
    return python if result.returncode == 0 else None


if __name__ == "__main__":
    sys.exit(main())
