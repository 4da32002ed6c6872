"""What the tests of `lightmesh.ray` share: a small film, how one process renders it, and where the benchmarks are."""

import subprocess
import sys
from pathlib import Path

BENCH = Path(__file__).resolve().parents[3] / "bench" / "ray"
SCENE = "builtin:gazebo"
FILM = {"size": (48, 36), "quality": "draft"}
STORE = 100_000_000


def command(*arguments):
    subprocess.run([sys.executable, "-m", "lightmesh", *map(str, arguments), "--quiet"], check=True, timeout=300)


def flags(settings):
    text = {name: "x".join(map(str, value)) if isinstance(value, tuple) else str(value) for name, value in settings.items()}
    return [f"--{name}" if value == "True" else f"--{name}={value}" for name, value in text.items()]


def by_one_process(scene, output, settings):
    output.parent.mkdir(exist_ok=True)
    command("render", scene, "-o", output, "--device", "cpu", *flags(settings))


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}
