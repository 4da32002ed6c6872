"""Each kind of light against Cycles, with direct light only."""

import math

import bpy
import numpy as np
import pytest
from support import Agreement, agreement, cycles, image, light, lightmesh, stage, world

#: Kind, energy, and settings of lights.
LIGHTS = {
    "point": ("POINT", 400.0, {"shadow_soft_size": 0.0}),
    "ball": ("POINT", 400.0, {"shadow_soft_size": 0.5}),
    "sun": ("SUN", 3.0, {"angle": 0.0}),
    "wide_sun": ("SUN", 3.0, {"angle": math.radians(15.0)}),
    "spot": ("SPOT", 600.0, {"spot_size": math.radians(50.0), "spot_blend": 0.15, "shadow_soft_size": 0.1}),
    "sharp_spot": ("SPOT", 600.0, {"spot_size": math.radians(50.0), "spot_blend": 0.0, "shadow_soft_size": 0.0}),
    "square": ("AREA", 300.0, {"shape": "SQUARE", "size": 1.0}),
    "rectangle": ("AREA", 300.0, {"shape": "RECTANGLE", "size": 2.0, "size_y": 0.5}),
    "disk": ("AREA", 300.0, {"shape": "DISK", "size": 1.0}),
    "ellipse": ("AREA", 300.0, {"shape": "ELLIPSE", "size": 1.6, "size_y": 0.5}),
}


@pytest.mark.parametrize("name", LIGHTS)
def test_light(name: str) -> None:
    kind, energy, settings = LIGHTS[name]
    stage()
    light(kind, energy, **settings)
    # A cone's edge is as sharp as a shadow's, and is compared with it.
    compared(name).check(difference=0.015, shadows=0.97, penumbra=0.045 if kind == "SPOT" else 0.025)


def compared(name: str) -> Agreement:
    return agreement(name, lightmesh(), cycles())


def test_blended_spot() -> None:
    """A cone that fades all the way: its light is the same, though it falls off otherwise."""
    stage()
    light("SPOT", 600.0, spot_size=math.radians(70.0), spot_blend=1.0, shadow_soft_size=0.2)
    compared("blended_spot").check(difference=0.1)


def _exposed(data: bpy.types.Light) -> None:
    if not hasattr(data, "exposure"):
        pytest.skip("this Blender has no exposure of lights")
    data.exposure = 1.5


def _warm(data: bpy.types.Light) -> None:
    if not hasattr(data, "use_temperature"):
        pytest.skip("this Blender has no temperature of lights")
    data.use_temperature, data.temperature = True, 3000.0


def _nodes(data: bpy.types.Light) -> None:
    data.use_nodes = True
    node = next(node for node in data.node_tree.nodes if node.type == "EMISSION")
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0.2, 0.9, 0.4, 1.0), 2.5


def _coloured(data: bpy.types.Light) -> None:
    data.color = (1.0, 0.3, 0.1)


def _not_normalized(data: bpy.types.Light) -> None:
    if not hasattr(data, "normalize"):
        pytest.skip("this Blender has normalized lights only")
    data.normalize = False
    data.energy *= 0.3


CHANGES = {"exposed": _exposed, "warm": _warm, "nodes": _nodes, "coloured": _coloured, "not_normalized": _not_normalized}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("kind", ["wide_sun", "spot", "rectangle", "disk", "ball"])
def test_strength(kind: str, change: str) -> None:
    """What a light's strength is made of; each channel counts."""
    sort, energy, settings = LIGHTS[kind]
    stage()
    CHANGES[change](light(sort, energy, **settings).data)
    ours, theirs = lightmesh(), cycles(samples=32)
    assert ours.rgb.mean((0, 1)) == pytest.approx(theirs.rgb.mean((0, 1)), rel=0.02)


@pytest.mark.parametrize("kind", ["spot", "rectangle", "disk", "ball", "wide_sun"])
def test_scaled(kind: str) -> None:
    """The scale of a light's object counts as in Cycles."""
    sort, energy, settings = LIGHTS[kind]
    stage()
    light(sort, energy, **settings).scale = (1.7, 1.7, 1.7)
    compared(f"scaled_{kind}").check()


def test_all_kinds_and_a_panorama() -> None:
    """Everything at once, with an environment texture."""
    stage()
    light("POINT", 60.0, (-2.0, -2.0, 2.5), shadow_soft_size=0.1, color=(1.0, 0.5, 0.3))
    light("SUN", 0.8, (3.0, 1.0, 4.0), angle=math.radians(4.0))
    light("SPOT", 200.0, (2.0, -2.0, 4.0), spot_size=math.radians(40.0), spot_blend=0.2)
    light("AREA", 80.0, (-1.0, 2.5, 3.0), shape="RECTANGLE", size=2.0, size_y=0.6, color=(0.4, 0.6, 1.0))
    nodes = world().node_tree
    texture = nodes.nodes.new("ShaderNodeTexEnvironment")
    rows = np.linspace(0.5, 0.02, 16)[:, None, None] * np.array((0.5, 0.7, 1.0))
    texture.image = image("sky", np.repeat(rows, 32, axis=1), is_float=True)
    nodes.links.new(texture.outputs["Color"], nodes.nodes["Background"].inputs["Color"])
    # What surfaces gather of a world is reflected up to fourteen times, so that Cycles' diffuse light is, too.
    agreement("all_kinds", lightmesh(), cycles(bounces=14)).check()
