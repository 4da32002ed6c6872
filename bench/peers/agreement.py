"""Do lightmesh and Embree cast the same rays, with the same results?

Lightmesh reports how many rays it casts, and how many primary rays hit. How many shadow rays reach a light is read from its pictures
of one light at a time: a pixel's value, relative to what it would be without shadows, is a multiple of 1 / samples.
"""

import itertools
import sys
from dataclasses import replace

import flip_evaluator
import numpy as np

import rays
from scene import KD

TOLERANCE = 1e-4
"""Rays that may end differently, as a share: edges are decided by rounding."""
GRID = 8
"""Points along a light's edge from which its unshadowed light is computed."""


def check(plan, scene, folder, embree, notes):
    """Compares the two; Embree becomes robust if that is what it takes."""
    found = differences(plan, scene, folder, embree)
    if max(found.values()) > TOLERANCE:
        embree.start("robust")
        found = differences(plan, scene, folder, embree)
    shares = ", ".join(f"{share:.1e} of the {kind} rays" for kind, share in found.items())
    note = f"{scene.name}: lightmesh and Embree ({embree.precision}) differ in {shares}."
    if max(found.values()) > TOLERANCE:
        note = f"MISMATCH: {note} Their times do not compare."
        print(note, file=sys.stderr)
    notes.append(note)


def differences(plan, scene, folder, embree):
    """For each kind, the share of rays that only one of the two casts, or that end differently."""
    shares = {}
    for kind in rays.KINDS:
        lightmesh = rays.Lightmesh(plan, scene, folder, 1)
        traced = embree.ask(kind.split()[0], 16, 1)
        counts = lightmesh.render(kind)["counts"]
        if kind == "primary":
            different = abs(counts["rays"] - traced["rays"]) + abs(counts["hits"] - traced["hits"])
        else:
            different = abs(counts["shadow_rays"] - traced["rays"]) + unlike(plan, scene, folder, kind, embree.surface())
        shares[kind] = different / traced["rays"]
    return shares


def unlike(plan, scene, folder, kind, surface):
    """How many more or fewer rays reach the lights, summed over pixels and lights."""
    points, normals, lit = surface
    samples = rays.SOFT_SAMPLES if kind == "soft shadow" else 1
    total = 0
    for number, light in enumerate(scene.lights):
        # All lights stay, so that each keeps the pattern of its number.
        lights = [replace(other, intensity=light.intensity if other is light else 0) for other in scene.lights]
        alone = replace(scene, lights=lights, file=folder / "alone.toml")
        alone.write()
        path = folder / "alone.exr"
        rays.Lightmesh(plan, alone, folder, 1).render(kind, path)
        picture = flip_evaluator.load(str(path))[..., 0].ravel()
        unshadowed, clear = without_shadow(light, points, normals)
        shares = np.divide(picture, unshadowed, out=np.zeros_like(unshadowed), where=clear)
        total += np.sum(np.abs(np.rint(samples * shares) - lit[:, number])[clear])
    return total


def without_shadow(light, points, normals):
    """What a light adds to each pixel if nothing hides it, and whether all of it is above the horizon there."""
    total, clear = np.zeros(len(points)), np.any(normals != 0, axis=1)
    steps = (np.arange(GRID) + 0.5) / GRID - 0.5
    for a, b in itertools.product([*steps, -0.5, 0.5], repeat=2):
        ways = light.position + a * light.u + b * light.v - points
        distance = np.linalg.norm(ways, axis=1)
        height = np.sum(normals * ways, axis=1)
        if max(abs(a), abs(b)) < 0.5:
            total += np.maximum(height, 0) / distance**3
        else:
            clear &= height > 0
    return KD * light.intensity / np.pi * total / GRID**2, clear
