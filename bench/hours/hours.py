#!/usr/bin/env python3
"""The error of hours of direct sun: studies as anybody asks for them, against the same with many samples of the sun and a step of a minute.

    python3 bench/hours/hours.py target/release/lightmesh -o bench/hours/hours.json

The error is the mean of |hours - reference| in hours, over the pixels that see a surface with any sun. It has two parts, which are told
apart: that of the samples at the study's own moments, and that of the time between moments. Needs Python alone; models are
those of `../shared/scenes`, where that folder exists. `--device cuda` takes a tenth of the time.
"""

import argparse
import array
import json
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "scenes"
#: A day of long shadows and a high sun.
DAY = "54.98,82.9,2026-06-21+07:00,06:00-20:00"
#: Built-in, and models that hide much of the sun: rooms and columns, furniture, thin parts.
SCENES = ["builtin:childpark", "house/house.glb", "sponza/sponza.obj", "chess/chess-board.glb"]
#: Samples of the sun that serve as the truth at a moment.
MANY = 1024


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the program lightmesh")
    parser.add_argument("-o", "--output", type=Path, help="write the figures as JSON, too")
    parser.add_argument("--device", default="cpu", help="that of all runs")
    parser.add_argument("--size", default="320x240", help="of the images")
    parser.add_argument("--steps", default="15m,5m", help="steps that a user may give, beside none")
    parser.add_argument("--scenes", nargs="+", default=SCENES, help="built-in scenes, or models of the folder")
    parser.add_argument("--folder", type=Path, default=SHARED, help="of the models")
    return parser.parse_args()


def read(path: Path) -> tuple[array.array, array.array]:
    """`A` and `hours` of an uncompressed exr file of 32-bit numbers."""
    data = path.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        end = data.index(0, at)
        name, at = data[at:end].decode(), data.index(0, end + 1) + 1
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path} is compressed")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    at += 1 + 8 * height
    planes = array.array("f"), array.array("f")
    for _ in range(height):
        at += 8
        for plane in planes:
            plane.frombytes(data[at : at + 4 * width])
            at += 4 * width
    return planes


class Studies:
    """Hours of one scene."""

    def __init__(self, given: argparse.Namespace, scene: str, folder: str):
        self.given, self.scene, self.folder = given, scene, Path(folder)

    def hours(self, step: str, *flags: str) -> tuple[tuple[array.array, array.array], float]:
        path = self.folder / "hours.exr"
        sun = DAY + (f"/{step}" if step else "")
        command = [self.given.program, "render", self.scene, "--sun", sun, "--sun-hours", str(path), "--size", self.given.size]
        command += ["--exr-compression", "none", "--exr-type", "float", "--progress", "none", "--device", self.given.device, *flags]
        start = time.monotonic()
        subprocess.run(command, check=True, capture_output=True)
        return read(path), time.monotonic() - start


def error(found: tuple[array.array, array.array], reference: tuple[array.array, array.array]) -> dict[str, float]:
    """Mean and quantiles of the difference where there is a surface with sun."""
    lit = sorted(
        abs(a - b) for a, b, sees in zip(found[1], reference[1], reference[0]) if sees and max(a, b) > 0.0
    )
    return {"mean": sum(lit) / len(lit), "p95": lit[int(0.95 * (len(lit) - 1))], "most": lit[-1], "pixels": len(lit)}


def figures(given: argparse.Namespace, scene: str) -> list[dict]:
    path = scene if scene.startswith("builtin:") else str(given.folder / scene)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        studies = Studies(given, path, folder)
        truth, _ = studies.hours("1m", "--samples", str(MANY // 4))
        for step in ["", *filter(None, given.steps.split(","))]:
            found, seconds = studies.hours(step)
            sampled, _ = studies.hours(step, "--samples", str(MANY))
            row = {
                "scene": scene,
                "step": step or "none",
                "seconds": round(seconds, 2),
                "of_samples": error(found, sampled),
                "in_all": error(found, truth),
            }
            rows.append(row)
            show(row)
    return rows


def show(row: dict) -> None:
    of_samples, in_all = row["of_samples"], row["in_all"]
    print(
        f"| {row['scene']} | {row['step']} | {of_samples['mean']:.4f} | {in_all['mean']:.4f} | {in_all['p95']:.3f} | "
        f"{in_all['most']:.2f} | {row['seconds']:.1f} |",
        flush=True,
    )


def main() -> int:
    given = arguments()
    print("| scene | step | mean error of samples, h | mean error in all, h | 95 % below | most | s |\n|---|---|---|---|---|---|---|")
    scenes = [scene for scene in given.scenes if scene.startswith("builtin:") or (given.folder / scene).exists()]
    for scene in set(given.scenes) - set(scenes):
        print(f"{given.folder / scene} does not exist", file=sys.stderr)
    rows = [row for scene in scenes for row in figures(given, scene)]
    if given.output:
        device = "CPU" if given.device == "cpu" else given.device
        given.output.write_text(json.dumps({"day": DAY, "size": given.size, "device": device, "rows": rows}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
