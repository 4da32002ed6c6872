"""What a scene of `scenes/` looks like: paths of any length by Mitsuba, by two seeds, whose difference is the noise of either."""

import hashlib
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import model
import panorama
from by_lightmesh import Camera
from by_mitsuba import Mitsuba
from shown import flip

FOLDER = Path(__file__).parent / "scenes"
PATHS = 32 * 320 * 240
"""In one go: memory."""
CHECKED = 128
"""Samples of a pixel after which the noise is looked at."""


@dataclass
class Given:
    """What Mitsuba gets."""

    model: model.Model
    camera: Camera
    panorama: np.ndarray | None
    suns: tuple = ()
    sky_radiance: float | None = None
    """The same in all directions."""


@dataclass
class Truth:
    """Two images of the same number of samples, by different seeds."""

    first: np.ndarray
    second: np.ndarray

    @property
    def mean(self):
        return (self.first + self.second) / 2


class Missing(Exception):
    """There is no truth of a scene and size, and no time to render it."""


def file(room):
    return FOLDER / f"{room.name}.toml"


def given(room, lightmesh, folder):
    """The triangles are those of `lightmesh export`."""
    whole, diffuse = folder / "whole.glb", folder / "diffuse.glb"
    lightmesh("export", file(room), "-o", whole)
    model.make_diffuse(whole, diffuse, keep_facets=True)
    view = tomllib.loads(file(room).read_text())["camera"]
    place = np.array(view["position"], float)
    along = np.array(view["target"], float) - place
    camera = Camera(place, along / np.linalg.norm(along), np.array(view.get("up", [0, 1, 0]), float), view["vfov"])
    # Mitsuba's column 0 is where this one's middle is.
    around = np.roll(panorama.soft_boxes(), panorama.COLUMNS // 2, axis=1) if room.soft_boxes else None
    made = Given(model.read(diffuse), camera, around)
    if room.opening:
        made.model.parts.append(glowing(*map(np.array, room.opening), place))
    elif room.sky:
        made.sky_radiance = 1.0
    return made


def glowing(low, high, inside):
    """A rectangle of radiance 1 that shines to the side where `inside` is."""
    across = int(np.argmin(high - low))
    first, second = ((across + step) % 3 for step in (1, 2))
    corners = np.array([low, low, high, high], float)
    corners[1, first], corners[3, first] = high[first], low[first]
    triangles = [[0, 1, 2], [0, 2, 3]] if inside[across] > low[across] else [[0, 2, 1], [0, 3, 2]]
    material = model.Material(np.zeros(3, np.float32), np.ones(3, np.float32))
    return model.Part(corners.astype(np.float32), np.array(triangles, np.uint32), material)


def of(room, lightmesh, folder, options):
    """The kept truth. If `options.minutes` is not 0, samples are added until the noise is below `options.noise`, or the time has passed."""
    width, height = options.size
    kept = options.references / f"{room.name}-{width}x{height}.npz"
    sums, samples = stored(kept, room, options.size)
    if not samples and not options.minutes:
        raise Missing(f"{kept}: there is no truth of this scene and size; --minutes 10 renders it, with Mitsuba")
    if options.minutes and (not samples or noise(room, sums, samples) > options.noise):
        mitsuba, end = Mitsuba(given(room, lightmesh, folder), options), time.monotonic() + 60 * options.minutes
        integrator, at_once = mitsuba.particles if room.hidden else mitsuba.endless, max(PATHS // (width * height), 1)
        while not samples or (time.monotonic() < end and noise(room, sums, samples) > options.noise):
            for _ in range(CHECKED // at_once if samples else 1):
                for half in (0, 1):
                    # Seeds that no other call uses, whatever the number of samples that are kept.
                    seed = 2 * (samples // at_once) + half
                    sums[half] += at_once * mitsuba.render(at_once, seed, integrator)[1].astype(np.float64)
                samples += at_once
                if time.monotonic() > end:
                    break
        options.references.mkdir(parents=True, exist_ok=True)
        halves = [np.float32(one / samples) for one in sums]
        np.savez_compressed(kept, first=halves[0], second=halves[1], samples=samples, digest=digest(room))
        print(f"{room.name}: {samples} samples, noise {noise(room, sums, samples):.4f}", flush=True)
    return Truth(*(np.float32(one / samples) for one in sums))


def stored(kept, room, size):
    """Sums over samples of both seeds, and how many samples."""
    if kept.exists():
        found = np.load(kept)
        if found["digest"] == digest(room):
            samples = int(found["samples"])
            return [samples * found[name].astype(np.float64) for name in ("first", "second")], samples
    return [np.zeros((size[1], size[0], 3)) for _ in range(2)], 0


def digest(room):
    """Of all that the truth depends on."""
    return hashlib.sha256(file(room).read_bytes() + repr((room.sky, room.soft_boxes, room.opening)).encode()).hexdigest()


def noise(room, sums, samples):
    return flip(*(one / samples for one in sums), room.exposure)
