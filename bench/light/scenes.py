"""Scenes that are full of gathered light."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Scene:
    name: str
    source: str
    """Relative to the repository, to the folder of models after `models:`, or built in."""
    exposure: float
    """Of the images that are compared, in stops."""
    sky: str | None = None
    camera: str | None = None

    def file(self, root, models):
        if self.source.startswith("builtin:"):
            return self.source
        kind, _, path = self.source.rpartition(":")
        return (models if kind else root) / path


SCENES = [
    Scene("cornell", "bench/light/cornell.toml", 0.0),
    Scene("sponza", "models:sponza/sponza.obj", 0.5, "clear;sun=60,120", "-13,3,0;10,5,0;60"),
    Scene("interior", "scenes/interior.toml", 0.0),
    Scene("arbour", "scenes/arbour.toml", 0.0, "clear;sun=38,140"),
    Scene("house", "models:house/house.glb", 0.0, "clear;sun=40,225"),
    Scene("childpark", "builtin:childpark", 0.5, "clear;sun=8,250;alone"),
]


@dataclass(frozen=True)
class Room:
    """A scene of `scenes/`, which is compared with paths of any length."""

    name: str
    exposure: float
    """Of the images that are compared, in stops: a plain wall in the middle of the scale."""
    sky: bool = False
    """A sky of radiance 1 in all directions."""
    opening: tuple | None = None
    """The only opening to the sky, in an outer face of what stands alone: its corners. Nothing else is seen from there but the sky, so that
    Mitsuba gets a glowing rectangle instead of it, of which it needs fewer samples."""
    soft_boxes: bool = False
    """The panorama that `panorama.py` draws."""
    hidden: bool = False
    """Most of what is seen sees no light: paths from the lights to the camera need a tenth of the samples of paths from the camera."""
    outdoors: bool = False
    """Its mark is that of open air."""
    bounces: int = 0
    """Mirror reflections that are followed."""
    reflectance: float | None = None
    """The largest of all surfaces: none may be brighter, if the sky is all the light there is."""


ROOMS = [
    Room("room-window", 3.0, sky=True, opening=((-2.8, 0.9, -1.7), (-2.8, 2.2, 0.3)), reflectance=0.75, hidden=True),
    Room("room-door", 4.5, hidden=True),
    Room("room-slit", 6.5, sky=True, opening=((-2.8, 1.2, -2.6), (-2.8, 1.28, 1.4)), reflectance=0.8, hidden=True),
    Room("room-half-open", 1.0, sky=True, opening=((-2.5, 0, 3), (2.5, 2.7, 3)), reflectance=0.75),
    Room("shelf", -0.5, sky=True, outdoors=True, reflectance=0.6),
    Room("tube", 0.0, sky=True, outdoors=True, reflectance=0.7),
    Room("tables", -0.5, sky=True, outdoors=True, reflectance=0.7),
    Room("white-on-white", -0.5, sky=True, outdoors=True, reflectance=0.75),
    Room("rough-wood", -0.5, sky=True, outdoors=True, bounces=2),
    Room("rough-metal", -0.5, sky=True, outdoors=True, bounces=2),
    Room("soft-boxes", -0.5, soft_boxes=True, outdoors=True),
    Room("glowing-ceiling", 0.0),
    Room("screen", 3.0),
    Room("strip", 1.5),
    Room("cove", 0.0, hidden=True),
    Room("lampshade", 3.0, hidden=True),
    Room("uplight", 2.5, hidden=True),
    Room("sealed", 0.0, sky=True, reflectance=0.0),
]

BESIDE = ("room-window", "room-door", "glowing-ceiling", "strip")
"""Rooms that `light.py` renders by all programs."""
SCENES += [
    Scene(room.name, f"bench/light/scenes/{room.name}.toml", room.exposure, "uniform" if room.sky else None) for room in ROOMS if room.name in BESIDE
]
