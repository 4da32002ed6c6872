#!/usr/bin/env python3
"""Does gathered light look as it does to path tracers, and what does it cost?

Renders scenes that are full of it by Lightmesh, Mitsuba and Cycles, with the same triangles, diffuse colours, lamps, sun and sky, and
compares all images with one of many samples by Mitsuba. README.md has the table, and what makes it fair.

    cargo build --release
    python3.11 -m venv target/peers
    target/peers/bin/pip install -r bench/peers/requirements.txt pillow
    target/peers/bin/python bench/light/light.py -o light.json
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from by_lightmesh import Lightmesh
from by_mitsuba import Mitsuba
from scenes import SCENES
from shown import flip, keep

ROOT = Path(__file__).resolve().parents[2]
TITLES = ["scene", "program", "seconds", "processor", "mean FLIP", "mean difference", "mean radiance"]


def main():
    options = arguments()
    rows = json.loads(options.output.read_text())["rows"] if options.output and options.output.exists() else []
    for scene in SCENES:
        if options.only and scene.name not in options.only:
            continue
        rows = [row for row in rows if row["scene"] != scene.name]
        for row in compare(scene, options):
            rows.append(row)
            print(line([row[title] for title in TITLES]), flush=True)
        if options.output:
            settings = {key: getattr(options, key) for key in ("size", "samples", "reflections", "threads", "device", "repeat")}
            options.output.write_text(json.dumps({"settings": settings, "rows": rows}, indent=1) + "\n")
    print(table(rows))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("-o", "--output", type=Path, help="a JSON file with the rows; those of other scenes in it are kept")
    add("--pictures", type=Path, help="a folder for the images, as they are compared, and references, which are used again")
    add("--only", nargs="+", choices=[scene.name for scene in SCENES], help="scenes")
    add("--models", type=Path, default=ROOT / "../shared/scenes", help="a folder with models")
    add("--lightmesh", default=ROOT / "target/release/lightmesh", help="the program")
    add("--size", type=int, nargs=2, default=[320, 240], help="width and height")
    add("--samples", type=int, default=1024, help="samples of a pixel of the reference")
    add("--at-once", type=int, default=16, help="so many of them in one go: memory")
    add("--reflections", type=int, help="of all paths but Lightmesh's, and of the reference; default: any number")
    add("--counts", type=int, nargs="*", default=[16, 64], help="samples of a pixel of path tracers")
    add("--qualities", nargs="*", default=["good", "final"], help="Lightmesh's")
    add("--threads", type=int, default=2, help="of each program")
    add("--repeat", type=int, default=3, help="of each image, after one to warm up; the median counts")
    add("--device", choices=["cpu", "cuda"], default="cpu", help="of all programs")
    add("--without", nargs="+", default=[], choices=["mitsuba", "cycles"], help="only the reference, or nothing, of a program")
    options = parser.parse_args()
    options.root = ROOT
    return options


def compare(scene, options):
    """The rows of a scene, one after another."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        lightmesh = Lightmesh(scene, options, folder)
        mitsuba = Mitsuba(lightmesh, options)
        judge = Judge(scene, options, mitsuba)
        for quality in options.qualities:
            yield judge.row(f"Lightmesh, {quality}", *lightmesh.render(quality))
        if "mitsuba" not in options.without:
            for count in options.counts:
                render = lambda seed: mitsuba.render(count, seed)
                yield judge.row(f"Mitsuba, {count} samples", *timed(render, options))
        if "cycles" not in options.without:
            from by_cycles import Cycles

            cycles = Cycles(lightmesh, options, folder)
            for count in options.counts:
                for denoise in (False, True):
                    render = lambda seed: cycles.render(count, seed, denoise)
                    name = f"Cycles, {count} samples{', denoised' if denoise else ''}"
                    yield judge.row(name, *timed(render, options))
        if options.reflections:
            yield judge.row("any number of reflections", None, None, mitsuba.mean(64, options.at_once, mitsuba.endless))


def timed(render, options):
    """The median of the times after the first, that of the processor time of all threads, and an image."""
    render(0)
    runs, busy = [], []
    for turn in range(options.repeat):
        start = time.process_time()
        runs.append(render(1 + turn))
        busy.append(time.process_time() - start)
    return float(np.median([seconds for seconds, _ in runs])), float(np.median(busy)), runs[0][1]


class Judge:
    """Compares with the reference."""

    def __init__(self, scene, options, mitsuba):
        self.scene, self.options = scene, options
        limit = f"-{options.reflections}" if options.reflections else ""
        kept = options.pictures / f"{scene.name}-{options.samples}{limit}.npy" if options.pictures else None
        if kept and kept.exists():
            self.reference = np.load(kept)
        else:
            self.reference = mitsuba.mean(options.samples, options.at_once).astype(np.float32)
            if kept:
                options.pictures.mkdir(parents=True, exist_ok=True)
                np.save(kept, self.reference)
        self.keep("reference", self.reference)

    def row(self, program, seconds, busy, image):
        image = np.asarray(image, np.float32)
        self.keep(program, image)
        # What is far beyond white, such as lamps that are seen, would outweigh the rest.
        reference, image = (np.minimum(linear, 2 / self.gain) for linear in (self.reference, image))
        return {
            "scene": self.scene.name,
            "program": program,
            "seconds": seconds,
            "processor": busy,
            "mean FLIP": flip(self.reference, image, self.scene.exposure),
            "mean difference": float(abs(image - reference).mean() / reference.mean()),
            "mean radiance": float(image.mean() / reference.mean()),
        }

    @property
    def gain(self):
        return 2.0**self.scene.exposure

    def keep(self, program, image):
        if self.options.pictures:
            name = program.replace(", ", "-").replace(" ", "-").lower()
            keep(self.options.pictures / f"{self.scene.name}-{name}.png", image, self.scene.exposure)


def line(cells):
    return "| " + " | ".join("" if cell is None else f"{cell:.3g}" if isinstance(cell, float) else cell for cell in cells) + " |"


def table(rows):
    return "\n".join(["", line(TITLES), "|---|---|" + "--:|" * 5, *(line([row[title] for title in TITLES]) for row in rows)])


if __name__ == "__main__":
    sys.exit(main())
