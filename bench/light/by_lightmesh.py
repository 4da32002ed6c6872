"""Lightmesh's side: exports the scene, finds the sun and the sky, and renders."""

import json
import resource
import subprocess
from dataclasses import dataclass

import flip_evaluator
import numpy as np

import model

FACE, WIDE = 512, 46
"""Pixels of a face of the cube around the camera, and half of the angle that it sees: more than a face, for interpolation."""
DISC, RING = 0.8, 1.3
"""Degrees around the sun that show what is between both."""
PANORAMA = (512, 1024)

FACES = [
    ([1, 0, 0], [0, 1, 0]),
    ([-1, 0, 0], [0, 1, 0]),
    ([0, 1, 0], [0, 0, 1]),
    ([0, -1, 0], [0, 0, -1]),
    ([0, 0, 1], [0, 1, 0]),
    ([0, 0, -1], [0, 1, 0]),
]


@dataclass
class Camera:
    position: np.ndarray
    direction: np.ndarray
    up: np.ndarray
    vfov: float


@dataclass
class Sun:
    direction: np.ndarray
    """The one in which its light travels."""
    irradiance: np.ndarray
    angle: float
    """Its diameter, degrees."""


class Program:
    """The program, and a folder for its files."""

    def __init__(self, options, folder, binary=None):
        self.options, self.folder, self.binary = options, folder, binary or options.lightmesh

    def run(self, *words):
        result = subprocess.run([str(word) for word in (self.binary, *words)], capture_output=True, text=True)
        if result.returncode:
            raise SystemExit(result.stderr)

    def image(self, file, size, words):
        """Seconds of all threads, with opening and writing files, and linear colours."""
        path, (width, height), before = self.folder / "image.exr", size, processor()
        words = ["--size", f"{width}x{height}", "--filter", "box", *words, "--threads", self.options.threads]
        self.run("render", file, "-o", path, *words, "--device", self.options.device, "--quiet")
        return processor() - before, flip_evaluator.load(str(path))

    def seconds(self, file, size, words):
        """Seconds of all threads, with opening and writing; on a GPU those of the render alone, by the program's own clock."""
        stats = self.folder / "stats.json"
        seconds, _ = self.image(file, size, [*words, "--stats", stats])
        return seconds if self.options.device == "cpu" else json.loads(stats.read_text())["seconds"]["render"]


class Lightmesh(Program):
    name = "Lightmesh"

    def __init__(self, scene, options, folder):
        super().__init__(options, folder)
        self.sky = scene.sky
        source, whole = scene.file(options.root, options.models), folder / "whole.glb"
        self.run("export", source, "-o", whole)
        self.file = folder / "diffuse.glb"
        model.make_diffuse(whole, self.file)
        self.model = model.read(self.file)
        self.view = ["--camera", scene.camera] if scene.camera else []
        # The camera and the lights that the program uses; the file for all programs has no cameras.
        settings = self.call(source, folder / "first.exr", ["--size", "8x6", "--mode", "ray-trace"])["settings"]
        view = settings["camera"]
        self.camera = Camera(*(np.array(view[key]) for key in ("position", "direction", "up")), view["vfov"])
        numbers = [*self.camera.position.tolist(), *(self.camera.position + self.camera.direction).tolist()]
        self.view = ["--camera", f"{','.join(map(repr, numbers[:3]))};{','.join(map(repr, numbers[3:]))};{self.camera.vfov}"]
        suns = [light for light in settings["lights"] if light["kind"] == "directional"] if scene.sky else []
        self.suns = [Sun(np.array(sun["direction"]), np.pi * np.array(sun["intensity"]), sun["angle"]) for sun in suns]
        self.panorama = self.paint_sky() if scene.sky else None

    def call(self, file, image, words, view=None):
        """Renders; returns the statistics."""
        stats, sky = self.folder / "stats.json", ["--sky", self.sky] if self.sky else []
        words = [*words, *(self.view if view is None else view), *sky, "--threads", self.options.threads]
        self.run("render", file, "-o", image, "--stats", stats, *words, "--device", self.options.device)
        return json.loads(stats.read_text())

    def paint_sky(self):
        """What is around the scene, without the sun: row 0 is straight above, and column 0 begins at -z and goes on to x."""
        triangle = self.folder / "sky.obj"
        triangle.write_text("v 0 -1e3 0\nv 1e-3 -1e3 0\nv 0 -1e3 1e-3\nf 1 2 3\n")
        rows, columns = ((np.arange(count) + 0.5) / count for count in PANORAMA)
        up, around = np.meshgrid(np.pi * rows, 2 * np.pi * columns, indexing="ij")
        across = np.sin(up)
        directions = np.stack([np.sin(around) * across, np.cos(up), -np.cos(around) * across], -1)
        sky, nearest = np.zeros((*PANORAMA, 3), np.float32), np.argmax([directions @ forward for forward, _ in FACES], axis=0)
        for number, (forward, upper) in enumerate(FACES):
            scene = self.folder / "sky.toml"
            camera = f"[camera]\nposition = [0, 0, 0]\ndirection = {forward}\nup = {upper}\nvfov = {2 * WIDE}\n"
            scene.write_text(camera + '[[mesh]]\nfile = "sky.obj"\n')
            self.call(scene, self.folder / "face.exr", ["--size", f"{FACE}x{FACE}"], view=[])
            face = flip_evaluator.load(str(self.folder / "face.exr"))
            here = nearest == number
            right = np.cross(forward, upper)
            reach = np.tan(np.radians(WIDE)) * (directions[here] @ forward)
            x, y = directions[here] @ right / reach, -(directions[here] @ upper) / reach
            sky[here] = bilinear(face, *(FACE * (0.5 + 0.5 * place) - 0.5 for place in (x, y)))
        for sun in self.suns:
            away = np.degrees(np.arccos(np.clip(-(directions @ sun.direction), -1, 1)))
            sky[away < DISC] = sky[(away > DISC) & (away < RING)].mean(axis=0)
        return sky

    def render(self, quality):
        """Seconds, those of all threads with opening and writing files, and linear colours: medians of some runs."""
        image, seconds, busy = self.folder / "lightmesh.exr", [], []
        width, height = self.options.size
        words = ["--size", f"{width}x{height}", "--filter", "box", "--quality", quality, "--ambient-light", "mesh"]
        for _ in range(self.options.repeat):
            before = processor()
            seconds.append(self.call(self.file, image, words)["seconds"]["render"])
            busy.append(processor() - before)
        return float(np.median(seconds)), float(np.median(busy)), flip_evaluator.load(str(image))


def processor():
    """Processor time of programs that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def bilinear(image, x, y):
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, down = (x - left)[:, None], (y - top)[:, None]
    row = lambda y: (1 - right) * image[y, left] + right * image[y, left + 1]
    return (1 - down) * row(top) + down * row(top + 1)
