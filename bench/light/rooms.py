#!/usr/bin/env python3
"""How right is gathered light in the scenes of `scenes/`? A quick look while working on it; `marks.py` has all marks.

    python bench/light/rooms.py --references FOLDER --only room-window screen --lightmesh target/release/lightmesh

Columns: mean FLIP less that of two seeds of the truth, at the image's size and averaged to half of it; the mean radiance, and the worst block
of 8x8 pixels, as ratios to the truth; the middle of this block in pixels; the root mean square of all blocks; the share of pixels brighter
than energy allows; the largest radiance; seconds of the processor.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

import measures
import panorama
import shown
import truth
from by_lightmesh import Program
from scenes import ROOMS

ROOT = Path(__file__).resolve().parents[2]
HEADER = f"{'scene':16} {'quality':7} {'FLIP':>6} {'half':>6} {'noise':>6} {'mean':>6} {'block':>6} {'at':>9} {'rms':>6} {'over':>7} {'max':>8} {'CPU s':>6}"


def main():
    options = arguments()
    if not options.make_only:
        print(HEADER, flush=True)
    for room in ROOMS:
        if options.only and room.name not in options.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            program = Program(options, folder)
            try:
                true = truth.of(room, program.run, folder, options)
            except truth.Missing as missing:
                sys.exit(str(missing))
            if options.pictures:
                options.pictures.mkdir(parents=True, exist_ok=True)
                shown.keep(options.pictures / f"{room.name}-truth.png", true.mean, room.exposure)
            for quality in [] if options.make_only else options.qualities:
                seconds, image = render(room, program, quality, options)
                print(line(room, quality, measures.all_of(room, true, image), image, seconds), flush=True)
                if options.pictures:
                    shown.keep(options.pictures / f"{room.name}-{quality}.png", image, room.exposure)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    common(parser)
    add("--only", nargs="+", choices=[room.name for room in ROOMS], help="scenes")
    add("--size", type=int, nargs=2, default=[320, 240], help="width and height")
    add("--qualities", nargs="*", default=["good"], help="Lightmesh's")
    add("--make-only", action="store_true", help="the truth alone")
    return parser.parse_args()


def common(parser):
    """Options that `marks.py` has, too."""
    add = parser.add_argument
    add("--lightmesh", default=ROOT / "target/release/lightmesh", help="the program")
    add("--references", type=Path, default=ROOT / "target/references", help="a folder for the truth, which is kept")
    add("--ambient-light", default="mesh", choices=["mesh", "rays"], help="of the images")
    add("--pictures", type=Path, help="a folder for the images, as they are compared")
    add("--threads", type=int, default=2, help="of each program")
    add("--device", choices=["cpu", "cuda"], default="cpu", help="of Lightmesh and Mitsuba")
    add("--noise", type=float, default=0.02, help="mean FLIP of two seeds at which the truth needs no more samples")
    add("--minutes", type=float, default=0, help="for each truth that is missing or noisier; 0 takes what is there")
    add("--words", default="", help="more flags for `lightmesh render`, in one string")


def render(room, program, quality, options):
    """Seconds of the processor and linear colours."""
    words = ["--quality", quality, "--ambient-light", options.ambient_light, *options.words.split()]
    words += ["--bounces", str(room.bounces)] if room.bounces else []
    return program.image(truth.file(room), options.size, [*words, *surroundings(room, program.folder)])


def surroundings(room, folder):
    """What stands around the scene."""
    if room.soft_boxes:
        panorama.write(folder / "boxes.exr")
        return ["--environment", folder / "boxes.exr"]
    return ["--sky", "uniform"] if room.sky else []


def line(room, quality, row, image, seconds):
    over = "" if row["too bright"] is None else f"{100 * row['too bright']:.3f}%"
    at = "{},{}".format(*row["block at"])
    mean = "" if row["mean"] is None else f"{row['mean']:.3f}"
    numbers = f"{row['flip']:6.3f} {row['flip, half size']:6.3f} {row['noise']:6.3f} {mean:>6} {row['block']:6.2f} {at:>9} {row['rms']:6.3f}"
    return f"{room.name:16} {quality:7} {numbers} {over:>7} {np.nanmax(image):8.2g} {seconds:6.2f}"


if __name__ == "__main__":
    sys.exit(main())
