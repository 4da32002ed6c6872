"""Progress, cancelling, signals and threads."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import SIZE, camera, cube, floor

import lightmesh
from lightmesh import Cancel, Light, MeshCache, Scene

#: A render of some seconds.
SLOW = {"size": (1600, 1200), "mode": "area", "samples": 4096}


def test_progress(renderer, scene):
    seen = []
    renderer.render(scene, size=(640, 480), mode="area", samples=64, progress=seen.append)
    assert seen and seen[-1].done == 1.0
    assert all(a.done <= b.done and a.seconds <= b.seconds for a, b in zip(seen, seen[1:]))
    assert all(0.0 <= progress.done <= 1.0 and progress.stage for progress in seen)
    assert all(progress.left is None or progress.left >= 0.0 for progress in seen)


def mirrors() -> Scene:
    """Mirrors make more work while they are traced."""
    mirror = lightmesh.Material(0.1, specular=0.9)
    return Scene([floor(), cube(mirror)], [Light.sphere((2.0, 4.0, 1.0), 0.5)], camera())


@pytest.mark.parametrize("settings", [{}, {"bounces": 6}, {"ambient_light": "mesh"}, {"lookup": "half-ball"}, {"memory_limit": "600M"}], ids=str)
def test_progress_never_falls(renderer, settings):
    shares = []
    renderer.render(mirrors(), size=(320, 240), progress=lambda progress: shares.append(progress.done), **settings)
    assert shares == sorted(shares) and shares[-1] == 1.0


def test_progress_ends_whatever_is_done(renderer, scene):
    for work in (
        lambda **watched: renderer.prepare(scene, **watched),
        lambda **watched: renderer.sun_hours("builtin:gazebo", sun="54.98,82.9,2026-06-21+07:00,09:00-15:00/3h", size=(16, 12), **watched),
        lambda **watched: renderer.visibility([(0, 0, 0)], [(0, 1, 0)], scene, **watched),
    ):
        shares = []
        work(progress=lambda progress: shares.append(progress.done))
        assert shares == sorted(shares) and shares[-1] == 1.0


def test_tqdm_follows(renderer, scene):
    tqdm = pytest.importorskip("tqdm")
    steps = []

    class Bar(tqdm.tqdm):
        def update(self, n=1):
            steps.append(n)
            return super().update(n)

    with Bar(total=100, disable=None, file=open(os.devnull, "w")) as bar:
        for _ in renderer.film(scene, turntable=3, size=(64, 48), progress=lightmesh.follow(bar)):
            pass
        assert bar.disable or bar.n == pytest.approx(100.0)
    with Bar(total=100, file=open(os.devnull, "w"), mininterval=0) as bar:
        renderer.render(scene, size=(320, 240), progress=lightmesh.follow(bar))
        assert bar.n == pytest.approx(100.0) and min(steps) >= 0.0


class PlainBar:
    """What `follow` needs of a bar, with the texts that tqdm would show."""

    def __init__(self, total=None):
        self.n, self.total, self.shown = 0, total, []

    def update(self, n):
        self.n += n
        self.shown.append(str(self.n))


@pytest.mark.parametrize(("total", "digits"), [(1.0, 3), (None, 3), (100, 1), (24, 2), (0.3, 4)])
def test_bars_show_short_numbers(total, digits):
    bar = PlainBar(total)
    move = lightmesh.follow(bar)
    for step in range(1, 1001):
        move(SimpleNamespace(done=step / 1000 if step == 1000 else step * 0.000997))
    assert all(len(text.partition(".")[2]) <= digits for text in bar.shown), bar.shown
    assert bar.n == (total or 1.0) and len(set(bar.shown)) > 200


def test_what_cannot_be_told_of_progress_is_refused_at_once(renderer, scene):
    with pytest.raises(lightmesh.ArgumentError, match="give a bar of tqdm, or one like it, not int, which has no n, total, update"):
        lightmesh.follow(3)
    for work in (renderer.render, renderer.prepare, renderer.film):
        with pytest.raises(lightmesh.ArgumentError, match="progress: give a function of a Progress.*, not int"):
            work(scene, progress=3)


def test_callback_is_called_by_the_thread_that_asked(renderer, scene):
    threads = set()
    renderer.render(scene, size=(320, 240), progress=lambda _: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


class Stop(Exception):
    pass


def test_what_a_callback_raises_stops_the_render(renderer, scene):
    def stop(progress):
        raise Stop(progress.done)

    start = time.monotonic()
    with pytest.raises(Stop) as raised:
        renderer.render(scene, progress=stop, **SLOW)
    assert raised.value.args[0] < 1.0
    assert time.monotonic() - start < 20.0
    # The renderer is as good as new.
    assert np.isfinite(renderer.render(scene, size=SIZE).rgb).all()


def test_cancel_from_another_thread(renderer, scene):
    cancel = Cancel()
    started = threading.Event()

    def stop():
        started.wait(30.0)
        cancel.cancel()

    thread = threading.Thread(target=stop)
    thread.start()
    with pytest.raises(lightmesh.Cancelled):
        renderer.render(scene, cancel=cancel, progress=lambda _: started.set(), **SLOW)
    thread.join()
    assert cancel.cancelled
    with pytest.raises(lightmesh.Cancelled):
        renderer.prepare(scene, cancel=cancel)


def test_partial(renderer, scene):
    cancel = Cancel()
    frame = renderer.render(scene, partial=True, cancel=cancel, progress=lambda p: p.done > 0.3 and cancel.cancel(), **SLOW)
    assert 0 < frame.finished_rows < SLOW["size"][1]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no kill")
def test_interrupt():
    """Ctrl-C stops a render, as KeyboardInterrupt."""
    script = (
        "import lightmesh, signal, sys\n"
        # Whoever runs the tests may ignore Ctrl-C, as a shell does for what it starts in the background.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "scene = lightmesh.Scene.builtin('childpark')\n"
        "try:\n"
        "    lightmesh.Renderer('cpu').render(scene, size=(2000, 2000), mode='area', samples=4096, progress=lambda _: print('up', flush=True))\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(42)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"up\n"
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 42


def test_renders_in_two_threads_overlap(renderer, scene):
    """Each waits, in the midst of its render, for the other to be in the midst of its own."""
    meeting = threading.Barrier(2, timeout=60.0)
    frames, raised = {}, []

    def render(number):
        met = False

        def meet(progress):
            nonlocal met
            if not met and progress.done < 1.0:
                met = True
                meeting.wait()

        try:
            frames[number] = renderer.render(scene, size=(640, 480), mode="area", samples=256, seed=number, progress=meet)
        except BaseException as error:
            raised.append(error)

    threads = [threading.Thread(target=render, args=(number,)) for number in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert raised == [] and set(frames) == {1, 2}
    alone = renderer.render(scene, size=(640, 480), mode="area", samples=256, seed=2)
    np.testing.assert_array_equal(frames[2].rgb, alone.rgb)


def test_interpreter_is_free_while_it_renders(renderer, scene):
    done = threading.Event()
    thread = threading.Thread(target=lambda: (renderer.render(scene, size=(800, 600), mode="area", samples=256), done.set()))
    thread.start()
    steps = 0
    while not done.is_set():
        steps += 1
        time.sleep(0.001)
    thread.join()
    assert steps > 20


def test_bars(renderer, scene):
    class Bar:
        """What tqdm offers."""

        n, total = 0.0, 1.0

        def update(self, n):
            self.n += n

    bar = Bar()
    renderer.render(scene, size=(320, 240), progress=lightmesh.follow(bar))
    assert bar.n == pytest.approx(1.0)


def resident() -> int:
    """Bytes of memory that the process has."""
    with open("/proc/self/statm") as status:
        return int(status.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="needs /proc")
def test_a_thousand_renders_leak_nothing(renderer):
    """A frame with its layers takes about 200 KB: were one in ten kept, or the cache's copy of a scene, this would find it."""
    cache = MeshCache()

    def once(turn):
        scene = Scene([floor(), cube()], [Light.sphere((2.0, 4.0, 1.0), 0.5)], camera())
        frame = renderer.render(scene, size=SIZE, quality="draft", layers=True, cache=cache if turn % 2 else None, progress=lambda _: None)
        assert frame.depth.shape == SIZE[::-1]
        with pytest.raises(lightmesh.SettingError):
            renderer.render(scene, samples=-1)

    for turn in range(200):
        once(turn)
    gc.collect()
    before = resident()
    for turn in range(1000):
        once(turn)
    gc.collect()
    assert resident() - before < 20e6
