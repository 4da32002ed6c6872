"""Scenes, geometry, lights, cameras and materials."""

import warnings

import numpy as np
import pytest
from conftest import CUBE, CUBE_TRIANGLES, SIZE, at, camera, cube, floor

import lightmesh
from lightmesh import Camera, Environment, Geometry, Light, Material, Scene, Texture


def test_scene_of_arrays(scene):
    assert scene.triangle_count == 14
    assert scene.objects == ["floor", "cube"]
    assert scene.materials == ["stone", "clay"]
    low, high = scene.bounds
    assert low == pytest.approx((-3, 0, -3)) and high == pytest.approx((3, 1.5, 3))
    assert scene.warnings == [] and scene.duration is None
    assert repr(scene) == '<lightmesh.Scene "cube", 14 triangles, 1 lights>'


def test_files_and_builtin_scenes(model):
    bunny = Scene.open(model("bunny/bunny.ply"))
    assert bunny.triangle_count > 60_000
    assert Scene.builtin("garden?lights=3").lights[2].kind
    assert Scene.builtin("builtin:gazebo").triangle_count == Scene.builtin("gazebo").triangle_count


def test_loader_warnings_are_warnings_of_python(tmp_path):
    path = tmp_path / "bad.obj"
    path.write_text("mtllib missing.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.warns(lightmesh.SceneWarning) as warned:
        scene = Scene.open(path)
    assert [str(warning.message) for warning in warned] == scene.warnings
    assert any("missing.mtl" in warning for warning in scene.warnings)
    with warnings.catch_warnings():
        warnings.simplefilter("error", lightmesh.SceneWarning)
        with pytest.raises(lightmesh.SceneWarning):
            Scene.open(path)
    with pytest.raises(lightmesh.SceneError):
        Scene.open(path, strict=True)


@pytest.mark.parametrize("instances", ["always", "never", "auto"])
def test_places_of_one_object_look_like_copies(renderer, instances):
    places = np.stack([at(x, 1.0, z) for x in (-2.0, 0.0, 2.0) for z in (-2.0, 2.0)])
    one = Geometry.from_arrays(CUBE, CUBE_TRIANGLES, transforms=places, name="cube")
    copies = [Geometry.from_arrays(CUBE + place[:3, 3].astype(np.float32), CUBE_TRIANGLES) for place in places]
    light = Light.directional((-1.0, -2.0, -1.0), angle=4.0)
    placed = Scene([floor(), one], [light], camera(), instances=instances)
    copied = Scene([floor(), *copies], [light], camera())
    assert placed.triangle_count == copied.triangle_count or instances == "always"
    settings = {"size": SIZE, "mode": "area", "samples": 64}
    difference = renderer.render(placed, **settings).rgb - renderer.render(copied, **settings).rgb
    # Rounding differs where edges are seen.
    assert (np.abs(difference).max(axis=2) > 1e-3).mean() < 0.01


def test_placed_shares_and_moves():
    first = cube()
    second = first.placed(at(1.0, 0.0, 0.0), name="other")
    assert second.name == "other" and first.name == "cube"
    assert Scene([first, second]).objects == ["cube", "other"]


def test_colors_and_materials_by_triangle(renderer):
    corners = np.array([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)], np.float32)
    square = Geometry.from_arrays(
        corners,
        [(0, 1, 2), (0, 2, 3)],
        materials=[Material((1.0, 0.0, 0.0), name="red"), Material((0.0, 1.0, 0.0), name="green")],
        material_indices=[0, 1],
    )
    above = Camera((0.0, 4.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), height=2.0)
    scene = Scene(square, [Light.directional((0.0, -1.0, 0.0))], above, ambient=0.0)
    image = renderer.render(scene, size=(32, 32), mode="ray-trace").rgb
    # The first triangle is below the diagonal from the upper left to the lower right corner: x < z.
    np.testing.assert_allclose(image[24, 8], (1.0, 0.0, 0.0), atol=1e-5)
    np.testing.assert_allclose(image[8, 24], (0.0, 1.0, 0.0), atol=1e-5)
    tinted = Geometry.from_arrays(corners, [(0, 1, 2), (0, 2, 3)], colors=[(0.0, 0.0, 1.0)] * 4, material=Material(1.0))
    image = renderer.render(Scene(tinted, scene.lights, above, ambient=0.0), size=(32, 32), mode="ray-trace").rgb
    np.testing.assert_allclose(image[16, 16], (0.0, 0.0, 1.0), atol=1e-5)


def test_texture_is_upright(renderer):
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[0, 0] = (255, 0, 0)
    pixels[1, 1] = (0, 0, 255)
    wall = Geometry.from_arrays(
        np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32),
        [(0, 1, 2), (0, 2, 3)],
        uvs=[(0, 1), (1, 1), (1, 0), (0, 0)],
        material=Material(1.0, texture=Texture(pixels, wrap="clamp", name="corners")),
    )
    front = Camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), height=2.0)
    image = renderer.render(Scene(wall, [Light.directional((0.0, 0.0, -1.0))], front, ambient=0.0), size=(32, 32), mode="ray-trace").rgb
    np.testing.assert_allclose(image[3, 3], (1, 0, 0), atol=1e-4)
    np.testing.assert_allclose(image[28, 28], (0, 0, 1), atol=1e-4)
    np.testing.assert_allclose(image[3, 28], 0, atol=1e-4)


def test_light_in_candela(renderer):
    """A white surface that faces a light of I candela at distance d shows I / (π d²)."""
    for light in (
        Light.point((0.0, 2.0, 0.0), intensity=8.0, falloff="inverse-square"),
        Light.spot((0.0, 2.0, 0.0), (0.0, -1.0, 0.0), outer=30.0, intensity=8.0, falloff="inverse-square"),
    ):
        above = Camera((0.0, 4.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), height=0.1)
        white = Geometry.from_arrays(floor_corners(), [(0, 1, 2), (0, 2, 3)], material=Material(1.0))
        image = renderer.render(Scene(white, [light], above, ambient=0.0), size=(9, 9), mode="ray-trace").rgb
        np.testing.assert_allclose(image[4, 4], 8.0 / (np.pi * 4.0), rtol=1e-4)


def floor_corners() -> np.ndarray:
    return np.array([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)], np.float32)


def test_no_lights_are_meant_or_missing(renderer):
    """A list, even an empty one, is what there is; `None` is for the renderer to choose."""
    above = Camera((0.0, 4.0, 0.01), (0.0, 0.0, 0.0))
    dark, chosen = Scene(floor(), [], above, ambient=0.0), Scene(floor(), None, above, ambient=0.0)
    assert renderer.render(dark, size=SIZE).rgb.max() == 0.0
    assert renderer.render(chosen, size=SIZE).rgb.max() > 0.1
    chosen.lights = []
    assert renderer.render(chosen, size=SIZE).rgb.max() == 0.0


def test_emission_texture(renderer):
    """It multiplies the emission."""
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[:, 1] = 255
    glowing = Material(0.0, emission=(0.5, 1.0, 2.0), emission_texture=Texture(pixels, wrap="clamp"))
    uvs = [(0, 0), (0, 1), (1, 1), (1, 0)]
    square = Geometry.from_arrays(floor_corners(), [(0, 1, 2), (0, 2, 3)], uvs=uvs, material=glowing)
    above = Camera((0.0, 4.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), height=2.0)
    image = renderer.render(Scene(square, [], above, ambient=0.0), size=(32, 32), mode="ray-trace").rgb
    np.testing.assert_allclose(image[16, 2], 0.0, atol=1e-5)
    np.testing.assert_allclose(image[16, 29], (0.5, 1.0, 2.0), rtol=1e-4)


def panel() -> Geometry:
    """A small square that shines, above the floor."""
    corners = np.array([(-0.3, 2, -0.3), (0.3, 2, -0.3), (0.3, 2, 0.3), (-0.3, 2, 0.3)], np.float32)
    return Geometry.from_arrays(corners, [(0, 1, 2), (0, 2, 3)], material=Material.principled(0.0, emission=20.0), name="panel")


def test_small_surfaces_that_shine_are_lamps(renderer):
    """They are sampled as lights, which stay when others are set, and are not gathered a second time."""
    view = Camera((0.0, 1.5, 6.0), (0.0, 0.5, 0.0))
    scene = Scene([floor(), panel()], [], view)
    assert scene.lights == []
    settings = {"size": (40, 30), "ambient_light": "mesh", "layers": True}
    lamp = renderer.render(scene, **settings)
    assert len(lamp.visibility) == 1
    # The reference casts thousands of rays from each point, at surfaces that lamps do not stand for. Few hit the panel: the mean of several seeds.
    plain = Scene([floor(), panel()], [], view, lamps=False)
    expected = np.mean([renderer.render(plain, size=(40, 30), ambient_light="rays", seed=seed).rgb for seed in range(4)], axis=0)
    np.testing.assert_allclose(lamp.rgb[-5:].mean(), expected[-5:].mean(), rtol=0.05)
    scene.lights = [Light.point((0.0, 3.0, 0.0), intensity=0.0)]
    scene.environment = Environment(np.zeros((8, 16, 3), np.float32))
    assert len(scene.lights) == 1
    both = renderer.render(scene, **settings)
    assert len(both.visibility) == 2
    np.testing.assert_allclose(both.rgb[-5:].mean(), lamp.rgb[-5:].mean(), rtol=0.01)


def test_surfaces_shine_beside_one_sided_lights(renderer):
    """Without lamps, what they emit is gathered, whatever lights there are."""
    lights = [Light.rectangle((0.0, 9.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1), one_sided=True, intensity=0.0)]
    scene = Scene([floor(), panel()], lights, Camera((0.0, 1.5, 6.0), (0.0, 0.5, 0.0)), lamps=False)
    assert renderer.render(scene, size=(40, 30), ambient_light="mesh").rgb[-5:].mean() > 1e-3


def test_lights_read_back():
    lights = [
        Light.point((1.0, 2.0, 3.0), name="lamp"),
        Light.directional((0.0, -1.0, 0.0), angle=0.53, intensity=(1.0, 0.5, 0.25)),
        Light.spot((0.0, 3.0, 0.0), (0.0, -1.0, 0.0), inner=10.0, outer=20.0, radius=0.1),
        Light.sphere((0.0, 5.0, 0.0), 0.5, falloff="inverse-square"),
        Light.disk((0.0, 5.0, 0.0), (0.0, -1.0, 0.0), 1.0, one_sided=True),
        Light.rectangle((0.0, 5.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ]
    scene = Scene(floor(), lights, camera())
    assert [light.kind for light in scene.lights] == [light.kind for light in lights]
    assert scene.lights[0].name == "lamp" and scene.lights[0].position == pytest.approx((1, 2, 3))
    assert scene.lights[1].direction == pytest.approx((0, -1, 0)) and scene.lights[3].direction is None
    assert scene.lights[1].position is None and scene.lights[1].intensity == pytest.approx((1.0, 0.5, 0.25))
    assert scene.lights[3].falloff == "inverse-square"
    assert lights[0].replaced(position=(4.0, 5.0, 6.0)).position == pytest.approx((4, 5, 6))


def test_far_from_the_origin(renderer, scene):
    """Double precision arrives: a scene far away looks the same."""
    offset = np.array((4.0e6, 0.0, -7.0e6))
    moved = Scene(
        [
            Geometry.from_arrays(np.asarray(floor_corners(), np.float64) * 3.0 + offset, [(0, 1, 2), (0, 2, 3)], material=Material(0.7)),
            cube().placed(at(*(offset + (0.0, 1.0, 0.0)))),
        ],
        [Light.sphere(offset + (2.0, 4.0, 1.0), 0.5)],
        Camera(offset + (4.0, 3.0, 5.0), offset + (0.0, 0.7, 0.0)),
    )
    near = renderer.render(scene, size=SIZE, mode="area", samples=64).rgb
    far = renderer.render(moved, size=SIZE, mode="area", samples=64).rgb
    assert np.abs(near - far).mean() < 0.01


def test_surroundings(renderer, scene):
    pixels = np.full((8, 16, 3), 0.5, np.float32)
    scene.environment = Environment(pixels, find_sun=False)
    assert scene.environment.size == (16, 8)
    scene.lights = []
    image = renderer.render(scene, size=SIZE, quality="draft").rgb
    # What is behind the scene is seen, and white under an even sky shows the sky.
    np.testing.assert_allclose(image[2, 2], 0.5, rtol=1e-3)
    assert 0.2 < image[-4, SIZE[0] // 2].mean() <= 0.36
    scene.environment = None
    scene.background = (0.0, 0.25, 0.0)
    assert renderer.render(scene, size=SIZE).rgb[2, 2] == pytest.approx((0.0, 0.25, 0.0))


def test_moments_of_an_animation(model):
    truck = Scene.open(model("milk_truck/CesiumMilkTruck.glb"))
    assert truck.duration == pytest.approx(1.25)
    assert truck.at(0.5).triangle_count == truck.triangle_count


def test_frames_follow_an_animation(model, renderer):
    truck = Scene.open(model("milk_truck/CesiumMilkTruck.glb"))
    truck.lights = [Light.directional((-1.0, -2.0, -1.0), angle=1.0)]
    truck.camera = Camera((5.0, 3.0, 5.0), (0.0, 1.0, 0.0))
    before = renderer.prepare(truck.at(0.0))
    after = renderer.prepare(truck.at(0.3), before=before)
    kept = renderer.render(after, size=SIZE).rgb
    fresh = lightmesh.Renderer("cpu").render(truck.at(0.3), size=SIZE).rgb
    np.testing.assert_array_equal(kept, fresh)
    assert (kept != renderer.render(before, size=SIZE).rgb).any()


def test_other_geometry_keeps_lights_and_cameras(scene):
    other = scene.with_geometry(floor(2.0))
    assert other.triangle_count == 2 and len(other.lights) == 1
    assert other.camera.position == pytest.approx(scene.camera.position)


def test_info_is_that_of_the_command_line(scene):
    assert scene.info()["triangles"] == 14
