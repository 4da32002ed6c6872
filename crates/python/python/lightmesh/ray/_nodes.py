"""What is done once on each node: comparing files, receiving them, cleaning up. None of it takes a CPU from the actors."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import shutil
import socket
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

from .. import __version__
from .._errors import LightmeshError, SaveError
from .._lightmesh import _digest, _seal, _sweep

#: A file: path, size and checksum.
File = tuple[Path, int, str]
#: What sets how much workers log, by the names of `logging`.
LOG = "LIGHTMESH_RAY_LOG"
#: How long the end of killed processes is waited for.
PATIENCE = 10.0
#: Files that were sent so long ago are no longer read.
LONG = 7 * 24 * 3600.0


def begin_log() -> None:
    """Workers log to their standard error, which Ray hands to the leader and keeps with the logs of the session."""
    logger = logging.getLogger("lightmesh.ray")
    if not logger.handlers:
        handler = logging.StreamHandler(sys.stderr)
        handler.setFormatter(logging.Formatter(f"lightmesh.ray %(levelname)s {socket.gethostname()} %(process)d: %(message)s"))
        logger.addHandler(handler)
        logger.setLevel(os.environ.get(LOG, "WARNING").upper())


def digest_of_all(files: Iterable[File]) -> str:
    """One checksum of the content of files, in their order."""
    whole = hashlib.sha256()
    for _, size, xxh3 in files:
        whole.update(f"{size} {xxh3}\n".encode())
    return whole.hexdigest()[:32]


def folder() -> Path:
    """Where files go that are sent to this node."""
    owner = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"lightmesh-scenes-{owner}"


def shipped(shipped_as: str, path: str) -> str:
    """What a path of the leader is called where files were sent."""
    if path.startswith("builtin:"):
        return path
    return f"{folder() / shipped_as}{os.sep}{path.lstrip(os.sep)}"


def problems(files: Sequence[File], output: Path | None, version: str) -> tuple[list[str], str | None]:
    """What is wrong with the files of this node, a sentence each, and the seal of the manifest that it sees."""
    if version != __version__:
        return [f"lightmesh is version {__version__} there, and {version} here: install the same"], None
    found = []
    for path, size, xxh3 in files:
        try:
            same = _digest(path) == (size, xxh3)
        except LightmeshError:
            found.append(f"{path} is missing")
        else:
            if not same:
                found.append(f"{path} is another file: its checksum differs")
    return found, None if output is None else _seal(output)


def lacking(files: Sequence[File], shipped_as: str) -> list[int]:
    """Which of the files were not yet sent to this node, by their places in the list."""
    lacks = []
    for place, (path, size, xxh3) in enumerate(files):
        try:
            is_there = _digest(shipped(shipped_as, str(path))) == (size, xxh3)
        except LightmeshError:
            is_there = False
        if not is_there:
            lacks.append(place)
    return lacks


def receive(shipped_as: str, path: str, node: str, content: bytes, is_first: bool, is_last: bool) -> None:
    """Writes a piece of a file that is sent. It appears with the last one. Nodes of one machine, each by its name, do not mix."""
    prepare(folder())
    target = Path(shipped(shipped_as, path))
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(f".{target.name}.{node}.part")
    with open(part, "wb" if is_first else "ab") as file:
        file.write(content)
    if is_last:
        part.replace(target)


def prepare(whole: Path) -> None:
    """Makes the folder that files are sent to, which nobody else may have made, and removes what runs have left there whose leaders died."""
    whole.mkdir(mode=0o700, exist_ok=True)
    if hasattr(os, "getuid") and whole.stat().st_uid != os.getuid():
        raise SaveError(f"{whole} belongs to another user: remove it, or set TMPDIR for the node")
    for left in whole.iterdir():
        if time.time() - left.stat().st_mtime > LONG:
            shutil.rmtree(left, ignore_errors=True)


def frames_of(run: str) -> str:
    """How the names of folders begin in which the actors of a run write frames that they send."""
    return f"lightmesh-frames-{run}-"


def clean(output: Path | None, pids: Sequence[int], shipped_as: str, run: str) -> None:
    """Waits for the end of actors, and removes what they have left: temporary files beside the output, folders of their own, and what was sent."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and any(is_alive(pid) for pid in pids):
        time.sleep(0.02)
    if output is not None:
        _sweep(output)
    for left in Path(tempfile.gettempdir()).glob(f"{frames_of(run)}*") if run else ():
        shutil.rmtree(left, ignore_errors=True)
    if shipped_as:
        shutil.rmtree(folder() / shipped_as, ignore_errors=True)
        with contextlib.suppress(OSError):
            # Other runs may have files there.
            folder().rmdir()


def is_alive(pid: int) -> bool:
    """Whether a process of this node runs; one that has ended and is not yet waited for does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[-1].split()[0]
    except OSError:
        return False
    return state != "Z"
