"""Rays of the same camera and lights through Embree and through lightmesh, on one thread each; or through OptiX and lightmesh on a GPU.

Embree gets rays one by one, in arrays without Python in between, OptiX gets all of them in one launch; lightmesh forms its own, of the
same pixels and lights, which is part of its time for shadow rays.
"""

import json
import subprocess
import time

import numpy as np

KINDS = {"primary": "ray-trace", "hard shadow": "ray-trace", "soft shadow": "area"}
"""Kinds of rays, and the mode of lightmesh that casts them."""
SOFT_SAMPLES = 16
"""Rays per light and pixel for soft shadows."""
OFFSET = 1e-4
"""Offset of Embree's shadow rays from the surface, as a fraction of their length."""


class Embree:
    def __init__(self, scene, plan):
        from importlib.metadata import version

        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.name, self.version = "Embree", f"embreex {version('embreex')}"
        self.scene = EmbreeScene()
        TriangleMesh(self.scene, scene.positions[scene.triangles])
        self.primary = scene.camera.rays(plan.size)
        triangle = self.scene.run(*self.primary, query="INTERSECT")
        distance = self.scene.run(*self.primary, query="DISTANCE")
        self.rays = rays_to_lights(scene, self.primary, triangle, distance)

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


class Optix:
    """OptiX through Mitsuba: one launch for all rays, timed by the device."""

    def __init__(self, scene, plan):
        import drjit
        import mitsuba

        self.name, self.drjit, self.mitsuba = "OptiX", drjit, mitsuba
        mitsuba.set_variant("cuda_ad_rgb")
        self.version = f"Mitsuba {mitsuba.__version__}"
        ply = {"type": "ply", "filename": str(scene.file.with_suffix(".ply")), "face_normals": True}
        self.scene = mitsuba.load_dict({"type": "scene", "mesh": ply})
        primary = scene.camera.rays(plan.size)
        found = self.scene.ray_intersect_preliminary(self.ray(*primary), coherent=True)
        distance = np.array(found.t)
        triangle = np.where(np.isfinite(distance), np.array(found.prim_index).astype(np.int64), -1)
        rays = {"primary": primary, **rays_to_lights(scene, primary, triangle, distance)}
        self.rays = {kind: self.ray(*arrays, end=None if kind == "primary" else 1 - OFFSET) for kind, arrays in rays.items()}

    def ray(self, origins, directions, end=None):
        points = (self.mitsuba.Point3f(origins.T), self.mitsuba.Vector3f(directions.T))
        ray = self.mitsuba.Ray3f(*points) if end is None else self.mitsuba.Ray3f(*points, end, 0.0, [])
        self.drjit.eval(ray)
        return ray

    def cast(self, kind):
        """Rays and seconds."""
        drjit, ray = self.drjit, self.rays[kind]
        with drjit.scoped_set_flag(drjit.JitFlag.KernelHistory, True):
            drjit.kernel_history_clear()
            if kind == "primary":
                drjit.eval(self.scene.ray_intersect_preliminary(ray, coherent=True))
            else:
                drjit.eval(self.scene.ray_test(ray))
            drjit.sync_thread()
            launches = [entry for entry in drjit.kernel_history() if entry.get("uses_optix")]
        return drjit.width(ray), sum(entry["execution_time"] for entry in launches) / 1000


class Lightmesh:
    def __init__(self, program, scene, plan, folder):
        self.name, self.stats = "lightmesh", folder / "rays.json"
        self.on_gpu = plan.device == "cuda"
        threads = [] if self.on_gpu else ["--threads", "1"]
        self.command = [program, "render", scene.file, "-q", "--device", plan.device, *threads, "--size", f"{plan.size}x{plan.size}"]
        self.command += ["--samples", str(SOFT_SAMPLES), "-o", folder / "rays.png", "--stats", self.stats]
        self.suite = [program, "bench", "rays", "--device", plan.device, "--scene", scene.file, "--json", self.stats, "-q"]

    def cast(self, kind):
        # The first image of a process starts with small launches, which would distort the rate of few rays.
        if self.on_gpu and kind != "soft shadow":
            return self.warm(kind)
        subprocess.run([*self.command, "--mode", KINDS[kind]], check=True)
        stats = json.loads(self.stats.read_text())
        rays, stage = ("rays", "primary_rays") if kind == "primary" else ("shadow_rays", "long_tests")
        return stats["counts"][rays], stats["seconds"][stage]

    def warm(self, kind):
        """The suite `rays`: medians after a warm-up, 1024 x 1024 pixels."""
        subprocess.run(self.suite, check=True, stdout=subprocess.DEVNULL)
        rows = json.loads(self.stats.read_text())["rows"]
        values = next(row["values"] for row in rows if row["keys"]["accel"] == "bvh" and row["keys"]["rays"] == kind)
        return values["rays"], values["rays"] / values["million_per_second"] / 1e6


def rays_to_lights(scene, primary, triangle, distance):
    """Hard and soft shadow rays from the hits of primary rays: triangle indices, -1 for none, and distances."""
    origins, directions = primary
    hit = triangle >= 0
    corners = scene.positions[scene.triangles[triangle[hit]]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Towards the camera.
    normals *= -np.sign(np.sum(normals * directions[hit], 1, keepdims=True))
    points = origins[hit] + distance[hit, None] * directions[hit]
    random = np.random.default_rng(0)
    return {
        "hard shadow": shadow_rays(points, normals, scene.lights, lambda light: light.position),
        "soft shadow": shadow_rays(
            np.repeat(points, SOFT_SAMPLES, 0),
            np.repeat(normals, SOFT_SAMPLES, 0),
            scene.lights,
            lambda light: light.position + (random.random((len(points) * SOFT_SAMPLES, 2)) - 0.5) @ np.stack([light.u, light.v]),
        ),
    }


def shadow_rays(points, normals, lights, target):
    """Segments from points to lights that are not behind the surface, as origins and unnormalised directions, light by light."""
    origins, directions = [], []
    for light in lights:
        ways = target(light) - points
        front = np.sum(normals * ways, 1) > 0
        origins.append((points + OFFSET * ways)[front])
        directions.append(ways[front])
    return np.concatenate(origins).astype(np.float32), np.concatenate(directions).astype(np.float32)
