#!/usr/bin/env python3
"""What gathered light, lamps and films are held to, and what they reach: a table of all marks.

    python bench/light/marks.py --lightmesh target/release/lightmesh --references FOLDER -o bench/light/marks.json

Values of other builds, sizes, devices and points in the file are kept; `--build NAME` names those that are measured. `--only` takes some of
the points. The exit code is 1 if a mark is not held or a truth is missing. README.md says what each point is.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np

import built
import contact
import measures
import moving
import near
import shown
import times
import truth
from by_lightmesh import Program
from rooms import common, render
from scenes import ROOMS, Scene
from table import markdown, merged, row

ROOT = Path(__file__).resolve().parents[2]
README, BEGIN, END = Path(__file__).with_name("README.md"), "<!-- marks -->", "<!-- end of marks -->"
THICKNESSES, TURNS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5), (0, 10, 20, 30, 45, 55, 70, 85)
SLABS = (0, 0.02, 0.2, 0.3, 3)
SUNS = (0, 0.533, 5, 30, 60, 90, 120, 150, 179)
GATHERED = ["--ambient-light", "mesh"]
DIRECT = ["--ambient-light", "constant", "--ambient", "0"]


class Measurement:
    """Rows of one build, quality, size and device."""

    def __init__(self, options, quality, size, folder):
        self.options, self.quality, self.size, self.folder = options, quality, size, folder
        self.program = Program(options, folder)

    def row(self, point, what, value, size=None, **more):
        return row(self.options.build, point, what, self.quality, size or self.size, self.options.device, value, **more)

    def image(self, text, words, size=None):
        """Of a scene file's text."""
        path = self.folder / "scene.toml"
        path.write_text(text)
        return self.program.image(path, size or self.size, ["--quality", self.quality, *words])[1]

    def rooms(self):
        for room in ROOMS:
            if room.name == "sealed" or (self.options.scenes and room.name not in self.options.scenes):
                continue
            self.options.size = self.size
            try:
                true = truth.of(room, self.program.run, self.folder, self.options)
            except truth.Missing as missing:
                # Other scenes may have theirs, but not all is measured.
                print(missing, file=sys.stderr)
                self.options.missing = True
                continue
            seconds, image = render(room, self.program, self.quality, self.options)
            found = measures.all_of(room, true, image)
            if self.options.pictures:
                self.keep(room, true, image)
            more = {"noise": found["noise"], "whole": found["flip to both"], "seconds": seconds}
            if room.outdoors:
                yield self.row("open air: FLIP less the noise", room.name, found["flip"], **more)
            else:
                yield self.row("indoors and glowing things: FLIP less the noise", room.name, found["flip"], **more)
                yield self.row("the same, averaged to half size", room.name, found["flip, half size"])
            yield self.row("mean radiance to the truth", room.name, found["mean"])
            yield self.row("worst block of 8×8 pixels", room.name, found["block"], at=found["block at"], rms=found["rms"])
            if found["too bright"] is not None:
                yield self.row("share of pixels above energy", room.name, found["too bright"])
            if room.name == "tables":
                for height, ratio, pixels in contact.ratios(truth.file(room), true.mean, image):
                    yield self.row("contact under low tables", f"table of {height} m", ratio, pixels=pixels)

    def keep(self, room, true, image):
        folder, size = self.options.pictures, "x".join(map(str, self.size))
        folder.mkdir(parents=True, exist_ok=True)
        shown.keep(folder / f"{room.name}-{size}-truth.png", true.mean, room.exposure)
        shown.keep(folder / f"{room.name}-{size}-{self.quality}-{self.options.build}.png", image, room.exposure)

    def sealed(self):
        for thickness in THICKNESSES:
            for turn in TURNS:
                image = self.image(built.sealed(thickness, turn), [*GATHERED, "--sky", "uniform"])
                yield self.row("sealed rooms, largest radiance", f"{thickness} m, {turn}°", float(image.max()))

    def sealed_small(self):
        for number, thickness in enumerate(THICKNESSES):
            turn = TURNS[number]
            image = self.image(built.sealed(thickness, turn), [*GATHERED, "--sky", "uniform"], (160, 120))
            yield self.row("sealed rooms, largest radiance", f"{thickness} m, {turn}°", float(image.max()), (160, 120))

    def sealed_rays(self):
        for thickness, turn in ((0.02, 30), (0.3, 0)):
            image = self.image(built.sealed(thickness, turn), ["--ambient-light", "rays", "--sky", "uniform"], (160, 120))
            yield self.row("sealed rooms by rays, largest radiance", f"{thickness} m, {turn}°", float(image.max()), (160, 120))

    def slabs(self):
        for thickness in SLABS:
            low, high = contact.spread(self.image(built.floor(thickness), [*GATHERED, "--sky", "uniform"]), 0.75)
            worst = low if 1 - low > high - 1 else high
            yield self.row("open floor of any thickness", f"{thickness or 'sheet'}", worst, low=low, high=high)

    def near(self):
        for case in near.cases():
            words = GATHERED if case.hides else DIRECT
            image = self.image(case.text, [*words, "--aa", "1"])
            off, rms, mean = near.error(case, self.folder / "scene.toml", image)
            yield self.row("near lights, of the peak", case.name, off, rms=rms, mean=mean)

    def suns(self):
        for angle in SUNS:
            image = self.image(built.sun(angle), DIRECT)
            worst = max(image.min(), image.max(), key=lambda value: abs(value - 1))
            yield self.row("suns of 0–179°", f"{angle}°", float(worst))

    def films(self):
        def film(name, *more):
            path = truth.FOLDER / f"{name}.toml"
            return path, moving.frames(self.program, path, self.size, [*GATHERED, "--quality", self.quality, *more])

        largest, most = moving.of_wall(*film("film-ball", "--sky", "uniform"))
        yield self.row("static wall of a film", "film-ball", largest, p999=most)
        for name, more in (("film-dolly-door", []), ("film-dolly-window", ["--sky", "uniform"])):
            yield self.row("moving camera, p99", name, moving.of_dolly(*film(name, *more)))

    def piles(self):
        def seconds(count, key, words):
            path = self.folder / f"pile{count}.toml"
            path.write_text(built.pile(count, key))
            return lambda: self.program.seconds(path, (64, 48), ["--quality", self.quality, *words])

        for point, key, counts, words in (
            ("12 panes : 4", built.PANE, (12, 4), ["--bounces", "2"]),
            ("40 veils : 10", built.VEIL, (40, 10), []),
        ):
            value, first, second = times.ratio(*(seconds(count, key, words) for count in counts), turns=1 if self.options.hasty else 3)
            yield self.row(point, "64×48", value, (64, 48), seconds=[first, second])

    def times(self):
        if not self.options.against:
            return
        old = Program(self.options, self.folder, self.options.against)
        words = ["--quality", self.quality, *GATHERED]
        for name in times.ROOMS:
            room = next(room for room in ROOMS if room.name == name)
            yield self.beside(name, old, truth.file(room), [*words, *(["--sky", "uniform"] if room.sky else [])])
        for name, (source, more) in times.OTHERS.items():
            file = Scene(name, source, 0).file(ROOT, self.options.models)
            yield self.beside(name, old, file, [*words, *more])

    def beside(self, name, old, file, words):
        value, new, before = times.ratio(*(lambda program=program: program.seconds(file, self.size, words) for program in (self.program, old)))
        return self.row("time beside another build", name, value, seconds=[new, before])


GROUPS = ("rooms", "sealed", "sealed_small", "sealed_rays", "slabs", "near", "suns", "films", "piles", "times")
ONE_SIZE = ("sealed_small", "sealed_rays", "piles")
"""Have a size of their own."""


def main():
    options = arguments()
    rows = json.loads(options.output.read_text())["rows"] if options.output and options.output.exists() else []
    for number, size in enumerate(options.sizes):
        for quality in options.qualities:
            for group in options.only:
                if group in ONE_SIZE and number:
                    continue
                with tempfile.TemporaryDirectory() as folder:
                    made = []
                    for one in getattr(Measurement(options, quality, tuple(size), Path(folder)), group)():
                        made.append(one)
                        print(f"{one['point']}: {one['what']}, {quality}, {one['size'][0]}×{one['size'][1]}: {one['value']:.4g}", flush=True)
                rows = merged(rows, made)
                if options.output:
                    options.output.write_text(written(rows))
    table = markdown(rows, options.build, options.before)
    print(table)
    if options.readme:
        before, _, rest = README.read_text().partition(BEGIN)
        README.write_text(f"{before}{BEGIN}\n{table}\n{END}{rest.partition(END)[2]}")
    return int(options.missing or any(row["holds"] is False for row in rows if row["build"] == options.build))


def written(rows):
    lines = (json.dumps(rounded(row), ensure_ascii=False) for row in rows)
    return '{"rows": [\n ' + ",\n ".join(lines) + "\n]}\n"


def rounded(value):
    """Four digits are what measurements are worth."""
    if isinstance(value, float):
        return float(f"{value:.4g}")
    if isinstance(value, dict):
        return {name: rounded(one) for name, one in value.items()}
    return [rounded(one) for one in value] if isinstance(value, list) else value


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    common(parser)
    add = parser.add_argument
    add("-o", "--output", type=Path, help="a JSON file with the values; those that are not measured now are kept")
    add("--build", default="now", help="what to call this build's values")
    add("--before", default="before", help="the build that the table shows beside it")
    add("--only", nargs="*", choices=GROUPS, default=GROUPS, help="points; none prints the table of what is in the file")
    add("--readme", action="store_true", help="write the table into README.md")
    add("--scenes", nargs="+", help="of rooms")
    add("--sizes", nargs="+", type=lambda text: [int(one) for one in text.split("x")], default=[[320, 240], [1280, 960]], help="as 320x240")
    add("--qualities", nargs="*", default=["good", "final"], help="Lightmesh's")
    add("--against", type=Path, help="another build of the program, for times")
    add("--models", type=Path, default=ROOT / "../shared/scenes", help="a folder with models")
    add("--hasty", action="store_true", help="times of panes and veils from a single run")
    options = parser.parse_args()
    options.missing = False
    return options


if __name__ == "__main__":
    sys.exit(main())
