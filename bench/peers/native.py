"""Embree, natively: embree/trace.cpp is compiled for this machine, gets the scene as a file, and casts its rays when asked to."""

import importlib.metadata
import json
import math
import os
import shutil
import statistics
import struct
import subprocess
from pathlib import Path

import numpy as np

from scene import unit

WIDTHS = [16, 8, 1]
"""Rays per packet. Which is fastest depends on the processor and on the rays."""
FLAGS = ["-std=c++20", "-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-pthread"]


class Embree:
    """A scene in a process that keeps its acceleration structure."""

    name = "Embree"

    def __init__(self, scene, plan, samples, folder):
        self.scene, self.folder, self.process = scene, folder, None
        self.command = [compiled((plan.embree or library()).resolve(), folder), folder / "scene.bin", str(plan.ray_size), str(samples)]
        self.config = [plan.embree_config] if plan.embree_config else []
        write(scene, plan.ray_size, folder / "scene.bin")
        self.start("fast")
        self.version = f"{self.facts['version']}, for vectors of {self.facts['native_width']}"

    def start(self, precision):
        """`fast`, or `robust`: no ray slips between two triangles, for more work."""
        self.close()
        command = [*self.command, precision, *self.config]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.precision, self.facts = precision, self.answer()
        # Shadow rays start where primary rays end.
        self.ask("primary", WIDTHS[0], 1)

    def ask(self, *words):
        print(*words, file=self.process.stdin, flush=True)
        return self.answer()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.command[0]} ended with exit code {self.process.wait()}")
        return json.loads(line)

    def reached(self):
        """For each light and pixel how many rays of the last kind reached it."""
        path = self.folder / "reached.bin"
        self.ask("save", path)
        return np.fromfile(path, "<u2").reshape(len(self.scene.lights), -1)

    def close(self):
        if self.process:
            self.process.stdin.close()
            self.process.wait()


class Packets:
    """Embree with packets of one width, on some threads."""

    name = Embree.name

    def __init__(self, embree, width, threads):
        self.embree, self.width, self.threads = embree, width, threads
        self.answers, self.forming = {}, {}

    def cast(self, kind):
        """Rays and seconds."""
        word = kind.split()[0]
        answer = self.answers[kind] = self.embree.ask(word, self.width, self.threads)
        if kind != "primary":
            # What it takes to form these rays, to tell tracing apart.
            formed = self.embree.ask("form", self.width, self.threads, word)
            self.forming.setdefault(kind, []).append(formed["seconds"])
        return answer["rays"], answer["seconds"]

    def values(self, kind, count, seconds):
        """Further values of a row: the width, hits or occluded rays, the rate without forming the rays, the time to build."""
        found = {name: number for name, number in self.answers[kind].items() if name in ("hits", "occluded")}
        tracing = seconds - statistics.median(self.forming.get(kind, [0]))
        rate = count / tracing / 1e6
        return {"width": self.width, **found, "tracing_million_per_second": rate, "build_seconds": self.embree.facts["build_seconds"]}


def library():
    """Embree 4 as a wheel contains it."""
    files = importlib.metadata.files("embreex")
    return next(Path(file.locate()) for file in files if file.name.startswith("libembree4"))


def compiled(library, folder):
    """The program, linked with this library."""
    compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++")
    if not compiler:
        raise ImportError("there is no C++ compiler")
    source, program = Path(__file__).parent / "embree" / "trace.cpp", folder / "trace"
    subprocess.run([compiler, *FLAGS, source, library, f"-Wl,-rpath,{library.parent}", "-o", program], check=True)
    return program


def write(scene, size, path):
    """The scene as trace.cpp reads it: the numbers of lights, vertices and triangles, then camera, lights, vertices, triangles."""
    camera = scene.camera
    right = unit(np.cross(camera.direction, camera.up))
    pixel = 2 * math.tan(math.radians(camera.vfov) / 2) / size
    vectors = [camera.position, camera.direction, pixel * right, -pixel * np.cross(right, camera.direction)]
    vectors += [vector for light in scene.lights for vector in (light.position, light.u / 2, light.v / 2)]
    counts = struct.pack("<3I", len(scene.lights), len(scene.positions), len(scene.triangles))
    arrays = [np.array(vectors, "<f4"), scene.positions.astype("<f4"), scene.triangles.astype("<u4")]
    path.write_bytes(counts + b"".join(array.tobytes() for array in arrays))
