"""The marks, and what was measured beside them."""

from dataclasses import dataclass
from typing import Callable

EITHER = ("good", "final")


@dataclass(frozen=True)
class Mark:
    """What a point is held to."""

    point: str
    bounds: dict
    """By quality; those that have none are not held to anything."""
    words: str
    off: Callable = lambda value: value
    """How far a value is off, which is compared with the bound."""


def from_one(value):
    return abs(value - 1)


MARKS = [
    Mark("open air: FLIP less the noise", {"good": 0.015, "final": 0.010}, "≤ .015 / .010"),
    Mark("indoors and glowing things: FLIP less the noise", {"good": 0.045, "final": 0.03}, "≤ .045 / .03"),
    Mark("the same, averaged to half size", {"good": 0.035, "final": 0.025}, "≤ .035 / .025"),
    Mark("mean radiance to the truth", dict.fromkeys(EITHER, 0.03), ".97–1.03", from_one),
    Mark("worst block of 8×8 pixels", {"good": 0.25, "final": 0.12}, "within 25 / 12 %", from_one),
    Mark("share of pixels above energy", dict.fromkeys(EITHER, 0.0), "0"),
    Mark("sealed rooms, largest radiance", dict.fromkeys(EITHER, 0.0), "exactly 0"),
    Mark("sealed rooms by rays, largest radiance", dict.fromkeys(EITHER, 0.0), "exactly 0"),
    Mark("contact under low tables", dict.fromkeys(EITHER, 0.08), "±8 %", from_one),
    Mark("open floor of any thickness", dict.fromkeys(EITHER, 0.002), "±.2 % a pixel", from_one),
    Mark("near lights, of the peak", dict.fromkeys(EITHER, 0.02), "±2 %"),
    Mark("suns of 0–179°", dict.fromkeys(EITHER, 0.005), "±.5 %", from_one),
    Mark("static wall of a film", dict.fromkeys(EITHER, 0.02), "≤ 2 % a frame"),
    Mark("moving camera, p99", dict.fromkeys(EITHER, 0.03), "≤ 3 %"),
    Mark("12 panes : 4", dict.fromkeys(EITHER, 6.0), "≤ 6 ×"),
    Mark("40 veils : 10", dict.fromkeys(EITHER, 8.0), "≤ 8 ×"),
    Mark("time beside another build", {"good": 2.0, "final": 4.0}, "≤ 2 × / 4 ×"),
]
POINTS = {mark.point: mark for mark in MARKS}


def row(build, point, what, quality, size, device, value, **more):
    """A measured value, and whether it holds; `what` is the scene or case."""
    mark = POINTS[point]
    bound = mark.bounds.get(quality)
    holds = None if bound is None else bool(mark.off(value) <= bound)
    keys = {"build": build, "point": point, "what": what, "quality": quality, "size": list(size), "device": device}
    return {**keys, "value": value, "holds": holds, **more}


def same(one, other):
    return all(one[key] == other[key] for key in ("build", "point", "what", "quality", "size", "device"))


def merged(old, new):
    """New rows take the place of old ones of the same thing."""
    return [row for row in old if not any(same(row, other) for other in new)] + new


def markdown(rows, build, before):
    """A line for each point: the worst of its values, where it is, and the one before."""
    lines = [
        f"| point | {build}, good | final | mark | holds | where it is worst | {before}, good |",
        "|---|--:|--:|---|---|---|--:|",
    ]
    for mark in MARKS:
        found = {quality: worst(rows, mark, build, quality) for quality in EITHER}
        if not any(found.values()):
            continue
        here = [row for row in rows if row["build"] == build and row["point"] == mark.point and row["holds"] is not None]
        held = sum(row["holds"] for row in here)
        holds = "yes" if held == len(here) else f"no: {held} of {len(here)}"
        where = "; ".join(dict.fromkeys(place(row) for row in found.values() if row))
        old = worst(rows, mark, before, "good")
        cells = [mark.point, *(number(found[quality]) for quality in EITHER), mark.words, holds, where, number(old)]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def worst(rows, mark, build, quality):
    of = [row for row in rows if (row["build"], row["point"], row["quality"]) == (build, mark.point, quality)]
    return max(of, key=lambda row: mark.off(row["value"]), default=None)


def place(row):
    return f"{row['what']}, {row['size'][0]}×{row['size'][1]}, {row['device']}"


def number(row):
    return "" if row is None else f"{row['value']:.3g}"
