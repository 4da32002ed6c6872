"""Blender's side: Cycles."""

import math
import time

import flip_evaluator
import numpy as np

ENDLESS = 65
"""Reflections after which nothing is left to see."""
# Blender has z up.
TURN = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)


class Cycles:
    name = "Cycles"

    def __init__(self, lightmesh, options, folder):
        import bpy

        self.bpy, self.folder, self.version = bpy, folder, bpy.app.version_string
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.context = bpy.context.scene
        self.set_up(options)
        for part in lightmesh.model.parts:
            self.add_part(part)
        self.add_camera(lightmesh.camera)
        for sun in lightmesh.suns:
            self.add_sun(sun)
        self.add_sky(lightmesh.panorama)

    def set_up(self, options):
        render, cycles = self.context.render, self.context.cycles
        render.engine = "CYCLES"
        cycles.device, cycles.use_adaptive_sampling = "CPU", False
        if options.device == "cuda":
            self.move_to_gpu()
        cycles.max_bounces = cycles.diffuse_bounces = (options.reflections or ENDLESS) - 1
        cycles.transparent_max_bounces = 64
        cycles.denoiser, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "RGB_ALBEDO_NORMAL"
        cycles.pixel_filter_type = "BOX"
        render.resolution_x, render.resolution_y = options.size
        render.threads_mode, render.threads = "FIXED", options.threads
        # Keeps the acceleration structure between images.
        render.use_persistent_data = True
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"

    def move_to_gpu(self):
        preferences = self.bpy.context.preferences.addons["cycles"].preferences
        preferences.compute_device_type = "OPTIX"
        preferences.refresh_devices()
        for device in preferences.devices:
            device.use = device.type == "OPTIX"
        self.context.cycles.device, self.context.cycles.denoising_use_gpu = "GPU", True

    def add(self, name, data, vectors, place):
        """Places an object with these axes, as columns, at a position."""
        import mathutils

        thing = self.bpy.data.objects.new(name, data)
        matrix = np.eye(4)
        matrix[:3] = np.stack([*vectors, place], 1)
        thing.matrix_world = mathutils.Matrix(matrix.tolist())
        self.context.collection.objects.link(thing)

    def add_part(self, part):
        mesh = self.bpy.data.meshes.new("part")
        mesh.from_pydata(part.positions @ TURN.T, [], part.triangles.tolist())
        corners = np.array([loop.vertex_index for loop in mesh.loops])
        if part.uvs is not None:
            # Blender's images begin at the bottom.
            mesh.uv_layers.new(name="uv").data.foreach_set("uv", np.ravel(part.uvs[corners] * [1, -1] + [0, 1]))
        if part.colors is not None:
            colors = np.concatenate([part.colors, np.ones((len(part.colors), 1))], 1)
            mesh.attributes.new("color", "FLOAT_COLOR", "POINT").data.foreach_set("color", np.ravel(colors))
        if part.normals is not None:
            mesh.shade_smooth()
            mesh.normals_split_custom_set((part.normals @ TURN.T)[corners].tolist())
        mesh.materials.append(self.surface(part))
        self.add("part", mesh, np.eye(3), np.zeros(3))

    def surface(self, part):
        made, material = self.bpy.data.materials.new("material"), part.material
        made.use_nodes = True
        nodes, link = made.node_tree.nodes, made.node_tree.links.new
        nodes.clear()
        diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = (*material.color.tolist(), 1)
        shown = diffuse.outputs[0]
        if material.image is not None:
            texture, product = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeVectorMath")
            texture.image = self.picture(material.image[..., :3] / 255.0, "sRGB")
            product.operation = "MULTIPLY"
            product.inputs[1].default_value = material.color.tolist()
            link(texture.outputs["Color"], product.inputs[0])
            link(product.outputs[0], diffuse.inputs["Color"])
        elif part.colors is not None:
            attribute = nodes.new("ShaderNodeVertexColor")
            attribute.layer_name = "color"
            link(attribute.outputs["Color"], diffuse.inputs["Color"])
        if material.emission.any():
            emission, total = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
            emission.inputs["Color"].default_value = (*material.emission.tolist(), 1)
            # To one side, as in other programs.
            geometry, front = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMath")
            front.operation, front.inputs[0].default_value = "SUBTRACT", 1
            link(geometry.outputs["Backfacing"], front.inputs[1])
            link(front.outputs[0], emission.inputs["Strength"])
            link(shown, total.inputs[0])
            link(emission.outputs[0], total.inputs[1])
            shown = total.outputs[0]
        if material.mask is not None:
            texture, above = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeMath")
            texture.image = self.picture(np.repeat(material.mask[..., None], 3, -1), "Non-Color")
            above.operation, above.inputs[1].default_value = "GREATER_THAN", material.cutoff
            nothing, mix = nodes.new("ShaderNodeBsdfTransparent"), nodes.new("ShaderNodeMixShader")
            link(texture.outputs["Color"], above.inputs[0])
            link(above.outputs[0], mix.inputs[0])
            link(nothing.outputs[0], mix.inputs[1])
            link(shown, mix.inputs[2])
            shown = mix.outputs[0]
        link(shown, output.inputs["Surface"])
        return made

    def picture(self, texels, space):
        """An image of Blender's, whose rows begin at the bottom; `space` says how its texels are encoded."""
        height, width = texels.shape[:2]
        linear = space == "linear"
        image = self.bpy.data.images.new("image", width, height, alpha=True, float_buffer=linear)
        image.colorspace_settings.name = "Linear Rec.709" if linear else space
        whole = np.concatenate([texels, np.ones((height, width, 1))], -1)[::-1]
        image.pixels.foreach_set(np.ravel(whole).astype(np.float32))
        image.pack()
        return image

    def add_camera(self, camera):
        data = self.bpy.data.cameras.new("camera")
        data.sensor_fit = "VERTICAL"
        data.angle_y, data.clip_start, data.clip_end = math.radians(camera.vfov), 1e-4, 1e6
        right = np.cross(camera.direction, camera.up)
        right /= np.linalg.norm(right)
        axes = [TURN @ axis for axis in (right, np.cross(right, camera.direction), -camera.direction)]
        self.add("camera", data, axes, TURN @ camera.position)
        self.context.camera = self.context.collection.objects[-1]

    def add_sun(self, sun):
        data = self.bpy.data.lights.new("sun", "SUN")
        strength = sun.irradiance.max()
        data.energy, data.angle, data.color = strength, math.radians(sun.angle), (sun.irradiance / strength).tolist()
        along = TURN @ sun.direction
        across = np.cross(along, [1, 0, 0] if abs(along[0]) < 0.5 else [0, 1, 0])
        across /= np.linalg.norm(across)
        self.add("sun", data, [across, np.cross(-along, across), -along], np.zeros(3))

    def add_sky(self, panorama):
        world = self.bpy.data.worlds.new("world")
        world.use_nodes = True
        self.context.world = world
        nodes = world.node_tree.nodes
        nodes.clear()
        background, output = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
        background.inputs["Color"].default_value = (0, 0, 0, 1)
        if panorama is not None:
            texture = nodes.new("ShaderNodeTexEnvironment")
            # Its image begins a quarter of a turn earlier.
            texture.image = self.picture(np.roll(panorama, panorama.shape[1] // 4, axis=1), "linear")
            world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])
        world.node_tree.links.new(background.outputs[0], output.inputs["Surface"])

    def render(self, samples, seed, denoise):
        """Seconds and linear colours."""
        cycles, path = self.context.cycles, str(self.folder / "cycles.exr")
        cycles.samples, cycles.seed, cycles.use_denoising = samples, seed, denoise
        # Without this the previous image is returned: Blender does not notice that these settings changed.
        self.context.update_tag()
        start = time.perf_counter()
        self.bpy.ops.render.render()
        seconds = time.perf_counter() - start
        self.bpy.data.images["Render Result"].save_render(path)
        return seconds, flip_evaluator.load(path)
