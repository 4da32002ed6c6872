"""Films: their frames are rendered by many, and recorded in one manifest."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from .._lightmesh import _FilmLog
from ._actors import Job
from ._files import Files
from ._leader import Leader, Setup
from ._report import Progress, Report
from ._request import scene_path, settings, share
from ._units import Choose, Chosen, Frame, Result, Unit, Written

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ..typing import Path as AnyPath
    from ._settings import FilmRequest


def film(
    scene: AnyPath,
    output: AnyPath,
    *,
    frames: str | Sequence[int] | None = None,
    address: str | None = None,
    cpus_per_actor: float = 1,
    gpus_per_actor: float = 0,
    actors: int | None = None,
    ship: bool = False,
    on_progress: Callable[[Progress], object] | None = None,
    **request: Unpack[FilmRequest],
) -> Report:
    """Renders the frames of a film of `scene`, a file, to `output`, a pattern such as "film.####.png", on the cluster at `address`: the one that the
    program is connected to, that of `RAY_ADDRESS`, one that runs on this machine, or one of this machine alone.

    `frames` are those of `lightmesh render --frames`, as text or a sequence of numbers; all, unless given. Actors, at most `actors`, get
    `cpus_per_actor` and `gpus_per_actor` each, which may be parts. `ship` sends the files of the scene to nodes that lack them; without it, all nodes
    need the same files under the same paths. Frames that the leader does not see on its own disk are sent to it. `on_progress` is called
    several times a second with a `Progress`; what it raises ends the run. The other keywords are the flags of `lightmesh render`.

    Returns what was done. With `resume=True`, frames that the manifest beside the output names as finished are left as they are. Raises
    `FilesError` before any work begins if files of nodes differ, and exceptions of the package with the name of the node.
    """
    given = settings(request)
    if frames is not None:
        given["frames"] = frames if isinstance(frames, str) else ",".join(str(int(number)) for number in frames)
    each = share(cpus_per_actor, gpus_per_actor, given.get("device"))
    log = _FilmLog(scene, output, given)
    path = Path(output).absolute()
    if not log.numbers:
        return Report(kept=log.kept, notes=log.notes)
    leader = Leader(each, actors, address, on_progress)
    leader.report.kept, leader.report.notes = log.kept, log.notes
    try:
        files = Files(log.inputs, path, ship)
        job = Job(scene_path(scene), str(path), log.request, files.digest, files.shipped_as, False, each.gpus, files.run)
        leader.begin(Setup(files, job.shared, log.has_written))
        render(leader, log)
    finally:
        log.close()
        leader.close()
    return leader.report


def render(leader: Leader, log: _FilmLog) -> None:
    """Has all frames rendered that are left, and records them."""
    leader.planned = len(log.numbers)
    chosen = log.chosen
    if chosen is None:
        chosen = choose(leader)
        log.choose(chosen)

    with Recorder(log) as recorder:
        leader.run([Frame(number, chosen) for number in log.numbers], recorder.take)


class Recorder:
    """Records frames beside the leader, in their order: while the disk takes the manifest, units are handed out."""

    def __init__(self, log: _FilmLog) -> None:
        self.log = log
        self.beside = ThreadPoolExecutor(1)
        self.calls: deque[Future[None]] = deque()

    def take(self, unit: Unit, result: Result) -> None:
        """A frame is finished. Raises what went wrong with those before."""
        assert isinstance(unit, Frame) and isinstance(result, Written)
        while self.calls and self.calls[0].done():
            self.calls.popleft().result()
        self.calls.append(self.beside.submit(self.record, unit.number, result))

    def record(self, number: int, written: Written) -> None:
        if written.content is not None:
            self.log.publish(number, written.content, written.files)
        self.log.finished(number, written.files)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        # What is finished is recorded however the run ends.
        self.beside.shutdown(wait=True)
        while self.calls and kind is None:
            self.calls.popleft().result()


def choose(leader: Leader) -> str:
    """Has exposure and step chosen for all frames."""
    found: list[str] = []

    def take(_: Unit, result: Result) -> None:
        assert isinstance(result, Chosen)
        found.append(result.text)

    leader.run([Choose()], take, (0.0, 0.0))
    return found[0]
