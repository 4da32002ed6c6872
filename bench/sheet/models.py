"""Which models are shown, and what is known of their pictures by Lightmesh: camera, lights, which pixels are covered."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from scene import Camera, unit

KINDS = {".obj", ".gltf", ".glb", ".ply", ".stl"}

# Architecture is seen from inside; everything else as the program frames it. From the README beside the models.
CAMERAS = {"sponza/sponza.obj": "-13,3,0;10,5,0;60"}

# The program's lights for scenes without any (crates/scene/src/staging/framing/mod.rs): right and up in reaches, and intensity.
DEFAULT_LIGHTS = [(-0.5, 0.8, 1.0), (0.9, 0.2, 0.25)]
SPREAD = 0.05


@dataclass
class Sun:
    """Parallel light along `direction`."""

    direction: np.ndarray
    irradiance: float
    angle: float
    """Radians across."""


@dataclass
class Model:
    """A model and its picture."""

    name: str
    file: Path
    camera: Camera
    ambient: list
    background: list
    suns: list
    """What stands for the lights that the program adds; empty if the file has lights."""
    picture: np.ndarray
    """Codes of the 8-bit picture."""
    covered: np.ndarray
    """Share of each pixel that is covered."""
    first: np.ndarray
    """Codes of the first picture: in the studio, if the file brings no light."""
    sky: np.ndarray
    """Codes of the picture under a clear sky, with ground and horizon."""
    notes: str


def find(folder, only):
    """Names of models in a folder, relative to it."""
    names = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.suffix.lower() in KINDS)
    return [name for name in names if not only or any(part in name for part in only)]


def render(program, folder, name, size, output):
    """Renders a model as the program does without being told anything but the size, and as Cycles can show it; keeps PNG, statistics and notes in `output`."""
    file, stem = folder / name, output / name.replace("/", "-")
    picture, mask, stats = (stem.with_name(stem.name + end) for end in (".lightmesh.png", ".mask.png", ".stats.json"))
    view = ["--camera", CAMERAS[name]] if name in CAMERAS else []
    command = [program, "render", file, "--no-studio", "--size", f"{size}x{size}", *view, "--device", "cpu"]
    done = subprocess.run([*command, "-o", picture, "--stats", stats], check=True, stderr=subprocess.PIPE, text=True)
    first, sky = (stem.with_name(stem.name + end) for end in (".first.png", ".sky.png"))
    usual = [argument for argument in command if argument != "--no-studio"]
    subprocess.run([*usual, "-o", first, "-q"], check=True)
    subprocess.run([*usual, "-o", sky, "--sky", "clear", "-q"], check=True)
    subprocess.run([*command, "-o", mask, "--background", "transparent", "--quality", "draft", "-q"], check=True)
    settings = json.loads(stats.read_text())["settings"]
    info = json.loads(subprocess.run([program, "info", file, "--json"], check=True, stdout=subprocess.PIPE).stdout)
    camera = view_of(settings["camera"], file)
    suns = [] if info["lights"] else suns_of(camera, info["bounds"])
    codes, alone, under_sky = (np.asarray(Image.open(file).convert("RGB")) for file in (picture, first, sky))
    alpha = np.asarray(Image.open(mask).convert("RGBA"))[..., 3] / 255
    return Model(name, file, camera, settings["ambient"], settings["background"], suns, codes, alpha, alone, under_sky, done.stderr.strip())


def view_of(camera, file):
    if camera["vfov"] is None:
        raise SystemExit(f"error: the camera of {file} is orthographic, which the sheet cannot show; add one to CAMERAS in models.py")
    return Camera(*(np.array(camera[key]) for key in ("position", "direction", "up")), camera["vfov"])


def suns_of(camera, bounds):
    """Suns that light the middle of the scene as the program's lights do: these are so far away that the difference is small."""
    low, high = np.array(bounds["min"]), np.array(bounds["max"])
    middle, diagonal = (low + high) / 2, np.linalg.norm(high - low)
    right = unit(np.cross(camera.direction, camera.up))
    reach = max(np.linalg.norm(camera.position - middle), diagonal)
    suns = []
    for beside, above, intensity in DEFAULT_LIGHTS:
        place = camera.position + reach * (above * np.cross(right, camera.direction) + beside * right)
        # A white surface reflects the intensity itself: radiance is irradiance over pi.
        suns.append(Sun(unit(middle - place), np.pi * intensity, 2 * SPREAD * diagonal / np.linalg.norm(middle - place)))
    return suns


def shares(codes, covered):
    """Of the covered pixels, the share with a channel at its limit, and the share that is nearly black."""
    inside = covered > 0.99
    pixels = codes[inside]
    if not len(pixels):
        return {"covered": 0.0, "clipped": 0.0, "black": 0.0}
    share = lambda which: round(float(np.mean(which)), 4)
    return {"covered": share(inside), "clipped": share(pixels.max(axis=1) == 255), "black": share(pixels.max(axis=1) < 6)}
