#!/usr/bin/env python3
"""Compares two EXR files with `lightmesh compare` and with the authors' package for HDR-FLIP, and fails if the means differ.

    python3 bench/exports/hdr_flip.py target/release/lightmesh a.exr b.exr

It needs the wheels `flip-evaluator` 1.7, `numpy` and `openexr`.
"""

import json
import subprocess
import sys

import flip_evaluator
import numpy as np
import OpenEXR

# Single precision, in another order.
NEAR = 2e-4


def colors(path):
    channels = OpenEXR.File(path, separate_channels=True).channels()
    return np.ascontiguousarray(np.stack([channels[name].pixels for name in "RGB"], -1), np.float32)


def main():
    program, reference, test = sys.argv[1:]
    ours = json.loads(subprocess.run([program, "compare", reference, test, "--json"], capture_output=True, check=True).stdout)
    # Ours is at 67 pixels per degree, theirs at 67.02 unless told.
    images = [np.maximum(colors(path), 0) for path in (reference, test)]
    _, mean, parameters = flip_evaluator.evaluate(*images, "HDR", applyMagma=False, parameters={"ppd": 67.0})
    exposures = [parameters[key] for key in ("startExposure", "stopExposure", "numExposures")]
    print(f"ours {ours['mean_hdr_flip']:.6f} {ours['hdr_exposures']}, theirs {mean:.6f} {exposures}")
    sys.exit(abs(mean - ours["mean_hdr_flip"]) > NEAR)


if __name__ == "__main__":
    main()
