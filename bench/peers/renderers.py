"""The programs that render images, each as `render(samples, seed)`, which returns seconds and linear colours, row 0 at the top.

All look through the middle of each pixel: what differs is the shadows alone, not how edges are smoothed.
"""

import math
import time
from pathlib import Path

import flip_evaluator
import numpy as np

from scene import KD


class Lightmesh:
    """`samples` shadow rays per light and pixel, or what a lookup makes of that number."""

    def __init__(self, opened, method, size):
        self.name = f"lightmesh {'rays' if method == 'area' else method}"
        self.opened, self.method, self.size = opened, method, size

    def render(self, samples, seed):
        report, color, _ = self.opened.render(self.method, self.size, samples, seed)
        return report.seconds, color

    reference = render


class Denoised:
    """A renderer with its denoiser, which expects edges without stairs: samples cover the pixel. The reference has no denoiser."""

    def __init__(self, renderer):
        self.name, self.renderer = f"{renderer.name} denoised", renderer

    def render(self, samples, seed):
        return self.renderer.render(samples, seed, smooth=True, denoise=True)

    def reference(self, samples, seed):
        return self.renderer.render(samples, seed, smooth=True)


# Only emitters are sampled, as by shadow rays: with material sampling, half of the rays would miss small lights.
DIRECT = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0, "hide_emitters": True}

# Of OptiX's denoiser, as the driver installs them. Without them it ends the process.
WEIGHTS = Path("/usr/share/nvidia/nvoptix.bin")


class Mitsuba:
    """The `direct` integrator, compiled by LLVM or for OptiX, with the sampler `multijitter`: the default one, `independent`, has far
    more noise. What it compiles is kept for each number of samples. Its denoiser is OptiX's, which gets albedo and normals."""

    def __init__(self, scene, plan):
        import drjit
        import mitsuba

        self.name, self.drjit, self.mitsuba = "Mitsuba", drjit, mitsuba
        on_gpu = plan.device == "cuda"
        compiled = on_gpu or drjit.has_backend(drjit.JitBackend.LLVM)
        mitsuba.set_variant("cuda_ad_rgb" if on_gpu else "llvm_ad_rgb" if compiled else "scalar_rgb")
        self.version = f"{mitsuba.__version__}, {mitsuba.variant()}"
        # Scalar code requests each number separately, for which Python is too slow: there, samples cover the pixel.
        sampler = centred(mitsuba) if compiled else "multijitter"
        if compiled and not on_gpu:
            drjit.set_thread_count(plan.threads)
        self.scene = mitsuba.load_dict(self.describe(scene))
        self.compiled, self.kept = compiled, {}
        self.centred, self.smooth = (self.sensor(scene, plan.size, kind) for kind in (sampler, "multijitter"))
        layers = {"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "image": DIRECT}
        self.direct, self.with_layers = mitsuba.load_dict(DIRECT), mitsuba.load_dict(layers)
        usable = on_gpu and WEIGHTS.exists()
        self.denoiser = mitsuba.OptixDenoiser([plan.size] * 2, albedo=True, normals=True) if usable else None

    def sensor(self, scene, size, sampler):
        film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}}
        camera = scene.camera
        corners = (v.tolist() for v in (camera.position, camera.position + camera.direction, camera.up))
        view = self.mitsuba.ScalarTransform4f().look_at(*corners)
        sensor = {"type": "perspective", "fov": camera.vfov, "to_world": view, "film": film, "sampler": {"type": sampler}}
        return self.mitsuba.load_dict(sensor)

    def describe(self, scene):
        transform = self.mitsuba.ScalarTransform4f
        grey = {"type": "diffuse", "reflectance": {"type": "rgb", "value": KD}}
        parts = {
            "type": "scene",
            "mesh": {
                "type": "ply",
                "filename": str(scene.file.with_suffix(".ply")),
                "face_normals": True,
                "bsdf": {"type": "twosided", "bsdf": grey},
            },
        }
        for number, light in enumerate(scene.lights):
            columns = np.eye(4)
            columns[:3] = np.stack([light.u / 2, light.v / 2, np.cross(light.u, light.v) / light.area, light.position], 1)
            if columns[:3, 2] @ light.direction < 0:
                columns[:3, [0, 2]] *= -1
            radiance = {"type": "rgb", "value": float(light.intensity / light.area)}
            emitter = {"type": "area", "radiance": radiance}
            parts[f"light{number}"] = {"type": "rectangle", "to_world": transform(columns), "emitter": emitter}
        return parts

    def render(self, samples, seed, smooth=False, denoise=False):
        key = (samples, smooth, denoise)
        if key not in self.kept:
            integrator = self.with_layers if denoise else self.direct
            image = lambda scene, sensor, seed: self.mitsuba.render(scene, sensor=sensor, integrator=integrator, spp=samples, seed=seed)
            self.kept[key] = self.drjit.freeze(image) if self.compiled else image
        start = time.perf_counter()
        picture = self.kept[key](self.scene, self.smooth if smooth else self.centred, self.mitsuba.UInt32(seed))
        if self.compiled:
            self.drjit.eval(picture)
            self.drjit.sync_thread()
        # OptiX's denoiser is no part of what is compiled.
        if denoise:
            picture = self.denoised(picture)
        return time.perf_counter() - start, np.array(picture)[..., :3]

    reference = render

    def denoised(self, layers):
        to_sensor = self.smooth.world_transform().inverse()
        picture = self.denoiser(layers[..., :3], albedo=layers[..., -6:-3], normals=layers[..., -3:], to_sensor=to_sensor)
        self.drjit.eval(picture)
        self.drjit.sync_thread()
        return picture


def centred(mitsuba):
    """Registers a sampler like `multijitter`, whose first point for each ray, the position in the pixel, is the centre."""

    class Centred(mitsuba.Sampler):
        def __init__(self, props):
            super().__init__(props)
            self.inner, self.fresh = mitsuba.load_dict({"type": "multijitter"}), True

        def fork(self):
            return self

        clone = fork

        def set_sample_count(self, count):
            super().set_sample_count(count)
            self.inner.set_sample_count(count)

        def schedule_state(self):
            self.inner.schedule_state()

        def seed(self, seed, wavefront_size=2**32 - 1):
            self.fresh = True
            # All samples of an image are one wavefront. Python is not informed, and without this they are not stratified.
            self.inner.set_samples_per_wavefront(self.inner.sample_count())
            self.inner.seed(seed, wavefront_size)

        def advance(self):
            self.fresh = True
            self.inner.advance()

        def next_1d(self, active=True):
            return self.inner.next_1d(active)

        def next_2d(self, active=True):
            if self.fresh:
                self.fresh = False
                return mitsuba.Point2f(0.5)
            return self.inner.next_2d(active)

    mitsuba.register_sampler("centred", Centred)
    return "centred"


class Cycles:
    """Blender's path tracer, without bounces or adaptive sampling, on a GPU through OptiX. Its times include the set-up of each image. Its
    denoiser is Open Image Denoise, which gets albedo and normals."""

    def __init__(self, scene, plan, folder):
        import bpy

        self.name, self.bpy, self.version, self.denoiser = "Cycles", bpy, bpy.app.version_string, "Open Image Denoise"
        self.path = str(folder / "cycles.exr")
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.context = bpy.context.scene
        self.set_up(plan.size, plan.threads)
        if plan.device == "cuda":
            self.move_to_gpu()
        self.add_mesh(scene)
        self.add_camera(scene.camera)
        for light in scene.lights:
            self.add_light(light)

    def set_up(self, size, threads):
        render, cycles = self.context.render, self.context.cycles
        render.engine = "CYCLES"
        cycles.device, cycles.max_bounces, cycles.use_adaptive_sampling = "CPU", 0, False
        cycles.denoiser, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "RGB_ALBEDO_NORMAL"
        render.resolution_x = render.resolution_y = size
        render.threads_mode, render.threads = "FIXED", threads
        # Keeps the acceleration structure between images.
        render.use_persistent_data = True
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"

    def move_to_gpu(self):
        preferences = self.bpy.context.preferences.addons["cycles"].preferences
        preferences.compute_device_type = "OPTIX"
        preferences.refresh_devices()
        for device in preferences.devices:
            device.use = device.type == "OPTIX"
        if not any(device.use for device in preferences.devices):
            raise ImportError("it finds no GPU")
        self.context.cycles.device, self.context.cycles.denoising_use_gpu = "GPU", True

    def add(self, name, data, vectors, place):
        """Places an object with these axes, as columns, at a position."""
        import mathutils

        thing = self.bpy.data.objects.new(name, data)
        matrix = np.eye(4)
        matrix[:3] = np.stack([*vectors, place], 1)
        thing.matrix_world = mathutils.Matrix(matrix.tolist())
        self.context.collection.objects.link(thing)
        return thing

    def add_mesh(self, scene):
        mesh = self.bpy.data.meshes.new("mesh")
        mesh.from_pydata(scene.positions, [], scene.triangles)
        material = self.bpy.data.materials.new("grey")
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = (KD, KD, KD, 1)
        material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
        mesh.materials.append(material)
        self.add("mesh", mesh, np.eye(3), np.zeros(3))

    def add_camera(self, camera):
        data = self.bpy.data.cameras.new("camera")
        data.angle, data.clip_start, data.clip_end = math.radians(camera.vfov), 1e-4, 1e6
        right = np.cross(camera.direction, camera.up)
        axes = [right, np.cross(right, camera.direction), -camera.direction]
        self.context.camera = self.add("camera", data, axes, camera.position)

    def add_light(self, light):
        data = self.bpy.data.lights.new("light", "AREA")
        data.shape, data.size, data.size_y = "RECTANGLE", np.linalg.norm(light.u), np.linalg.norm(light.v)
        # Watts of a Lambertian emitter.
        data.energy = math.pi * light.intensity
        across = light.u / data.size
        thing = self.add("light", data, [across, np.cross(-light.direction, across), -light.direction], light.position)
        thing.visible_camera = False

    def render(self, samples, seed, smooth=False, denoise=False):
        cycles = self.context.cycles
        cycles.samples, cycles.seed, cycles.use_denoising = samples, seed, denoise
        # Its default, or the narrowest filter available: a hundredth of a pixel.
        cycles.pixel_filter_type, cycles.filter_width = ("BLACKMAN_HARRIS", 1.5) if smooth else ("GAUSSIAN", 0.01)
        # Without this the previous image is returned: Blender does not notice that these settings changed.
        self.context.update_tag()
        start = time.perf_counter()
        self.bpy.ops.render.render()
        seconds = time.perf_counter() - start
        self.bpy.data.images["Render Result"].save_render(self.path)
        return seconds, flip_evaluator.load(self.path)

    reference = render
