"""Random commands: scenes × flags × signals. What `lightmesh render --help` lists is what flags are drawn from."""

from __future__ import annotations

import functools
import random
import re
import signal
from dataclasses import dataclass, field
from pathlib import Path

from files import NotWholeError, check
from process import CODES, Ended, Plan, run, says
from scenes import any_scene

OLD = b"what was here before"
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]
DAY = "54.98,82.9,2026-06-21+07:00,06:00-20:00/"
LEFT_OUT = {
    "--allow-outside": "it reads files outside of the folder",
    "--color": "messages are compared without colours",
    "--device": "always the CPU",
    "--environment": "it needs a panorama",
    "--help": "it renders nothing",
    "--stats": "an output",
    "--layers": "an output",
    "--output": "an output",
    "--mesh-file": "an output",
    "--sun-hours": "an output",
    "--scene-format": "with a pipe",
    "--format": "with a pipe",
    "--size": "always",
    "--grid-file": "it needs a grid",
}
"""Flags that are not drawn from the table below, and why."""
VALUES: dict[str, tuple[list[str], list[str]]] = {
    "--samples": (["1", "4", "17", "256"], ["0", "-1", "99999999"]),
    "--step": (["auto", "0.5"], ["0", "nan", "1e-30", "1e30"]),
    "--radius": (["2.1", "6"], ["0.1", "inf"]),
    "--bounces": (["0", "1", "8"], ["-3", "4294967296"]),
    "--grid": (["16x16x16", "40x3x20"], ["1x1x10000000", "500x500x500"]),
    "--memory-limit": (["256M", "1G"], ["1", "0", "64M"]),
    "--light": (["0,3,1", "1,2,3;1;0.5"], ["nan,0,0", "0,0,0;1e38"]),
    "--camera": (["0,2,5;0,1,0;45"], ["0,0,0;0,0,0;45", "1e30,0,0;0,0,0;1"]),
    "--camera-name": ([], ["none", "\x1b[31m"]),
    "--animation": (["walk"], ["none"]),
    "--smooth": (["off", "45", "180"], ["0", "181"]),
    "--exposure": (["auto", "3"], ["1e9", "nan"]),
    "--aa": (["1", "3", "16"], ["0", "100000"]),
    "--seed": (["0", "7", "18446744073709551615"], ["-1", "x"]),
    "--crop": (["0,0,16,8", "7,9,8,1", "-5,-3,26,18", "-40,60,9,9"], ["0,0,0,1", "1,2,3", "4294967295,0,2,2", "60,40,100000,1"]),
    "--background": (["transparent", "0.5", "1,0,0", "#8090a0"], ["nan", "#12"]),
    "--ambient": (["0", "0.2", "1,2,3"], ["-1", "nan"]),
    "--sky": (["clear", "clear;sun=3,90;alone", "uniform;color=0.5", "gradient;north=30"], ["blue", "clear;sun=-5,0"]),
    "--threads": (["1", "3"], ["0", "100000"]),
    "--turntable": (["2", "3"], ["0", "-1"]),
    "--sun": ([DAY + "7h", DAY + "5h", "70,20,2026-12-21+01:00,10:00-14:00/2h"], ["91,0,2026-06-21+07:00,06:00-20:00/7h", DAY]),
    "--frames": (["1-2", "1,3", "2-3x2", "1"], ["0-1", "3-1", "1-2x0"]),
    "--fps": (["4", "30000/1001"], ["0", "nan", "1/0"]),
}
"""Values of flags that take one: those that are accepted, and those that may be refused."""
APART = [
    {"--studio", "--no-studio", "--sky", "--light", "--sun", "--background"},
    {"--quiet", "--verbose"},
    {"--resume", "--skip-existing", "--overwrite"},
    {"--partial", "--turntable", "--sun"},
    {"--partial", "--fps"},
    {"--partial", "--frames"},
    {"--sky", "--no-studio", "--sun"},
    {"--grid", "--accel", "--instances"},
    {"--studio", "--camera-name"},
]
"""Flags of which most commands have one at most, because the program refuses several."""
NEEDS = {
    "--falloff": ["--light"],
    "--resume": ["--turntable"],
    "--skip-existing": ["--turntable"],
    "--overwrite": ["--turntable"],
    "--frames": ["--turntable"],
}
"""Flags that others are nothing without."""
FILMS = ["--turntable", "--sun", "--frames", "--fps"]
RARE = {*FILMS, "--memory-limit", "--background", "--resume", "--skip-existing", "--overwrite", "--strict", "--animation", "--camera-name"}


@dataclass
class Command:
    """A command and what it may leave in its folder."""

    words: list[str]
    outputs: dict[str, int] = field(default_factory=dict)
    """Patterns of files, and how many of each must be there after a success."""
    piped: str | None = None
    """The name of what is written to standard output."""
    stdin: Path | None = None
    film: bool = False


def soak(plan: Plan, folder: Path, dice: random.Random) -> tuple[list[str], Ended]:
    """One command: what is wrong with it, and how it ended."""
    scene = any_scene(folder, dice, plan.scenes)
    command = a_command(plan, scene, folder, dice)
    inputs = {path: path.read_bytes() for path in folder.iterdir()}
    for name in command.outputs:
        if "#" not in name and folder / name not in inputs and dice.random() < 0.2:
            (folder / name).write_bytes(OLD)
    kill = dice.choice(SIGNALS) if dice.random() < 0.2 else None
    ended = run(plan, command.words, folder, kill=kill, after=dice.expovariate(1 / 0.15), stdin=command.stdin)
    return problems(command, ended, inputs, folder), ended


def problems(command: Command, ended: Ended, inputs: dict[Path, bytes], folder: Path) -> list[str]:
    found = says(ended)
    allowed = {0, 2, 3} | ({4} if command.film else set()) | CODES.get(ended.kill, set())
    if ended.code not in allowed:
        found.append(f"exit code {ended.code}: {ended.err[-300:]!r}")
    found += [f"the input {path.name} is changed" for path, data in inputs.items() if path.name not in command.outputs and path.read_bytes() != data]
    named = {path for pattern in command.outputs for path in folder.glob(re.sub("#+", "*", pattern))}
    named |= {folder / "manifest.json"} if command.film else set()
    left = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()} - {path.relative_to(folder) for path in {*named, *inputs}}
    # After SIGKILL the next run removes temporary files.
    if left and ended.code != -signal.SIGKILL:
        found.append(f"left behind: {sorted(map(str, left))}")
    for path in named - set(inputs):
        data = path.read_bytes() if path.exists() else OLD
        if data != OLD:
            found += wrong(path.name, data)
        elif ended.code == 0 and command.outputs.get(path.name):
            found.append(f"{path.name} is as before")
    if ended.code == 0:
        there = {name: len(list(folder.glob(re.sub("#+", "*", name)))) for name in command.outputs}
        found += [f"{there[name]} of {count} files {name}" for name, count in command.outputs.items() if there[name] < count]
        found += wrong(command.piped, ended.out) if command.piped else []
    return found


def wrong(name: str, data: bytes) -> list[str]:
    try:
        check(name, data)
    except NotWholeError as error:
        return [f"{name} is not whole: {error}"]
    return []


# ---- Commands ----


@functools.cache
def listed_flags(plan: Plan) -> dict[str, list[str]]:
    """The flags of `render` by its help, and the words that each can be chosen from."""
    text = run(plan, ["render", "--help"], Path.cwd()).out.decode()
    found: dict[str, list[str]] = {}
    for part in re.split(r"\n(?=      --| +-\w, --)", text):
        if flag := re.match(r" +(?:-\w, )?(--[a-z-]+)( <)?", part):
            words = re.search(r"\[possible values: ([^\]]*)\]", part)
            found[flag[1]] = words[1].split(", ") if words else re.findall(r"^ +- ([a-z0-9-]+): ", part, re.MULTILINE)
            if not flag[2]:
                found[flag[1]] = [""]
    return found


def unknown_flags(plan: Plan) -> list[str]:
    """Flags that this program has and the tables here have not."""
    return [flag for flag, words in listed_flags(plan).items() if not words and flag not in VALUES and flag not in LEFT_OUT]


def a_command(plan: Plan, scene: str, folder: Path, dice: random.Random) -> Command:
    kind = dice.choices(["render", "info", "export", "grid"], [20, 2, 1, 1])[0]
    if kind == "info":
        return Command(["info", scene, *["--json"] * dice.randrange(2)])
    if kind == "export":
        name = dice.choice(["out.glb", "out.toml"])
        return Command(["export", scene, "-o", name], {name: 1, "out.mesh.glb": 0})
    if kind == "grid":
        return Command(["grid", scene, "-o", "out.grid"], {"out.grid": 1})
    command = Command(["render", scene])
    if scene.startswith("scene.") and dice.random() < 0.1:
        command.words[1:] = ["-", "--scene-format", scene.removeprefix("scene.")]
        command.stdin = folder / scene
    flags = flags_of(plan, dice)
    add_outputs(command, scene, flags, dice)
    sizes = ["64x48", "64x48", "33x20", "1x1", "7x64"] if dice.random() < 0.97 else ["0x5", "3x", "70000x70000", "1x65535"]
    command.words += ["--device", "cpu", f"--size={dice.choice(sizes)}", *flags]
    return command


def flags_of(plan: Plan, dice: random.Random) -> list[str]:
    """Each flag now and then. Three in four commands have only flags that go together, and values that are accepted."""
    listed, careful = listed_flags(plan), dice.random() < 0.75
    names = [flag for flag in sorted(listed) if flag not in LEFT_OUT and dice.random() < (0.04 if flag in RARE else 0.12)]
    if careful:
        dice.shuffle(names)
        names += [need for name in names for need in NEEDS.get(name, []) if need not in names]
        for apart in APART:
            for name in [name for name in names if name in apart][:-1]:
                names.remove(name)
        names = [name for name in names if set(NEEDS.get(name, [])) <= set(names)]
    flags = []
    for name in names:
        if listed[name] == [""]:
            flags.append(name)
            continue
        accepted, refused = VALUES.get(name, (listed[name], ["x", ""]))
        if accepted or not careful:
            # With `=` a leading minus is a value's.
            flags.append(f"{name}={dice.choice(refused if not accepted or (not careful and dice.random() < 0.2) else accepted)}")
    return flags


def add_outputs(command: Command, scene: str, flags: list[str], dice: random.Random) -> None:
    films = [flag for flag in flags if flag.startswith(tuple(FILMS))]
    command.film = bool(films)
    # Only a turntable alone has frames for certain: a night has none, and those that are asked for may all be beyond the end.
    count = 1 if not films else int(films[0][-1]) if len(films) == 1 and films[0] in ("--turntable=2", "--turntable=3") else 0
    number, ending = "##" if films else "out", dice.choice(["png", "png", "bmp", "exr", "exr", "jpg"])
    output = dice.choice([f"f.{number}.{ending}"] * 12 + [f"out.{ending}", "f.mp4"] * bool(films))
    if not films and scene.startswith("scene.") and dice.random() < 0.04:
        # Onto an input, one of its own.
        output = scene
    if not films and dice.random() < 0.05:
        command.words += ["-o", "-", f"--format={ending}"]
        command.piped = f"out.{ending}"
    else:
        command.words += ["-o", output]
        command.outputs[output] = count if "#" in output else 1
    for flag, name, chance in [("--stats", f"s.{number}.json", 0.4), ("--layers", f"l.{number}.exr", 0.3), ("--mesh-file", "m.mesh", 0.1)]:
        if dice.random() < chance:
            command.words += [flag, name]
            command.outputs[name] = 0 if flag == "--mesh-file" else count
    if any(flag.startswith("--sun=") for flag in flags) and dice.random() < 0.5:
        name = "hours." + dice.choice(["exr", "png", "csv"])
        command.words += ["--sun-hours", name]
        command.outputs[name] = 1
