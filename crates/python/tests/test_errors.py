"""What goes wrong has a class, and says what to do."""

import pickle

import numpy as np
import pytest
from conftest import CUBE, CUBE_TRIANGLES, SIZE, camera, floor

import lightmesh
from lightmesh import Camera, Geometry, Light, Material, Renderer, Scene


def test_classes():
    for name in ("SettingError", "SceneError", "GeometryError", "DeviceError", "HostMemoryError", "MeshFileError", "SaveError", "Cancelled"):
        assert issubclass(getattr(lightmesh, name), lightmesh.LightmeshError)
    assert issubclass(lightmesh.DeviceMemoryError, lightmesh.DeviceError) and issubclass(lightmesh.DeviceMemoryError, MemoryError)
    assert issubclass(lightmesh.SettingError, ValueError)
    error = pickle.loads(pickle.dumps(lightmesh.SceneError("text")))
    assert isinstance(error, lightmesh.SceneError) and str(error) == "text"


@pytest.mark.parametrize(
    ("settings", "error", "text"),
    [
        ({"sizee": (2, 2)}, TypeError, "unexpected keyword argument 'sizee'. Did you mean 'size'?"),
        ({"size": (0, 5)}, lightmesh.SettingError, "size cannot be [0, 5]: write WIDTHxHEIGHT"),
        ({"quality": "best"}, lightmesh.SettingError, "quality cannot be `best`: choose draft, good or final"),
        ({"samples": -1}, lightmesh.SettingError, "-1 is not in"),
        ({"samples": 1.5}, lightmesh.SettingError, "1.5"),
        ({"size": object()}, TypeError, "size cannot be of type object"),
        ({"mode": True}, lightmesh.LightmeshError, "mode"),
        ({"camera_name": "nobody"}, lightmesh.SettingError, "nobody"),
        ({"memory_limit": "1KB"}, lightmesh.HostMemoryError, "memory"),
        ({"step": 1e-9}, lightmesh.LightmeshError, "step"),
        ({"environment": "missing.hdr"}, lightmesh.LightmeshError, "missing.hdr"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else None,
)
def test_settings(renderer, scene, settings, error, text):
    with pytest.raises(error) as raised:
        renderer.render(scene, **({"size": SIZE} | settings))
    assert text in str(raised.value)


def test_none_is_not_given(renderer, scene):
    plain = renderer.render(scene, size=SIZE).rgb
    np.testing.assert_array_equal(renderer.render(scene, size=SIZE, samples=None, quality=None, camera=None).rgb, plain)


@pytest.mark.parametrize(
    ("arrays", "text"),
    [
        ({"triangles": [(0, 1, 9)]}, "vertex index 9"),
        ({"triangles": [(0, 1, -1)]}, "-1"),
        ({"triangles": [(0.5, 1, 2)]}, "whole numbers"),
        ({"triangles": [0, 1, 2]}, "(N, 3)"),
        ({"vertices": CUBE[:, :2]}, "(8, 2)"),
        ({"vertices": [("a", "b", "c")]}, "vertices"),
        ({"vertices": np.full((8, 3), np.nan, np.float32)}, "row 0 of vertices is not finite"),
        ({"normals": np.full((8, 3), np.inf)}, "row 0 of normals is not finite"),
        ({"normals": CUBE[:4]}, "normals"),
        ({"uvs": [(0, 0)]}, "1 uvs for 8 vertices"),
        ({"transforms": np.eye(3)}, "(4, 4)"),
        ({"material_indices": [0] * 12, "materials": []}, "material"),
        ({"material_indices": [5] * 12, "materials": [Material()]}, "5"),
        ({"material_indices": [0] * 3, "materials": [Material()]}, "3"),
    ],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_arrays(arrays, text):
    arrays = {"vertices": CUBE, "triangles": CUBE_TRIANGLES} | arrays
    with pytest.raises(lightmesh.GeometryError) as raised:
        Scene(Geometry.from_arrays(arrays.pop("vertices"), arrays.pop("triangles"), **arrays))
    assert text in str(raised.value)


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: Light.sphere((0, 0, 0), -1.0), lightmesh.SettingError),
        (lambda: Light.point("abc"), TypeError),
        (lambda: Light.point((0, 0)), ValueError),
        (lambda: Light.point((0, 0, np.inf)), ValueError),
        (lambda: Light.spot((0, 0, 0), (0, 0, 0)), lightmesh.SettingError),
        (lambda: Light.rectangle((0, 0, 0), (1, 0, 0), (1, 1, 0)), lightmesh.SettingError),
        (lambda: Light.point((0, 0, 0), falloff="linear"), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0), (0, 0, 0)), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0)), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0), (1, 0, 0), vfov=200.0), lightmesh.SettingError),
        (lambda: Material("red"), TypeError),
        (lambda: Material(-0.5), ValueError),
        (lambda: Renderer("gpu"), lightmesh.SettingError),
        (lambda: Renderer("cuda:99"), lightmesh.DeviceError),
        (lambda: Scene.open("missing.obj"), lightmesh.SceneError),
        (lambda: Scene.builtin("missing"), lightmesh.SceneError),
        (lambda: Scene(5), TypeError),
        (lambda: Scene([floor(), "cube"]), TypeError),
    ],
)
def test_arguments(make, error):
    with pytest.raises(error):
        make()


def test_what_is_asked_for_is_named(renderer):
    with pytest.raises(TypeError, match="Scene or a PreparedScene, not int"):
        renderer.render(5)
    with pytest.raises(TypeError, match="Geometry or a sequence of them, not int"):
        Scene(5, [], camera())
