"""The extension: its manifest by the rules, also by those of Blender's own program, which the `bpy` module has with it."""

import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import bpy
import build
import pytest

WHEEL = "lightmesh-0.1.0-cp310-abi3-manylinux_2_28_x86_64.whl"
VALIDATOR = Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    """Stands for a wheel: nothing looks inside."""
    path = tmp_path / WHEEL
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("lightmesh/__init__.py", "")
    return path


def manifest() -> dict:
    text = build.with_wheels((build.ADDON / build.MANIFEST).read_text("utf-8"), [Path(WHEEL)])
    return tomllib.loads(text)


FILES = ["__init__.py", f"wheels/{WHEEL}"]


def test_manifest_keeps_the_rules() -> None:
    assert build.problems(manifest(), FILES) == []


CHANGES = [
    ("schema_version", "2.0.0", "schema_version"),
    ("id", "light-mesh", "id must"),
    ("version", "1.2", "version must"),
    ("version", "01.2.3", "version must"),
    ("tagline", "x" * 65, "tagline has 65"),
    ("tagline", "A renderer.", "punctuation"),
    ("maintainer", "", "maintainer is missing"),
    ("type", "addon", "type must"),
    ("license", ["MIT"], "license: MIT"),
    ("license", [], "license is missing"),
    ("tags", ["Shadows"], "tags: Shadows"),
    ("blender_version_min", "4.2", "blender_version_min"),
    ("blender_version_min", "3.6.0", "4.2.0 or later"),
    ("platforms", ["linux"], "platforms: linux"),
    ("permissions", {"files": "Reads images."}, "permissions: files"),
    ("permissions", {"disk": "Reads images"}, "permissions: disk"),
    ("permissions", {}, "permissions must"),
    ("wheels", ["./wheels/other-1-py3-none-any.whl"], "is not in the extension"),
    ("wheels", ["wheels/" + WHEEL], "must be a path"),
    ("wheels", [], "is not listed"),
    ("bl_info", {}, "not a key"),
]


@pytest.mark.parametrize(("key", "value", "problem"), CHANGES)
def test_broken_rules_are_found(key: str, value: object, problem: str) -> None:
    found = build.problems({**manifest(), key: value}, FILES)
    assert any(problem in text for text in found), found


def test_build(wheel: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One command makes the zip file; Blender takes it, and it has all sources and the wheel."""
    assert build.main(["--wheel", str(wheel), "--out", str(tmp_path / "dist")]) == 0
    path = Path(capsys.readouterr().out.strip())
    assert path.name == "lightmesh-0.1.0-linux_x64.zip"
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        assert f"wheels/{WHEEL}" in names and "blender_manifest.toml" in names
        assert {source.relative_to(build.ADDON).as_posix() for source in build.ADDON.rglob("*.py")} <= names
        assert not any("__pycache__" in name for name in names)
        assert tomllib.loads(archive.read("blender_manifest.toml").decode())["wheels"] == [f"./wheels/{WHEEL}"]
    build.validate(path, [sys.executable, str(VALIDATOR)])
    again = build.build([wheel], tmp_path / "again")
    assert again.read_bytes() == path.read_bytes()


def test_blender_refuses_broken_manifests(wheel: Path, tmp_path: Path) -> None:
    """Blender's own check sees what it is given."""
    path = tmp_path / "broken.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("__init__.py", "")
        archive.writestr("blender_manifest.toml", (build.ADDON / build.MANIFEST).read_text("utf-8").replace('version = "0.1.0"', 'version = "one"'))
    with pytest.raises(build.BuildError, match="does not take"):
        build.validate(path, [sys.executable, str(VALIDATOR)])


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("numpy-1.0-cp310-abi3-win_amd64.whl", "not a wheel of lightmesh"),
        ("lightmesh-0.1.0-cp310-abi3-musllinux_1_2_x86_64.whl", "where Blender does not run"),
    ],
)
def test_wrong_wheels(name: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / name).write_bytes(b"")
    assert build.main(["--wheel", str(tmp_path / name), "--out", str(tmp_path)]) == 1
    assert message in capsys.readouterr().err


def test_missing_wheel(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert build.main(["--wheel", str(tmp_path / WHEEL), "--out", str(tmp_path)]) == 1
    assert "is not there" in capsys.readouterr().err


def test_two_wheels_for_a_platform() -> None:
    with pytest.raises(build.BuildError, match="several wheels"):
        build.with_wheels("", [Path(WHEEL), Path(WHEEL.replace("2_28", "2_35"))])


def test_wheels_of_all_platforms() -> None:
    names = ["manylinux_2_28_x86_64", "macosx_11_0_universal2", "win_amd64", "manylinux_2_28_aarch64"]
    text = build.with_wheels("", [Path(f"lightmesh-0.1.0-cp310-abi3-{name}.whl") for name in names])
    platforms = tomllib.loads(text)["platforms"]
    assert platforms == ["linux-arm64", "linux-x64", "macos-arm64", "macos-x64", "windows-x64"]
    assert build.suffix(platforms) == ""


def ended_well(result: subprocess.CompletedProcess[str]) -> bool:
    """Whether a process ended without an error. The module of Blender 4.2 crashes at its end after any list of choices that a function makes."""
    return result.returncode == 0 or bpy.app.version < (4, 3)


def test_add_on_without_the_package_says_so() -> None:
    """Without the wheel, the add-on can be enabled, and rendering names what is missing."""
    script = (
        "import sys; sys.modules['lightmesh'] = None\n"
        f"sys.path.insert(0, {str(build.ADDON.parent)!r})\n"
        "import bpy, lightmesh_addon\n"
        "lightmesh_addon.register()\n"
        "bpy.context.scene.render.engine = 'LIGHTMESH'\n"
        "try:\n    bpy.ops.render.render()\n"
        "except RuntimeError as error:\n    print('caught', error)\n"
        "lightmesh_addon.unregister()\n"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert "caught" in result.stdout and "is missing: install the add-on from its zip file" in result.stdout, result
    assert ended_well(result), result


@pytest.mark.skipif("LIGHTMESH_WHEEL" not in os.environ, reason="LIGHTMESH_WHEEL names no wheel")
def test_blender_installs_it(tmp_path: Path) -> None:
    """Blender unpacks the zip file and the wheel, enables the add-on, and renders with it."""
    path = build.build([Path(os.environ["LIGHTMESH_WHEEL"])], tmp_path / "dist")
    script = (
        "import bpy, addon_utils\n"
        "bpy.ops.wm.read_factory_settings()\n"
        "addon_utils.enable('bl_pkg')\n"
        f"bpy.ops.extensions.package_install_files(filepath={str(path)!r}, repo='user_default', enable_on_install=True)\n"
        "scene = bpy.context.scene\n"
        "scene.render.engine, scene.render.resolution_percentage = 'LIGHTMESH', 5\n"
        "bpy.ops.render.render()\n"
        "addon_utils.disable('bl_ext.user_default.lightmesh')\n"
        "print('rendered')\n"
    )
    user = tmp_path / "user"
    user.mkdir()
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(user)}
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=100, env=environment)
    assert result.stdout.strip().endswith("rendered"), result
    assert list(user.glob("extensions/.local/lib/python*/site-packages/lightmesh/__init__.py"))


def test_registers_twice_in_a_row() -> None:
    """Disabling and enabling leaves nothing behind; the process ends."""
    script = (
        f"import sys; sys.path.insert(0, {str(build.ADDON.parent)!r})\n"
        "import bpy, lightmesh_addon\n"
        "for _ in range(2):\n"
        "    lightmesh_addon.register()\n    assert hasattr(bpy.types.Scene, 'lightmesh')\n"
        "    lightmesh_addon.unregister()\n    assert not hasattr(bpy.types.Scene, 'lightmesh')\n"
        "others = [p for p in bpy.types.Panel.__subclasses__() if not p.__module__.startswith('lightmesh_addon')]\n"
        "assert not any('LIGHTMESH' in getattr(p, 'COMPAT_ENGINES', ()) for p in others)\n"
        "print('done')\n"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert result.stdout.strip().endswith("done") and ended_well(result), result
