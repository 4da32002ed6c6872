"""The same model in Blender's Cycles: the file by Blender's own importer, the camera that Lightmesh used, and its lights as suns."""

import math

import numpy as np

import renderers
from scene import Camera

# Blender has z up; its importers turn files like this.
TURN = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
AXES = {"forward_axis": "NEGATIVE_Z", "up_axis": "Y"}
CREASE = math.radians(30)


class Cycles(renderers.Cycles):
    """With Cycles' own defaults: bounces, adaptive sampling, pixel filter."""

    def __init__(self, model, size, threads, folder):
        import bpy

        self.bpy, self.path = bpy, str(folder / "cycles.exr")
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.context = bpy.context.scene
        self.set_up(size, threads)
        self.context.cycles.max_bounces, self.context.cycles.use_adaptive_sampling = 12, True
        self.add_model(model.file)
        camera = model.camera
        self.add_camera(Camera(TURN @ camera.position, TURN @ camera.direction, TURN @ camera.up, camera.vfov))
        for sun in model.suns:
            self.add_sun(sun)
        self.add_surroundings(model.ambient, model.background)

    def add_model(self, file):
        operators, kind = self.bpy.ops, file.suffix.lower()
        if kind in (".gltf", ".glb"):
            # Intensities as they are, without the factor of 683 lumens per watt: they are relative to the ambient light.
            operators.import_scene.gltf(filepath=str(file), export_import_convert_lighting_mode="COMPAT")
            return
        if kind == ".ply":
            operators.wm.ply_import(filepath=str(file), **AXES)
        elif kind == ".stl":
            operators.wm.stl_import(filepath=str(file), **AXES)
        else:
            operators.wm.obj_import(filepath=str(file), **AXES)
        for thing in self.bpy.data.objects:
            self.finish(thing)

    def finish(self, thing):
        """Smooth normals for files without, as Lightmesh makes them, and a material that shows vertex colours."""
        mesh = thing.data
        if not mesh.has_custom_normals:
            with self.bpy.context.temp_override(object=thing, active_object=thing, selected_editable_objects=[thing]):
                self.bpy.ops.object.shade_smooth_by_angle(angle=CREASE)
        if mesh.color_attributes and not mesh.materials:
            material = self.bpy.data.materials.new("colours")
            material.use_nodes = True
            tree = material.node_tree
            color = tree.nodes.new("ShaderNodeVertexColor")
            color.layer_name = mesh.color_attributes[0].name
            shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
            tree.links.new(color.outputs["Color"], shader.inputs["Base Color"])
            mesh.materials.append(material)

    def add_sun(self, sun):
        data = self.bpy.data.lights.new("sun", "SUN")
        data.energy, data.angle = sun.irradiance, sun.angle
        along = TURN @ sun.direction
        across = np.cross(along, [1, 0, 0] if abs(along[0]) < 0.5 else [0, 1, 0])
        across /= np.linalg.norm(across)
        self.add("sun", data, [across, np.cross(-along, across), -along], np.zeros(3))

    def add_surroundings(self, ambient, background):
        """The ambient light from all sides, the background for the camera alone."""
        world = self.bpy.data.worlds.new("world")
        world.use_nodes = True
        self.context.world = world
        nodes, links = world.node_tree.nodes, world.node_tree.links
        nodes.clear()
        output, mix, path = (nodes.new(f"ShaderNode{kind}") for kind in ("OutputWorld", "MixShader", "LightPath"))
        links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
        for slot, color in ((1, ambient), (2, background)):
            shader = nodes.new("ShaderNodeBackground")
            shader.inputs["Color"].default_value = (*color, 1)
            links.new(shader.outputs[0], mix.inputs[slot])
        links.new(mix.outputs[0], output.inputs["Surface"])


def shown(linear, like, covered):
    """8-bit codes of linear colours. `like`: a picture whose mean brightness it gets, as an exposure that is automatic there calls for."""
    gain = 1.0
    if like is not None:
        wanted, low, high = mean(like / 255, covered), 1e-6, 1e6
        for _ in range(60):
            gain = math.sqrt(low * high)
            low, high = (gain, high) if mean(coded(gain * linear), covered) < wanted else (low, gain)
    return np.uint8(255 * coded(gain * linear) + 0.5)


def mean(codes, covered):
    return float((codes.mean(axis=-1) * covered).sum() / max(covered.sum(), 1))


def coded(linear):
    """The sRGB transfer function."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
