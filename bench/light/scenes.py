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
