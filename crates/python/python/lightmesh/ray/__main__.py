"""`python -m lightmesh.ray`: films and pictures on a cluster, with the flags of `lightmesh render`."""

from __future__ import annotations

import argparse
import json
import logging
import sys
from typing import TYPE_CHECKING

from .._errors import Cancelled, DeviceError, HostMemoryError, LightmeshError, SettingError
from .._lightmesh import _parse
from . import ClusterError, Progress, Report, film, picture

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

#: Exit codes, as those of `lightmesh render`.
BAD_INPUT, UNABLE, INTERRUPTED = 2, 3, 130


def parser() -> argparse.ArgumentParser:
    """The flags that `lightmesh render` does not have."""
    flags = argparse.ArgumentParser(
        prog="python -m lightmesh.ray",
        description="Render on a Ray cluster. All other flags are those of `lightmesh render`.",
        usage="%(prog)s {film,picture} SCENE -o OUT [flags] [flags of lightmesh render]",
        allow_abbrev=False,
    )
    flags.add_argument("what", choices=("film", "picture"), help="a film, frame by frame, or a large picture, in bands of rows")
    flags.add_argument("--address", help="the cluster, as in 10.0.0.1:6379 [default: RAY_ADDRESS, else this machine alone]")
    flags.add_argument("--cpus-per-actor", type=float, default=1.0, metavar="N", help="CPUs of each actor [default: 1]")
    flags.add_argument("--gpus-per-actor", type=float, default=0.0, metavar="N", help="GPUs of each actor, or a part of one [default: 0]")
    flags.add_argument("--actors", type=int, metavar="N", help="start at most so many [default: as many as the nodes hold]")
    flags.add_argument("--ship", action="store_true", help="send the files of the scene to the nodes")
    flags.add_argument("-q", "--quiet", action="store_true", help="print only errors")
    flags.add_argument("-v", "--verbose", action="store_true", help="print what nodes and actors do")
    return flags


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command, and returns its exit code."""
    own, others = parser().parse_known_args(arguments)
    logging.basicConfig(format="%(message)s", level=logging.INFO if own.verbose else logging.ERROR if own.quiet else logging.WARNING)
    try:
        report = run(own, others)
    except (KeyboardInterrupt, Cancelled):
        print("interrupted; what was finished is on disk (--resume goes on)", file=sys.stderr)
        return INTERRUPTED
    except LightmeshError as error:
        print(f"error: {error}", file=sys.stderr)
        return UNABLE if isinstance(error, (DeviceError, HostMemoryError, ClusterError)) else BAD_INPUT
    if not own.quiet:
        for note in report.notes:
            print(f"note: {note}", file=sys.stderr)
        print(report, file=sys.stderr)
    return 0


def run(own: argparse.Namespace, others: Sequence[str]) -> Report:
    """Does what the flags say."""
    scene, output, text = _parse(others)
    request = json.loads(text)
    options = {name: getattr(own, name) for name in ("address", "cpus_per_actor", "gpus_per_actor", "actors", "ship")}
    tell = None if own.quiet else Line()
    if output is None:
        raise SettingError("-o is needed: a file, or a pattern such as film.####.png")
    render: Callable[..., Report] = film if own.what == "film" else picture
    report = render(scene, output, on_progress=tell, **options, **request)
    if tell is not None:
        tell.end()
    return report


class Line:
    """Progress in one line of a terminal, or in a few lines of a file."""

    def __init__(self) -> None:
        self.is_terminal = sys.stderr.isatty()
        self.next = 0.0

    def __call__(self, progress: Progress) -> None:
        if not self.is_terminal and progress.done < self.next:
            return
        self.next = min(progress.done + 0.1, 1.0) if progress.done < 1.0 else 2.0
        left = "" if progress.left is None else f", {progress.left:.0f} s left"
        text = f"{progress.done:4.0%}  {progress.units} of {progress.total} units, {progress.actors} actors{left}"
        print(f"\r\x1b[2K{text}" if self.is_terminal else text, end="" if self.is_terminal else "\n", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Leaves the line."""
        if self.is_terminal:
            print(file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
