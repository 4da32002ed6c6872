"""Materials against Cycles, with direct light only."""

import bpy
import numpy as np
import pytest
from support import agreement, ball, box, camera, cycles, image, light, lightmesh, matt, picture, plane, principled, shader_of, stage, world


def checker(size: int = 64) -> bpy.types.Image:
    """Squares of several colours, with an orange corner at the lower left, so that flips are seen."""
    rows, columns = np.mgrid[0:size, 0:size] * 4 // size
    pixels = np.where(((rows + columns) % 2)[..., None], (0.9, 0.9, 0.85), (0.2, 0.35, 0.6))
    pixels[rows + 3 - columns == 6] = (0.9, 0.4, 0.05)
    return image("checker", pixels)


def add_image(material: bpy.types.Material, shows: bpy.types.Image, socket: str, output: str = "Color") -> bpy.types.Node:
    """An Image Texture node that feeds a socket of the Principled BSDF."""
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = shows
    tree.links.new(node.outputs[output], shader_of(material).inputs[socket])
    return node


def add_mapping(material: bpy.types.Material, node: bpy.types.Node, kind: str = "POINT", **inputs: object) -> None:
    tree = material.node_tree
    mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.vector_type = kind
    for name, value in inputs.items():
        mapping.inputs[name].default_value = value
    tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])


def shown(material: bpy.types.Material) -> None:
    """The material on a floor and a ball, under a lamp and a sun."""
    plane("Floor", 2.5, material)
    ball("Ball", 0.8, (0.2, 0.0, 0.8), material)
    camera((0.0, -5.0, 4.0), (0.0, 0.0, 0.3))
    world()
    light("AREA", 200.0, (-2.0, -2.0, 4.0), size=1.0)
    light("SUN", 1.0, (3.0, -1.0, 3.0), angle=0.05)


@pytest.mark.parametrize("interpolation", ["Linear", "Closest"])
def test_textured(interpolation: str) -> None:
    material = principled(Specular_IOR_Level=0.0)
    add_image(material, checker(), "Base Color").interpolation = interpolation
    shown(material)
    agreement(f"textured_{interpolation.lower()}", lightmesh(), cycles()).check()


PLACEMENTS = {
    "scaled": ("POINT", {"Scale": (3.0, 2.0, 1.0), "Location": (0.1, 0.2, 0.0)}),
    "turned": ("POINT", {"Rotation": (0.0, 0.0, 0.5), "Scale": (2.0, 1.0, 1.0), "Location": (0.3, 0.0, 0.0)}),
    "as_texture": ("TEXTURE", {"Rotation": (0.0, 0.0, 0.5), "Scale": (0.5, 0.7, 1.0), "Location": (0.3, 0.1, 0.0)}),
}


@pytest.mark.parametrize("name", PLACEMENTS)
def test_placed(name: str) -> None:
    kind, inputs = PLACEMENTS[name]
    material = principled(Specular_IOR_Level=0.0)
    add_mapping(material, add_image(material, checker(), "Base Color"), kind, **inputs)
    shown(material)
    agreement(f"placed_{name}", lightmesh(), cycles()).check()


@pytest.mark.parametrize("extension", ["EXTEND", "MIRROR"])
def test_beyond_the_edges(extension: str) -> None:
    material = principled(Specular_IOR_Level=0.0)
    node = add_image(material, checker(), "Base Color")
    node.extension = extension
    add_mapping(material, node, Scale=(2.5, 2.5, 1.0), Location=(-0.7, -0.6, 0.0))
    shown(material)
    agreement(f"beyond_{extension.lower()}", lightmesh(), cycles()).check()


def test_float_image_as_colour() -> None:
    material = principled(Specular_IOR_Level=0.0)
    codes = np.array(checker().pixels[:]).reshape(64, 64, 4)[::-1, :, :3]
    add_image(material, image("linear", codes, is_float=True), "Base Color")
    shown(material)
    agreement("float_image", lightmesh(), cycles()).check()


FINISHES = {
    "default": {},
    "rough": {"Roughness": 0.9},
    "satin": {"Roughness": 0.3},
    "metal": {"Metallic": 1.0, "Roughness": 0.5, "Base_Color": (0.9, 0.6, 0.2, 1.0)},
    "half_metal": {"Metallic": 0.5, "Roughness": 0.6},
    "tinted": {"Specular_IOR_Level": 0.6, "IOR": 1.6, "Specular_Tint": (1.0, 0.9, 0.8, 1.0), "Roughness": 0.4},
    "faint": {"Alpha": 0.4, "Specular_IOR_Level": 0.0},
}


@pytest.mark.parametrize("name", FINISHES)
def test_finish(name: str) -> None:
    """Facets show lights, and other surfaces below a roughness of 0.6, where mirror rays end."""
    finish = FINISHES[name]
    shown(principled(**finish))
    mirrors = 2 if finish.get("Roughness", 0.5) < 0.6 else 0
    agreement(f"finish_{name}", lightmesh(), cycles(mirrors=mirrors)).check()


def test_normal_map() -> None:
    """Ridges along both ways: wrong signs of either would show."""
    u, v = np.meshgrid(*2 * [np.linspace(0.0, 8.0 * np.pi, 256, endpoint=False)])
    normals = np.stack([0.5 * np.sin(u), 0.3 * np.maximum(np.sin(v), 0.0), np.ones_like(u)], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    material = principled(Specular_IOR_Level=0.0)
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeNormalMap")
    picture = add_image(material, image("normals", 0.5 * normals + 0.5, space="Non-Color"), "Base Color")
    tree.links.remove(picture.outputs["Color"].links[0])
    tree.links.new(picture.outputs["Color"], node.inputs["Color"])
    tree.links.new(node.outputs["Normal"], shader_of(material).inputs["Normal"])
    node.inputs["Strength"].default_value = 0.8
    shown(material)
    agreement("normal_map", lightmesh(), cycles()).check()


def test_metallic_and_roughness_images() -> None:
    """Two images become one texture; data are not decoded."""
    rows, columns = np.mgrid[0:64, 0:64] // 16
    metallic, rough = (rows % 2).astype(float), np.where(columns % 2, 0.35, 0.8)
    material = principled(Base_Color=(0.8, 0.5, 0.3, 1.0))
    add_image(material, image("metallic", np.repeat(metallic[..., None], 3, 2), space="Non-Color"), "Metallic")
    add_image(material, image("rough", np.repeat(rough[..., None], 3, 2), space="Non-Color"), "Roughness")
    shown(material)
    agreement("metallic_roughness", lightmesh(), cycles(mirrors=2)).check()


def test_cut_out() -> None:
    """An image's alpha: holes, in the shadow, too."""
    rows, columns = np.mgrid[0:64, 0:64] // 16
    picture = bpy.data.images.new("holes", 64, 64, alpha=True)
    full = np.ones((64, 64, 4), np.float32)
    full[..., 3] = (rows + columns) % 2
    picture.pixels.foreach_set(full.ravel())
    material = principled(Specular_IOR_Level=0.0)
    node = add_image(material, picture, "Base Color")
    material.node_tree.links.new(node.outputs["Alpha"], shader_of(material).inputs["Alpha"])
    plane("Floor", 3.0, matt())
    plane("Grid", 1.0, material, (0.0, 0.0, 1.0))
    camera()
    world()
    light("AREA", 300.0, (1.0, -1.0, 4.0), size=0.3)
    agreement("cut_out", lightmesh(), cycles()).check()


def test_vertex_colours() -> None:
    stage()
    data = bpy.data.objects["Floor"].data
    layer = data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    layer.data.foreach_set("color", [1, 0.2, 0.1, 1, 0.1, 0.9, 0.2, 1, 0.1, 0.2, 1, 1, 0.8, 0.8, 0.8, 1])
    data.materials[0] = painted = principled("painted", Specular_IOR_Level=0.0)
    tree = painted.node_tree
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "Paint"
    tree.links.new(node.outputs["Color"], shader_of(painted).inputs["Base Color"])
    light("SUN", 2.0, angle=0.05)
    agreement("vertex_colours", lightmesh(), cycles()).check()


def test_emission_lights_the_scene() -> None:
    """A shining box lights a floor. Both pictures have its light after reflections."""
    plane("Floor", 3.0, matt())
    box(
        "Lamp",
        (0.3, 0.3, 0.3),
        (0.0, 0.5, 1.2),
        principled("lamp", Emission_Color=(1.0, 0.7, 0.4, 1.0), Emission_Strength=4.0, Base_Color=(0.0, 0.0, 0.0, 1.0), Specular_IOR_Level=0.0),
    )
    camera()
    world()
    agreement("emission", lightmesh(), cycles(samples=256, bounces=14)).check(ratio=0.04, difference=0.12, shadows=0.9)


def test_glass() -> None:
    """A pane of glass lets the light of the world through."""
    plane("Floor", 3.0, matt(color=(0.6, 0.2, 0.1)))
    ball("Glass", 0.8, (0.0, 0.0, 0.9), principled("glass", Transmission_Weight=1.0, Roughness=0.0, IOR=1.45))
    camera()
    world((0.8, 0.9, 1.0), 0.7)
    bpy.context.scene.lightmesh.bounces = 4
    ours = lightmesh()
    settings = bpy.context.scene.cycles
    cycles(samples=1, bounces=8)
    settings.samples, settings.glossy_bounces, settings.transmission_bounces = 64, 8, 8
    agreement("glass", ours, picture("CYCLES")).check(ratio=0.05, difference=0.1)


def test_no_material() -> None:
    stage()
    for obj in bpy.data.objects:
        if obj.type == "MESH":
            obj.data.materials.clear()
    light("SUN", 2.0, angle=0.1)
    agreement("no_material", lightmesh(), cycles()).check()
