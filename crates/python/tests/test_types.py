"""The stubs are true, and programs are checked by them."""

import subprocess
import sys
from pathlib import Path

import pytest

import lightmesh

PROGRAM = '''
import numpy as np
import lightmesh
from lightmesh import Camera, Frame, Geometry, Light, Material, MeshCache, Renderer, Scene

box = Geometry.from_arrays(np.zeros((3, 3), np.float32), [(0, 1, 2)], material=Material.principled(0.5, roughness=0.2))
scene = Scene([box], [Light.sphere((0, 1, 0), 0.5)], Camera((1, 1, 1), (0, 0, 0)))
renderer = Renderer(device="cpu")
frame: Frame = renderer.render(scene, size=(64, 48), quality="good", cache=MeshCache(), progress=lambda progress: print(progress.done))
mean: float = float(frame.rgb.mean())
first = frame.visibility[0].shape
frame.save("a.png", bit_depth=16)
shares = lightmesh.visibility(np.zeros((1, 3)), np.ones((1, 3)), scene)
'''

WRONG = '''
import lightmesh
renderer = lightmesh.Renderer()
renderer.render(lightmesh.Scene.builtin("gazebo"), {setting})
'''


def check(tool: str, path: Path) -> subprocess.CompletedProcess[str]:
    pytest.importorskip(tool)
    command = {"mypy": ["mypy", "--strict", "--cache-dir", str(path.parent / "cache")], "pyright": ["pyright", "--pythonpath", sys.executable]}[tool]
    return subprocess.run([sys.executable, "-m", *command, str(path)], capture_output=True, text=True, timeout=600, cwd=path.parent)


@pytest.mark.parametrize("tool", ["mypy", "pyright"])
def test_programs(tool, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(PROGRAM)
    result = check(tool, path)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize("tool", ["mypy", "pyright"])
@pytest.mark.parametrize("setting", ["quality='best'", "sizee=(1, 2)", "seed='a'"])
def test_wrong_settings(tool, setting, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(WRONG.format(setting=setting))
    result = check(tool, path)
    assert result.returncode != 0 and "program.py:4" in result.stdout.replace(" ", ""), result.stdout


def test_stubs_match_the_module():
    """Every name, argument and property of the stubs is in the module, and the other way round."""
    pytest.importorskip("mypy")
    result = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "lightmesh", "--ignore-disjoint-bases", "--allowlist", str(Path(__file__).with_name("stubs.txt"))],
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert result.returncode == 0, result.stdout


def test_typed():
    assert (Path(lightmesh.__file__).parent / "py.typed").exists()
