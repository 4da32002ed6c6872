"""Progress bars."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

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
    """

    def move(progress: Progress) -> None:
        bar.update(progress.done * (bar.total or 1.0) - bar.n)

    return move
