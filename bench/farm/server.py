#!/usr/bin/env python3
"""How long a job of a farm takes with one server for all tasks, and without: whole runs of `openjd run`, in turn.

    python3 bench/farm/server.py target/release/lightmesh SCENE [--frames 24] [--rounds 5]

Python needs `openjd-cli`. The film is a turntable in tasks of two frames, small and quick, so that reading the scene counts. Prints the medians and their
ratio, and checks that all frames are the same.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def run(job: Path) -> float:
    """Runs a job; returns its seconds."""
    begin = time.perf_counter()
    openjd = Path(sys.executable).with_name("openjd")
    subprocess.run([openjd, "run", job.name], cwd=job.parent, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def main() -> None:
    flags = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    flags.add_argument("program", type=Path)
    flags.add_argument("scene")
    flags.add_argument("--frames", type=int, default=24)
    flags.add_argument("--size", default="320x180")
    flags.add_argument("--rounds", type=int, default=5)
    given = flags.parse_args()
    scene = given.scene if given.scene.startswith("builtin:") else str(Path(given.scene).absolute())
    times: dict[str, list[float]] = {"server": [], "no server": []}
    frames = {}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(given.rounds):
            for kind, seconds in times.items():
                place = Path(folder) / f"{kind}-{number}"
                place.mkdir()
                if not scene.startswith("builtin:"):
                    # Defaults of a job lie in its folder.
                    (place / "scene").symlink_to(Path(scene).parent, target_is_directory=True)
                inside = scene if scene.startswith("builtin:") else f"scene/{Path(scene).name}"
                film = ["--turntable", str(given.frames), "--size", given.size, "--frames-to", "f.####.png", "--frames-per-task", "2"]
                more = ["--no-server"] if kind == "no server" else []
                program = given.program.absolute()
                command = [program, "farm", inside, *film, "-o", "job.yaml", "--program", program, *more, "-q"]
                subprocess.run(command, cwd=place, check=True)
                seconds.append(run(place / "job.yaml"))
                frames[kind] = [path.read_bytes() for path in sorted(place.glob("f.*.png"))]
    assert frames["server"] == frames["no server"] and len(frames["server"]) == given.frames
    medians = {kind: statistics.median(seconds) for kind, seconds in times.items()}
    for kind, seconds in times.items():
        print(f"{kind:10} {medians[kind]:7.3f} s  ({', '.join(f'{each:.3f}' for each in seconds)})")
    print(f"server : no server = {medians['server'] / medians['no server']:.2f}")


if __name__ == "__main__":
    main()
