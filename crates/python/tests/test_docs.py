"""Docstrings: what editors show from the stubs is what `help` shows."""

import ast
import inspect
from pathlib import Path

import pytest

import lightmesh
from lightmesh import _lightmesh


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
