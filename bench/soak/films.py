"""Films that are killed, or that find a full disk, and go on: all files are whole at any time, and those of an undisturbed film at the end."""

from __future__ import annotations

import json
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Set
from pathlib import Path

from files import NotWholeError, check
from process import CODES, Ended, Plan, run, says
from scenes import good_scene

KILLS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]
RENAMED = {"-o": "output", "--layers": "layers_file"}
"""Flags whose keyword argument in Python has another name."""
IN_PYTHON = """
import json, sys, lightmesh
scene, settings = sys.argv[1], json.loads(sys.argv[2])
for frame in lightmesh.Renderer(device="cpu").film(scene, **settings):
    pass
"""


def kills(plan: Plan, folder: Path, dice: random.Random) -> tuple[list[str], Ended]:
    """A film that is killed a few times and resumed, by the program or from Python."""
    words, undisturbed, seconds, ended = make_film(plan, folder, dice)
    if ended.code != 0:
        return [f"an undisturbed film ends with {ended.code}: {ended.err[-300:]!r}"], ended
    place = copy_scene(folder, "killed")
    in_python = plan.python is not None and dice.random() < 0.5
    go_on = "--skip-existing" if dice.random() < 0.25 else "--resume"
    found: list[str] = []
    spared: set[str] = set()
    for turn in range(20):
        kill = dice.choice(KILLS) if turn < dice.randrange(1, 7) else None
        flags = [go_on] * (turn > 0)
        after = dice.uniform(0, 1.1 * seconds)
        if in_python and plan.python:
            arguments = ["-c", IN_PYTHON, words[1], json.dumps(settings(words, flags))]
            ended = run(plan, arguments, place, program=[str(plan.python)], kill=kill, after=after)
        else:
            ended = run(plan, [*words, *flags], place, kill=kill, after=after)
            found += says(ended)
        # Python's own way to end by Ctrl-C is an exception.
        allowed = {0} | CODES.get(ended.kill, set()) | ({1} if in_python and ended.kill == signal.SIGINT else set())
        if ended.code not in allowed:
            return [*found, f"exit code {ended.code} after {ended.kill!r}: {ended.err[-300:]!r}"], ended
        # The next run that comes so far removes temporary files after SIGKILL, and after SIGTERM, for which Python does not listen.
        if ended.code == -signal.SIGKILL or (in_python and ended.code < 0):
            spared |= {path.name for path in place.glob(".lightmesh-*")}
        kept = go_on == "--skip-existing" and turn > 0
        found += differences(undisturbed, place, whole=ended.code == 0, spared=set() if ended.code == 0 else spared, kept=kept)
        if ended.code == 0 or found:
            break
    return found, ended


def disks(plan: Plan, folder: Path, dice: random.Random) -> tuple[list[str], Ended]:
    """A film, or a picture with all of its files, on a disk that becomes full."""
    film = dice.random() < 0.7
    words, undisturbed, _, ended = make_film(plan, folder, dice, film=film)
    if ended.code != 0:
        return [f"with room it ends with {ended.code}: {ended.err[-300:]!r}"], ended
    sizes = [path.stat().st_size for path in undisturbed.iterdir()]
    with Disk(folder / "disk", 2 * sum(sizes) + (4 << 20)) as disk:
        place = copy_scene(folder, "disk/full")
        full = run(plan, words, place, before=disk.fill(dice.random(), sizes))
        found = says(full)
        if full.code not in {0, 2, 3} | ({4} if film else set()):
            found.append(f"exit code {full.code}: {full.err[-300:]!r}")
        if film or full.code == 0:
            found += differences(undisturbed, place, whole=full.code == 0)
        else:
            # Files of one run appear together.
            found += [f"{path.name} is there, and others are not" for path in sorted(place.iterdir()) if not path.name.startswith("scene.")]
        disk.clear()
        ended = run(plan, [*words, *["--resume"] * film], place)
        if ended.code != 0:
            found.append(f"with room again it ends with {ended.code}: {ended.err[-300:]!r}")
        found += differences(undisturbed, place, whole=True)
    return found, full


# ---- Films ----


def make_film(plan: Plan, folder: Path, dice: random.Random, *, film: bool = True) -> tuple[list[str], Path, float, Ended]:
    """A command, the folder with its undisturbed result, and the seconds that it took."""
    scene = good_scene(folder, dice)
    place = copy_scene(folder, "undisturbed")
    number = ".##" if film else ""
    ending = dice.choice(["png", "png", "exr", "bmp", "jpg"])
    words = ["render", scene, "-o", f"f{number}.{ending}", "--device", "cpu", f"--size={dice.choice(['64x48', '48x64'])}"]
    words += [f"--quality={dice.choice(['draft', 'good'])}"]
    if film:
        moving = ["--fps=20", "--frames=1-5"] if scene == "scene.toml" else ["--turntable=5"]
        day = ["--ambient-light=constant", "--sun=54.98,82.9,2026-06-21+07:00,08:00-18:00/2h"]
        words += dice.choice([moving, [f"--turntable={dice.randrange(4, 9)}"], day])
    words += ["--layers", f"l{number}.exr"] * (dice.random() < 0.4)
    words += ["--stats", f"s{number}.json"] * (dice.random() < 0.4)
    words += dice.choice([[], [], ["--lookup=half-ball", "--mode=light-mesh"], ["--mode=area"], ["--ground"]])
    start = time.monotonic()
    ended = run(plan, words, place)
    return words, place, time.monotonic() - start, ended


def settings(words: list[str], flags: list[str]) -> dict[str, object]:
    """The keyword arguments of Python that are these flags."""
    found: dict[str, object] = {}
    rest = iter([*words[2:], *flags])
    for word in rest:
        flag, _, value = word.partition("=")
        name = RENAMED.get(flag, flag.removeprefix("--").replace("-", "_"))
        if flag in ("-o", "--layers", "--stats", "--device"):
            value = next(rest)
        if flag == "--size":
            found[name] = [int(side) for side in value.split("x")]
        elif flag in ("--turntable", "--fps"):
            found[name] = int(value)
        elif flag != "--device":
            found[name] = value or True
    return found


def copy_scene(folder: Path, name: str) -> Path:
    """A new folder with the files of the scene."""
    place = folder / name
    place.mkdir(parents=True)
    for path in folder.glob("scene.*"):
        shutil.copy(path, place)
    return place


def differences(undisturbed: Path, place: Path, *, whole: bool, spared: Set[str] = frozenset(), kept: bool = False) -> list[str]:
    """What of `place` is not of the undisturbed film, and what is missing if it is to be `whole`. The manifest does not answer for frames that
    were `kept` without a look at them, nor for what has times."""
    wanted = {path.name: path.read_bytes() for path in undisturbed.iterdir()}
    there = {path.name: path.read_bytes() for path in place.iterdir()}
    found = [f"{name} is missing" for name in sorted(wanted.keys() - there.keys())] if whole else []
    if left := sorted(there.keys() - wanted.keys() - spared):
        found.append(f"left behind: {left}")
    has_times = any(name.startswith("s.") and name.endswith(".json") for name in wanted)
    for name in sorted(wanted.keys() & there.keys()):
        if name == "manifest.json" or name.startswith("s."):
            try:
                check("manifest.json", there[name])
            except NotWholeError as error:
                found.append(f"{name} is not whole: {error}")
            if name.startswith("s.") or has_times or kept or not whole:
                continue
        if there[name] != wanted[name]:
            found.append(f"{name} is not as in an undisturbed film")
    return found


# ---- Disks ----


class Disk:
    """A small file system in memory, where this process may mount one; else a limit for the size of files stands for a full disk."""

    def __init__(self, place: Path, size: int) -> None:
        self.place = place
        place.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)]
        self.mounted = shutil.which("mount") is not None and subprocess.run(command, capture_output=True, check=False).returncode == 0

    def __enter__(self) -> Disk:
        return self

    def __exit__(self, *_: object) -> None:
        if self.mounted:
            kept = self.place.with_name("kept")
            shutil.copytree(self.place, kept)
            subprocess.run(["umount", str(self.place)], check=True)
            shutil.copytree(kept, self.place, dirs_exist_ok=True)
            shutil.rmtree(kept)

    def fill(self, share: float, sizes: list[int]) -> Callable[[], None] | None:
        """Leaves room for a share of files of these sizes; what is to be called in the process that writes, if that is how."""
        if not self.mounted:
            room = int(share * max(sizes))
            return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))
        room = int(share * sum(sizes))
        found = os.statvfs(self.place)
        with open(self.place / "filler", "wb") as file:
            os.posix_fallocate(file.fileno(), 0, max(1, found.f_bavail * found.f_frsize - room))
        return None

    def clear(self) -> None:
        (self.place / "filler").unlink(missing_ok=True)


def kind_of_disk(folder: Path) -> str:
    """How disks are made full here."""
    with Disk(folder / "trial", 1 << 20) as disk:
        return "file systems in memory" if disk.mounted else "limits for the size of files"
