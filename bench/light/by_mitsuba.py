"""Mitsuba's side: a path tracer, and one whose paths begin at the lights."""

import time

import numpy as np

import facets

FAR = 1e4
"""The distance of the sun's disc, in diagonals of the scene."""
FINER = 8
"""Texels of a mask that stand for one of the image: Mitsuba interpolates opacities, and then draws lots."""


class Mitsuba:
    name = "Mitsuba"

    def __init__(self, lightmesh, options):
        import drjit
        import mitsuba

        self.drjit, self.mitsuba, self.size = drjit, mitsuba, options.size
        on_gpu = options.device == "cuda"
        compiled = on_gpu or drjit.has_backend(drjit.JitBackend.LLVM)
        mitsuba.set_variant("cuda_ad_rgb" if on_gpu else "llvm_ad_rgb" if compiled else "scalar_rgb")
        self.version = f"{mitsuba.__version__}, {mitsuba.variant()}"
        if compiled and not on_gpu:
            drjit.set_thread_count(options.threads)
        if any(part.material.facets is not None for part in lightmesh.model.parts):
            facets.register(mitsuba, drjit)
        self.compiled, self.scene = compiled, mitsuba.load_dict(self.describe(lightmesh))
        # Only this one sees lights through what is cut out.
        kind = "volpath" if any(part.material.mask is not None for part in lightmesh.model.parts) else "path"
        limit = getattr(options, "reflections", None)
        self.integrator = mitsuba.load_dict({"type": kind, "max_depth": limit + 1 if limit else -1, "rr_depth": 64 if limit else 8})
        self.endless = mitsuba.load_dict({"type": kind, "max_depth": -1, "rr_depth": 8})
        self.particles = mitsuba.load_dict({"type": "ptracer", "max_depth": -1, "rr_depth": 8})
        self.sensor = self.look(lightmesh.camera)

    def look(self, camera):
        width, height = self.size
        corners = (vector.tolist() for vector in (camera.position, camera.position + camera.direction, camera.up))
        return self.mitsuba.load_dict(
            {
                "type": "perspective",
                "fov": camera.vfov,
                "fov_axis": "y",
                "near_clip": 1e-3,
                "far_clip": 1e9,
                "to_world": self.mitsuba.ScalarTransform4f().look_at(*corners),
                "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
                "sampler": {"type": "independent"},
            }
        )

    def describe(self, lightmesh):
        scene = {"type": "scene"}
        for number, part in enumerate(lightmesh.model.parts):
            scene[f"part{number}"] = self.mesh(part)
        if getattr(lightmesh, "sky_radiance", None):
            scene["sky"] = {"type": "constant", "radiance": rgb([lightmesh.sky_radiance] * 3)}
        if lightmesh.panorama is not None:
            scene["sky"] = {"type": "envmap", "bitmap": self.mitsuba.Bitmap(lightmesh.panorama)}
        lower, upper = lightmesh.model.bounds
        middle, distance = (lower + upper) / 2, FAR * np.linalg.norm(upper - lower)
        for number, sun in enumerate(lightmesh.suns):
            radius = distance * np.tan(np.radians(sun.angle / 2))
            place = middle - distance * sun.direction
            radiance = sun.irradiance / (np.pi * np.sin(np.radians(sun.angle / 2)) ** 2)
            side = [1, 0, 0] if abs(sun.direction[0]) < 0.5 else [0, 1, 0]
            view = self.mitsuba.ScalarTransform4f().look_at(place.tolist(), middle.tolist(), side)
            scene[f"sun{number}"] = {
                "type": "disk",
                "to_world": view.scale([float(radius), float(radius), 1]),
                "emitter": {"type": "area", "radiance": rgb(radiance)},
            }
        return scene

    def mesh(self, part):
        properties = self.mitsuba.Properties()
        properties["bsdf"] = self.mitsuba.load_dict(self.surface(part))
        properties["face_normals"] = part.normals is None
        if part.material.emission.any():
            properties["emitter"] = self.mitsuba.load_dict({"type": "area", "radiance": self.radiance(part.material)})
        given = {"has_vertex_normals": part.normals is not None, "has_vertex_texcoords": part.uvs is not None}
        mesh = self.mitsuba.Mesh("part", len(part.positions), len(part.triangles), props=properties, **given)
        if part.colors is not None:
            mesh.add_attribute("vertex_color", 3, np.ravel(part.colors))
        values = self.mitsuba.traverse(mesh)
        values["vertex_positions"], values["faces"] = np.ravel(part.positions), np.ravel(part.triangles)
        values.update()
        # Later than positions, with which others would be made.
        if part.normals is not None:
            values["vertex_normals"] = np.ravel(part.normals)
        if part.uvs is not None:
            values["vertex_texcoords"] = np.ravel(part.uvs)
        values.update()
        return mesh

    def radiance(self, material):
        if material.glow is None:
            return rgb(material.emission)
        return {"type": "bitmap", "bitmap": self.mitsuba.Bitmap(tinted(material.glow, material.emission)), "raw": True}

    def surface(self, part):
        material, color = part.material, rgb(part.material.color)
        if material.image is not None:
            encoded = self.mitsuba.Bitmap(tinted(material.image, material.color))
            color = {"type": "bitmap", "bitmap": encoded, "raw": True}
        elif part.colors is not None:
            color = {"type": "mesh_attribute", "name": "vertex_color"}
        surface = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}
        if material.facets is not None:
            surface = facets.described(self.mitsuba, material)
        if material.mask is None:
            return surface
        bits = self.mitsuba.Bitmap((finer(material.mask) >= material.cutoff).astype(np.float32)[..., None])
        opacity = {"type": "bitmap", "bitmap": bits, "raw": True, "filter_type": "nearest"}
        return {"type": "mask", "bsdf": surface, "opacity": opacity}

    def render(self, samples, seed, integrator=None):
        """Seconds and linear colours."""
        start = time.perf_counter()
        picture = self.mitsuba.render(
            self.scene, sensor=self.sensor, integrator=integrator or self.integrator, spp=samples, seed=seed
        )
        if self.compiled:
            self.drjit.eval(picture)
            self.drjit.sync_thread()
        return time.perf_counter() - start, np.array(picture)[..., :3]

    def mean(self, samples, at_once, integrator=None):
        """The image of many samples."""
        turns = max(samples // at_once, 1)
        return sum(self.render(at_once, 1000 + turn, integrator)[1].astype(np.float64) for turn in range(turns)) / turns


def rgb(color):
    return {"type": "rgb", "value": [float(channel) for channel in color]}


def tinted(image, color):
    """Linear colours of the image times another one."""
    share = image[..., :3] / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return (linear * color).astype(np.float32)


def finer(mask):
    """A repeated image, interpolated between its texels."""
    for axis in (0, 1):
        place = (np.arange(mask.shape[axis] * FINER) + 0.5) / FINER - 0.5
        first = np.floor(place).astype(int)
        share = (place - first).astype(np.float32)
        share = share[:, None] if axis == 0 else share[None]
        before, after = (np.take(mask, first + step, axis, mode="wrap") for step in (0, 1))
        mask = (1 - share) * before + share * after
    return mask
