#!/usr/bin/env python3
"""Measures how soon signals end the program in each of its phases: loading, building, rendering and writing.

    cargo build --release && python3 fuzz/signals.py target/release/lightmesh --runs 10

Each run sends one signal at a random moment of a phase and takes the time until the process is gone, on the CPU. It must be gone
within `--limit` seconds, with the signal's exit code, and leave no file.
"""

import argparse
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
SIDE = 1000
"""Vertices along each side of the scene, a sheet: reading it and building a structure take a second or so."""
LOOK = 0.001
"""Seconds between two looks at a process."""
CHECKED = 1 << 20
"""Bytes of a temporary file that holds a part of an image."""
PATIENCE = 60
"""Seconds until a process is taken to hang."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--runs", type=int, default=10, help="of each phase with each signal")
    parser.add_argument("--limit", type=float, default=0.3, help="seconds")
    parser.add_argument("--seed", type=int, default=0)
    plan = parser.parse_args()
    dice, slow, wrong = random.Random(plan.seed), 0, 0
    with tempfile.TemporaryDirectory(prefix="lightmesh-signals-") as folder:
        folder = Path(folder)
        (folder / "sheet.obj").write_text(sheet())
        print(f"{'phase':10}{'signal':8}{'runs':>6}{'median':>10}{'maximum':>10}")
        for phase in (Loading, Building, Rendering, Writing):
            phase = phase(plan.program.resolve(), folder)
            for kill in CODES:
                seconds, problems = measure(phase, kill, plan.runs, dice)
                middle, most = statistics.median(seconds), max(seconds)
                print(f"{phase.name:10}{kill.name[3:]:8}{len(seconds):6}{middle:8.3f} s{most:8.3f} s", flush=True)
                slow += sum(time > plan.limit for time in seconds)
                wrong += len(problems)
                for problem in problems:
                    print(f"  {problem}")
    print(f"{slow} of {len(CODES) * 4 * plan.runs} runs took longer than {plan.limit} s, {wrong} ended wrongly")
    return slow + wrong > 0


def measure(phase, kill, runs, dice):
    """Seconds from the signal to the end, for each run, and what was wrong."""
    seconds, problems = [], []
    span = phase.span()
    while len(seconds) < runs:
        process = phase.start()
        try:
            phase.wait(process)
            time.sleep(dice.uniform(0, span))
            if process.poll() is not None:
                # The phase was shorter this time.
                continue
            sent = time.monotonic()
            process.send_signal(kill)
            code = process.wait(PATIENCE)
            seconds.append(time.monotonic() - sent)
        finally:
            process.kill()
            _, err = process.communicate()
            left = phase.left()
        # A signal may come when everything is done.
        if code not in (CODES[kill], 0):
            problems.append(f"exit code {code}: {err.decode(errors='replace')[-200:]!r}")
        if left and code != 0:
            problems.append(f"left behind: {left}")
    return seconds, problems


# ---- Phases ----


class Phase:
    """A command that spends most of its time in one phase."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def start(self):
        command, nothing = [str(self.program), *self.words], subprocess.DEVNULL
        return subprocess.Popen(command, cwd=self.folder, stdin=nothing, stdout=nothing, stderr=subprocess.PIPE)

    def wait(self, process):
        """Until the phase begins."""
        look(process, lambda: self.begun(process))

    def span(self):
        """Seconds of an undisturbed phase, a little less than that."""
        process = self.start()
        self.wait(process)
        begin = time.monotonic()
        self.wait_end(process)
        seconds = time.monotonic() - begin
        process.kill()
        process.communicate()
        self.left()
        return 0.9 * seconds

    def wait_end(self, process):
        process.communicate(timeout=PATIENCE)

    def left(self):
        """Files beside the scene, which are removed."""
        left = [path for path in self.folder.iterdir() if path.name != "sheet.obj"]
        for path in left:
            path.unlink()
        return [path.name for path in left]


class Loading(Phase):
    name = "loading"
    words = ["info", "sheet.obj"]

    def begun(self, process):
        return listens(process)


class Building(Phase):
    name = "building"
    words = ["render", "sheet.obj", "-o", "a.png", "--size", "16x16", "--device", "cpu", "--progress", "json"]

    def wait(self, process):
        read_until(process, b'{"event":"begin","stage":"build"')

    def wait_end(self, process):
        read_until(process, b'{"event":"end","stage":"build"')


class Rendering(Phase):
    name = "rendering"
    words = ["render", "builtin:gazebo", "-o", "a.png", "--size", "4000x3000", "--device", "cpu", "--mode", "area"]
    words += ["--samples", "1024", "--progress", "json"]

    def wait(self, process):
        read_until(process, b'{"event":"end","stage":"build"')

    def span(self):
        return 2.0


class Writing(Phase):
    name = "writing"
    words = ["render", "builtin:gazebo", "-o", "a.png", "--layers", "a.exr", "--size", "2000x1500", "--device", "cpu"]
    words += ["--mode", "ray-trace"]

    def begun(self, process):
        # Before, temporary files are created to see whether that is possible.
        unfinished = (path for path in self.folder.iterdir() if path.name.startswith(".lightmesh-"))
        return any(size(path) > CHECKED for path in unfinished)


def listens(process):
    """Whether the program catches signals."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    mask = next((line for line in status.splitlines() if line.startswith("SigCgt:")), "SigCgt: 0")
    return int(mask.split()[1], 16) >> (signal.SIGTERM - 1) & 1 == 1


def size(path):
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return 0


def look(process, ask):
    end = time.monotonic() + PATIENCE
    while process.poll() is None and not ask():
        if time.monotonic() > end:
            raise TimeoutError(f"{process.args} does not reach its phase")
        time.sleep(LOOK)


def read_until(process, begin):
    """Reads lines of progress until one begins so."""
    for line in process.stderr:
        if line.startswith(begin):
            return
    raise RuntimeError(f"{process.args} ended without {begin}")


def sheet():
    """The text of a sheet of triangles."""
    points = [f"v {x} {y} {x * y % 7}\n" for y in range(SIDE) for x in range(SIDE)]
    corners = [y * SIDE + x + 1 for y in range(SIDE - 1) for x in range(SIDE - 1)]
    faces = [f"f {a} {a + 1} {a + SIDE}\nf {a + 1} {a + SIDE + 1} {a + SIDE}\n" for a in corners]
    return "".join(points + faces)


if __name__ == "__main__":
    sys.exit(main())
