"""Progress bars."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

from ._errors import ArgumentError
from ._lightmesh import Progress


class Bar(Protocol):
    """A bar of tqdm, or one like it."""

    @property
    def n(self) -> float:
        """Where it is."""

    @property
    def total(self) -> float | None:
        """Where it ends."""

    def update(self, n: float, /) -> object:
        """Moves it by so much."""


def follow(bar: Bar) -> Callable[[Progress], None]:
    """A callback for `progress` that moves a `bar` of tqdm, or one like it: with `n`, `total` and `update`.

    with tqdm(total=1.0) as bar:
        renderer.render(scene, progress=lightmesh.follow(bar))

    It moves by about a thousandth of its `total` at least, so that plain bars show short numbers.
    """
    missing = [name for name in ("n", "total", "update") if not hasattr(bar, name)]
    if missing:
        raise ArgumentError(f"bar: give a bar of tqdm, or one like it, not {type(bar).__name__}, which has no {', '.join(missing)}")

    def move(progress: Progress) -> None:
        bar.update(_way(bar.n, _place(progress.done, bar.total or 1.0)))

    return move


def _place(done: float, total: float) -> float:
    """Where a bar is that ends at `total`: with a digit for about a thousandth of it."""
    digits = max(0, 3 - round(math.log10(abs(total))))
    return total if done >= 1.0 else round(done * total, digits)


def _way(n: float, place: float) -> float:
    """What leads from `n` to `place`: their difference can be off by a last digit, which bars would show as many."""
    way = place - n
    while n + way < place:
        way = math.nextafter(way, math.inf)
    while n + way > place:
        way = math.nextafter(way, -math.inf)
    return way
