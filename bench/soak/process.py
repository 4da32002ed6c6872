"""Runs the program, with a time limit and perhaps a signal."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

CODES: dict[signal.Signals | None, set[int]] = {
    signal.SIGINT: {130, -signal.SIGINT},
    signal.SIGTERM: {143, -signal.SIGTERM},
    signal.SIGHUP: {129, -signal.SIGHUP},
    signal.SIGKILL: {-signal.SIGKILL},
}
"""Exit codes after a signal; one that comes before the program listens ends it as any other."""
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")
FAULTS = ["panicked", "a fault in lightmesh", "RUST_BACKTRACE", "stack overflow", "memory allocation"]
TOO_SLOW = 1000
"""Stands for the exit code of a run that exceeded the time limit."""


@dataclass(frozen=True)
class Plan:
    """What all runs have in common."""

    program: Path
    limit: float
    """Seconds that a run may take."""
    scenes: tuple[Path, ...]
    python: Path | None
    """A Python that can import the package."""


@dataclass
class Ended:
    """How a run ended."""

    words: Sequence[str]
    """The command."""
    folder: Path
    code: int
    out: bytes
    err: bytes
    kill: signal.Signals | None
    stdin: Path | None = None


def run(
    plan: Plan,
    words: Sequence[str],
    folder: Path,
    *,
    program: Sequence[str] = (),
    kill: signal.Signals | None = None,
    after: float = 0,
    stdin: Path | None = None,
    before: Callable[[], None] | None = None,
) -> Ended:
    """Runs the program, or `program`, in `folder`, with `words`, and sends the signal `kill` `after` seconds if it is still there."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("LIGHTMESH_")} | {"TMPDIR": str(folder)}
    with open(stdin or os.devnull, "rb") as source:
        command = [*(program or [str(plan.program)]), *words]
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdin=source, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=before,
        )  # fmt: skip
        if kill:
            try:
                out, err = process.communicate(timeout=after)
                return Ended(command, folder, process.returncode, out, err, None, stdin)
            except subprocess.TimeoutExpired:
                process.send_signal(kill)
        try:
            out, err = process.communicate(timeout=plan.limit)
            code = process.returncode
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            code = TOO_SLOW
    return Ended(command, folder, code, out, err, kill, stdin)


def says(ended: Ended) -> list[str]:
    """What is wrong with what it says."""
    text = ended.err.decode(errors="replace")
    found = [f"it says {fault!r}" for fault in FAULTS if fault in text]
    if ended.code in {2, 3, 4} and not text.strip():
        found.append("no reason is given")
    if control := CONTROL.search(text):
        found.append(f"it prints {control.group()!r}")
    return found


def shown(ended: Ended) -> str:
    """The command for a shell, and the signal that it got."""
    source = f" < {shlex.quote(str(ended.stdin))}" if ended.stdin else ""
    kill = f"   # {ended.kill.name}" if ended.kill else ""
    return f"cd {shlex.quote(str(ended.folder))} && {shlex.join(ended.words)}{source}{kill}"
