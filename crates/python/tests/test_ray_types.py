"""The annotations of `lightmesh.ray` are complete, and programs are checked by them."""

import dataclasses
import inspect
import subprocess
import sys
from pathlib import Path

import pytest
from test_types import check

pytest.importorskip("ray")

import lightmesh.ray

PROGRAM = Path(__file__).with_name("typed_ray.py")


@pytest.mark.parametrize("tool", ["mypy", "pyright"])
def test_programs(tool, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(PROGRAM.read_text())
    result = check(tool, path)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize("tool", ["mypy", "pyright"])
@pytest.mark.parametrize("setting", ["quality='best'", "sizee=(1, 2)", "frames=1.5", "layers=True"])
def test_wrong_arguments(tool, setting, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(f"\nimport lightmesh.ray\n\nlightmesh.ray.film('a.toml', 'f.#.png', {setting})\n")
    result = check(tool, path)
    assert result.returncode != 0 and "program.py:4" in result.stdout.replace(" ", ""), result.stdout


@pytest.mark.parametrize("tool", ["mypy", "pyright"])
def test_the_package_itself(tool):
    pytest.importorskip(tool)
    folder = str(Path(lightmesh.ray.__file__).parent)
    command = {"mypy": ["mypy", "--strict", "-p", "lightmesh.ray"], "pyright": ["pyright", "--pythonpath", sys.executable, folder]}
    result = subprocess.run([sys.executable, "-m", *command[tool]], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stdout


def public() -> set[str]:
    """Names that users write: those that are exported, their fields and properties, and parameters."""
    names = set(lightmesh.ray.__all__)
    for name in lightmesh.ray.__all__:
        thing = getattr(lightmesh.ray, name)
        if dataclasses.is_dataclass(thing):
            names |= {field.name for field in dataclasses.fields(thing)}
            names |= {member for member, value in vars(thing).items() if isinstance(value, property)}
        elif inspect.isfunction(thing):
            kinds = (inspect.Parameter.KEYWORD_ONLY,)
            names |= {f"{parameter.name}=" for parameter in inspect.signature(thing).parameters.values() if parameter.kind in kinds}
    return names


def test_the_program_uses_every_public_name():
    text = PROGRAM.read_text()
    assert {name for name in public() if name not in text} == set()
    assert {name for name in public() if name not in text.replace("report.leading", "")} == {"leading"}


def test_everything_is_documented():
    for name in lightmesh.ray.__all__:
        thing = getattr(lightmesh.ray, name)
        assert thing.__doc__, name
        if inspect.isfunction(thing):
            parameters = inspect.signature(thing).parameters.values()
            bare = [p.name for p in parameters if p.kind is not p.VAR_KEYWORD and f"`{p.name}`" not in thing.__doc__]
            assert bare == [], name
