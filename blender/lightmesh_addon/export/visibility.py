"""What renders show of a scene that is evaluated for viewports: operators have no other dependency graph."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from ..notes import Notes

#: Objects without them show nothing.
SHOWN = {"MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT", "EMPTY"}
#: So many names are in a note.
NAMED = 3


class RenderVisibility:
    """The objects that renders of a view layer show. Notes say what a viewport's evaluation has otherwise."""

    def __init__(self, depsgraph: bpy.types.Depsgraph, notes: Notes) -> None:
        layer = depsgraph.view_layer
        self.objects = set(_rendered(layer.layer_collection))
        shown = [obj for obj in self.objects if obj.type in SHOWN]
        hidden = [obj for obj in shown if not obj.visible_get(view_layer=layer)]
        if hidden:
            notes.add(f"Hidden in viewports, and left out, though renders show it: {_names(hidden)}")
        other = [obj for obj in shown if any(map(_differs, obj.modifiers))]
        if other:
            notes.add(f"Modifiers are those of viewports, not of renders: {_names(other)}")

    def shows(self, instance: bpy.types.DepsgraphObjectInstance) -> bool:
        """Whether renders show it."""
        obj = instance.object
        if instance.is_instance:
            return not obj.hide_render and instance.parent.original in self.objects
        return obj.original in self.objects and (not obj.is_instancer or obj.show_instancer_for_render)


def _rendered(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.Object]:
    if layer.collection.hide_render:
        return
    if not layer.exclude:
        yield from (obj for obj in layer.collection.objects if not obj.hide_render)
    for child in layer.children:
        yield from _rendered(child)


def _differs(modifier: bpy.types.Modifier) -> bool:
    levels = getattr(modifier, "levels", None), getattr(modifier, "render_levels", None)
    return modifier.show_viewport != modifier.show_render or (modifier.show_render and levels[0] != levels[1])


def _names(objects: Iterable[bpy.types.Object]) -> str:
    return names_of(obj.name for obj in objects)


def names_of(objects: Iterable[str]) -> str:
    """The first of these names, and how many more there are; empty without any."""
    names = sorted(objects)
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(f"“{name}”" for name in names[:NAMED]) + more
