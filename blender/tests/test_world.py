"""Worlds against Cycles: their colour, and panoramas as they are placed, seen and as light.

A ball alone shows no light that was reflected before: that of the world is direct there.
"""

import math

import bpy
import numpy as np
import pytest
from support import agreement, ball, camera, cycles, image, lightmesh, matt, stage, world


def ball_in_world(**settings: object) -> bpy.types.World:
    """A ball before a wide camera."""
    ball("Ball", 1.0, (0.0, 0.0, 0.0), matt())
    camera((0.0, -4.0, 1.0), lens=18.0)
    return world(**settings)


def panorama(size: tuple[int, int] = (64, 32)) -> bpy.types.Image:
    """Colours that tell where a direction is: red to the left, green above, blue in the middle, with a bright patch."""
    width, height = size
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    pixels = np.stack([1.0 - u, 1.0 - v, 1.0 - np.abs(2.0 * u - 1.0)], axis=2)
    pixels[height // 4 : height // 3, width // 5 : width // 4] = 3.0
    return image("panorama", pixels, is_float=True)


def textured(made: bpy.types.World, node_type: str = "ShaderNodeTexEnvironment") -> bpy.types.Node:
    tree = made.node_tree
    node = tree.nodes.new(node_type)
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    return node


def test_colour() -> None:
    ball_in_world(color=(0.2, 0.5, 0.9), strength=0.7)
    ours, theirs = lightmesh(), cycles()
    agreement("world_colour", ours, theirs).check()
    assert ours.rgb.mean((0, 1)) == pytest.approx(theirs.rgb.mean((0, 1)), rel=0.01)


def test_colour_hides() -> None:
    """Contacts are darker; what is reflected is in both pictures."""
    stage()
    world((1.0, 1.0, 1.0), 0.5)
    agreement("world_contacts", lightmesh(), cycles(bounces=4)).check()


def test_no_world() -> None:
    stage()
    bpy.context.scene.world = None
    assert lightmesh().rgb.max() == 0.0


def test_black_world_gives_no_light() -> None:
    stage()
    assert lightmesh().rgb.max() == 0.0


TURNS = {
    "straight": (0.0, 0.0, 0.0),
    "turned": (0.0, 0.0, math.radians(70.0)),
    "tilted": (math.radians(40.0), math.radians(-20.0), math.radians(110.0)),
}


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE"])
@pytest.mark.parametrize("name", TURNS)
def test_panorama(name: str, kind: str) -> None:
    made = ball_in_world(strength=0.8)
    texture = textured(made)
    texture.image = panorama()
    tree = made.node_tree
    mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.vector_type = kind
    mapping.inputs["Rotation"].default_value = TURNS[name]
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    ours, theirs = lightmesh(), cycles()
    # Without shadows, no edge tells what is dark.
    agreement(f"panorama_{name}_{kind.lower()}", ours, theirs).check(shadows=0.0)
    assert ours.rgb.mean((0, 1)) == pytest.approx(theirs.rgb.mean((0, 1)), rel=0.02)


def test_mirror_ball() -> None:
    texture = textured(ball_in_world())
    texture.image, texture.projection = panorama((64, 64)), "MIRROR_BALL"
    agreement("mirror_ball", lightmesh(), cycles()).check(difference=0.06)


def test_sun_in_a_panorama() -> None:
    """A few very bright texels light as a sun does, with shadows."""
    stage()
    pixels = np.full((128, 256, 3), 0.1)
    pixels[30:32, 100:102] = 2000.0
    texture = textured(world((1.0, 1.0, 1.0)))
    texture.image = image("sun", pixels, is_float=True)
    agreement("panorama_sun", lightmesh(), cycles(bounces=4)).check(difference=0.06)


def test_camera_sees_another_colour() -> None:
    made = ball_in_world(color=(1.0, 1.0, 1.0), strength=0.6)
    tree = made.node_tree
    mix, ray, seen = (tree.nodes.new(name) for name in ("ShaderNodeMixShader", "ShaderNodeLightPath", "ShaderNodeBackground"))
    seen.inputs["Color"].default_value = (0.05, 0.0, 0.1, 1.0)
    tree.links.new(ray.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(seen.outputs[0], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    agreement("two_worlds", lightmesh(), cycles()).check()


def test_sky() -> None:
    """A Sky Texture is Lightmesh's own sky, which is not the same: about as bright, with shadows in the same place."""
    stage()
    node = textured(world(), "ShaderNodeTexSky")
    node.sun_elevation, node.sun_rotation = math.radians(35.0), math.radians(120.0)
    agreement("sky", lightmesh(), cycles(bounces=4)).check(ratio=0.15, difference=0.3, shadows=0.85)


def test_sky_without_a_sun() -> None:
    stage()
    textured(world(), "ShaderNodeTexSky").sky_type = "HOSEK_WILKIE"
    found = agreement("sky_without_a_sun", lightmesh(), cycles(bounces=4))
    assert 0.5 < found.ratio < 2.0
