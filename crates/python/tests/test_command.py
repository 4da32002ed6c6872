"""The command that comes with the package, and that the package renders what it renders."""

import contextlib
import json
import re
import subprocess
import sys
import typing
from pathlib import Path

import numpy as np
import pytest

import lightmesh
from lightmesh import Scene
from lightmesh.typing import FilmSettings, ImageSettings, OpenSettings, SaveSettings

RENDER = {"size": (96, 64), "seed": 7}
#: The same on the command line.
GAZEBO = ("render", "builtin:gazebo", "--device", "cpu", "--size", "96x64", "--seed", "7")
SETTINGS = (ImageSettings, SaveSettings, OpenSettings, FilmSettings)
#: Flags about files, several images, the device or the program itself.
NOT_OF_A_FRAME = set(
    "color device help mesh_file output progress quiet server stats sun_hours threads verbose".split()
)


def run(*arguments: str, **settings: object) -> subprocess.CompletedProcess[str]:
    """Runs the command in a process of its own."""
    return subprocess.run([sys.executable, "-m", "lightmesh", *arguments], capture_output=True, text=True, timeout=300, **settings)


def test_version_and_exit_codes(tmp_path):
    assert run("--version").stdout.startswith(f"lightmesh {lightmesh.__version__}")
    failed = run("render", "nope.obj", "-o", "out.png", cwd=tmp_path)
    assert failed.returncode != 0 and "nope.obj" in failed.stderr and "Traceback" not in failed.stderr
    assert list(tmp_path.iterdir()) == []


def test_entry_point_is_installed():
    script = Path(sys.executable).with_name("lightmesh")
    if not script.exists():
        script = Path(lightmesh.__file__).parents[1] / "bin" / "lightmesh"
    assert "main" in script.read_text()


@pytest.mark.parametrize(
    "flags",
    [
        {},
        {"quality": "draft"},
        {"mode": "area", "samples": 16},
        {"mode": "ray-trace", "aa": 4, "filter": "gauss"},
        {"lookup": "half-ball", "step": 40.0},
        {"ground": True, "up": "y", "background": (0.1, 0.2, 0.3)},
        {"exposure": "auto", "crop": (10, 10, 40, 30)},
        {"exposure": "auto", "crop": (-9, -5, 40, 30)},
        {"sky": "uniform", "samples": 16},
    ],
    ids=lambda flags: "+".join(flags) or "none",
)
def test_same_bits_as_the_command_line(tmp_path, renderer, flags):
    """The same file, byte by byte, for every format of pixels."""
    settings = RENDER | flags
    frame = renderer.render(Scene.builtin("gazebo"), **settings)
    arguments = [*GAZEBO]
    for name, value in flags.items():
        text = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
        arguments += [f"--{name}"] if value is True else [f"--{name}", text]
    for extension in ("exr", "png"):
        by_command, by_package = tmp_path / f"command.{extension}", tmp_path / f"package.{extension}"
        result = run(*arguments, "-o", str(by_command))
        assert result.returncode == 0, result.stderr
        frame.save(by_package)
        assert pixels(by_package) == pixels(by_command)


def pixels(path: Path) -> bytes:
    """The bytes of a file, without how long it took to render."""
    return re.sub(rb"[0-9.e-]+(?= s\b)", b"", path.read_bytes())


def test_layers_are_those_of_the_command_line(tmp_path, renderer):
    frame = renderer.render(Scene.builtin("gazebo"), layers=True, **RENDER)
    by_command, by_package = tmp_path / "command.exr", tmp_path / "package.exr"
    result = run(*GAZEBO, "--layers", str(by_command), "-o", str(tmp_path / "o.png"))
    assert result.returncode == 0, result.stderr
    frame.save_layers(by_package)
    assert pixels(by_package) == pixels(by_command)


def test_stats_are_those_of_the_command_line(tmp_path, renderer):
    frame = renderer.render(Scene.builtin("gazebo"), **RENDER)
    path = tmp_path / "stats.json"
    assert run(*GAZEBO, "--stats", str(path), "-o", str(tmp_path / "o.png")).returncode == 0
    stats = json.loads(path.read_text())
    assert frame.stats["counts"] == stats["counts"]
    # Those of the file come on top.
    assert frame.stats["settings"].items() <= stats["settings"].items()


def test_five_lines_of_the_readme(tmp_path, monkeypatch, model):
    """They are run as they are written, where the bunny is."""
    readme = (Path(__file__).resolve().parents[3] / "README.md").read_text()
    code = re.search(r"```python\n(.*?)```", readme, re.DOTALL).group(1)
    assert len(code.strip().splitlines()) <= 6
    bunny = model("bunny/bunny.ply")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bunny.ply").symlink_to(bunny)
    names: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), names)
    frame = names["frame"]
    assert isinstance(frame, lightmesh.Frame) and np.isfinite(frame.rgb).all() and frame.rgb.std() > 0.05
    (picture,) = tmp_path.glob("*.png")
    size = "x".join(map(str, frame.size))
    assert run("render", "bunny.ply", "--ground", "--size", size, "-o", "command.png", "--device", "auto", cwd=tmp_path).returncode == 0
    assert picture.read_bytes() == (tmp_path / "command.png").read_bytes()


def test_every_keyword_is_a_flag_and_every_flag_is_a_keyword():
    """The names in the stubs are those of the command line."""
    flags = {flag.replace("-", "_") for flag in re.findall(r"^ +(?:-\w, )?--([a-z-]+)", run("render", "--help").stdout, re.MULTILINE)}
    keywords = {keyword for settings in SETTINGS for keyword in settings.__annotations__}
    assert keywords <= flags, keywords - flags
    assert flags - keywords == NOT_OF_A_FRAME


def literals(annotation: object) -> set[object]:
    """All values of the literals in an annotation."""
    if typing.get_origin(annotation) is typing.Literal:
        return set(typing.get_args(annotation))
    return set().union(*map(literals, typing.get_args(annotation)))


@pytest.mark.parametrize("settings", SETTINGS)
def test_literals_are_what_flags_take(settings):
    """The choices in the stubs are the possible values of the command line's help."""
    sections = re.split(r"^ {2,6}(?:-\w, )?--([a-z-]+)", run("render", "--help").stdout, flags=re.MULTILINE)
    choices = dict(zip(sections[1::2], sections[2::2], strict=True))
    for keyword, annotation in typing.get_type_hints(settings).items():
        text = choices[keyword.replace("_", "-")]
        possible = set(re.findall(r"^ +- ([\w-]+):", text, re.MULTILINE)) if "Possible values:" in text else set()
        possible |= {value for found in re.findall(r"\[possible values: ([^\]]*)\]", text) for value in re.split(r",\s+", found)}
        ours = {str(value) for value in literals(annotation)}
        if possible and ours:
            assert ours == possible, keyword


@pytest.mark.parametrize("settings", SETTINGS)
def test_every_keyword_is_taken(renderer, scene, tmp_path, settings):
    """A keyword that the stubs have and the module does not would be a TypeError."""
    take = {
        FilmSettings: lambda **flag: renderer.film(scene, **({"size": (8, 6)} | flag)),
        ImageSettings: lambda **flag: renderer.render(scene, **({"size": (8, 6)} | flag)),
        SaveSettings: renderer.render(scene, size=(8, 6)).save,
    }
    for keyword in settings.__annotations__:
        with contextlib.suppress(lightmesh.LightmeshError):
            if settings is OpenSettings:
                Scene.open(tmp_path / "missing.obj", **{keyword: "?"})
            else:
                take[settings](*([tmp_path / "a.png"] if settings is SaveSettings else []), **({keyword: "?"}))

