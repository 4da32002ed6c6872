"""How long other programs take for the error of occluder lists."""

import math
import statistics

from results import row

OURS = "lightmesh lists"
SAMPLES = [4, 16, 64]
"""Numbers of samples of a light at each surface point: a draft, the default, and good quality."""


def rows(images):
    """A row for each program and each of our images, from those of soft shadows of one scene: `ms` and `rmse` are ours, `times` is
    their time over ours. If even most samples leave a larger error, `times` is missing and `rmse_at_best` is theirs; if even fewest leave
    a smaller one, `at_most` is 1."""
    curves = {}
    for image in images:
        point = (image["values"]["rmse"], statistics.median(image["seconds"]["render"]))
        curves.setdefault(image["keys"]["program"], []).append((image["keys"]["samples"], *point))
    ours = {samples: point for samples, *point in curves.pop(OURS)}
    keys = {name: key for name, key in images[0]["keys"].items() if name not in ("program", "samples")}
    found = []
    for samples in SAMPLES:
        for program, curve in curves.items():
            if samples not in ours:
                continue
            error, seconds = ours[samples]
            values = {"rmse": error, "ms": 1000 * seconds, **reached(sorted(curve), error, seconds)}
            found.append(row("programs at equal error", {**keys, "program": program, "samples": samples}, {}, values))
    return found


def reached(curve, error, seconds):
    """What a program takes for an error. Errors and times are roughly powers of the number of samples, so logarithms are interpolated."""
    for index, (_, own_error, own_seconds) in enumerate(curve):
        if own_error > error:
            continue
        if index == 0:
            return {"times": own_seconds / seconds, "at_most": 1}
        _, error_before, seconds_before = curve[index - 1]
        share = math.log(error_before / error) / math.log(error_before / own_error)
        return {"times": seconds_before * (own_seconds / seconds_before) ** share / seconds}
    return {"rmse_at_best": min(own_error for _, own_error, _ in curve)}
