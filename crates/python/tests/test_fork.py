"""Processes that are forked from one that has used the library, as those of servers and of loaders of data are."""

import os
import pickle
import signal
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
from conftest import SIZE, camera, cube, floor

import lightmesh
from lightmesh import Light, MeshCache, Renderer, Scene

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork"),
    # What the tests are about.
    pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning"),
]
SETTINGS = {"size": SIZE, "quality": "draft"}
#: Far more than any of it takes.
SECONDS = 60.0


def in_child(work: Callable[[], object]) -> object:
    """What a function returns in a forked child; an exception in the child is raised here."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            result = (True, work())
        except BaseException as error:
            result = (False, error)
        with os.fdopen(writing, "wb") as pipe:
            pipe.write(pickle.dumps(result))
        os._exit(0)
    os.close(writing)
    received: list[bytes] = []
    with os.fdopen(reading, "rb") as pipe:
        reader = threading.Thread(target=lambda: received.append(pipe.read()))
        reader.start()
        reader.join(SECONDS)
        is_done = not reader.is_alive()
        if not is_done:
            os.kill(child, signal.SIGKILL)
            reader.join()
    os.waitpid(child, 0)
    assert is_done, f"the child is not done after {SECONDS} s"
    is_fine, result = pickle.loads(received[0])
    if not is_fine:
        raise result
    return result


@pytest.fixture
def used(renderer, scene) -> Renderer:
    """A renderer that has worked, as has the global pool of threads."""
    renderer.render(scene, **SETTINGS).to_png()
    return renderer


def test_a_renderer_of_the_parent(used, scene):
    here = used.render(scene, **SETTINGS).rgb
    np.testing.assert_array_equal(in_child(lambda: used.render(scene, **SETTINGS).rgb), here)
    # And a second time, and in its child.
    np.testing.assert_array_equal(in_child(lambda: [used.render(scene, **SETTINGS).rgb for _ in range(2)][1]), here)
    np.testing.assert_array_equal(in_child(lambda: in_child(lambda: used.render(scene, **SETTINGS).rgb)), here)
    np.testing.assert_array_equal(used.render(scene, **SETTINGS).rgb, here)


def test_a_prepared_scene_and_a_cache(used, scene):
    settings = {"size": SIZE, "lookup": "half-ball", "step": 0.4}
    prepared, cache = used.prepare(scene), MeshCache()
    here = used.render(prepared, cache=cache, **settings).rgb
    assert len(cache) > 0

    def work():
        before = len(cache)
        return before, used.render(prepared, cache=cache, **settings).rgb, len(cache)

    before, there, after = in_child(work)
    np.testing.assert_array_equal(there, here)
    assert before == 0 and after == len(cache)


def test_scenes_are_made_and_opened(used, tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

    def work():
        own = Scene([floor(), cube()], [Light.point((0, 3, 0))], camera())
        opened, built = Scene.open(path), Scene.builtin("childpark")
        environment = lightmesh.Environment(np.ones((16, 32, 3), np.float32))
        frame = Renderer("cpu", threads=1).render(own, **SETTINGS)
        return own.info()["triangles"], opened.triangle_count, built.triangle_count, environment.size, frame.size

    here = work()
    assert in_child(work) == here


def test_files_are_written_and_compared(used, scene, tmp_path):
    frame = used.render(scene, layers=True, **SETTINGS)
    frame.save(tmp_path / "here.png")
    frame.save(tmp_path / "here.exr")

    def work():
        from lightmesh._lightmesh import command

        for extension in ("png", "exr", "jpg", "bmp"):
            frame.save(tmp_path / f"there.{extension}")
        frame.save_layers(tmp_path / "layers.exr")
        return command(["compare", str(tmp_path / "here.png"), str(tmp_path / "there.png")]), len(frame.ids.cryptomatte())

    assert in_child(work)[0] == 0
    for extension in ("png", "exr"):
        assert (tmp_path / f"there.{extension}").read_bytes() == (tmp_path / f"here.{extension}").read_bytes()


def test_studies_and_visibility(used):
    def work():
        study = used.sun_hours("builtin:gazebo", sun="54.98,82.9,2026-06-21+07:00,09:00-15:00/3h", size=(16, 12))
        shares = used.visibility([(0, 0, 0)], [(0, 1, 0)], Scene(floor(), [Light.sphere((0, 3, 0), 0.5)]))
        return study.hours, shares

    for there, here in zip(in_child(work), work(), strict=True):
        np.testing.assert_array_equal(there, here)


def test_a_film_goes_on_where_it_was_begun(used, scene):
    film = used.film(scene, turntable=3, **SETTINGS)
    next(film)
    with pytest.raises(lightmesh.LightmeshError, match="begun by another process"):
        in_child(lambda: next(film))
    assert in_child(lambda: repr(film)) == "<lightmesh.Film of another process>"
    assert in_child(lambda: len(list(used.film(scene, turntable=2, **SETTINGS)))) == 2
    assert len(list(film)) == 2


def test_a_fork_in_the_midst_of_a_render(used, scene):
    """Locks that another thread holds in that moment stay locked in the child."""
    started, cancel, cache = threading.Event(), lightmesh.Cancel(), MeshCache()
    slow = {"size": (1600, 1200), "mode": "area", "samples": 4096, "cancel": cancel, "progress": lambda _: started.set()}

    def render():
        with pytest.raises(lightmesh.Cancelled):
            used.render(scene, cache=cache, **slow)

    thread = threading.Thread(target=render)
    thread.start()
    assert started.wait(SECONDS)
    try:
        assert in_child(lambda: used.render(scene, cache=cache, **SETTINGS).size) == SIZE
    finally:
        cancel.cancel()
        thread.join()


def test_a_device_is_not_used_by_a_child():
    """Where there is a GPU, the message says what to do."""
    try:
        renderer = Renderer("cuda")
    except lightmesh.DeviceError:
        pytest.skip("no CUDA device works")
    with pytest.raises(lightmesh.DeviceError, match="spawn"):
        in_child(lambda: renderer.render(Scene.builtin("gazebo"), **SETTINGS))


def test_a_pool_of_processes(used, scene):
    """As loaders of data make them, with what they send."""
    multiprocessing = pytest.importorskip("multiprocessing")
    start = time.monotonic()
    with multiprocessing.get_context("fork").Pool(2, initializer=_keep, initargs=(used, scene)) as pool:
        means = pool.map_async(_mean, range(4)).get(SECONDS)
    assert means == [used.render(scene, seed=seed, **SETTINGS).rgb.mean() for seed in range(4)]
    assert time.monotonic() - start < SECONDS


_kept: list[object] = []


def _keep(*objects: object) -> None:
    _kept[:] = objects


def _mean(seed: int) -> float:
    used, scene = _kept
    return used.render(scene, seed=seed, **SETTINGS).rgb.mean()
