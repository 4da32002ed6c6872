"""What is kept from image to image: structures, and light points."""

import numpy as np
import pytest
from conftest import SIZE, camera, floor

import lightmesh
from lightmesh import Camera, Light, MeshCache, Renderer, Scene

#: Settings with light points that are kept; the step must not follow the camera.
KEPT = {"size": SIZE, "lookup": "half-ball", "step": 0.4}


def test_prepared_scene(renderer, scene):
    prepared = renderer.prepare(scene)
    assert prepared.memory > 0 and prepared.scene.name == "cube"
    np.testing.assert_array_equal(renderer.render(prepared, size=SIZE).rgb, renderer.render(scene, size=SIZE).rgb)
    assert repr(prepared) == '<lightmesh.PreparedScene of "cube">'


def test_lights_and_cameras_move_without_a_rebuild(renderer, scene):
    prepared = renderer.prepare(scene)
    lights = [Light.sphere((-2.0, 4.0, 1.0), 0.5), Light.point((0.0, 3.0, 3.0))]
    view = Camera((-4.0, 3.0, 5.0), (0.0, 0.7, 0.0))
    moved = renderer.render(prepared.with_lights(lights).with_camera(view), size=SIZE)
    scene.lights, scene.camera = lights, view
    np.testing.assert_array_equal(moved.rgb, Renderer("cpu").render(scene, size=SIZE).rgb)


def building(frame: lightmesh.Frame) -> float:
    """Seconds that its structure took."""
    return frame.stats["seconds"]["build"]


def test_renderer_keeps_the_last_structure():
    renderer, scene = Renderer("cpu"), Scene.builtin("childpark")
    first = building(renderer.render(scene, size=SIZE, mode="ray-trace"))
    scene.lights = scene.lights[:1]
    # A structure of 27 000 triangles against a look at what is there.
    assert building(renderer.render(scene, size=SIZE, mode="ray-trace")) < 0.1 * first


def test_settings_of_preparing_hold_for_images(renderer, scene):
    prepared = renderer.prepare(scene, size=SIZE, samples=4)
    assert renderer.render(prepared).size == SIZE
    assert renderer.render(prepared, size=(32, 24)).stats["settings"]["samples"] == 4


def test_a_ground_is_built_once():
    renderer, scene = Renderer("cpu"), Scene.builtin("childpark")
    first = renderer.render(scene, size=SIZE, ground=True, mode="ray-trace")
    again = renderer.render(scene, size=SIZE, ground=True, mode="ray-trace")
    assert building(again) < 0.1 * building(first)
    np.testing.assert_array_equal(first.rgb, again.rgb)
    assert (renderer.render(scene, size=SIZE, mode="ray-trace").rgb != first.rgb).any()


def test_images_are_the_same_with_a_cache(renderer, scene):
    cache = MeshCache()
    assert len(cache) == 0 and cache and cache.memory >= 0
    prepared = renderer.prepare(scene)
    for step in range(3):
        view = Camera((4.0 - 0.2 * step, 3.0, 5.0), (0.0, 0.7, 0.0))
        kept = renderer.render(prepared, cache=cache, camera=view, **KEPT)
        fresh = renderer.render(prepared, camera=view, **KEPT)
        np.testing.assert_array_equal(kept.rgb, fresh.rgb)
    assert len(cache) > 0 and cache.memory > 0
    cache.clear()
    assert len(cache) == 0


def test_cache_files(renderer, scene, tmp_path):
    cache, prepared = MeshCache(), renderer.prepare(scene)
    renderer.render(prepared, cache=cache, **KEPT)
    path = tmp_path / "mesh"
    assert cache.save(path, prepared) > 0
    loaded = MeshCache.load(path, prepared)
    assert len(loaded) == len(cache)
    np.testing.assert_array_equal(renderer.render(prepared, cache=loaded, **KEPT).rgb, renderer.render(scene, **KEPT).rgb)
    other = renderer.prepare(Scene(floor(), scene.lights, camera()))
    with pytest.raises(lightmesh.MeshFileError):
        MeshCache.load(path, other)
    path.write_bytes(b"nothing of the kind")
    with pytest.raises(lightmesh.MeshFileError, match="mesh"):
        MeshCache.load(path, prepared)


def test_nothing_to_save(renderer, scene, tmp_path):
    assert MeshCache().save(tmp_path / "mesh", renderer.prepare(scene)) == 0
    assert list(tmp_path.iterdir()) == []
