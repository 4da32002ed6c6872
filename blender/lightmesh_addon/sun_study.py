"""Sun studies: what is exported of a scene for one, and the work on it, which needs nothing of Blender."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np

from . import session, settings
from .export import camera
from .export.scene import Exporter

if TYPE_CHECKING:
    from .job import Job
    from .notes import Notes
    from .output import Output
    from .properties import LightmeshSunSettings


@dataclass
class Study:
    """A scene under the sky of a day. `renderer` is called by the work, for a device may take a while to start."""

    scene: lightmesh.Scene
    renderer: Callable[[], lightmesh.Renderer]
    settings: dict[str, Any]
    #: What of the scene the sky stands for; may be empty.
    replaced: str


@dataclass
class Hours:
    """The hours of direct sun of an image: its picture with a legend, and the numbers, (H, W), row 0 at the top."""

    png: bytes
    values: np.ndarray
    #: What surfaces that let light through count as.
    notes: list[str]


@dataclass
class Day:
    """The frames that were rendered."""

    count: int


def study(depsgraph: bpy.types.Depsgraph, notes: Notes) -> Study:
    """The study that a scene asks for, of what its camera sees."""
    scene = depsgraph.scene
    sun = scene.lightmesh.sun
    view, framing = camera.of_scene(depsgraph)
    exported = Exporter(depsgraph, notes, sky=sky(sun)).run()
    if exported.has_holdouts:
        notes.add("Holdouts are black in a study: render without it to have holes in their place")
    camera.warn_of(depsgraph, notes)
    if camera.is_mirrored(depsgraph.scene.camera.evaluated_get(depsgraph)):
        notes.add(f"Camera “{depsgraph.scene.camera.name}” is mirrored by a negative scale: flip the images of a study, left to right")
    made = exported.scene(view)
    for text in made.warnings:
        notes.add(text)
    chosen = {**settings.of_scene(scene), **exported.settings, **framing, "sun": day(sun), "glass": sun.glass.lower()}
    device = settings.device(scene)
    return Study(made, lambda: session.renderer(*device), chosen, replaced(depsgraph))


def day(sun: LightmeshSunSettings) -> str:
    """The day as `--sun` has it. A step that nobody set is none: frames have the same one, and hours are those of all times."""
    minutes = round(60.0 * sun.offset)
    offset = f"{'-' if minutes < 0 else '+'}{clock(abs(minutes))}"
    date = f"{sun.year:04}-{sun.month:02}-{sun.day:02}{offset}"
    hours = "-".join(clock(round(60.0 * hour)) for hour in (sun.begin, sun.end))
    step = f"/{sun.step}m" if sun.is_property_set("step") else ""
    return f"{number(sun.latitude)},{number(sun.longitude)},{date},{hours}{step}"


def sky(sun: LightmeshSunSettings) -> str:
    """The sky as `--sky` has it. Where the sun stands in it comes from the day."""
    return f"clear;north={number(sun.north)};strength={number(sun.strength)}"


def clock(minutes: int) -> str:
    return f"{minutes // 60:02}:{minutes % 60:02}"


def number(value: float) -> str:
    """Blender's numbers of 32 bits as they were typed."""
    return f"{value:.5f}".rstrip("0").rstrip(".")


def replaced(depsgraph: bpy.types.Depsgraph) -> str:
    """What of the scene the sky of a study stands for."""
    world, objects = depsgraph.scene.world, depsgraph.view_layer.objects
    suns = [obj.name for obj in objects if obj.type == "LIGHT" and obj.data.type == "SUN" and not obj.hide_render]
    names = ([f"World “{world.name}”"] if world else []) + [f"Light “{name}”" for name in suns]
    return ", ".join(names)


def hours(asked: Study, job: Job) -> Hours:
    """Computes the hours of direct sun."""
    found = asked.renderer().sun_hours(asked.scene, progress=job.follow(), cancel=job.token, **asked.settings)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hours.png"
        found.save(path)
        return Hours(path.read_bytes(), found.hours, about_glass(found.notes))


def about_glass(notes: list[str]) -> list[str]:
    """The notes on glass, in the words of the panel."""
    return [re.sub(r"glass=(\w+)", lambda name: f"Glass “{name[1].capitalize()}”", note) for note in notes if "glass=" in note]


def frames(asked: Study, output: Output, job: Job) -> Day:
    """Renders the frames of the day and writes them."""
    output.path.parent.mkdir(parents=True, exist_ok=True)
    film = asked.renderer().film(
        asked.scene, output.path, progress=job.follow(), cancel=job.token, **asked.settings, **output.settings
    )
    return Day(sum(1 for _ in film))
