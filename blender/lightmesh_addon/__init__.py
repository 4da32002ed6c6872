"""Lightmesh as a render engine of Blender. The add-on exports scenes and shows pictures; the Python package `lightmesh` renders."""

from __future__ import annotations

import importlib.util

import bpy

from . import engine, operators, panels, properties


def register() -> None:
    properties.register()
    operators.register()
    panels.register()
    bpy.utils.register_class(engine.LightmeshEngine)
    if _installed():
        from . import session

        session.register()


def unregister() -> None:
    if _installed():
        from . import session

        session.unregister()
    bpy.utils.unregister_class(engine.LightmeshEngine)
    panels.unregister()
    operators.unregister()
    properties.unregister()


def _installed() -> bool:
    """Whether the package is there; without it, the engine says what is missing when it is asked to render."""
    return importlib.util.find_spec("lightmesh") is not None
