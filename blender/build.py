"""Builds the add-on as an extension of Blender: a zip file with its manifest and the wheels of the Python package `lightmesh`.

    python blender/build.py --wheel lightmesh-….whl [--wheel …] --out dist [--blender blender]

The manifest is checked by the rules of Blender's extensions platform, and by Blender itself if its executable is given.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Sequence
from pathlib import Path

ADDON = Path(__file__).resolve().parent / "lightmesh_addon"
MANIFEST = "blender_manifest.toml"
SCHEMA = "1.0.0"
REQUIRED = ("schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min", "license")
KNOWN = (*REQUIRED, "tags", "website", "copyright", "blender_version_max", "platforms", "permissions", "wheels", "build")
VERSION = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)(-[0-9A-Za-z.-]+)?(\+[0-9A-Za-z.-]+)?")
BLENDER_VERSION = re.compile(r"\d+\.\d+\.\d+")
#: Tags that the platform knows for add-ons.
TAGS = {
    "3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine", "Geometry Nodes",
    "Grease Pencil", "Import-Export", "Lighting", "Material", "Mesh", "Modeling", "Motion Tracking", "Node", "Object", "Paint", "Physics",
    "Pipeline", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System", "Text Editor", "Tracking", "User Interface", "UV",
}  # fmt: skip
#: Licenses that the platform takes for add-ons: those that go with the GPL.
LICENSES = {
    "SPDX:GPL-2.0-or-later", "SPDX:GPL-3.0-or-later", "SPDX:LGPL-2.1-or-later", "SPDX:LGPL-3.0-or-later", "SPDX:MIT", "SPDX:MIT-0", "SPDX:MPL-2.0",
    "SPDX:Apache-2.0", "SPDX:BSD-1-Clause", "SPDX:BSD-2-Clause", "SPDX:BSD-3-Clause", "SPDX:BSL-1.0", "SPDX:CC0-1.0", "SPDX:Pixar", "SPDX:Zlib",
}  # fmt: skip
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}
#: Blender's names of platforms, by the beginnings and ends of those of wheels.
PLATFORMS = {
    ("manylinux", "x86_64"): ("linux-x64",),
    ("manylinux", "aarch64"): ("linux-arm64",),
    ("macosx", "x86_64"): ("macos-x64",),
    ("macosx", "arm64"): ("macos-arm64",),
    ("macosx", "universal2"): ("macos-arm64", "macos-x64"),
    ("win", "amd64"): ("windows-x64",),
    ("win", "arm64"): ("windows-arm64",),
}
PLATFORM_NAMES = {name for names in PLATFORMS.values() for name in names}


class BuildError(Exception):
    """What keeps the extension from being built, and how to mend it."""


def problems(manifest: dict[str, object], files: Sequence[str]) -> list[str]:
    """What breaks the rules of Blender's extensions platform. `files`: paths in the zip file."""
    found = [f"{key} is missing" for key in REQUIRED if not manifest.get(key)]
    found += [f"{key} is not a key of a manifest" for key in manifest if key not in KNOWN]
    text = {key: str(manifest.get(key, "")) for key in REQUIRED}
    if text["schema_version"] != SCHEMA:
        found.append(f"schema_version must be {SCHEMA}")
    if not text["id"].isidentifier() or text["id"].startswith("_") or "__" in text["id"]:
        found.append("id must be a Python identifier without double or leading underscores")
    if not VERSION.fullmatch(text["version"]):
        found.append("version must be semantic, as in 1.2.3")
    if text["type"] != "add-on":
        found.append("type must be add-on")
    for key in ("blender_version_min", "blender_version_max"):
        if key in manifest and not BLENDER_VERSION.fullmatch(str(manifest[key])):
            found.append(f"{key} must be as in 4.2.0")
    if BLENDER_VERSION.fullmatch(text["blender_version_min"]) and _numbers(text["blender_version_min"]) < (4, 2, 0):
        found.append("blender_version_min must be 4.2.0 or later")
    found += _text_problems(text)
    found += _list_problems(manifest)
    found += _wheel_problems(manifest, files)
    if "__init__.py" not in files:
        found.append("__init__.py is missing")
    return found


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def _text_problems(text: dict[str, str]) -> list[str]:
    found, tagline = [], text["tagline"]
    if len(tagline) > 64:
        found.append(f"tagline has {len(tagline)} characters, of 64 at most")
    if tagline and not _ends_well(tagline):
        found.append("tagline must not end with punctuation")
    for key in ("name", "tagline", "maintainer"):
        if text[key] != text[key].strip() or any(not character.isprintable() for character in text[key]):
            found.append(f"{key} must be one line without spaces around")
    return found


def _ends_well(text: str) -> bool:
    return text[-1].isalnum() or text[-1] in ")]}"


def _list_problems(manifest: dict[str, object]) -> list[str]:
    found = []
    for key, known in (("license", LICENSES), ("tags", TAGS), ("platforms", PLATFORM_NAMES)):
        values = manifest.get(key, [])
        if not isinstance(values, list) or (not values and key in manifest):
            found.append(f"{key} must be a list that is not empty")
        else:
            found += [f"{key}: {value} is unknown" for value in values if value not in known]
    permissions = manifest.get("permissions", {})
    if not isinstance(permissions, dict) or (not permissions and "permissions" in manifest):
        return [*found, "permissions must be a table of reasons that is not empty"]
    for name, reason in permissions.items():
        if name not in PERMISSIONS:
            found.append(f"permissions: {name} is unknown")
        if not isinstance(reason, str) or not reason or len(reason) > 64 or not _ends_well(reason):
            found.append(f"permissions: {name} needs a reason of up to 64 characters without a closing period")
    return found


def _wheel_problems(manifest: dict[str, object], files: Sequence[str]) -> list[str]:
    wheels = manifest.get("wheels", [])
    if not isinstance(wheels, list):
        return ["wheels must be a list"]
    found = []
    for wheel in wheels:
        path = str(wheel)
        if not path.startswith("./") or not path.endswith(".whl") or "\\" in path or ".." in path:
            found.append(f"wheels: {path} must be a path as in ./wheels/name.whl")
        elif len(Path(path).stem.split("-")) not in (5, 6):
            found.append(f"wheels: {path} is not named as wheels are")
        elif path[2:] not in files:
            found.append(f"wheels: {path} is not in the extension")
    listed = {str(wheel)[2:] for wheel in wheels}
    return found + [f"wheels: {file} is not listed" for file in files if file.endswith(".whl") and file not in listed]


def platforms_of(wheel: Path) -> tuple[str, ...]:
    """Blender's names of the platforms of a wheel."""
    tag = wheel.stem.split("-")[-1]
    for (begin, end), names in PLATFORMS.items():
        if tag.startswith(begin) and tag.endswith(end):
            return names
    raise BuildError(f"{wheel.name} is for {tag}, where Blender does not run: build a wheel for one of {', '.join(sorted(PLATFORM_NAMES))}")


def with_wheels(manifest: str, wheels: Sequence[Path]) -> str:
    """The text of a manifest with its platforms and wheels."""
    platforms = sorted(name for wheel in wheels for name in platforms_of(wheel))
    if len(set(platforms)) < len(platforms):
        raise BuildError("there are several wheels for one platform: give one for each")
    listed = "".join(f'    "./wheels/{wheel.name}",\n' for wheel in wheels)
    names = ", ".join(f'"{platform}"' for platform in platforms)
    return f"{manifest.rstrip()}\nplatforms = [{names}]\nwheels = [\n{listed}]\n"


def suffix(platforms: Sequence[str]) -> str:
    """The end of the zip file's name: that of its platform, as Blender itself names such files, if there is one alone."""
    return f"-{platforms[0].replace('-', '_')}" if len(platforms) == 1 else ""


def checked_wheels(paths: Sequence[Path]) -> list[Path]:
    """The wheels, if they are of the package."""
    for path in paths:
        if not path.is_file():
            raise BuildError(f"{path} is not there: build it with maturin")
        if path.suffix != ".whl" or not path.name.startswith("lightmesh-"):
            raise BuildError(f"{path.name} is not a wheel of lightmesh")
    return sorted(paths, key=lambda path: path.name)


def sources() -> list[Path]:
    """The files of the add-on itself."""
    return sorted(path for path in ADDON.rglob("*") if path.is_file() and "__pycache__" not in path.parts and path.name != MANIFEST)


def build(wheels: Sequence[Path], out: Path) -> Path:
    """Writes the zip file into the folder `out`, and returns its path. The same files give the same bytes."""
    wheels = checked_wheels(wheels)
    text = with_wheels((ADDON / MANIFEST).read_text("utf-8"), wheels)
    contents = {MANIFEST: text.encode()}
    contents |= {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in sources()}
    contents |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    manifest = tomllib.loads(text)
    if found := problems(manifest, list(contents)):
        raise BuildError(f"the manifest {ADDON / MANIFEST} breaks rules:\n" + "\n".join(f"  {problem}" for problem in found))
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{manifest['id']}-{manifest['version']}{suffix(manifest['platforms'])}.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in sorted(contents.items()):
            entry = zipfile.ZipInfo(name)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return path


def validate(path: Path, command: Sequence[str]) -> None:
    """Lets Blender check the zip file: `command` is that of its extensions, up to `validate`."""
    result = subprocess.run([*command, "validate", str(path)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise BuildError(f"Blender does not take {path.name}:\n{result.stdout}{result.stderr}")


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="Builds the Blender extension of Lightmesh.")
    parser.add_argument("--wheel", type=Path, action="append", required=True, help="a wheel of the Python package; repeatable, one for each platform")
    parser.add_argument("--out", type=Path, required=True, help="the folder for the zip file")
    parser.add_argument("--blender", help="the executable of Blender, to validate the result with")
    chosen = parser.parse_args(arguments)
    try:
        path = build(chosen.wheel, chosen.out)
        if chosen.blender:
            validate(path, [chosen.blender, "--command", "extension"])
    except BuildError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
