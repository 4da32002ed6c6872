"""What the panels say, as settings of a render."""

from __future__ import annotations

from typing import Any

import bpy

from .choices import SETTINGS

def of_scene(scene: bpy.types.Scene) -> dict[str, Any]:
    """The settings of images of a scene, without their size."""
    chosen = scene.lightmesh
    settings = dict(SETTINGS[chosen.mode])
    settings["quality"] = chosen.quality.lower()
    settings["bounces"] = chosen.bounces
    settings["ambient_light"] = chosen.ambient_light.lower()
    settings["seed"] = chosen.seed
    settings["up"] = "z"
    if chosen.samples:
        settings["samples"] = chosen.samples
    if chosen.pixel_samples:
        settings["aa"] = chosen.pixel_samples
    if chosen.mode == "HALF_BALL":
        if chosen.step:
            settings["step"] = chosen.step
        settings["radius"] = chosen.radius
    if scene.render.film_transparent:
        settings["background"] = "transparent"
    return settings


def device(scene: bpy.types.Scene) -> tuple[str, int | None]:
    """The device and the number of threads of a scene's renderer."""
    render = scene.render
    return scene.lightmesh.device or "auto", render.threads if render.threads_mode == "FIXED" else None


def stages(settings: dict[str, Any]) -> list[tuple[float, dict[str, Any]]]:
    """What a viewport shows one after the other until it is as good as the settings ask for: shares of its size, and settings."""
    draft = {**settings, "quality": "draft"}
    draft.pop("samples", None)
    first = {**draft, "aa": 1, "ambient_light": "constant", "bounces": min(settings["bounces"], 1)}
    found = [(0.25, first), (1.0, draft)]
    return found if settings == draft else [*found, (1.0, settings)]
