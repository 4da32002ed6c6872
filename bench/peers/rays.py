"""Rays of the same camera and lights through Embree and through lightmesh, on one thread each.

Embree gets rays one by one, in arrays without Python in between; lightmesh forms its own, of the same pixels and lights, which is
part of its time for shadow rays.
"""

import json
import subprocess
import time

import numpy as np

KINDS = {"primary": "ray-trace", "hard shadow": "ray-trace", "soft shadow": "area"}
"""Kinds of rays, and the mode of lightmesh that casts them."""
SOFT_SAMPLES = 16
"""Rays to each light and pixel for soft shadows."""
OFFSET = 1e-4
"""How far from the surface Embree's shadow rays begin, as a share of their length."""


class Embree:
    def __init__(self, scene, size):
        from importlib.metadata import version

        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.name, self.version = "Embree", f"embreex {version('embreex')}"
        self.scene = EmbreeScene()
        TriangleMesh(self.scene, scene.positions[scene.triangles])
        self.primary = scene.camera.rays(size)
        points, normals = self.object_points(scene)
        random = np.random.default_rng(0)
        self.rays = {
            "hard shadow": shadow_rays(points, normals, scene.lights, lambda light: light.position),
            "soft shadow": shadow_rays(
                np.repeat(points, SOFT_SAMPLES, 0),
                np.repeat(normals, SOFT_SAMPLES, 0),
                scene.lights,
                lambda light: light.position + (random.random((len(points) * SOFT_SAMPLES, 2)) - 0.5) @ np.stack([light.u, light.v]),
            ),
        }

    def object_points(self, scene):
        """What the camera sees, with normals that face it."""
        origins, directions = self.primary
        triangle = self.scene.run(origins, directions, query="INTERSECT")
        distance = self.scene.run(origins, directions, query="DISTANCE")
        hit = triangle >= 0
        corners = scene.positions[scene.triangles[triangle[hit]]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals *= -np.sign(np.sum(normals * directions[hit], 1, keepdims=True))
        return origins[hit] + distance[hit, None] * directions[hit], normals

    def cast(self, kind):
        """Rays and seconds."""
        start = time.perf_counter()
        if kind == "primary":
            count = len(self.primary[0])
            self.scene.run(*self.primary, query="INTERSECT")
        else:
            origins, directions = self.rays[kind]
            count = len(origins)
            # The end of a segment is its direction away.
            self.scene.run(origins, directions, dists=np.full(count, 1 - OFFSET, np.float32), query="OCCLUDED")
        return count, time.perf_counter() - start


class Lightmesh:
    def __init__(self, program, scene, size, folder):
        self.name, self.stats = "lightmesh", folder / "rays.json"
        self.command = [program, "render", scene.file, "-q", "--device", "cpu", "--threads", "1", "--size", f"{size}x{size}"]
        self.command += ["--samples", str(SOFT_SAMPLES), "-o", folder / "rays.png", "--stats", self.stats]

    def cast(self, kind):
        subprocess.run([*self.command, "--mode", KINDS[kind]], check=True)
        stats = json.loads(self.stats.read_text())
        rays, stage = ("rays", "primary_rays") if kind == "primary" else ("shadow_rays", "long_tests")
        return stats["counts"][rays], stats["seconds"][stage]


def shadow_rays(points, normals, lights, target):
    """Segments from points to lights that are not behind the surface, as origins and whole directions, light by light."""
    origins, directions = [], []
    for light in lights:
        ways = target(light) - points
        front = np.sum(normals * ways, 1) > 0
        origins.append((points + OFFSET * ways)[front])
        directions.append(ways[front])
    return np.concatenate(origins).astype(np.float32), np.concatenate(directions).astype(np.float32)
