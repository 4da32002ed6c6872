"""Cameras: the same pixels are covered as in Cycles' pictures."""

import bpy
import numpy as np
import pytest
from support import HEIGHT, WIDTH, Picture, agreement, camera, cycles, light, lightmesh, overlap, picture, stage

CAMERAS = {
    "automatic": {"lens": 35.0},
    "horizontal": {"lens": 35.0, "sensor_fit": "HORIZONTAL", "sensor_width": 30.0},
    "vertical": {"lens": 35.0, "sensor_fit": "VERTICAL", "sensor_height": 30.0},
    "shifted": {"lens": 35.0, "shift_x": 0.15, "shift_y": -0.1},
    "parallel": {"type": "ORTHO", "ortho_scale": 6.0},
    "parallel_shifted": {"type": "ORTHO", "ortho_scale": 6.0, "shift_x": -0.1, "shift_y": 0.2},
}


def covered(by: Picture) -> np.ndarray:
    return by.alpha > 0.5


@pytest.mark.parametrize("size", [(WIDTH, HEIGHT), (90, 140)], ids=["wide", "tall"])
@pytest.mark.parametrize("name", CAMERAS)
def test_camera(name: str, size: tuple[int, int]) -> None:
    stage()
    bpy.data.objects["Floor"].scale = (0.4, 0.4, 1.0)
    camera(**CAMERAS[name])
    scene = bpy.context.scene
    scene.render.film_transparent = True
    ours = picture("LIGHTMESH", size)
    cycles_samples(scene)
    theirs = picture("CYCLES", size)
    assert overlap(covered(ours), covered(theirs)) > 0.985
    assert ours.alpha.mean() == pytest.approx(theirs.alpha.mean(), rel=0.01)


def cycles_samples(scene: bpy.types.Scene) -> None:
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 16, False, "BOX"


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (1.0, -1.0, 1.0)], ids=["sideways", "upside_down"])
@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_mirrored(kind: str, scale: tuple[float, float, float]) -> None:
    """A negative scale mirrors the image and its passes, with shift and border."""
    stage()
    light("SUN", 2.0)
    camera(type=kind, lens=35.0, ortho_scale=8.0, shift_x=0.1, shift_y=-0.05).scale = scale
    bpy.context.view_layer.use_pass_position = True
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.1, 0.7, 0.0, 1.0
    ours, theirs = lightmesh(), cycles()
    agreement(f"mirrored_{kind.lower()}_{scale[0]:g}", ours, theirs).check()
    assert np.median(np.abs(ours.pass_("Position", "XYZ") - theirs.pass_("Position", "XYZ"))) < 0.05


def test_border() -> None:
    """Only a part of the image is rendered; the rest is empty, or left out."""
    stage()
    light("SUN", 2.0)
    whole = lightmesh()
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1.0
    part = lightmesh()
    assert part.rgb.shape == whole.rgb.shape
    rows, columns = slice(0, HEIGHT // 2), slice(WIDTH // 4, 3 * WIDTH // 4)
    np.testing.assert_array_equal(part.rgb[rows, columns], whole.rgb[rows, columns])
    assert part.rgb[HEIGHT // 2 :].max() == 0.0
    render.use_crop_to_border = True
    np.testing.assert_array_equal(lightmesh().rgb, whole.rgb[rows, columns])
