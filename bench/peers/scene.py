"""One scene for all programs: triangles, camera and lights, taken from lightmesh.

Everything is cut down to what all programs mean alike: triangles without normals of their own, one diffuse material, square lights that
face the middle of the scene, inverse-square falloff, no ambient light, a black background.
"""

import json
import math
import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

KD = 0.7
"""Diffuse reflectance of all surfaces."""
LIGHT_SHARE = 0.1
"""Edge of a light as a fraction of its distance from the centre of the scene."""
FOCUS = 0.8
"""Radiance of a surface at the centre of the scene that faces all lights: below 1, so that few pixels are clipped."""


@dataclass
class Camera:
    position: np.ndarray
    direction: np.ndarray
    up: np.ndarray
    vfov: float

    def rays(self, size):
        """Origins and unit directions of rays through pixel centres, row by row from the top."""
        right = unit(np.cross(self.direction, self.up))
        upper = np.cross(right, self.direction)
        steps = ((np.arange(size) + 0.5) / size * 2 - 1) * math.tan(math.radians(self.vfov) / 2)
        x, y = np.meshgrid(steps, -steps)
        directions = self.direction + x[..., None] * right + y[..., None] * upper
        directions = unit(directions.reshape(-1, 3)).astype(np.float32)
        return np.tile(self.position.astype(np.float32), (len(directions), 1)), directions


@dataclass
class Light:
    """A square that emits along `direction`; its edges are `u` and `v`."""

    position: np.ndarray
    direction: np.ndarray
    u: np.ndarray
    v: np.ndarray
    intensity: float
    """Candela along the direction."""

    @property
    def area(self):
        return np.linalg.norm(self.u) * np.linalg.norm(self.v)


@dataclass
class Scene:
    name: str
    positions: np.ndarray
    triangles: np.ndarray
    camera: Camera
    lights: list
    file: Path
    """The scene for lightmesh; its triangles are in a PLY file next to it."""

    @classmethod
    def open(cls, program, source, folder):
        """Exports the scene `source` with `program`, lightmesh; files go to `folder`."""
        quiet = {"check": True, "stdout": subprocess.PIPE}
        glb, stats = folder / "scene.glb", folder / "camera.json"
        subprocess.run([program, "export", source, "-o", glb, "--smooth", "off", "-q"], **quiet)
        positions, triangles = read_glb(glb)
        info = json.loads(subprocess.run([program, "info", source, "--json"], **quiet).stdout)
        one_pixel = ["--size", "1x1", "--mode", "ray-trace", "--device", "cpu", "-o", folder / "pixel.png", "-q"]
        subprocess.run([program, "render", source, *one_pixel, "--stats", stats], **quiet)
        stats = json.loads(stats.read_text())
        view = stats["settings"]["camera"]
        camera = Camera(*(np.array(view[key]) for key in ("position", "direction", "up")), view["vfov"])
        middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
        lights = square_lights(info["lights"], camera, middle)
        scene = cls(stats["scene"]["name"], positions, triangles, camera, lights, folder / "common.toml")
        scene.write()
        return scene

    def write(self):
        ply = self.file.with_suffix(".ply")
        write_ply(ply, self.positions, self.triangles)
        row = lambda vector: "[" + ", ".join(repr(float(x)) for x in vector) + "]"
        camera = self.camera
        lines = ["[camera]", f"position = {row(camera.position)}", f"direction = {row(camera.direction)}"]
        lines += [f"up = {row(camera.up)}", f"vfov = {camera.vfov}"]
        lines += ["[ambient]", "intensity = [0, 0, 0]", "background = [0, 0, 0]"]
        lines += ["[[material]]", 'name = "grey"', f"kd = {row([KD] * 3)}", "ks = [0, 0, 0]"]
        lines += ["[[mesh]]", f'file = "{ply.name}"', 'material = "grey"']
        for light in self.lights:
            lines += ["[[light]]", 'kind = "rectangle"', "one_sided = false", 'falloff = "inverse-square"', f"position = {row(light.position)}"]
            lines += [f"u = {row(light.u)}", f"v = {row(light.v)}", f"intensity = {row([light.intensity] * 3)}"]
        self.file.write_text("\n".join(lines) + "\n")


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def square_lights(infos, camera, middle):
    """A square for every light with a position; one beside and above the camera if there is none."""
    lamps = [(np.array(info["position"]), max(info["intensity"])) for info in infos if info["position"]]
    if not lamps:
        right, reach = np.cross(camera.direction, camera.up), np.linalg.norm(camera.position - middle)
        lamps = [(camera.position + reach * (0.8 * camera.up - 0.5 * right), 1.0)]
    total = sum(strength for _, strength in lamps)
    lights = []
    for position, strength in lamps:
        distance, direction = np.linalg.norm(middle - position), unit(middle - position)
        across = unit(np.cross(direction, [1, 0, 0] if abs(direction[0]) < 0.5 else [0, 1, 0]))
        edge = LIGHT_SHARE * distance
        # The radiance of a white surface is I / (π d²).
        intensity = FOCUS / KD * strength / total * math.pi * distance**2
        lights.append(Light(position, direction, edge * across, edge * np.cross(direction, across), intensity))
    return lights


def read_glb(path):
    """Positions in world coordinates and triangles of a file by `lightmesh export`, whose nodes are translated but not rotated."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    gltf, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def array(index, dtype, width):
        accessor = gltf["accessors"][index]
        view = gltf["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(binary, dtype, accessor["count"] * width, start).reshape(-1, width)

    positions, triangles, count = [], [], 0
    for node in (node for node in gltf["nodes"] if "mesh" in node):
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]:
            points = array(primitive["attributes"]["POSITION"], np.float32, 3)
            triangles.append(array(primitive["indices"], np.uint32, 1).reshape(-1, 3) + count)
            positions.append(points + np.array(node.get("translation", [0, 0, 0])))
            count += len(points)
    return np.concatenate(positions).astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def write_ply(path, positions, triangles):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n"
    header += "property float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    path.write_bytes(header.encode() + positions.astype("<f4").tobytes() + faces.tobytes())
