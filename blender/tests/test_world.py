"""Worlds against Cycles: their colour, and panoramas as they are placed, seen and as light.

A ball alone shows no light that was reflected before: that of the world is direct there.
"""

import math

import bpy
import numpy as np
import pytest
from support import Picture, agreement, ball, camera, cycles, image, lightmesh, matt, stage, world


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


SKIES = [item.identifier for item in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items]


def in_the_open() -> bpy.types.World:
    """The stage as someone sees it who stands there, with much of the sky."""
    stage()
    camera((0.0, -7.0, 1.6), (0.0, 0.0, 2.0), lens=24.0)
    bpy.context.view_layer.use_pass_z = True
    return world()


def check_background(ours: Picture, theirs: Picture) -> None:
    """The sky is that of Cycles, but for the row of pixels at the horizon, and a few around the sun."""
    where = (ours.channels["Depth.Z"] > 1e9) & (theirs.channels["Depth.Z"] > 1e9)
    assert where.mean() > 0.3
    scale = float(np.percentile(theirs.rgb[where], 95.0))
    a, b = (255.0 * np.clip(of.rgb[where] / scale, 0.0, 1.0) ** (1.0 / 2.2) for of in (ours, theirs))
    assert np.percentile(np.abs(a - b), 98.0) <= 20.0
    assert np.abs(a - b).mean() <= 2.0


@pytest.mark.parametrize("kind", SKIES)
def test_sky(kind: str) -> None:
    """Sky Textures with their defaults look as in Cycles, and light as there."""
    textured(in_the_open(), "ShaderNodeTexSky").sky_type = kind
    ours, theirs = lightmesh(), cycles(bounces=4)
    # The sun itself is a few pixels of very different brightness.
    most = 4.0 * float(np.percentile(theirs.rgb, 95.0))
    for of in (ours, theirs):
        for letter in "RGB":
            of.channels[f"Combined.{letter}"] = np.minimum(of.channels[f"Combined.{letter}"], most)
    # Without a sun there are no edges of shadows.
    sunny = kind not in ("PREETHAM", "HOSEK_WILKIE")
    agreement(f"sky_{kind.lower()}", ours, theirs).check(ratio=0.02, shadows=0.95 if sunny else 0.0)
    check_background(ours, theirs)


def test_sky_with_a_high_sun() -> None:
    """Shadows are where they are in Cycles."""
    stage()
    node = textured(world(strength=0.1), "ShaderNodeTexSky")
    node.sun_elevation, node.sun_rotation = math.radians(35.0), math.radians(120.0)
    agreement("sky_with_a_high_sun", lightmesh(), cycles(bounces=4)).check(ratio=0.03, shadows=0.95)


def test_sky_without_a_disc() -> None:
    textured(in_the_open(), "ShaderNodeTexSky").sun_disc = False
    ours, theirs = lightmesh(), cycles(bounces=4)
    agreement("sky_without_a_disc", ours, theirs).check(shadows=0.0)
    check_background(ours, theirs)


def test_turned_sky() -> None:
    """Skies without a sun are looked up by directions, which nodes turn."""
    made = in_the_open()
    node = textured(made, "ShaderNodeTexSky")
    node.sky_type = "HOSEK_WILKIE"
    node.sun_direction = (0.6, 0.0, 0.8)
    tree = made.node_tree
    mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0.1, 0.0, 1.0)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    ours, theirs = lightmesh(), cycles(bounces=4)
    agreement("turned_sky", ours, theirs).check(shadows=0.0)
    check_background(ours, theirs)


def test_sky_that_cannot_be_rendered(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    """Lightmesh's own sky stands for it."""
    from lightmesh_addon.export import sky

    monkeypatch.setattr(sky, "_kept", {})
    monkeypatch.setattr(sky.sys, "executable", "/nowhere/python")
    stage()
    textured(world(), "ShaderNodeTexSky")
    assert lightmesh().rgb.mean() > 0.1
    assert "is Lightmesh's clear sky" in capfd.readouterr().out


def test_the_same_sky_is_rendered_once(monkeypatch: pytest.MonkeyPatch) -> None:
    from lightmesh_addon.export import sky

    made = []
    monkeypatch.setattr(sky, "_kept", {})
    monkeypatch.setattr(sky, "_rendered", lambda key: (made.append(key), np.ones((4, 8, 3), np.float32))[1])
    node = textured(in_the_open(), "ShaderNodeTexSky")
    for elevation, turn in ((0.2, 0.0), (0.2, 1.0), (0.4, 2.0), (0.2, 3.0)):
        node.sun_elevation, node.sun_rotation = elevation, turn
        lightmesh()
    assert len(made) == 2
