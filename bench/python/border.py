"""What it costs to render from Python in place of the command line, and whether 1000 renders leak.

    python bench/python/border.py target/release/lightmesh -o bench/python/border-cpu.json [--device cuda]

Childpark at 1024×1024, in turns: the command line program, in its own words (`--stats`: reading the scene, building, rendering), and the package, by
the clock around `Scene.builtin`, `render` and a look at every pixel of `Frame.rgb`. Starting Python and importing NumPy is reported beside it: a
program does that once. Then 1000 renders with layers and a kept mesh: resident memory and, on CUDA, free device memory, after a third and after all.
"""

import argparse
import gc
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import lightmesh

SIZE = (1024, 1024)
#: Most that the package may take of the command line's time.
MOST = 1.05


def spent(seconds: dict[str, float]) -> float:
    """Seconds from a scene to the finished frame, of what statistics say."""
    return seconds["build"] + seconds["upload"] + seconds["render"]


def by_command(program: str, device: str, quality: str) -> float:
    """Seconds from reading the scene to the finished frame, without starting the process and without writing the file."""
    with tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        arguments = ["render", "builtin:childpark", "--device", device, "--quality", quality, "--size", "x".join(map(str, SIZE)), "--quiet"]
        subprocess.run([program, *arguments, "--stats", str(stats), "-o", str(Path(folder) / "image.bmp")], check=True)
        seconds = json.loads(stats.read_text())["seconds"]
        return float(seconds["load"] + spent(seconds))


def by_package(renderer: lightmesh.Renderer, quality: str) -> tuple[float, float]:
    """The same through Python, by the clock; and what the frame says of itself."""
    start = time.perf_counter()
    scene = lightmesh.Scene.builtin("childpark")
    load = time.perf_counter() - start
    frame = renderer.render(scene, quality=quality, size=SIZE)
    assert np.isfinite(frame.rgb.sum())
    return time.perf_counter() - start, load + spent(frame.stats["seconds"])


def starting() -> float:
    """Seconds to start Python and import the package."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", "import lightmesh"], check=True)
    return time.perf_counter() - start


def memory(device: str) -> dict[str, int]:
    """Bytes of the process, and those that are not free on the device."""
    with open("/proc/self/statm") as status:
        resident = int(status.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    found = {"resident": resident}
    if device != "cpu":
        found["device_free"] = next(entry["free_bytes"] for entry in lightmesh.devices() if entry["device"] == device)
    return found


def leaks(renderer: lightmesh.Renderer, renders: int) -> dict[str, Any]:
    """Renders a small image of moving lights again and again."""
    scene, cache = lightmesh.Scene.builtin("gazebo"), lightmesh.MeshCache()
    lights = scene.lights
    warm: dict[str, int] = {}
    for turn in range(renders):
        shift = 0.01 * (turn % 7)
        scene.lights = [light if light.position is None else light.replaced(position=np.add(light.position, shift)) for light in lights]
        frame = renderer.render(scene, size=(160, 120), quality="draft", layers=True, cache=cache)
        assert frame.depth.shape == (120, 160)
        if turn + 1 == renders // 3:
            gc.collect()
            warm = memory(renderer.device)
    gc.collect()
    return {"renders": renders, "after_a_third": warm, "after_all": memory(renderer.device)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the command line program, a release build of the same commit")
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--repetitions", type=int, default=9)
    parser.add_argument("--renders", type=int, default=1000)
    parser.add_argument("-o", "--output", type=Path)
    options = parser.parse_args()
    renderer = lightmesh.Renderer(options.device)
    result: dict[str, Any] = {"version": lightmesh.__version__, "device": renderer.reason, "scene": "childpark", "size": list(SIZE)}
    result["rows"] = []
    for quality in ("draft", "good"):
        by_package(renderer, quality)
        once = lambda: (by_command(options.program, renderer.device, quality), *by_package(renderer, quality))  # noqa: B023, E731
        turns = [once() for _ in range(options.repetitions)]
        command, package, inside = (statistics.median(column) for column in zip(*turns, strict=True))
        ratio, border = package / command, package / inside - 1.0
        result["rows"].append(
            {"quality": quality, "command_s": command, "package_s": package, "inside_s": inside, "ratio": ratio, "border": border}
        )
        print(f"{quality}: command {command:.4f} s, package {package:.4f} s ({ratio:.3f}); outside the renderer {border:.2%}", flush=True)
    result["start_s"] = statistics.median(starting() for _ in range(5))
    result["leaks"] = leaks(renderer, options.renders)
    print(json.dumps(result["leaks"]))
    if options.output:
        options.output.write_text(json.dumps(result, indent=2) + "\n")
    worst = max(row["ratio"] for row in result["rows"])
    if worst > MOST:
        sys.exit(f"the package takes {worst:.3f} of the command line's time, more than {MOST}")


if __name__ == "__main__":
    main()
