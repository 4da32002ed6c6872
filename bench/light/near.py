"""Lights near a wall against closed forms: what a Lambertian surface of radiance L adds to a wall of reflectance kd,

    kd L / π · ∫ cos θ cos θ' / d² dA

summed over many small pieces of it. A light's intensity is that along its normal, L times its area; a ball's is L π r²."""

from dataclasses import dataclass

import numpy as np

import built
import seen

KD = 0.7
SHARES = (0.1, 0.25, 0.5)
"""Distances from the wall, as shares of the light's length."""
STEP = 3
"""Every so many pixels each way are compared."""
LONG, THIN, SQUARE, DISK, BALL = 1.0, 0.01, 0.5, 0.25, 0.1
RINGS, AROUND = 64, 96
"""Pieces of a disk from its middle to its edge, and of a ball for a quarter of its circumference; and around the middle."""


@dataclass
class Case:
    name: str
    text: str
    """The scene file."""
    points: np.ndarray
    """Middles of the light's pieces."""
    normals: np.ndarray
    areas: np.ndarray
    radiance: float
    hides: bool = False
    """Whether the camera sees it."""

    def true(self, places):
        """What the wall, which faces +z, shows at places on it."""
        way = self.points - places[:, None]
        square = (way**2).sum(axis=-1)
        cosines = np.maximum(way[..., 2], 0) * np.maximum(-(way * self.normals).sum(axis=-1), 0)
        return KD * self.radiance / np.pi * (cosines / square**2 * self.areas).sum(axis=-1)


def cases():
    for share in SHARES:
        yield facing("strip", share, LONG, LONG, THIN)
        yield facing("square", share, SQUARE, SQUARE, SQUARE)
        yield glowing(share)
        yield beside(share)
        yield disk(share)
        yield ball(share)


def facing(name, share, length, width, height):
    light = f'kind = "rectangle"\nposition = [0, 0, {share * length}]\nu = [{width}, 0, 0]\nv = [0, {-height}, 0]\n'
    points = rectangle((width, 0, 0), (0, height, 0), (0, 0, share * length))
    areas = np.full(len(points), width * height / len(points))
    return lit(f"{name} that faces the wall at {share}", light, points, (0, 0, -1), areas, 1 / (width * height))


def beside(share):
    """A strip along the wall that shines down."""
    light = f'kind = "rectangle"\nposition = [0, 0.3, {share * LONG}]\nu = [{LONG}, 0, 0]\nv = [0, 0, {THIN}]\n'
    points = rectangle((LONG, 0, 0), (0, 0, THIN), (0, 0.3, share * LONG))
    areas = np.full(len(points), LONG * THIN / len(points))
    return lit(f"strip along the wall at {share}", light, points, (0, -1, 0), areas, 1 / (LONG * THIN))


def disk(share):
    light = f'kind = "disk"\nposition = [0, 0, {2 * share * DISK}]\ndirection = [0, 0, -1]\nradius = {DISK}\n'
    # Rings of one width: rings of one area would be wide in the middle, where the wall is nearest.
    radii, angles = np.meshgrid((np.arange(RINGS) + 0.5) / RINGS, (np.arange(AROUND) + 0.5) * 2 * np.pi / AROUND)
    points = DISK * np.stack([radii * np.cos(angles), radii * np.sin(angles), np.full(radii.shape, 2 * share)], -1).reshape(-1, 3)
    return lit(f"disk at {share}", light, points, (0, 0, -1), radii.ravel() * 2 * np.pi / (RINGS * AROUND) * DISK**2, 1 / (np.pi * DISK**2))


def ball(share):
    """The distance is that of its surface."""
    away = BALL + 2 * share * BALL
    light = f'kind = "sphere"\nposition = [0, 0, {away}]\nradius = {BALL}\n'
    # Of one width, too.
    down, angles = np.meshgrid((np.arange(2 * RINGS) + 0.5) * np.pi / (2 * RINGS), (np.arange(AROUND) + 0.5) * 2 * np.pi / AROUND)
    normals = np.stack([np.sin(down) * np.cos(angles), np.sin(down) * np.sin(angles), -np.cos(down)], -1).reshape(-1, 3)
    middle = np.array([0, 0, away])
    areas = np.sin(down).ravel() * np.pi / (2 * RINGS) * 2 * np.pi / AROUND * BALL**2
    return lit(f"ball at {share}", light, middle + BALL * normals, normals, areas, 1 / (np.pi * BALL**2))


def glowing(share):
    """An emissive square, which the camera sees from behind, from the side."""
    away = share * SQUARE
    lamp = built.material("lamp", 0, 4.0) + "\n" + built.plane((0, 0, away), (0, 0, -1), (SQUARE, SQUARE), "lamp")
    text = "\n".join([built.camera((1.1, 0.8, 1.3), (0.1, 0.05, 0), 45), wall(), lamp])
    points = rectangle((SQUARE, 0, 0), (0, SQUARE, 0), (0, 0, away))
    name = f"glowing square at {share}"
    return Case(name, text, points, np.array([0, 0, -1.0]), np.full(len(points), SQUARE**2 / len(points)), 4.0, hides=True)


def lit(name, light, points, normals, areas, radiance):
    light = f'[[light]]\n{light}intensity = 1\nfalloff = "inverse-square"\n'
    text = "\n".join([built.camera((0, 0, 2.4), (0, 0, 0), 50), "[ambient]\nintensity = [0, 0, 0]\n", wall(), light])
    return Case(name, text, points, np.array(normals, float), areas, radiance)


def wall():
    return built.material("w", KD) + "\n" + built.plane((0, 0, 0), (0, 0, 1), (8, 8), "w")


def rectangle(u, v, middle):
    """Middles of its pieces: 200 along its length, as many across as makes them squares."""
    lengths = [np.linalg.norm(edge) for edge in (u, v)]
    counts = [max(round(100 * length / max(lengths)), 4) for length in lengths]
    a, b = (((np.arange(count) + 0.5) / count - 0.5) for count in counts)
    return (np.array(middle) + a[:, None, None] * np.array(u) + b[None, :, None] * np.array(v)).reshape(-1, 3)


def error(case, path, image):
    """The largest difference from the closed form, and the root mean square of all, relative to the peak; and the mean ratio."""
    scene = seen.read(path)
    eye = seen.view(scene, (image.shape[1], image.shape[0]))
    found = seen.look(scene, eye)
    wall_only = found.plain(2) & (found.face < 6) if case.hides else found.face >= 0
    wall_only[np.arange(image.shape[0]) % STEP != 0] = False
    wall_only[:, np.arange(image.shape[1]) % STEP != 0] = False
    places = found.point[wall_only]
    true = np.concatenate([case.true(some) for some in np.array_split(places, max(len(places) // 200, 1))])
    shows = image[wall_only].mean(axis=-1)
    off = abs(shows - true) / true.max()
    return float(off.max()), float(np.sqrt((off**2).mean())), float(shows.mean() / true.mean())
