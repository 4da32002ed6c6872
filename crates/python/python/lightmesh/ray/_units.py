"""Units of work: what an actor does in one go. A new kind is a class with `name`, `weight` and `run`."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from .._errors import LightmeshError, SaveError

if TYPE_CHECKING:
    from .._lightmesh import _Worker

#: A result that is sent has so many bytes at most: what is larger is published on a disk that all share.
MOST_BYTES = 64 << 20
#: Rows of a band, at least: what surrounds them is looked at, too.
LEAST_ROWS = 64
#: Bands for each actor, at least, if they are not lower than that: so none is waited for long in the end.
BANDS = 16
#: Bytes of a pixel in a band: colours and alpha.
PIXEL_BYTES = 16


@dataclass(frozen=True)
class Chosen:
    """What holds for all frames of a film, as text."""

    text: str


@dataclass(frozen=True)
class Written:
    """A frame: the record of its files as text, and its file's content if the leader is to publish it."""

    files: str
    content: bytes | None


@dataclass(frozen=True)
class Rows:
    """Rows of a picture: linear colours (H, W, 3), alpha (H, W) if there is one, and statistics as text."""

    color: NDArray[np.float32]
    alpha: NDArray[np.float32] | None
    stats: str


Result = Union[Chosen, Written, Rows]


@dataclass(frozen=True)
class Done:
    """What came of a unit, in so many seconds of rendering and of writing, and what was said of it."""

    result: Result
    render: float
    write: float = 0.0
    said: tuple[str, ...] = ()


@dataclass(frozen=True)
class Failed:
    """Why a unit, or a scene, came to nothing: an exception of the package."""

    error: LightmeshError


@dataclass(frozen=True)
class Place:
    """Where an actor writes: the film's pattern, and whether the leader sees it."""

    output: Path | None
    is_shared: bool


class Unit(Protocol):
    """A unit of work."""

    @property
    def name(self) -> str:
        """What messages call it; no two units of a run have the same."""
        ...

    @property
    def weight(self) -> float:
        """Its share of the work, relative to that of others."""
        ...

    def run(self, worker: _Worker, place: Place) -> Done:
        """Does it. The same unit gives the same result wherever it is done."""
        ...


@dataclass(frozen=True)
class Choose:
    """Exposure and step for a whole film, from frames across it."""

    name: str = "the choice of exposure and step"
    weight: float = 1.0

    def run(self, worker: _Worker, place: Place) -> Done:
        return Done(Chosen(worker.choose()), 0.0)


@dataclass(frozen=True)
class Frame:
    """A frame of a film, with what was chosen for all of them."""

    number: int
    chosen: str
    weight: float = 1.0

    @property
    def name(self) -> str:
        return f"frame {self.number}"

    def run(self, worker: _Worker, place: Place) -> Done:
        files, render, write, said = worker.frame(self.number, self.chosen)
        content = None if place.is_shared else self.taken(files, place)
        return Done(Written(files, content), render, write, tuple(said))

    def taken(self, files: str, place: Place) -> bytes:
        """The content of its file, which goes to the leader and not to this node's disk."""
        assert place.output is not None
        (file,) = json.loads(files)
        path = place.output.parent / str(file["file"])
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise SaveError(f"{path.name} has {size} bytes, and at most {MOST_BYTES} are sent; use a folder that all nodes share for the output")
        content = path.read_bytes()
        path.unlink()
        return content


@dataclass(frozen=True)
class Band:
    """Rows of a pass of a picture, which is given as text."""

    render_pass: str
    number: int
    first: int
    rows: int

    @property
    def name(self) -> str:
        again = f" of pass {self.number + 1}" if self.number else ""
        return f"rows {self.first} to {self.first + self.rows - 1}{again}"

    @property
    def weight(self) -> float:
        return float(self.rows)

    def run(self, worker: _Worker, place: Place) -> Done:
        (color, alpha, stats), render = worker.rows(self.render_pass, self.first, self.rows)
        return Done(Rows(color, alpha, stats), render)


def bands(width: int, height: int, actors: int) -> list[int]:
    """The heights of bands, from the top: some for each actor, none of fewer than 64 rows unless the image has no more, none of more than 64 MB."""
    most = max(LEAST_ROWS, MOST_BYTES // (PIXEL_BYTES * width))
    rows = min(most, max(LEAST_ROWS, -(-height // (BANDS * max(actors, 1)))))
    count = max(height // rows, 1)
    least, longer = divmod(height, count)
    while least + 1 > most and height // (count + 1) >= LEAST_ROWS:
        count += 1
        least, longer = divmod(height, count)
    return [least + 1] * longer + [least] * (count - longer)
