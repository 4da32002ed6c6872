#!/usr/bin/env python3
"""Whether inputs that once came out wrong come out right: prints `right` or `wrong` for each, and what came.

    python3 bench/reports/reports.py target/release/lightmesh
    python3 bench/reports/reports.py target/release/lightmesh --python target/python/bin/python

The inputs are in `../shared/reports`; its README says what is right. `--python` adds those of the Python package, and takes a Python that has
the wheel installed. Names of checks select some; `--list` names them. Exit code 1 if any is wrong. It needs NumPy and OpenEXR
(`.ci/openexr.txt`), and permission to mount for the full disk.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parents[2]
REPORTS = ROOT.parent / "shared" / "reports"
FAULTS = REPORTS / "faults"
LIMIT = 300

CHECKS: dict[str, Callable] = {}


def check(function: Callable) -> Callable:
    """Adds a check, which returns what came, and fails by an assertion."""
    CHECKS[function.__name__] = function
    return function


@dataclass
class Run:
    """A run of the program in a folder of its own."""

    program: Path
    python: Path | None
    folder: Path

    def __call__(self, *words: object, code: int | None = 0, limit: str | None = None, **options) -> subprocess.CompletedProcess:
        command = [str(self.program), *map(str, words)]
        if limit:
            command = ["bash", "-c", f'{limit}; exec "$@"', "bash", *command]
        done = subprocess.run(command, cwd=self.folder, text=True, capture_output=True, timeout=LIMIT, **options)
        if code is not None:
            assert done.returncode == code, f"exit code {done.returncode}: {done.stderr.strip()[-300:]}"
        return done

    def render(self, scene: Path, *words: object, **options) -> subprocess.CompletedProcess:
        return self("render", scene, "--progress", "none", "--device", "cpu", *words, **options)

    def radiance(self, scene: Path, *words: object) -> np.ndarray:
        """The linear picture of a scene, (height, width, 3)."""
        self.render(scene, "-o", "p.exr", *words)
        with OpenEXR.File(str(self.folder / "p.exr")) as file:
            channels = file.channels()
            pixels = channels["RGB"].pixels if "RGB" in channels else np.stack([channels[c].pixels for c in "RGB"], -1)
            return np.asarray(pixels, np.float64)[..., :3]

    def seconds(self, scene: Path, *words: object) -> float:
        """The least time of three runs."""
        times = []
        for _ in range(3):
            start = time.perf_counter()
            self.render(scene, "-o", "t.png", *words)
            times.append(time.perf_counter() - start)
        return min(times)

    def script(self, path: Path) -> str:
        assert self.python, "--python is not given"
        done = subprocess.run([self.python, path], cwd=self.folder, text=True, capture_output=True, timeout=60)
        assert done.returncode == 0, (done.stdout + done.stderr).strip()[-200:]
        return done.stdout

    def files(self) -> list[str]:
        return sorted(path.name for path in self.folder.iterdir())


def middle(picture: np.ndarray) -> float:
    """The green value in the middle."""
    height, width, _ = picture.shape
    return float(picture[height // 2, width // 2, 1])


def near(value: float, right: float, share: float) -> str:
    assert abs(value - right) <= share * right, f"{value:.4g}, not {right:.4g}"
    return f"{value:.4g}"


@check
def leak_slabs(run: Run) -> str:
    most = [run.radiance(REPORTS / "leak_slabs.toml", "--sky", "uniform", "--size", size).max() for size in ("320x240", "1024x768")]
    assert max(most) == 0, f"light in a sealed room: {most}"
    return "0"


@check
def lamp_large_panel(run: Run) -> str:
    value = middle(run.radiance(REPORTS / "lamp_large_panel.toml", "--size", "240x180"))
    assert value >= 1.197 * 0.99, f"{value:.4g} is less than the direct light of 1.197"
    return f"{value:.4g}"


@check
def lamp_weak_panel(run: Run) -> str:
    done = run.render(REPORTS / "lamp_weak_panel.toml", "-o", "w.png", "--size", "240x180")
    assert "no lights" not in done.stderr, done.stderr
    return near(middle(run.radiance(REPORTS / "lamp_weak_panel.toml", "--size", "240x180")), 0.012, 0.15)


@check
def lamp_strip_1900mm(run: Run) -> str:
    picture = run.radiance(REPORTS / "lamp_strip_1900mm.obj", "--camera", "0,2,0.01;0,0,0;20", "--size", "240x180")
    # Direct light is .095; what the surfaces reflect comes on top.
    value = middle(picture)
    assert 0.095 * 0.98 <= value <= 0.095 * 1.5, f"{value:.4g}, not .095 and reflections"
    return f"{value:.4g}"


@check
def near_strip(run: Run) -> str:
    picture = run.radiance(REPORTS / "near_strip.toml", "--size", "480x320", "--aa", "1")
    # 10 cm below the strip, y = 2.1, and over its middle half, |x| ≤ 0.25, as the camera of the file sees them.
    along = picture[125, 240 - 29 : 240 + 29, 1]
    ratio = along.max() / along.min()
    assert ratio <= 1.03, f"max/min {ratio:.3f}"
    return f"{ratio:.3f}"


def uplight(run: Run, name: str, floor: bool) -> str:
    ceiling = middle(run.radiance(REPORTS / name, "--camera", "0,2.05,0.3;0,2.5,0.31;20", "--ambient", 0, "--size", "240x180"))
    assert ceiling > 0, "the ceiling is dark"
    below = middle(run.radiance(REPORTS / name, "--camera", "0,1.5,0.3;0,0,0.31;20", "--ambient", 0, "--size", "240x180"))
    assert below > 0 or not floor, "the floor is dark"
    return f"ceiling {ceiling:.4g}, floor {below:.4g}"


@check
def uplight_up(run: Run) -> str:
    return uplight(run, "uplight_up.gltf", False)


@check
def uplight_doublesided(run: Run) -> str:
    return uplight(run, "uplight_doublesided.gltf", True)


@check
def wide_sun(run: Run) -> str:
    return near(middle(run.radiance(REPORTS / "wide_sun.toml", "--size", "240x180")), 1.0, 0.01)


@check
def ply_wedge_uv(run: Run) -> str:
    picture = run.radiance(REPORTS / "ply_wedge_uv.ply", "--size", "240x180").reshape(-1, 3)
    grey = picture.max(axis=1) - picture.min(axis=1)
    assert grey.max() > 0.1, "grey"
    return "coloured"


@check
def rgbe_magic(run: Run) -> str:
    run.render(FAULTS / "plain.toml", "--environment", REPORTS / "rgbe_magic.hdr", "-o", "p.png", "--size", "64x48")
    return "read"


@check
def sun_inf(run: Run) -> str:
    done = run.render(FAULTS / "plain.toml", "--environment", REPORTS / "sun_inf.exr", "-o", "p.png", "--size", "64x48")
    assert "sun_inf.exr" in done.stderr, "no warning"
    return "a warning"


@check
def fork_renderer(run: Run) -> str:
    return run.script(REPORTS / "fork_renderer.py").strip()


@check
def colors_uint8(run: Run) -> str:
    try:
        lines = run.script(REPORTS / "colors_uint8.py").split()
    except AssertionError as error:
        if "--python" in str(error) or "uint8" not in str(error):
            raise
        return "refused"
    return near(float(lines[3]), float(lines[1]), 0.02)


@check
def ground_instances(run: Run) -> str:
    for form in ("always", "auto", "never"):
        for more in ((), ("--turntable", 2)):
            out = f"{form}.#.png" if more else f"{form}.png"
            run.render(FAULTS / "ground_instances.toml", "--instances", form, "--ground", "-o", out, "--size", "64x48", *more)
    return "pictures"


def panes(run: Run, name: str, few: int, share: float, *words: object) -> str:
    text = (FAULTS / name).read_text()
    head, *parts = re.split(r"(?=\[\[(?:plane|sphere)\]\])", text)
    shown = [part for part in parts if 'material="x"' in part]
    others = [part for part in parts if part not in shown]
    small = run.folder / "few.toml"
    small.write_text(head + "".join(others + shown[:few]))
    all_of_them, part = (run.seconds(path, "--size", "64x48", *words) for path in (FAULTS / name, small))
    assert all_of_them <= share * part, f"{all_of_them:.2f} s, {part:.2f} s with {few}"
    return f"{all_of_them / part:.1f} × {few} of them"


@check
def panes12(run: Run) -> str:
    return panes(run, "panes12.toml", 4, 6, "--bounces", 2)


@check
def veils40(run: Run) -> str:
    return panes(run, "veils40.toml", 10, 8)


@check
def nested_glass32(run: Run) -> str:
    seconds = run.seconds(FAULTS / "nested_glass32.toml", "--size", "64x48")
    assert seconds < 6, f"{seconds:.1f} s"
    return f"{seconds:.1f} s"


@check
def full_mesh_file(run: Run) -> str:
    full = run.folder / "full"
    full.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", full], check=True)
    try:
        done = run.render(FAULTS / "plain.toml", "--sky", "clear", "-o", "o.png", "--mesh-file", full / "m.mesh", "--size", "64x48")
        assert (run.folder / "o.png").is_file(), "no picture"
        assert "m.mesh" in done.stderr, "no warning"
    finally:
        subprocess.run(["umount", full], check=True)
    return "a picture, a warning"


@check
def film_in_little_memory(run: Run) -> str:
    run.render(FAULTS / "fly.toml", "--fps", 2, "-o", "out.#.exr", "--layers", "outl.#.exr", "--size", "1500x1500", "--quality", "draft",
               "--mode", "ray-trace", "--memory-limit", "512M")
    return "all frames"


@check
def manifest_changed(run: Run) -> str:
    words = ("--fps", 3, "-o", "f.##.png", "--exposure", "auto", "--size", "64x48")
    run.render(FAULTS / "fly.toml", *words)
    path = run.folder / "manifest.json"
    text = path.read_text()
    changed, count = re.subn(r'("exposure": -?)(\d)', lambda found: found[1] + str((int(found[2]) + 1) % 10), text, count=1)
    assert count, "manifest.json has no exposure"
    path.write_text(changed)
    (run.folder / "f.03.png").unlink()
    done = run.render(FAULTS / "fly.toml", *words, "--resume", code=None)
    assert done.returncode == 2 and "manifest" in done.stderr, f"exit code {done.returncode}"
    return "refused"


@check
def million_instances(run: Run) -> str:
    subprocess.run([sys.executable, FAULTS / "million_instances.py"], cwd=run.folder, check=True)
    run.render(run.folder / "million_instances.gltf", "-o", "m.png", "--size", "64x48", "--memory-limit", "1G")
    return "a picture"


@check
def file_size_limit(run: Run) -> str:
    words = ("-o", "o.png", "--layers", "l.exr", "--size", "200x150")
    done = run.render(FAULTS / "plain.toml", *words, code=None, limit="ulimit -f 20")
    assert done.returncode == 2 and "error: cannot " in done.stderr, f"exit code {done.returncode}: {done.stderr[-200:]}"
    assert not run.files(), f"left: {run.files()}"
    return "a message, nothing left"


def warned(run: Run, name: str, *words: object) -> str:
    out = "w.#.png" if words else "w.png"
    done = run.render(FAULTS / name, "-o", out, "--size", "64x48", *words)
    lines = [line for line in done.stderr.splitlines() if line.startswith("warning:") and name in line]
    assert lines, f"no warning: {done.stderr[-200:]}"
    return lines[0].strip()[:110]


@check
def weights_nan(run: Run) -> str:
    return warned(run, "weights_nan.gltf")


@check
def scale_nan(run: Run) -> str:
    return warned(run, "scale_nan.gltf", "--fps", 3)


@check
def chan_node_oob(run: Run) -> str:
    return warned(run, "chan_node_oob.gltf")


@check
def objects_survive(run: Run) -> str:
    """Seven named boxes have seven rows of sun hours, from toml and glb, too."""
    boxes = "".join(f'[[box]]\nname = "box {k}"\ncenter = [{2 * k - 6}, 0.5, 0]\nsize = [1, 1, 1]\n\n' for k in range(7))
    (run.folder / "boxes.toml").write_text('[camera]\nposition = [0, 6, 14]\ntarget = [0, 0, 0]\nvfov = 60\n\n' + boxes)
    rows = {}
    for name in ("boxes.toml", "copy.toml", "boxes.glb"):
        if name != "boxes.toml":
            run("export", "boxes.toml", "-o", name)
        run.render(run.folder / name, "--sun", "54.98,82.9,2026-06-21+07:00,09:00-15:00/3h", "--sun-hours", f"{name}.csv", "-o", f"{name}.#.png", "--size", "160x90")
        rows[name] = len((run.folder / f"{name}.csv").read_text().strip().splitlines()) - 1
    assert set(rows.values()) == {7}, str(rows)
    return "seven rows each"


@check
def compare_is_linear(run: Run) -> str:
    """Pictures of 2.0 and 4.0 are not equal."""
    for value in (2, 4):
        channels = {name: np.full((8, 8), value, np.float32) for name in "RGB"}
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(run.folder / f"{value}.exr"))
    found = json.loads(run("compare", "2.exr", "4.exr", "--json").stdout)
    assert any(isinstance(value, int | float) and 0 < value < 1e6 for key, value in found.items() if "rmse" in key), str(found)
    return "not equal"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path, nargs="?")
    parser.add_argument("checks", nargs="*", help="names of checks [default: all]")
    parser.add_argument("--python", type=Path, help="a Python that has the wheel installed")
    parser.add_argument("--list", action="store_true", help="name the checks")
    chosen = parser.parse_args()
    if chosen.list:
        print("\n".join(CHECKS))
        return 0
    if not chosen.program:
        parser.error("which program?")
    if not REPORTS.is_dir():
        print(f"{REPORTS} is missing: ignored")
        return 0
    unknown = set(chosen.checks) - set(CHECKS)
    if unknown:
        parser.error(f"no such checks: {', '.join(sorted(unknown))}")
    wrong = 0
    for name, function in CHECKS.items():
        if chosen.checks and name not in chosen.checks:
            continue
        if name in ("fork_renderer", "colors_uint8") and not chosen.python:
            print(f"{'ignored':8}{name:24}--python is not given")
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                verdict, came = "right", function(Run(chosen.program.resolve(), chosen.python, Path(folder)))
            except AssertionError as error:
                verdict, came = "wrong", str(error)
            except subprocess.TimeoutExpired:
                verdict, came = "wrong", f"not done after {LIMIT} s"
        wrong += verdict == "wrong"
        print(f"{verdict:8}{name:24}{came}", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
