#!/usr/bin/env python3
"""Do the judges judge right? Closed forms beside Mitsuba, its two ways beside each other, and measures that must find an error.

    python bench/light/check.py --lightmesh target/release/lightmesh

Takes two minutes; the exit code is 1 if something does not agree.
"""

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

import built
import contact
import measures
import near
import seen
import truth
from by_lightmesh import Camera, Program
from by_mitsuba import Mitsuba
from rooms import common
from scenes import ROOMS

SIZE = [160, 120]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    common(parser)
    options = parser.parse_args()
    options.size = SIZE
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, holds, found in checks(options, Path(folder)):
            print(f"{'agrees' if holds else 'DIFFERS'}: {name}: {found}", flush=True)
            failed += not holds
    return int(failed > 0)


def checks(options, folder):
    program = Program(options, folder)
    yield from measured()
    yield from lines_of_sight(program)
    yield from pieces()
    yield from closed(program)
    yield from ways(program)


def measured():
    """Measures of a grey image with one block that is too bright."""
    room = next(room for room in ROOMS if room.name == "white-on-white")
    random = np.random.default_rng(0)
    true = [np.float32(0.5 + 0.01 * random.normal(size=(*SIZE[::-1], 3))) for _ in range(2)]
    image = (true[0] + true[1]) / 2
    same = measures.all_of(room, truth.Truth(*true), image)
    yield "an image like the truth", abs(same["flip"]) < 0.5 * same["noise"] and abs(same["block"] - 1) < 1e-6 and same["too bright"] == 0, same
    image = image.copy()
    image[40:48, 80:88] *= 1.6
    other = measures.all_of(room, truth.Truth(*true), image)
    holds = abs(other["block"] - 1.6) < 1e-3 and other["block at"] == [84, 44] and abs(other["too bright"] * 120 * 160 - 64) < 3
    yield "a block that is too bright is found", holds, other


def lines_of_sight(program):
    """Where `seen.py` sees a surface, its point and its face's normal are those of Lightmesh's layers."""
    import OpenEXR

    for name in ("tables", "film-dolly-door"):
        path = truth.FOLDER / f"{name}.toml"
        layers = program.folder / "layers.exr"
        program.image(path, SIZE, ["--mode", "ray-trace", "--aa", "1", "--layers", layers])
        channels = OpenEXR.File(str(layers), separate_channels=True).channels()
        there = np.stack([channels[f"P.{axis}"].pixels for axis in "XYZ"], -1)
        scene = seen.read(path)
        found = seen.look(scene, seen.view(scene, SIZE))
        here = (found.face >= 0) & (channels["Z"].pixels < 1e6)
        off = np.linalg.norm(found.point - there, axis=-1)[here]
        missing = float(((found.face >= 0) != np.isfinite(channels["Z"].pixels)).mean())
        # Balls have facets there.
        share = float((off > 0.02).mean())
        yield f"what is seen in {name}", share < 1e-3 and missing < 1e-3, f"{share:.5f} elsewhere, {missing:.5f} missing"


def pieces():
    """On the axis of a disk, or of a ball, a wall shows kd L sin² α, α half the angle at which it is seen."""
    for case in near.cases():
        kind, _, share = case.name.partition(" at ")
        if kind in ("disk", "ball"):
            size = near.DISK if kind == "disk" else near.BALL
            away = 2 * float(share) * size
            square = size**2 / (size**2 + away**2) if kind == "disk" else size**2 / (size + away) ** 2
            off = float(case.true(np.zeros((1, 3)))[0] / (near.KD * case.radiance * square) - 1)
            yield f"pieces of a {case.name}", abs(off) < 0.003, f"{off:+.5f}"


def closed(program):
    """Mitsuba's open floor, and its glowing square near a wall."""
    path = program.folder / "scene.toml"
    path.write_text(built.floor(0.2))
    floor = mitsuba(program, path, sky=1.0)
    mean = float(floor.render(64, 1, floor.endless)[1].mean())
    yield "Mitsuba's floor under an even sky shows 0.75", abs(mean - 0.75) < 0.003, f"{mean:.4f}"
    path.write_text(built.floor(0))
    low, high = contact.spread(program.image(path, SIZE, ["--sky", "uniform", "--ambient-light", "mesh"])[1], 0.75)
    yield "Lightmesh's, too, as a sheet", max(1 - low, high - 1) < 0.01, f"{low:.4f} to {high:.4f} of it"
    for case in near.cases():
        if case.hides:
            path.write_text(case.text)
            wall = mitsuba(program, path)
            _, rms, mean = near.error(case, path, wall.mean(1024, 64, wall.endless).astype(np.float32))
            # Its noise is that of each pixel.
            yield f"Mitsuba's {case.name}", rms < 0.015 and abs(mean - 1) < 0.005, f"{rms:.4f} of the peak, mean {mean:.4f}"


def ways(program):
    """A glowing opening and the sky behind it; paths from lights and from the camera: block by block the same light."""
    room = next(room for room in ROOMS if room.name == "room-window")
    images = {}
    for name, other, hidden in (("sky", replace(room, opening=None), False), ("opening", room, False), ("from lights", room, True)):
        one = Mitsuba(truth.given(other, program.run, program.folder), program.options)
        images[name] = one.mean(512, 64, one.particles if hidden else one.endless)
    white = 2.0**-room.exposure
    means = {name: measures.blocks(np.minimum(image, white), 20).mean(axis=-1) for name, image in images.items()}
    for name in ("opening", "from lights"):
        ratio = means[name] / means["sky"]
        whole = float(means[name].mean() / means["sky"].mean())
        holds = abs(whole - 1) < 0.01 and abs(np.median(ratio) - 1) < 0.02
        yield f"a window by its {name} and by the sky", holds, f"mean {whole:.4f}, blocks {ratio.min():.3f} to {ratio.max():.3f}"


def mitsuba(program, path, sky=None):
    """Of a scene file."""
    import model

    whole, diffuse = program.folder / "whole.glb", program.folder / "diffuse.glb"
    program.run("export", path, "-o", whole)
    model.make_diffuse(whole, diffuse)
    eye = seen.view(seen.read(path), SIZE)
    camera = Camera(eye.position, eye.axes[0], np.array([0, 1.0, 0]), eye.vfov)
    return Mitsuba(truth.Given(model.read(diffuse), camera, None, sky_radiance=sky), program.options)


if __name__ == "__main__":
    sys.exit(main())
