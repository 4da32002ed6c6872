"""What objects and cameras of a scene ask for that a render does not do: warnings that name them, and say what helps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from ..notes import Notes


def of_linking(obj: bpy.types.Object, label: str, notes: Notes) -> None:
    """Light linking and shadow linking of what shines."""
    linking = getattr(obj, "light_linking", None)
    if linking is None:
        return
    if linking.receiver_collection:
        notes.add(f"{label} lights only what its light linking (“{linking.receiver_collection.name}”) says in the scene, but everything here")
    if linking.blocker_collection:
        notes.add(f"{label} is hidden only by what its shadow linking (“{linking.blocker_collection.name}”) says in the scene, but by everything here")


def of_world(world: bpy.types.World, notes: Notes) -> None:
    """Kinds of rays that do not see a world. That the camera does not is shown."""
    rays = getattr(world, "cycles_visibility", None)
    hidden = [name for name in ("diffuse", "glossy", "transmission") if rays and not getattr(rays, name)]
    if hidden:
        notes.add(f"World “{world.name}” is hidden from some rays ({', '.join(hidden)}) in the scene, but not here")
