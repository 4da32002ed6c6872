"""Do lightmesh and Embree cast the same rays, with the same results?

Both report how many rays they cast, how many primary rays hit, and for each pixel how many shadow rays reach each light.
"""

import sys

import numpy as np

import rays

TOLERANCE = 1e-4
"""Rays that may end differently, as a share: edges are decided by rounding."""


def check(scene, lightmesh, embree, notes):
    """Compares the two; Embree becomes robust if that is what it takes."""
    found = differences(lightmesh, embree)
    if max(found.values()) > TOLERANCE:
        embree.start("robust")
        found = differences(lightmesh, embree)
    shares = ", ".join(f"{share:.1e} of the {kind} rays" for kind, share in found.items())
    note = f"{scene.name}: lightmesh and Embree ({embree.precision}) differ in {shares}."
    if max(found.values()) > TOLERANCE:
        note = f"MISMATCH: {note} Their times do not compare."
        print(note, file=sys.stderr)
    notes.append(note)


def differences(lightmesh, embree):
    """For each kind, the share of rays that only one of the two casts, or that end differently."""
    shares = {}
    for kind in rays.KINDS:
        traced = embree.ask(kind.split()[0], 16, 1)
        report, visibility = lightmesh.render(kind, with_visibility=True)
        if kind == "primary":
            different = abs(report.rays - traced["rays"]) + abs(report.hits - traced["hits"])
        else:
            samples = rays.SOFT_SAMPLES if kind == "soft shadow" else 1
            reached = np.rint(samples * visibility).reshape(len(visibility), -1)
            different = abs(report.shadow_rays - traced["rays"]) + np.sum(np.abs(reached - embree.reached()))
        shares[kind] = float(different / traced["rays"])
    return shares
