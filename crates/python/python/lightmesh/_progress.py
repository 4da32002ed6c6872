"""Progress bars."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._lightmesh import Progress


def follow(bar: Any) -> Callable[[Progress], None]:
    """A callback for `progress` that moves a bar of tqdm, or one like it: with `n`, `total` and `update`.

    with tqdm(total=1.0) as bar:
        renderer.render(scene, progress=lightmesh.follow(bar))
    """

    def move(progress: Progress) -> None:
        bar.update(progress.done * (bar.total or 1.0) - bar.n)

    return move
