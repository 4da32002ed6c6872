"""What is kept from render to render: renderers as long as Blender runs, and during an animation the prepared scene and what light points saw."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh

if TYPE_CHECKING:
    from .export.scene import Exported

#: What is kept is of one view layer of one scene, by their names.
Key = tuple[str, str]

_renderers = {}
_prepared = {}
_caches = {}


def renderer(device: str, threads: int | None = None) -> lightmesh.Renderer:
    """The renderer of a device; there is one for all frames and viewports."""
    key = (device, threads)
    if key not in _renderers:
        _renderers[key] = lightmesh.Renderer(device, threads=threads)
    return _renderers[key]


def cache(key: Key) -> lightmesh.MeshCache:
    """What light points see and surfaces gather, from frame to frame."""
    return _caches.setdefault(key, lightmesh.MeshCache())


def prepared(
    key: Key,
    renderer: lightmesh.Renderer,
    exported: Exported,
    camera: lightmesh.Camera,
    settings: dict[str, Any],
    progress: Callable[[lightmesh.Progress], None] | None = None,
) -> lightmesh.PreparedScene:
    """The scene with its structure; what has not changed since the last frame is kept."""
    before, last = _prepared.pop(key, (None, None))
    scene = exported.scene(camera, before, last)
    made = renderer.prepare(scene, before=last, progress=progress, **settings)
    _prepared[key] = exported, made
    return made


def forget(*_: object) -> None:
    """Frees what is kept for the next frame."""
    _prepared.clear()
    _caches.clear()


@bpy.app.handlers.persistent
def _ended(scene: bpy.types.Scene | None, *_: object) -> None:
    # A scene with persistent data keeps it for the next render, as with other engines.
    if not (scene and scene.render.use_persistent_data):
        forget()


@bpy.app.handlers.persistent
def _loading(*_: object) -> None:
    forget()


HANDLERS = (("render_complete", _ended), ("render_cancel", _ended), ("load_pre", _loading))


def register() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    forget()
    _renderers.clear()
