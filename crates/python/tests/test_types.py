"""The stubs are true, and programs are checked by them."""

import ast
import collections.abc
import inspect
import subprocess
import sys
import types
import typing
from pathlib import Path

import numpy as np
import pytest
from conftest import camera, cube, floor

import lightmesh
import lightmesh.typing
from lightmesh import Cancel, Camera, Light, Renderer, Scene
from lightmesh.typing import DeviceInfo, FrameStats, SceneInfo

PROGRAM = Path(__file__).with_name("typed_program.py")

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
    path.write_text(PROGRAM.read_text())
    result = check(tool, path)
    assert result.returncode == 0, result.stdout


class Uses(ast.NodeVisitor):
    """What a program uses of classes: `Frame.rgb`, and of functions: `Renderer.render(cache)`. Which class a name is of, annotations say."""

    def __init__(self, classes: set[str]):
        self.classes, self.found, self.names = classes, set(), {}

    def visit_FunctionDef(self, function):
        self.names = {}
        for argument in function.args.args:
            self.names[argument.arg] = ast.unparse(argument.annotation)
        self.generic_visit(function)

    def visit_AnnAssign(self, statement):
        # Settings are a dictionary that says of which type it is.
        if isinstance(statement.value, ast.Dict):
            self.found |= {f"{ast.unparse(statement.annotation)}[{key.value}]" for key in statement.value.keys}
        self.generic_visit(statement)

    def visit_Assign(self, statement):
        if isinstance(statement.targets[0], ast.Name) and isinstance(statement.value, ast.Call):
            kind = ast.unparse(statement.value.func)
            self.names[statement.targets[0].id] = kind if kind in self.classes else self.names.get(statement.targets[0].id, "")
        self.generic_visit(statement)

    def visit_Name(self, name):
        self.found.add(name.id)

    def visit_Attribute(self, attribute):
        self.found.add(self.named(attribute))
        self.generic_visit(attribute)

    def visit_Call(self, call):
        name = self.named(call.func)
        self.found |= {f"{name}({number})" for number in range(len(call.args))}
        self.found |= {f"{name}({keyword.arg or '**'})" for keyword in call.keywords}
        self.generic_visit(call)

    def named(self, node) -> str:
        """`Frame.rgb` for `frame.rgb`, `visibility` for `lightmesh.visibility`."""
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            owner = self.names.get(node.value.id, node.value.id)
            return node.attr if owner == "lightmesh" else f"{owner}.{node.attr}"
        return ast.unparse(node)


def uses(program: str) -> set[str]:
    found = Uses(set(lightmesh.__all__))
    found.visit(ast.parse(program))
    return found.found


def parameters(name: str, function: object) -> list[set[str]]:
    """The parameters of a function, each as the ways of giving it: by position, by name, or with all settings."""
    given = [p for p in inspect.signature(function).parameters.values() if p.name not in ("self", "cls")]
    by_position = (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) if (p := next(iter(given), None)) else ()
    ways = []
    for number, parameter in enumerate(given):
        keyword = "**" if parameter.kind is parameter.VAR_KEYWORD else parameter.name
        ways.append({f"{name}({keyword})"} | ({f"{name}({number})"} if parameter.kind in by_position else set()))
    return ways


def public() -> list[set[str]]:
    """Everything that users can name. Each is a set of ways, one of which a program has to use."""
    names: list[set[str]] = []
    for name in lightmesh.__all__:
        thing = getattr(lightmesh, name)
        names.append({name})
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            if thing.__text_signature__:
                names += parameters(name, thing)
            for member, value in vars(thing).items():
                if member.startswith("_"):
                    continue
                names.append({f"{name}.{member}"})
                if callable(value) or isinstance(value, staticmethod):
                    names += parameters(f"{name}.{member}", getattr(thing, member))
        elif inspect.isroutine(thing):
            names += parameters(name, thing)
    for name, thing in vars(lightmesh.typing).items():
        if not name.startswith("_") and name[0].isupper() and name not in ("ArrayLike", "Callable", "Literal", "PathLike", "Union"):
            names.append({name})
            if name.endswith("Settings"):
                # Settings that several functions take are used once.
                for key in thing.__annotations__:
                    all_types = ("ImageSettings", "FilmSettings", "SaveSettings", "OpenSettings")
                    names.append({f"{kind}[{key}]" for kind in all_types if key in getattr(lightmesh.typing, kind).__annotations__})
    return names


def missing(program: str) -> list[set[str]]:
    used = uses(program)
    return [ways for ways in public() if not ways & used]


def test_the_program_uses_every_public_name():
    assert missing(PROGRAM.read_text()) == []


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("    assert_type(hours.mask, NDArray[np.bool_])\n", {"SunHours.mask"}),
        ("        lightmesh.LayersError,\n", {"LayersError"}),
        ("        alpha_cutoff=0.5,\n", {"Material.principled(alpha_cutoff)"}),
        ('        "turntable": 3,\n', {"FilmSettings[turntable]"}),
    ],
)
def test_what_a_program_does_not_use_is_found(line, name):
    assert line in PROGRAM.read_text()
    assert missing(PROGRAM.read_text().replace(line, "")) == [name]


def test_no_any_in_the_stubs():
    folder = Path(lightmesh.__file__).parent
    for path in (folder / "_lightmesh.pyi", folder / "_settings.py", folder / "_info.py", folder / "_progress.py", folder / "typing.py"):
        names = {node.id for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Name)}
        assert "Any" not in names, path.name


def mistakes(value: object, kind: object, where: str, seen: set[str]) -> list[str]:
    """Where a value is not of a type; `seen` gets the keys of dictionaries that were there."""
    if typing.is_typeddict(kind):
        if not isinstance(value, dict):
            return [f"{where} is no dictionary: {value!r}"]
        hints = typing.get_type_hints(kind)
        seen |= {f"{kind.__name__}.{key}" for key in value}
        found = [f"{where}.{key} is not in {kind.__name__}" for key in value.keys() - hints.keys()]
        found += [f"{where}.{key} is missing" for key in kind.__required_keys__ - value.keys()]
        for key in value.keys() & hints.keys():
            found += mistakes(value[key], hints[key], f"{where}.{key}", seen)
        return found
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin in (typing.Union, types.UnionType):
        ways = [mistakes(value, way, where, seen) for way in arguments]
        return [] if [] in ways else ways[0]
    if origin is typing.Literal:
        return [] if value in arguments else [f"{where} is {value!r}"]
    if origin is list:
        if not isinstance(value, list):
            return [f"{where} is no list: {value!r}"]
        return [mistake for item in value for mistake in mistakes(item, arguments[0], f"{where}[]", seen)]
    return [] if type(value) is kind else [f"{where} is {value!r}, not {kind.__name__}"]


def keys(kind: object) -> set[str]:
    """All keys of a dictionary, and of those in it."""
    if typing.is_typeddict(kind):
        hints = typing.get_type_hints(kind)
        return {f"{kind.__name__}.{key}" for key in hints}.union(*map(keys, hints.values()))
    return set().union(*map(keys, typing.get_args(kind)))


def all_lights() -> list[Light]:
    return [
        Light.point((1.0, 4.0, 3.0), name="lamp", spread=0.1),
        Light.directional((0.0, -1.0, 0.0), angle=0.53),
        Light.spot((0.0, 3.0, 0.0), (0.0, -1.0, 0.0), inner=10.0, outer=20.0, radius=0.1),
        Light.sphere((0.0, 5.0, 0.0), 0.5, falloff="inverse-square"),
        Light.disk((0.0, 5.0, 0.0), (0.0, -1.0, 0.0), 1.0),
        Light.rectangle((0.0, 5.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ]


def test_infos_are_of_their_types(model):
    scene = Scene([floor(), cube()], all_lights())
    at, to = (4.0, 3.0, 5.0), (0.0, 0.7, 0.0)
    scene.cameras = [Camera(at, to, vfov=40.0), Camera(at, to, hfov=40.0), Camera(at, to, height=3.0, shift=(0.1, 0.2), near=1.0, far=9.0)]
    seen: set[str] = set()
    infos = [scene.info(), Scene([]).info(), Scene.builtin("gazebo").info(), Scene.open(model("milk_truck/CesiumMilkTruck.glb")).info()]
    assert [mistakes(info, SceneInfo, "info", seen) for info in infos] == [[]] * len(infos)
    assert keys(SceneInfo) - seen == set()


def test_stats_are_of_their_types(renderer):
    scene = Scene([floor(), cube()], [Light.sphere((2.0, 4.0, 1.0), 0.5)], Camera((4.0, 3.0, 5.0), (0.0, 0.7, 0.0), shift=(0.1, 0.0), near=0.5, far=50.0))
    seen: set[str] = set()
    frames = [renderer.render(scene, size=(16, 12), **settings) for settings in ({}, {"lookup": "half-ball", "crop": (0, 0, 8, 8)}, {"mode": "area"})]
    cancel = Cancel()
    slow = {"size": (1600, 1200), "mode": "area", "samples": 4096, "cancel": cancel}
    frames.append(renderer.render(scene, partial=True, progress=lambda progress: progress.done > 0.1 and cancel.cancel(), **slow))
    assert [mistakes(frame.stats, FrameStats, "stats", seen) for frame in frames] == [[]] * len(frames)
    assert keys(FrameStats) - seen == set()


def test_devices_are_of_their_types():
    seen: set[str] = set()
    assert [mistakes(device, DeviceInfo, "device", seen) for device in lightmesh.devices()] == [[]] * len(lightmesh.devices())
    assert keys(DeviceInfo) - seen == set()


def test_mistakes_in_types_are_found():
    stats = Renderer("cpu").render(Scene(floor(), all_lights(), camera()), size=(8, 6), quality="draft").stats
    for change, mistake in (
        ({"version": 1.0}, ["stats.version is 1.0, not int"]),
        ({"more": 1}, ["stats.more is not in FrameStats"]),
        ({"memory": {"host_peak_bytes": 1}}, ["stats.memory.device_peak_bytes is missing"]),
    ):
        assert mistakes({**stats, **change}, FrameStats, "stats", set()) == mistake


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
