"""Rays of the same camera and lights through lightmesh, and on a GPU through OptiX. Embree is in native.py.

OptiX gets all rays in one launch; lightmesh forms its own, of the same pixels and lights, which is part of its time for shadow rays.
"""

import numpy as np

KINDS = {"primary": "ray-trace", "hard shadow": "ray-trace", "soft shadow": "area"}
"""Kinds of rays, and the method of lightmesh that casts them."""
SOFT_SAMPLES = 16
"""Rays per light and pixel for soft shadows."""
OFFSET = 1e-4
"""Offset of OptiX's shadow rays from the surface, as a fraction of their length."""


class Optix:
    """OptiX through Mitsuba: one launch for all rays, timed by the device."""

    def __init__(self, scene, plan):
        import drjit
        import mitsuba

        self.name, self.threads, self.drjit, self.mitsuba = "OptiX", 1, drjit, mitsuba
        mitsuba.set_variant("cuda_ad_rgb")
        self.version = f"Mitsuba {mitsuba.__version__}"
        ply = {"type": "ply", "filename": str(scene.file.with_suffix(".ply")), "face_normals": True}
        self.scene = mitsuba.load_dict({"type": "scene", "mesh": ply})
        primary = scene.camera.rays(plan.ray_size)
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
    name = "lightmesh"

    def __init__(self, opened, size, threads):
        self.opened, self.size, self.threads = opened, size, threads

    def render(self, kind, with_visibility=False):
        """What an image takes, and the visibility of each light."""
        report, _, visibility = self.opened.render(KINDS[kind], self.size, SOFT_SAMPLES, with_visibility=with_visibility)
        return report, visibility

    def cast(self, kind):
        """Rays and seconds."""
        report, _ = self.render(kind)
        return (report.rays, report.primary_seconds) if kind == "primary" else (report.shadow_rays, report.shadow_seconds)


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
