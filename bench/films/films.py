"""Films by Lightmesh, with their layers and cameras."""

import hashlib
import json
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

from stages import FPS


class Frame:
    """Planes of a frame, and the camera that saw it."""

    def __init__(self, stem):
        layers = OpenEXR.File(f"{stem}.exr", separate_channels=True).channels()
        plane = lambda *names: np.stack([layers[name].pixels for name in names], axis=-1).astype(np.float64)  # noqa: E731
        self.color = plane("R", "G", "B")
        # Ambient and gathered light.
        self.rest = plane("L.rest.R", "L.rest.G", "L.rest.B")
        self.depth = layers["Z"].pixels.astype(np.float64)
        self.position, self.normal = plane("P.X", "P.Y", "P.Z"), plane("N.X", "N.Y", "N.Z")
        self.ids = np.stack([layers["id.object"].pixels, layers["id.material"].pixels], axis=-1)
        self.visibility = plane(*sorted(name for name in layers if name.startswith("V.")))
        settings = json.loads(Path(f"{stem}.json").read_text())["settings"]
        self.camera = settings["camera"]
        self.step = (settings["lattice"] or {}).get("step")


class Film:
    """Frames by number, read when they are needed; `part` is what they show of the whole image: first and last rows and columns."""

    def __init__(self, name, frames, part=None, whole=False):
        self.name, self.frames, self.part = name, dict(frames), part
        self.whole = whole

    def __getitem__(self, number):
        stem = self.frames[number]
        frame = Frame(stem)
        if self.whole:
            top, bottom, left, right = self.part
            for plane in ("color", "rest", "depth", "position", "normal", "ids", "visibility"):
                setattr(frame, plane, getattr(frame, plane)[top:bottom, left:right])
        return frame

    def join(self, other):
        self.frames |= other.frames


class Films:
    """Renders films into a folder, unless they are there."""

    def __init__(self, plan, folder):
        self.plan, self.folder = plan, folder.resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.reused = 0
        self.program = str(Path(plan.lightmesh).resolve())
        park = self.folder / "park.toml"
        subprocess.run([self.program, "export", "builtin:childpark", "-o", park, "--quiet"], check=True)
        self.park = park.read_text()

    def scene(self, name, text):
        path = self.folder / f"{name.replace(' ', '-')}.toml"
        path.write_text(text)
        return path

    def render(self, name, scene, flags, frames, part=None):
        stem = name.replace(" ", "-")
        size = "x".join(map(str, self.plan.size))
        command = [self.program, "render", str(scene), *flags, "--size", size, "--fps", str(FPS), "--frames", frames, "--device", self.plan.device]
        outputs = [flag for kind in ("-o", "--layers", "--stats") for flag in (kind, f"{self.folder / stem}.###.{ENDINGS[kind]}")]
        first, last = map(int, frames.split("-"))
        found = {number: self.folder / f"{stem}.{number:03}" for number in range(first, last + 1)}
        # What a film is of: the same command and scene need no second one.
        stamp = hashlib.sha256(json.dumps([command[1:], scene.read_text(), version(self.program)]).encode()).hexdigest()
        mark = self.folder / f"{stem}.stamp"
        if mark.exists() and mark.read_text() == stamp:
            self.reused += 1
        else:
            subprocess.run([*command, *outputs, "--overwrite", "--quiet"], check=True)
            mark.write_text(stamp)
        return Film(name, found, part)

    def map(self, name, values):
        """Writes a map of errors, black to white from 0 to a quarter."""
        codes = np.clip(4.0 * values, 0.0, 1.0) * 255.0
        Image.fromarray(codes.astype(np.uint8)).save(self.folder / f"map-{name.replace(' ', '-')}.png")


ENDINGS = {"-o": "png", "--layers": "exr", "--stats": "json"}


def version(program):
    return subprocess.run([program, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout
