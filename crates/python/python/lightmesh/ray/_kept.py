"""Bands of a picture that stay on disk until it is finished, so that a new leader goes on with them.

They are in a folder beside the picture, `NAME.bands`, a file each. Its name begins with a digest of all that decides the rows: the version, the request, the
files of the scene, the pass. A file is there as a whole or not at all.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
import tempfile
import zipfile
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._errors import SaveError
from .._lightmesh import __version__

#: A band: its first row, colours, alpha, and statistics as text.
GivenBand = tuple[int, NDArray[np.float32], "NDArray[np.float32] | None", str]

#: Characters of a digest.
DIGITS = 24
#: What the folder's name adds to the picture's.
SUFFIX = ".bands"


class Kept:
    """The folder of a picture's bands; without an output there is none."""

    def __init__(self, output: Path | None, resume: bool, request: str, inputs: Iterable[tuple[Path, int, str]]) -> None:
        self.folder = None if output is None else output.with_name(output.name + SUFFIX)
        #: Bands are written beside the work.
        self._writer = ThreadPoolExecutor(1)
        self._written: list[Future[None]] = []
        self._decides = repr((__version__, request, [(size, digest) for _, size, digest in inputs]))
        if self.folder is not None and not resume:
            remove(self.folder)

    def found(self, render_pass: str, width: int, rows: range) -> list[GivenBand]:
        """The bands of a pass that are there, from the top, of which none meets another."""
        bands: list[GivenBand] = []
        if self.folder is None or not self.folder.is_dir():
            return bands
        key, next_row = self._key(render_pass), rows.start
        named = (re.fullmatch(rf"{key}\.(-?\d+)\.npz", path.name) for path in self.folder.iterdir())
        for first in sorted(int(match[1]) for match in named if match):
            band = read(self._path(key, first), first, width)
            if band is not None and first >= next_row and first + len(band[1]) <= rows.stop:
                bands.append(band)
                next_row = first + len(band[1])
        return bands

    def add(self, render_pass: str, band: GivenBand) -> None:
        """Keeps a band. Raises why one before could not be kept."""
        for writing in [writing for writing in self._written if writing.done()]:
            self._written.remove(writing)
            writing.result()
        if self.folder is not None:
            self._written.append(self._writer.submit(self._write, self.folder, self._path(self._key(render_pass), band[0]), band))

    def close(self, is_finished: bool) -> None:
        """Ends when all is written. Of a picture that is finished nothing stays."""
        self._writer.shutdown()
        if self.folder is not None and is_finished:
            remove(self.folder)

    @staticmethod
    def _write(folder: Path, path: Path, band: GivenBand) -> None:
        _, color, alpha, stats = band
        told = np.frombuffer(stats.encode(), np.uint8)
        try:
            folder.mkdir(exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=folder, suffix=".part", delete=False) as file:
                if alpha is None:
                    np.savez(file, color=color, stats=told)
                else:
                    np.savez(file, color=color, stats=told, alpha=alpha)
            os.replace(file.name, path)
        except OSError as error:
            raise SaveError(f"cannot keep rows of the picture in {folder} ({error}); give the output a folder with room for 16 bytes a pixel") from error

    def _key(self, render_pass: str) -> str:
        return hashlib.sha256(f"{self._decides}{render_pass}".encode()).hexdigest()[:DIGITS]

    def _path(self, key: str, first: int) -> Path:
        assert self.folder is not None
        return self.folder / f"{key}.{first}.npz"


def read(path: Path, first: int, width: int) -> GivenBand | None:
    """The band in a file; `None` if it is damaged, which makes it one that is not there."""
    with contextlib.suppress(OSError, ValueError, KeyError, zipfile.BadZipFile), np.load(path, allow_pickle=False) as arrays:
        color, stats = arrays["color"], arrays["stats"].tobytes().decode()
        alpha = arrays["alpha"] if "alpha" in arrays else None
        if color.dtype == np.float32 and color.ndim == 3 and color.shape[1:] == (width, 3):
            return first, color, alpha, stats
    return None


def remove(folder: Path) -> None:
    """Removes a folder of bands. One that is something else stays."""
    if folder.is_dir() and all(path.suffix in (".npz", ".part") for path in folder.iterdir()):
        shutil.rmtree(folder, ignore_errors=True)


def gaps(rows: range, bands: Iterable[GivenBand]) -> list[range]:
    """The rows that no band has."""
    left, next_row = [], rows.start
    for first, color, _, _ in bands:
        left.append(range(next_row, first))
        next_row = first + len(color)
    left.append(range(next_row, rows.stop))
    return [gap for gap in left if gap]
