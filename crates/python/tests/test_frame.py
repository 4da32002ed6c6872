"""Frames: their arrays are views, of the right shapes; files and notebooks."""

import gc
import io
import sys
import tempfile
import warnings

import numpy as np
import pytest
from conftest import SIZE, camera

import lightmesh

WIDTH, HEIGHT = SIZE


@pytest.fixture
def frame(renderer, scene):
    return renderer.render(scene, size=SIZE, quality="draft", layers=True, background="transparent")


def test_shapes_and_kinds(frame):
    assert frame.size == SIZE and frame.finished_rows == HEIGHT
    for array, shape, kind in (
        (frame.rgb, (HEIGHT, WIDTH, 3), np.float32),
        (frame.alpha, (HEIGHT, WIDTH), np.float32),
        (frame.depth, (HEIGHT, WIDTH), np.float32),
        (frame.normal, (HEIGHT, WIDTH, 3), np.float32),
        (frame.position, (HEIGHT, WIDTH, 3), np.float32),
        (frame.visibility[0], (HEIGHT, WIDTH), np.float32),
        (frame.lights[0], (HEIGHT, WIDTH, 3), np.float32),
        (frame.rest, (HEIGHT, WIDTH, 3), np.float32),
        (frame.used, (HEIGHT, WIDTH), np.uint32),
        (frame.ids.nearest, (HEIGHT, WIDTH), np.uint32),
    ):
        assert array.shape == shape and array.dtype == kind


def test_overscan_is_around_the_image(renderer, scene):
    settings = {"size": SIZE, "quality": "draft", "layers": True}
    own = renderer.render(scene, **settings)
    around = renderer.render(scene, crop=(-7, -5, WIDTH + 11, HEIGHT + 9), **settings)
    assert around.size == (WIDTH + 11, HEIGHT + 9) and around.stats["settings"]["crop"] == [-7, -5, WIDTH + 11, HEIGHT + 9]
    inside = slice(5, 5 + HEIGHT), slice(7, 7 + WIDTH)
    for name in ("rgb", "depth", "normal"):
        assert np.array_equal(getattr(around, name)[inside], getattr(own, name)), name


def test_cameras_see_between_their_planes(renderer, scene):
    settings = {"size": SIZE, "aa": 1, "layers": True}
    at, along = np.array(camera().position), np.array(camera().direction)
    whole = renderer.render(scene, **settings)
    depth = np.where(np.isfinite(whole.depth), (whole.position - at) @ along, np.inf)
    near, far = np.quantile(depth[np.isfinite(depth)], [0.3, 0.7])
    scene.cameras = [lightmesh.Camera(at, direction=along, near=near, far=far)]
    part = renderer.render(scene, **settings)
    seen = (part.position - at) @ along
    assert near - 1e-3 <= seen[np.isfinite(part.depth)].min() and seen[np.isfinite(part.depth)].max() <= far + 1e-3
    between = (depth > near + 1e-3) & (depth < far - 1e-3)
    assert between.mean() > 0.1 and np.allclose(part.depth[between], whole.depth[between], rtol=1e-4)
    camera_stats = part.stats["settings"]["camera"]
    assert camera_stats["near"] == pytest.approx(near) and camera_stats["far"] == pytest.approx(far)


def test_arrays_are_views_that_cannot_be_written(frame):
    for array in (frame.rgb, frame.depth, frame.ids.nearest, frame.visibility[0]):
        assert not array.flags.writeable and not array.flags.owndata
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True
    assert frame.rgb.ctypes.data == frame.rgb.ctypes.data


def test_arrays_keep_the_frame_alive(renderer, scene):
    frame = renderer.render(scene, size=SIZE, layers=True)
    rgb, matte = frame.rgb, frame.ids
    nearest = matte.nearest
    expected = rgb.copy(), nearest.copy()
    references = sys.getrefcount(frame)
    assert references > 2
    del frame, matte
    gc.collect()
    np.testing.assert_array_equal(rgb, expected[0])
    np.testing.assert_array_equal(nearest, expected[1])


def test_layers_are_about_the_picture(frame):
    seen = frame.alpha > 0.999
    assert 0.1 < seen.mean() < 0.9
    np.testing.assert_allclose(np.linalg.norm(frame.normal[seen], axis=1), 1.0, atol=1e-5)
    distance = np.linalg.norm(frame.position - (4.0, 3.0, 5.0), axis=2)
    np.testing.assert_allclose(distance[seen], frame.depth[seen], rtol=1e-4)
    assert np.isinf(frame.depth[frame.alpha == 0]).all()
    total = sum(frame.lights, start=np.array(frame.rest))
    np.testing.assert_allclose(total, frame.rgb, atol=1e-5)
    assert (frame.visibility[0] >= 0).all() and (frame.visibility[0] <= 1).all() and frame.visibility[0].min() < 0.5


def test_ids_name_things(frame):
    assert frame.ids.names == ["floor", "cube"] and frame.material_ids.names == ["stone", "clay"]
    assert set(np.unique(frame.ids.nearest)) == {0, 1, 2}
    # The cube is in the middle, and what it hides of the floor is not seen.
    assert frame.ids.nearest[HEIGHT // 2 - 2, WIDTH // 2] == 2
    things, shares = frame.ids.ranks[0]
    assert ((things == 0) | (shares > 0)).all()
    manifest = frame.ids.manifest()
    assert '"cube"' in manifest
    assert frame.ids.cryptomatte()[0].shape == (HEIGHT, WIDTH, 4)


def test_without_layers(renderer, scene):
    frame = renderer.render(scene, size=SIZE)
    assert frame.alpha is None
    for name in ("depth", "normal", "visibility", "ids", "used"):
        with pytest.raises(AttributeError, match="layers=True"):
            getattr(frame, name)
    # hasattr is how tools ask.
    assert not hasattr(frame, "depth")


def test_as_array(frame):
    np.testing.assert_array_equal(np.asarray(frame), frame.rgb)
    assert np.asarray(frame, dtype=np.float64).dtype == np.float64
    copy = np.array(frame, copy=True)
    copy[0, 0] = 1.0


def test_dlpack_is_numpys(frame):
    """The arrays are on the host; libraries that take read-only memory take them without a copy."""
    array = np.array(frame.rgb)
    np.testing.assert_array_equal(np.from_dlpack(array), frame.rgb)
    assert frame.rgb.__dlpack_device__() == (1, 0)


def test_pictures_in_notebooks(frame):
    picture = frame._repr_png_()
    assert picture.startswith(b"\x89PNG") and picture == frame.to_png()
    assert frame.to_png(view="neutral") != picture
    assert repr(frame).startswith('<lightmesh.Frame of "cube", 64x48')


@pytest.mark.parametrize("extension", ["bmp", "png", "exr", "jpg"])
def test_files(renderer, scene, tmp_path, extension):
    frame = renderer.render(scene, size=SIZE)
    path = tmp_path / f"a.{extension}"
    frame.save(path)
    assert path.stat().st_size > 100
    frame.save(str(tmp_path / "b"), format=extension)
    assert (tmp_path / "b").read_bytes() == path.read_bytes()


@pytest.mark.parametrize("extension", ["bmp", "png", "exr", "jpg"])
def test_open_files(renderer, scene, tmp_path, extension):
    """The same bytes as in a file of a path."""
    frame = renderer.render(scene, size=SIZE, layers=True)
    frame.save(tmp_path / f"a.{extension}", bit_depth=16 if extension == "png" else None)
    expected = (tmp_path / f"a.{extension}").read_bytes()
    memory = io.BytesIO(b"")
    frame.save(memory, format=extension, bit_depth=16 if extension == "png" else None)
    assert memory.getvalue() == expected
    with open(tmp_path / "b", "wb") as file, tempfile.NamedTemporaryFile() as temporary:
        for each in (file, temporary):
            frame.save(each, format=extension, bit_depth=16 if extension == "png" else None)
        temporary.seek(0)
        assert temporary.read() == expected
    assert (tmp_path / "b").read_bytes() == expected


def test_layers_in_open_files(frame, tmp_path):
    memory = io.BytesIO()
    frame.save_layers(memory, exr_type="half")
    frame.save_layers(tmp_path / "a.exr", exr_type="half")
    assert memory.getvalue() == (tmp_path / "a.exr").read_bytes()


def test_open_files_that_cannot_be_used(frame, tmp_path):
    with pytest.raises(lightmesh.SettingError, match="format='png'"):
        frame.save(io.BytesIO())
    with pytest.raises(lightmesh.ArgumentError, match="open it in binary mode"):
        frame.save(io.StringIO(), format="png")
    with pytest.raises(lightmesh.ArgumentError, match="path: give a path or a file that is open for writing, not int"):
        frame.save(5)
    with open(tmp_path / "a", "wb") as file:
        pass
    with pytest.raises(ValueError, match="closed"):
        frame.save(file, format="png")


def test_what_cannot_be_saved(frame, tmp_path):
    with pytest.raises(lightmesh.SaveError, match="missing"):
        frame.save(tmp_path / "missing" / "a.png")
    with pytest.raises(lightmesh.LightmeshError, match="a.xyz"):
        frame.save(tmp_path / "a.xyz")
    with pytest.raises(TypeError, match="Did you mean 'bit_depth'"):
        frame.save(tmp_path / "a.png", bit_dept=8)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_named_as_another_is_warned_of(frame, tmp_path):
    with pytest.warns(lightmesh.LightmeshWarning, match=r"path .*a\.png is an exr file, as format says, but .* name it .*a\.exr, or leave out format"):
        frame.save(tmp_path / "a.png", format="exr")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x76\x2f\x31\x01")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        frame.save(tmp_path / "a", format="png")
