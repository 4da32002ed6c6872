#!/usr/bin/env python3
"""Contact sheets: every model of a folder at Lightmesh's defaults, without its studio and under its clear sky, beside Blender's Cycles.

    target/sheet/bin/python bench/sheet/sheet.py ../shared/scenes target/release/lightmesh -o sheets

Writes pairs at 1:1, sheets with several pairs, and the numbers of `verdicts.json`, whose words are kept: they are for those who look.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "peers"))

import models  # noqa: E402
from blender import Cycles, shown  # noqa: E402

VERDICTS = HERE / "verdicts.json"
PAIRS_PER_SHEET, TITLE = 4, 18


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=Path, help="folder, searched for model files")
    parser.add_argument("program", type=Path, help="lightmesh")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder for pictures")
    parser.add_argument("--only", action="append", help="models whose name contains this; repeatable")
    parser.add_argument("--size", type=int, default=384, help="pixels of an edge (384)")
    parser.add_argument("--samples", type=int, default=64, help="samples of Cycles, which are denoised (64)")
    parser.add_argument("--threads", type=int, default=2, help="threads of Cycles (2)")
    parser.add_argument("--without-cycles", action="store_true", help="Lightmesh alone")
    plan = parser.parse_args()
    plan.output.mkdir(parents=True, exist_ok=True)
    verdicts = {row["file"]: row for row in json.loads(VERDICTS.read_text())["models"]} if VERDICTS.exists() else {}
    pairs = []
    for name in models.find(plan.models, plan.only):
        model = models.render(plan.program.resolve(), plan.models, name, plan.size, plan.output)
        other = None if plan.without_cycles else cycles(model, plan)
        row = {"file": name, "lightmesh": models.shares(model.picture, model.covered)}
        row["first"] = models.shares(model.first, np.ones_like(model.covered))
        row["sky"] = models.shares(model.sky, np.ones_like(model.covered))
        if other is not None:
            row["cycles"] = models.shares(other, model.covered)
        row["verdict"] = verdicts.get(name, {}).get("verdict", "")
        verdicts[name] = {**verdicts.get(name, {}), **row}
        shown_as = {"first picture": model.first, "--sky clear": model.sky, "--no-studio": model.picture, "Cycles": other}
        pairs.append(pair(name, shown_as, plan.output))
        print(name, json.dumps({key: row[key] for key in ("first", "lightmesh", "sky")}), flush=True)
        save(verdicts, plan)
    for first in range(0, len(pairs), PAIRS_PER_SHEET):
        sheet(pairs[first : first + PAIRS_PER_SHEET], plan.output / f"sheet-{first // PAIRS_PER_SHEET:02}.png")


def cycles(model, plan):
    """Codes of the image by Cycles."""
    start = time.perf_counter()
    _, linear = Cycles(model, plan.size, plan.threads, plan.output).render(plan.samples, 0, smooth=True, denoise=True)
    print(f"{model.name}: {time.perf_counter() - start:.0f} s in Cycles", file=sys.stderr)
    return shown(np.asarray(linear), None if model.suns else model.picture, model.covered)


def save(verdicts, plan):
    text = {"size": plan.size, "samples": plan.samples, "models": [verdicts[name] for name in sorted(verdicts)]}
    VERDICTS.write_text(json.dumps(text, indent=1, ensure_ascii=False) + "\n")


def pair(name, images, folder):
    """The images side by side with the model's name and theirs above."""
    images = {title: image for title, image in images.items() if image is not None}
    size = next(iter(images.values())).shape[0]
    canvas = Image.new("RGB", (size * len(images), size + TITLE), (32, 32, 32))
    ImageDraw.Draw(canvas).text((4, 3), f"{name}: {', '.join(images)}", fill=(230, 230, 230))
    for number, image in enumerate(images.values()):
        canvas.paste(Image.fromarray(image), (number * size, TITLE))
    canvas.save(folder / f"{name.replace('/', '-')}.pair.png")
    return canvas


def sheet(pairs, path):
    """Pairs in two columns."""
    width, height = pairs[0].size
    canvas = Image.new("RGB", (2 * width, height * ((len(pairs) + 1) // 2)))
    for number, image in enumerate(pairs):
        canvas.paste(image, (number % 2 * width, number // 2 * height))
    canvas.save(path)


if __name__ == "__main__":
    main()
