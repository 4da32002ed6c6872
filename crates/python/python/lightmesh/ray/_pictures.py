"""Pictures: their rows are rendered by many, and put together by the leader."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._lightmesh import _BandedPicture
from ._actors import Job
from ._files import Files
from ._kept import GivenBand, Kept, gaps
from ._leader import Leader, Setup
from ._report import Progress, Report
from ._request import scene_path, settings, share
from ._units import Band, Result, Rows, Unit, bands

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ..typing import Path as AnyPath
    from ._settings import PictureRequest


def picture(
    scene: AnyPath,
    output: AnyPath | None = None,
    *,
    address: str | None = None,
    cpus_per_actor: float = 1,
    gpus_per_actor: float = 0,
    actors: int | None = None,
    ship: bool = False,
    resume: bool = False,
    on_progress: Callable[[Progress], object] | None = None,
    **request: Unpack[PictureRequest],
) -> Report:
    """Renders a picture of `scene`, a file, to `output` in bands of 64 rows or more, on the cluster at `address`. Without an output, the report has
    it as its `image`. The leader needs memory for the whole: about 50 bytes for each pixel.

    `cpus_per_actor`, `gpus_per_actor`, `actors`, `ship`, `on_progress` and the other keywords are as in `film`. Bands that are finished stay in a folder
    beside the output, named like it with `.bands` at the end, until the picture is written. If its leader dies, the same call with `resume=True` goes on
    with those; without `resume`, or with another scene or other settings, they are rendered anew.
    """
    given = settings(request)
    each = share(cpus_per_actor, gpus_per_actor, given.get("device"))
    whole = _BandedPicture(scene, output, given)
    leader = Leader(each, actors, address, on_progress)
    leader.report.notes = whole.notes
    kept = Kept(None if output is None else Path(output), resume, whole.request, whole.inputs)
    is_finished = False
    try:
        files = Files(whole.inputs, None, ship)
        job = Job(scene_path(scene), None, whole.request, files.digest, files.shipped_as, False, each.gpus, files.run)
        leader.begin(Setup(files, lambda _: job, lambda _: False))
        image, said = whole.render(lambda text: render(leader, text, kept))
        is_finished = True
        leader.report.notes += [sentence for sentence in said if sentence not in leader.report.notes]
        leader.report.image = image if output is None else None
    finally:
        kept.close(is_finished)
        leader.close()
    return leader.report


def render(leader: Leader, render_pass: str, kept: Kept) -> list[GivenBand]:
    """Has the rows of a pass rendered that are not kept."""
    told = json.loads(render_pass)
    _, top, width, height = told["area"]
    whole = range(top, top + height)
    found = kept.found(render_pass, width, whole)
    leader.report.kept += len(found)
    units = []
    for gap in gaps(whole, found):
        first = gap.start
        for rows in bands(width, len(gap), leader.most_actors()):
            units.append(Band(render_pass, told["number"], first, rows))
            first += rows

    def take(unit: Unit, result: Result) -> None:
        assert isinstance(unit, Band) and isinstance(result, Rows)
        # A copy of its own leaves the store's memory to others.
        alpha = None if result.alpha is None else np.array(result.alpha)
        band = (unit.first, np.array(result.color), alpha, result.stats)
        kept.add(render_pass, band)
        found.append(band)

    number, count = told["number"], told["of"]
    leader.run(units, take, (number / count, (number + 1) / count))
    return found
