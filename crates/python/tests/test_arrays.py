"""What arrays mean as they go in, and the arrays and copies that come out of scenes."""

import copy
import gc
import pickle

import numpy as np
import pytest
from conftest import CUBE, CUBE_TRIANGLES, SIZE, at, camera, cube, floor

import lightmesh
from lightmesh import Camera, Environment, Geometry, Light, Material, Scene, Texture

SQUARE = np.array([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)], np.float32)
SQUARE_TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def shown(renderer, colors=None, **material) -> np.ndarray:
    """What the middle of a square shows that a light of strength 1 faces."""
    square = Geometry.from_arrays(SQUARE, SQUARE_TRIANGLES, colors=colors, material=Material(**({"color": 1.0} | material)))
    above = Camera((0.0, 4.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), height=1.0)
    scene = Scene(square, [Light.directional((0.0, -1.0, 0.0))], above, ambient=0.0)
    return renderer.render(scene, size=(8, 8), mode="ray-trace").rgb[4, 4]


@pytest.mark.parametrize("kind", [np.uint8, np.float32, np.float64])
def test_codes_of_vertices_are_shares(renderer, kind):
    colors = np.tile(np.array((102, 51, 255), np.uint8), (4, 1))
    if kind != np.uint8:
        colors = (colors / 255).astype(kind)
    np.testing.assert_allclose(shown(renderer, colors), (0.4, 0.2, 1.0), atol=1e-5)


def test_codes_of_materials_and_lights_are_shares(renderer, scene):
    code = np.array((102, 51, 255), np.uint8)
    np.testing.assert_allclose(shown(renderer, color=code), (0.4, 0.2, 1.0), atol=1e-5)
    np.testing.assert_allclose(shown(renderer, color=code[0]), 0.4, atol=1e-5)
    np.testing.assert_allclose(shown(renderer, color=0.0, emission=code), (0.4, 0.2, 1.0), atol=1e-5)
    assert Light.point((0, 0, 0), intensity=code).intensity == pytest.approx((0.4, 0.2, 1.0))
    assert Light.point((0, 0, 0)).replaced(intensity=code).intensity == pytest.approx((0.4, 0.2, 1.0))
    scene.ambient, scene.background = code, code
    assert scene.ambient == pytest.approx((0.4, 0.2, 1.0)) and scene.background == pytest.approx((0.4, 0.2, 1.0))
    for name in ("background", "ambient"):
        frame = renderer.render(scene, size=SIZE, quality="draft", **{name: code})
        assert frame.stats["settings"][name] == pytest.approx((0.4, 0.2, 1.0))
    # Whole numbers that say nothing of themselves are numbers.
    assert Light.point((0, 0, 0), intensity=np.array((80, 62, 40))).intensity == (80, 62, 40)


@pytest.mark.parametrize("kind", [np.int64, np.uint16, np.int32])
def test_other_whole_numbers_are_shares_or_refused(renderer, kind):
    np.testing.assert_allclose(shown(renderer, np.tile(np.array((0, 1, 0), kind), (4, 1))), (0, 1, 0), atol=1e-5)
    with pytest.raises(lightmesh.GeometryError, match=r"row 0 of colors has the whole numbers \[102, 51, 255\].*uint8"):
        shown(renderer, np.tile(np.array((102, 51, 255), kind), (4, 1)))
    with pytest.raises(lightmesh.SettingError, match="color: the colour .* reflects more than it receives.*uint8"):
        Material(np.array((102, 51, 255), kind))
    with pytest.raises(lightmesh.SettingError, match="specular_tint: .*reflects more"):
        Material.principled(specular_tint=(204, 102, 51))
    with pytest.raises(lightmesh.GeometryError, match="row 1 of colors is negative"):
        shown(renderer, np.array([(0, 0, 0), (0, -1, 0), (0, 0, 0), (0, 0, 0)], np.float32))


@pytest.mark.parametrize("kind", [np.uint8, np.int64, np.bool_])
def test_surroundings_are_radiance(kind):
    with pytest.raises(lightmesh.SettingError, match="floating point, not"):
        Environment(np.ones((8, 16, 3), kind))


def test_transforms_end_in_0_0_0_1():
    matrix = at(1.0, 2.0, 3.0)
    for transforms, which in ((matrix.T, "transforms"), (np.stack([np.eye(4), matrix.T]), r"transforms\[1\]")):
        message = f"the last row of {which} is 1, 2, 3, 1 and not 0, 0, 0, 1: it looks transposed"
        with pytest.raises(lightmesh.GeometryError, match=message):
            Geometry.from_arrays(CUBE, CUBE_TRIANGLES, transforms=transforms)
        with pytest.raises(lightmesh.GeometryError, match=message):
            cube().placed(transforms)
    with pytest.raises(lightmesh.GeometryError, match="give an affine map for column vectors"):
        cube().placed(np.diag([1.0, 1.0, 1.0, 2.0]))
    # What products and inverses round is no mistake.
    turned = np.eye(4)
    turned[:3, :3] = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    cube().placed(np.linalg.inv(np.linalg.inv(turned @ matrix) @ np.diag([3.0, 0.1, 7.0, 1.0])))


def test_arrays_of_a_scene(scene):
    assert scene.vertices.shape == (12, 3) and scene.vertices.dtype == np.float32
    assert scene.triangles.shape == (14, 3) and scene.triangles.dtype == np.uint32
    corners = np.asarray(scene.origin) + scene.vertices[scene.triangles]
    low, high = scene.bounds
    np.testing.assert_allclose(corners.min(axis=(0, 1)), low, atol=1e-6)
    np.testing.assert_allclose(corners.max(axis=(0, 1)), high, atol=1e-6)
    assert scene.objects == ["floor", "cube"]
    np.testing.assert_array_equal(scene.object_ranges, [(0, 0, 2), (1, 2, 14)])
    assert [scene.materials[index] for index in scene.material_indices[[0, 13]]] == ["stone", "clay"]
    assert scene.normals is None and scene.uvs is None and scene.colors is None


def test_attributes_of_vertices_come_back():
    normals, uvs, colors = np.tile(np.float32((0, 1, 0)), (4, 1)), SQUARE[:, :2], np.full((4, 3), 0.25, np.float32)
    scene = Scene(Geometry.from_arrays(SQUARE, SQUARE_TRIANGLES, normals=normals, uvs=uvs, colors=colors))
    np.testing.assert_array_equal(scene.normals, normals)
    np.testing.assert_array_equal(scene.uvs, uvs)
    np.testing.assert_array_equal(scene.colors, colors)


def test_objects_of_one_name_have_several_ranges():
    scene = Scene([floor(), cube(), floor().placed(at(0, -1, 0))])
    assert scene.objects == ["floor", "cube"]
    np.testing.assert_array_equal(scene.object_ranges, [(0, 0, 2), (1, 2, 14), (0, 14, 16)])
    assert Scene([]).object_ranges.shape == (0, 3) and Scene([]).vertices.shape == (0, 3)


def test_geometry_goes_round(renderer, scene):
    """A scene that is made of the arrays of another one looks the same."""
    again = Geometry.from_arrays(np.asarray(scene.origin) + scene.vertices, scene.triangles, material=Material(0.5))
    plain = [floor().placed(np.eye(4)), cube(Material(0.5))]
    settings = {"size": SIZE, "layers": True}
    depth = [renderer.render(Scene(objects, scene.lights, camera()), **settings).depth for objects in (again, plain)]
    np.testing.assert_allclose(*depth, rtol=1e-5)


def test_arrays_are_views_that_live_as_long_as_they_are_used(scene):
    arrays = [scene.vertices, scene.triangles, scene.material_indices, scene.object_ranges]
    assert scene.vertices.ctypes.data == arrays[0].ctypes.data
    expected = [array.copy() for array in arrays]
    for array in arrays:
        assert not array.flags.writeable and not array.flags.owndata
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True
    scene = None
    gc.collect()
    for array, values in zip(arrays, expected, strict=True):
        np.testing.assert_array_equal(array, values)


@pytest.mark.parametrize("name", ["lights", "cameras", "objects", "materials", "warnings"])
def test_lists_of_a_scene_do_not_lose_what_is_added(scene, name):
    changes = [
        lambda items: items.append(items[0] if items else "x"),
        lambda items: items.extend(items),
        lambda items: items.insert(0, "x"),
        lambda items: items.clear(),
        lambda items: items.pop(),
        lambda items: items.remove("x"),
        lambda items: items.sort(),
        lambda items: items.reverse(),
        lambda items: items.__setitem__(0, "x"),
        lambda items: items.__delitem__(0),
    ]
    for change in changes:
        with pytest.raises(lightmesh.ArgumentError, match="copy"):
            change(getattr(scene, name))
    items = getattr(scene, name)
    assert isinstance(items, list) and items == list(items) and type(items + ["x"]) is list and type(items[:]) is list
    assert len(pickle.loads(pickle.dumps(items))) == len(copy.deepcopy(items)) == len(items)


def test_lights_and_cameras_are_set(scene):
    light = Light.point((0, 3, 0), name="second")
    scene.lights += [light]
    assert [light.kind for light in scene.lights] == ["sphere", "point"]
    scene.lights = [*scene.lights, light]
    scene.lights = scene.lights + [light]
    assert len(scene.lights) == 4
    scene.lights = light
    assert [light.name for light in scene.lights] == ["second"]
    scene.cameras += [camera()]
    assert len(scene.cameras) == 2
    with pytest.raises(lightmesh.ArgumentError, match="scene.lights = "):
        scene.lights.append(light)


@pytest.mark.parametrize("name", ["light", "lights"])
@pytest.mark.parametrize("is_list", [False, True], ids=["one", "list"])
def test_lights_among_settings(renderer, scene, name, is_list):
    light = Light.sphere((-2.0, 4.0, 1.0), 0.5)
    settings = {name: [light] if is_list else light, "size": SIZE, "quality": "draft"}
    other = copy.copy(scene)
    other.lights = [light]
    expected = renderer.render(other, size=SIZE, quality="draft").rgb
    np.testing.assert_array_equal(renderer.render(scene, **settings).rgb, expected)
    np.testing.assert_array_equal(renderer.render(renderer.prepare(scene, **settings)).rgb, expected)
    np.testing.assert_array_equal(renderer.render(renderer.prepare(scene), **settings).rgb, expected)
    (frame,) = renderer.film(scene, turntable=1, **settings)
    (plain,) = renderer.film(other, turntable=1, size=SIZE, quality="draft")
    np.testing.assert_array_equal(frame.rgb, plain.rgb)
    point, up = [(2.0, 0.0, 0.0)], [(0.0, 1.0, 0.0)]
    assert renderer.visibility(point, up, scene, **{name: settings[name]}).shape == (1, 1)
    assert lightmesh.visibility(point, up, scene, device="cpu", **{name: settings[name]}).shape == (1, 1)
    # The scene has its own still.
    assert scene.lights[0].position == pytest.approx((2, 4, 1))


def test_what_cannot_be_a_light(renderer, scene):
    light = Light.point((0, 3, 0))
    with pytest.raises(lightmesh.SettingError, match="light and lights cannot be given together"):
        renderer.render(scene, light=light, lights=light)
    with pytest.raises(lightmesh.SettingError, match="studio cannot be given with lights"):
        renderer.render(scene, lights=light, studio=True)
    for wrong in (5, [light, 5], [light, "0,3,0"]):
        with pytest.raises(lightmesh.ArgumentError, match="a Light"):
            renderer.render(scene, light=wrong)
        with pytest.raises(lightmesh.ArgumentError, match="lights: give a Light or a sequence of them"):
            renderer.render(scene, lights=wrong)
    typed = {"size": SIZE, "quality": "draft"}
    one = renderer.render(scene, light="0,3,0", **typed).rgb
    np.testing.assert_array_equal(renderer.render(scene, light=["0,3,0"], **typed).rgb, one)
    np.testing.assert_array_equal(renderer.render(scene, lights=light, **typed).rgb, one)
    assert renderer.render(scene, lights=[], ambient=0.0, background=0.0, **typed).rgb.max() == 0.0


def everything() -> Scene:
    """A scene with all that scenes can have, but motion."""
    pixels = np.arange(2 * 2 * 4, dtype=np.uint8).reshape(2, 2, 4) * 16
    painted = Material.principled(0.9, texture=Texture(pixels, name="paint"), alpha_mode="mask", alpha_cutoff=0.1, name="painted")
    square = Geometry.from_arrays(
        3.0 * SQUARE, SQUARE_TRIANGLES, uvs=SQUARE[:, [0, 2]], colors=np.full((4, 3), 0.8), material=painted, name="square"
    )
    many = cube().placed(np.stack([at(x, 1.0, 0.0) for x in (-1.5, 1.5)]))
    glass = Geometry.from_arrays(0.3 * CUBE + (0, 0.5, 1), CUBE_TRIANGLES, material=Material.principled(1.0, transmission=1.0, roughness=0.0))
    panel = Geometry.from_arrays(0.2 * SQUARE + (0, 3, 0), SQUARE_TRIANGLES, material=Material.principled(0.0, emission=20.0))
    sky = Environment(np.random.default_rng(1).random((8, 16, 3), np.float32), rotation=30.0)
    lights = [Light.spot((0, 3, 2), (0, -1, -0.5), outer=60.0, name="spot"), Light.directional((-1, -2, -1), angle=1.0, intensity=0.5)]
    return Scene(
        [square, many, glass, panel], lights, camera(), environment=sky, background=(0.1, 0.2, 0.3), instances="always", name="everything"
    )


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene))], ids=["copy", "deepcopy", "pickle"])
def test_copies_of_scenes(renderer, copied):
    scene = everything()
    twin = copied(scene)
    assert twin is not scene and repr(twin) == repr(scene) and twin.info() == scene.info()
    settings = {"size": SIZE, "quality": "draft", "samples": 8}
    here = renderer.render(scene, **settings).rgb
    np.testing.assert_array_equal(lightmesh.Renderer("cpu").render(twin, **settings).rgb, here)
    # Lights and cameras are the copy's own.
    twin.lights, twin.camera = [], None
    assert len(scene.lights) > 0 and scene.camera is not None


def test_scenes_of_files_are_pickled(tmp_path, renderer):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = Scene.open(path)
    twin = pickle.loads(pickle.dumps(scene))
    path.unlink()
    np.testing.assert_array_equal(renderer.render(twin, size=(8, 6)).rgb, renderer.render(scene, size=(8, 6)).rgb)


def test_a_scene_that_moves_is_not_pickled(model):
    truck = Scene.open(model("milk_truck/CesiumMilkTruck.glb"))
    with pytest.raises(lightmesh.LightmeshError, match="moves cannot be pickled: give its file"):
        pickle.dumps(truck)
    assert copy.deepcopy(truck).duration == truck.duration


def test_copies_of_parts():
    texture = Texture(np.zeros((2, 3, 3), np.uint8), name="t")
    parts = [
        *all_lights(),
        Camera((1, 2, 3), (0, 0, 0), hfov=40.0, shift=(0.1, 0.2), name="c", near=0.5, far=8.0),
        Camera((1, 2, 3), direction=(0, 0, 1), height=2.0),
        texture,
        Material((0.1, 0.2, 0.3), texture=texture, name="m"),
        cube(),
        Environment(np.ones((8, 16, 3), np.float32), name="e"),
    ]
    for part in parts:
        twin = pickle.loads(pickle.dumps(part))
        assert type(twin) is type(part) and repr(twin) == repr(part)
        # They never change, so that a copy can be the same.
        assert copy.copy(part) is part and copy.deepcopy(part) is part
    public = [name for name in dir(Light) if not name.startswith("_") and not callable(getattr(Light, name))]
    for light in all_lights():
        twin = pickle.loads(pickle.dumps(light))
        assert [getattr(twin, name) for name in public] == [getattr(light, name) for name in public]


def all_lights() -> list[Light]:
    return [
        Light.point((1.0, 2.0, 3.0), spread=0.1, name="lamp"),
        Light.directional((0.0, -1.0, 0.0), angle=0.53, intensity=(1.0, 0.5, 0.25)),
        Light.spot((0.0, 3.0, 0.0), (0.0, -1.0, 0.0), inner=10.0, outer=20.0, radius=0.1),
        Light.sphere((0.0, 5.0, 0.0), 0.5, falloff="inverse-square"),
        Light.disk((0.0, 5.0, 0.0), (0.0, -1.0, 0.0), 1.0, one_sided=False),
        Light.rectangle((0.0, 5.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ]


def test_pickles_of_another_version_are_refused():
    restore, (kind, version, data) = Light.point((0, 0, 0)).__reduce__()
    assert version == lightmesh.__version__
    with pytest.raises(lightmesh.SettingError, match="pickled by version 0.0.0 of lightmesh"):
        restore(kind, "0.0.0", data)
    with pytest.raises(lightmesh.SettingError, match="no pickled Light"):
        restore(kind, version, b"nonsense")
