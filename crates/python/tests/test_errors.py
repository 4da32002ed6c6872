"""What goes wrong has a class, and says what to do."""

import inspect
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from conftest import CUBE, CUBE_TRIANGLES, SIZE, camera, cube, floor

import lightmesh
from lightmesh import Camera, Environment, Geometry, Light, Material, MeshCache, Renderer, Scene, Texture


def test_classes():
    for name in ("SettingError", "ArgumentError", "LayersError", "SceneError", "GeometryError", "DeviceError", "HostMemoryError", "MeshFileError", "SaveError", "Cancelled"):
        assert issubclass(getattr(lightmesh, name), lightmesh.LightmeshError)
    assert issubclass(lightmesh.DeviceMemoryError, lightmesh.DeviceError) and issubclass(lightmesh.DeviceMemoryError, MemoryError)
    assert issubclass(lightmesh.SettingError, ValueError) and issubclass(lightmesh.ArgumentError, TypeError)
    assert issubclass(lightmesh.LayersError, AttributeError)
    error = pickle.loads(pickle.dumps(lightmesh.SceneError("text")))
    assert isinstance(error, lightmesh.SceneError) and str(error) == "text"


@pytest.mark.parametrize(
    ("settings", "error", "text"),
    [
        ({"sizee": (2, 2)}, lightmesh.ArgumentError, "unexpected keyword argument 'sizee'. Did you mean 'size'?"),
        ({"size": (0, 5)}, lightmesh.SettingError, "size cannot be [0, 5]: write WIDTHxHEIGHT"),
        ({"quality": "best"}, lightmesh.SettingError, "quality cannot be `best`: choose draft, good or final"),
        ({"samples": -1}, lightmesh.SettingError, "-1 is not in"),
        ({"samples": 1.5}, lightmesh.SettingError, "1.5"),
        ({"size": object()}, lightmesh.ArgumentError, "size cannot be of type object"),
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
        (lambda: Light.point("abc"), lightmesh.ArgumentError),
        (lambda: Light.point((0, 0)), lightmesh.SettingError),
        (lambda: Light.point((0, 0, np.inf)), lightmesh.SettingError),
        (lambda: Light.spot((0, 0, 0), (0, 0, 0)), lightmesh.SettingError),
        (lambda: Light.rectangle((0, 0, 0), (1, 0, 0), (1, 1, 0)), lightmesh.SettingError),
        (lambda: Light.point((0, 0, 0), falloff="linear"), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0), (0, 0, 0)), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0)), lightmesh.SettingError),
        (lambda: Camera((0, 0, 0), (1, 0, 0), vfov=200.0), lightmesh.SettingError),
        (lambda: Material("red"), lightmesh.ArgumentError),
        (lambda: Material(-0.5), lightmesh.SettingError),
        (lambda: Renderer("gpu"), lightmesh.SettingError),
        (lambda: Renderer("cuda:99"), lightmesh.DeviceError),
        (lambda: Scene.open("missing.obj"), lightmesh.SceneError),
        (lambda: Scene.builtin("missing"), lightmesh.SceneError),
        (lambda: Scene(5), lightmesh.ArgumentError),
        (lambda: Scene([floor(), "cube"]), lightmesh.ArgumentError),
    ],
)
def test_arguments(make, error):
    with pytest.raises(error):
        make()


def test_what_is_asked_for_is_named(renderer):
    with pytest.raises(lightmesh.ArgumentError, match="Scene or a PreparedScene, not int"):
        renderer.render(5)
    with pytest.raises(lightmesh.ArgumentError, match="Geometry or a sequence of them, not int"):
        Scene(5, [], camera())


#: Calls of everything that takes arguments, with valid ones for those that have no default.
CALLS = {
    "Texture": (Texture, {"pixels": np.zeros((2, 2, 3), np.uint8)}),
    "Texture.placed": (Texture(np.zeros((2, 2, 3), np.uint8)).placed, {}),
    "Material": (Material, {}),
    "Material.principled": (Material.principled, {}),
    "Geometry.from_arrays": (Geometry.from_arrays, {"vertices": CUBE, "triangles": CUBE_TRIANGLES}),
    "Geometry.placed": (cube().placed, {"transforms": np.eye(4)}),
    "Light.point": (Light.point, {"position": (0, 0, 0)}),
    "Light.directional": (Light.directional, {"direction": (0, -1, 0)}),
    "Light.spot": (Light.spot, {"position": (0, 0, 0), "direction": (0, -1, 0)}),
    "Light.sphere": (Light.sphere, {"position": (0, 0, 0), "radius": 1.0}),
    "Light.disk": (Light.disk, {"position": (0, 0, 0), "normal": (0, -1, 0), "radius": 1.0}),
    "Light.rectangle": (Light.rectangle, {"position": (0, 0, 0), "half_u": (1, 0, 0), "half_v": (0, 1, 0)}),
    "Light.replaced": (Light.point((0, 0, 0)).replaced, {}),
    "Camera": (Camera, {"position": (0, 0, 0), "target": (0, 0, 1)}),
    "Environment": (Environment, {"pixels": np.ones((8, 16, 3), np.float32)}),
    "Environment.open": (Environment.open, {"path": "missing.hdr"}),
    "Scene": (Scene, {"geometry": floor()}),
    "Scene.open": (Scene.open, {"path": "missing.obj"}),
    "Scene.builtin": (Scene.builtin, {"name": "gazebo"}),
    "Scene.at": (Scene(floor()).at, {"time": 0.0}),
    "Scene.with_geometry": (Scene(floor()).with_geometry, {"geometry": cube()}),
    "Renderer": (Renderer, {"device": "cpu"}),
    "devices": (lightmesh.devices, {}),
}
#: The same of what needs a renderer.
WORK = ("prepare", "render", "film", "sun_hours", "visibility", "with_lights", "with_camera", "save", "save_layers", "load", "cache.save", "sun.save")


def work(renderer, scene, name):
    """A call of something that works, and its valid arguments."""
    small = {"size": (8, 6), "quality": "draft"}
    if name in ("prepare", "render"):
        return getattr(renderer, name), {"scene": scene, **small}
    if name == "film":
        return renderer.film, {"scene": scene, "turntable": 1, **small}
    if name == "sun_hours":
        return renderer.sun_hours, {"scene": "builtin:gazebo", "sun": "54.98,82.9,2026-06-21+07:00,09:00-15:00/3h", **small}
    if name == "visibility":
        return renderer.visibility, {"points": [(0, 0, 0)], "normals": [(0, 1, 0)], "scene": scene}
    prepared = renderer.prepare(scene)
    if name == "with_lights":
        return prepared.with_lights, {"lights": scene.lights}
    if name == "with_camera":
        return prepared.with_camera, {"camera": scene.camera}
    if name == "load":
        return MeshCache.load, {"path": "missing", "prepared": prepared}
    if name == "cache.save":
        return MeshCache().save, {"path": "missing/a", "prepared": prepared}
    if name == "sun.save":
        call, arguments = work(renderer, scene, "sun_hours")
        return call(**arguments).save, {"path": "missing/a.csv"}
    return getattr(renderer.render(scene, layers=True, **small), name), {"path": "missing/a.exr"}


def refused(call, arguments, name, value) -> None:
    """An argument of another type is an exception of the package that names it."""
    with pytest.raises(lightmesh.LightmeshError) as raised:
        call(**{**arguments, name: value})
    assert isinstance(raised.value, TypeError | ValueError) and name in str(raised.value), f"{name}={value!r}: {raised.value!r}"


def every_argument(call, arguments) -> None:
    class Other:
        pass

    for parameter in inspect.signature(call).parameters.values():
        # Progress may be anything that can be called.
        if parameter.kind is not parameter.VAR_KEYWORD and parameter.name != "progress":
            refused(call, arguments, parameter.name, Other())


@pytest.mark.parametrize("name", CALLS)
def test_every_argument_of_another_type(name):
    every_argument(*CALLS[name])


@pytest.mark.parametrize("name", WORK)
def test_every_argument_of_work(renderer, scene, name):
    every_argument(*work(renderer, scene, name))


@pytest.mark.parametrize("name", ["light", "lights", "camera", "cameras", "ambient", "background", "environment"])
def test_attributes_of_another_type(scene, name):
    with pytest.raises(lightmesh.LightmeshError):
        setattr(scene, name, object()) if hasattr(scene, name) else scene.__class__(floor(), object())


#: Arguments that are one number.
NUMBERS = [
    (name, parameter.name)
    for name, (call, _) in CALLS.items()
    for parameter in inspect.signature(call).parameters.values()
    if isinstance(parameter.default, float)
]
NUMBERS += [("Scene.at", "time"), ("Light.sphere", "radius"), ("Light.disk", "radius"), ("Camera", "vfov"), ("Camera", "hfov"), ("Camera", "height")]


@pytest.mark.parametrize(("name", "argument"), NUMBERS)
@pytest.mark.parametrize("number", [float("nan"), float("inf"), -float("inf"), 10**400, 1e300], ids=str)
def test_numbers_are_finite(name, argument, number):
    call, arguments = CALLS[name]
    if argument == "time" and number == 1e300:
        pytest.skip("seconds are in double precision")
    refused(call, arguments, argument, number)


@pytest.mark.parametrize(
    "setting",
    ["step", "radius", "exposure", "fps", "smooth", "ambient", "background", "aa", "samples", "seed", "bounces", "turntable", "memory_limit"],
)
@pytest.mark.parametrize("number", [float("nan"), float("inf"), -float("inf")], ids=str)
def test_settings_are_finite(renderer, scene, setting, number):
    with pytest.raises(lightmesh.SettingError, match=setting):
        renderer.film("builtin:gazebo", **({"turntable": 1, "size": (8, 6)} | {setting: number}))


@pytest.mark.parametrize("argument", ["position", "target", "direction", "up", "shift"])
def test_vectors_are_finite(argument):
    arguments = {"position": (0, 0, 0), "target": (0, 0, 1)}
    if argument == "direction":
        arguments.pop("target")
    value = (0.0, np.nan, 1.0)[: 2 if argument == "shift" else 3]
    refused(Camera, arguments, argument, value)


@pytest.mark.parametrize("clip", [{"near": -1.0}, {"near": 2.0, "far": 2.0}, {"far": 0.0}, {"far": -3.0}], ids=str)
def test_clip_planes_have_space_between_them(clip):
    with pytest.raises(lightmesh.LightmeshError, match="between the depths"):
        Camera((0, 0, 0), (0, 0, 1), **clip)


@pytest.mark.parametrize("crop", [(-70_000, 0, 8, 6), (0, 0, 70_000, 6), (0, 0, 0, 6), (0, 0, 8, -6), (1, 2, 3)], ids=str)
def test_crops_are_near_the_image(renderer, scene, crop):
    with pytest.raises(lightmesh.LightmeshError, match="crop"):
        renderer.render(scene, size=(8, 6), crop=crop)


def test_a_note_is_a_note():
    error = lightmesh.SettingError("text")
    error.add_note("while processing 'size'")
    assert str(error) == "size: text"
    error.add_note("more")
    assert str(error) == "size: text" and getattr(error, "__notes__", ["more"]) == ["more"]


def test_frames_without_layers(renderer, scene):
    with pytest.raises(lightmesh.LayersError):
        _ = renderer.render(scene, size=(8, 6)).depth


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="the system does not say what is resident")
@pytest.mark.parametrize("extension", ["obj", "ply", "stl", "gltf", "toml"])
def test_files_beyond_memory_are_refused_before_they_are_read(tmp_path, extension):
    """More than the machine has, in a file with a hole in place of its content."""
    path = tmp_path / f"huge.{extension}"
    with open(path, "wb") as file:
        file.truncate(1 << 43)
    with pytest.raises(lightmesh.HostMemoryError, match=r"8\.0 TiB are needed.*huge"):
        Scene.open(path)


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="the system does not say what is resident")
@pytest.mark.parametrize("extension", ["obj", "ply", "stl"])
def test_content_needs_room_beside_its_file(tmp_path, extension):
    """The file would fit, and what it becomes while it is read would not. In a process of its own, which holds nothing else."""
    path = tmp_path / f"a.{extension}"
    with open(path, "wb") as file:
        file.truncate(200 << 20)
    script = "import lightmesh, sys\nlightmesh.Scene.open(sys.argv[1], memory_limit='400M')\n"
    result = subprocess.run([sys.executable, "-c", script, str(path)], capture_output=True, text=True, timeout=300)
    assert "HostMemoryError: there is not enough memory for the content of the file beside the file itself" in result.stderr
