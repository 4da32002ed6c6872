"""Docstrings: what editors show from the stubs is what `help` shows."""

import ast
import inspect
import re
from pathlib import Path

import pytest

import lightmesh
from lightmesh import _lightmesh
from lightmesh.typing import FilmSettings, ImageSettings, OpenSettings, SaveSettings


def words(text: str | None) -> str:
    """A docstring without its line breaks."""
    return " ".join((text or "").split())


def documented() -> dict[str, str]:
    """The docstrings of the stubs, by names such as `Frame.rgb`."""
    tree = ast.parse((Path(lightmesh.__file__).parent / "_lightmesh.pyi").read_text())
    found: dict[str, str] = {}

    def visit(node: ast.AST, prefix: str) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.ClassDef | ast.FunctionDef):
                text = ast.get_docstring(child)
                if text and not child.name.startswith("_"):
                    found[prefix + child.name] = words(text)
                if isinstance(child, ast.ClassDef):
                    visit(child, f"{child.name}.")

    visit(tree, "")
    return found


@pytest.mark.parametrize("name", documented())
def test_stubs_and_module_say_the_same(name):
    thing = _lightmesh
    for part in name.split("."):
        thing = getattr(thing, part)
    # Settings are listed by the module, and are annotations in the stubs.
    assert words(thing.__doc__.split("\n\nSettings:\n")[0]) == documented()[name]


def test_everything_is_documented():
    for name in lightmesh.__all__:
        thing = getattr(lightmesh, name)
        if not (inspect.isclass(thing) or callable(thing)):
            continue
        assert thing.__doc__, name
        if thing.__module__ == "lightmesh" and inspect.isclass(thing):
            members = [member for member in vars(thing) if not member.startswith("_")]
            bare = [member for member in members if not inspect.getdoc(getattr(thing, member))]
            assert bare == [], name


#: What takes settings, and their type.
SETTINGS = {
    "Renderer.prepare": ImageSettings,
    "Renderer.render": ImageSettings,
    "Renderer.visibility": ImageSettings,
    "visibility": ImageSettings,
    "Renderer.film": FilmSettings,
    "Renderer.sun_hours": FilmSettings,
    "Scene.open": OpenSettings,
    "Frame.save": SaveSettings,
    "Frame.save_layers": SaveSettings,
    "Frame.to_png": SaveSettings,
}


def functions() -> dict[str, tuple[object, str]]:
    """All functions that users call, with what `help` says of them; of constructors and methods, with what it says of the class."""
    found = {}
    for name in lightmesh.__all__:
        thing = getattr(lightmesh, name)
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            text = inspect.getdoc(thing) or ""
            if thing.__text_signature__:
                found[name] = (thing, text)
            for member in vars(thing):
                function = getattr(thing, member)
                if not member.startswith("_") and callable(function):
                    found[f"{name}.{member}"] = (function, f"{inspect.getdoc(function)} {text}")
        elif inspect.isroutine(thing):
            found[name] = (thing, inspect.getdoc(thing) or "")
    return found


@pytest.mark.parametrize("name", functions())
def test_help_has_every_parameter(name):
    """It is named in backquotes where it is explained, and settings are listed with their types and what they do."""
    function, text = functions()[name]
    parameters = [p for p in inspect.signature(function).parameters.values() if p.name not in ("self", "cls")]
    settings = [p for p in parameters if p.kind is p.VAR_KEYWORD]
    bare = [p.name for p in parameters if p not in settings and f"`{p.name}`" not in text]
    assert bare == [], text
    assert bool(settings) == (name in SETTINGS)
    for keyword in SETTINGS[name].__annotations__ if settings else ():
        assert re.search(rf"^{keyword}: .+\n    .+", text, re.MULTILINE), keyword
