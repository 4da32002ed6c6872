"""Films and pictures on a Ray cluster of this machine: the files of one process."""

import subprocess
import sys

import numpy as np
import pytest
from ray_films import FILM, SCENE, by_one_process, command, files, flags

pytest.importorskip("ray")

import lightmesh
import lightmesh.ray
import lightmesh.typing
from lightmesh._lightmesh import _BandedPicture, _Worker


def test_a_film_is_that_of_one_process(cluster, tmp_path):
    by_one_process(SCENE, tmp_path / "one" / "f.##.png", {**FILM, "turntable": 5})
    (tmp_path / "many").mkdir()
    heard = []
    report = lightmesh.ray.film(SCENE, tmp_path / "many" / "f.##.png", turntable=5, on_progress=heard.append, **FILM)
    assert files(tmp_path / "many") == files(tmp_path / "one")
    assert report.units == 5 and report.kept == 0 and not report.failures and report.image is None
    assert sum(node.units for node in report.nodes.values()) == 5
    assert "device auto: using cpu, since actors own no GPU" in "".join(report.notes)
    assert "5 units" in str(report)
    assert heard[-1].done == 1.0 and heard[-1].units == heard[-1].total == 5 and heard[-1].stage == "rendering"
    assert [one.done for one in heard] == sorted(one.done for one in heard)
    assert any(one.left is not None for one in heard)


def test_each_goes_on_with_films_of_the_other(cluster, tmp_path):
    settings = {**FILM, "turntable": 6, "exposure": "auto"}
    by_one_process(SCENE, tmp_path / "one" / "f.##.png", settings)
    for first in ("one process", "ray"):
        output = tmp_path / first / "f.##.png"
        output.parent.mkdir()
        runs = [
            lambda frames, output=output: command("render", SCENE, "-o", output, "--device", "cpu", "--resume", "--frames", frames, *flags(settings)),
            lambda frames, output=output: lightmesh.ray.film(SCENE, output, frames=frames, resume=True, **settings),
        ]
        for run, frames in zip(runs if first == "one process" else reversed(runs), ("1,2,3", "1-6")):
            last = run(frames)
        assert files(output.parent) == files(tmp_path / "one"), first
        if first == "one process":
            assert last.kept == 3 and last.units == 3
    again = lightmesh.ray.film(SCENE, tmp_path / "ray" / "f.##.png", frames=[2, 4], resume=True, **settings)
    assert (again.units, again.kept) == (0, 2)
    with pytest.raises(lightmesh.SettingError, match="seed was 0 and is 5"):
        lightmesh.ray.film(SCENE, tmp_path / "ray" / "f.##.png", resume=True, seed=5, **settings)


#: What a picture is put together from: bands alone, with alpha, exposed as a whole, with a second pass for what mirrors show, a part.
PICTURES = {
    "plain": {"size": (64, 200)},
    "transparent": {"size": (64, 200), "background": "transparent"},
    "exposed": {"size": (64, 200), "exposure": "auto", "ground": True},
    "reflected": {"size": (64, 200), "exposure": "auto", "ground": True, "bounces": 2},
    "part": {"size": (96, 300), "crop": "8,20,64,200", "exposure": "auto"},
    "beyond": {"size": (64, 100), "crop": "-8,-20,80,150", "exposure": "auto"},
    "half-ball": {"size": (64, 200), "lookup": "half-ball"},
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_that_of_one_process(cluster, tmp_path, name):
    settings = {**PICTURES[name], "quality": "draft"}
    for extension in ("png", "exr"):
        if extension == "exr" and name not in ("plain", "transparent"):
            continue
        one, many = tmp_path / f"one.{extension}", tmp_path / f"many.{extension}"
        command("render", SCENE, "-o", one, "--device", "cpu", *flags(settings))
        report = lightmesh.ray.picture(SCENE, many, **settings)
        assert many.read_bytes() == one.read_bytes(), extension
        assert report.units >= 2 and report.image is None


def test_a_picture_in_memory(cluster, tmp_path):
    by_one_process(SCENE, tmp_path / "one.png", {"size": (64, 130), "quality": "draft", "bit_depth".replace("_", "-"): 16})
    image = lightmesh.ray.picture(SCENE, size=(64, 130), quality="draft", bit_depth=16).image
    assert image.rgb.shape == (130, 64, 3) and image.stats["counts"]["pixels"] == 64 * 130 and image.stats["settings"]["crop"] is None
    image.save(tmp_path / "many.png")
    assert (tmp_path / "many.png").read_bytes() == (tmp_path / "one.png").read_bytes()


@pytest.mark.parametrize("layout", ["C", "F"])
@pytest.mark.parametrize("is_writable", [True, False])
def test_arrays_of_any_layout_are_taken(layout, is_writable):
    settings = {"size": (16, 8), "quality": "draft", "background": "transparent"}
    whole = _BandedPicture(SCENE, None, settings)
    worker = _Worker(SCENE, None, whole.request)

    def render(text):
        bands = []
        for first in (4, 0):
            (color, alpha, stats), _ = worker.rows(text, first, 4)
            color, alpha = (np.array(plane, order=layout) for plane in (color, alpha))
            color.flags.writeable = alpha.flags.writeable = is_writable
            bands.append((first, color, alpha, stats))
        return bands

    frame, _ = whole.render(render)
    want = lightmesh.Renderer("cpu").render(lightmesh.Scene.builtin("gazebo"), **settings)
    assert np.array_equal(frame.rgb, want.rgb) and np.array_equal(frame.alpha, want.alpha)
    with pytest.raises(lightmesh.SettingError, match="the bands do not make a picture of 8 rows"):
        whole.render(lambda text: render(text)[:1])
    with pytest.raises(ZeroDivisionError):
        whole.render(lambda text: 1 / 0)
    with pytest.raises(lightmesh.SettingError, match="does not have 5 rows from row 4 on"):
        whole.render(lambda text: worker.rows(text, 4, 5))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda out: lightmesh.ray.film(SCENE, out / "f.mp4", turntable=2), "is one file, and frames come from many processes"),
        (lambda out: lightmesh.ray.film("-", out / "f.#.png", turntable=2), "standard input cannot be read by many processes"),
        (lambda out: lightmesh.ray.picture(SCENE, turntable=2), "turntable is not for a picture by many processes"),
        (lambda out: lightmesh.ray.picture(SCENE, layers=True), "layers is not for a picture by many processes"),
        (lambda out: lightmesh.ray.picture(SCENE, camera=lightmesh.Camera((0, 0, 1), (0, 0, 0))), "camera: objects stay on this machine"),
        (lambda out: lightmesh.ray.picture(SCENE, cpus_per_actor=0), "cpus_per_actor cannot be 0"),
    ],
)
def test_what_many_processes_cannot_do(tmp_path, call, message):
    with pytest.raises(lightmesh.SettingError, match=message):
        call(tmp_path)
    assert not list(tmp_path.iterdir())


def test_from_a_shell(cluster, tmp_path):
    by_one_process(SCENE, tmp_path / "one" / "f.#.png", {**FILM, "turntable": 2})
    (tmp_path / "many").mkdir()
    output = str(tmp_path / "many" / "f.#.png")
    line = [sys.executable, "-m", "lightmesh.ray", "film", SCENE, "-o", output, "--address", cluster.address, "--turntable", "2"]
    done = subprocess.run([*line, *flags(FILM)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "2 units" in done.stderr and "100%" in done.stderr
    assert files(tmp_path / "many") == files(tmp_path / "one")
    refused = subprocess.run([*line, "--stats", "s.json"], capture_output=True, text=True, timeout=120)
    assert refused.returncode == 2 and "only -o is written by many processes" in refused.stderr
    unknown = subprocess.run([*line, "--turntabel", "2"], capture_output=True, text=True, timeout=120)
    assert unknown.returncode == 2 and "--turntable" in unknown.stderr


def test_without_ray_it_says_what_to_install(tmp_path):
    (tmp_path / "ray.py").write_text("raise ImportError('there is none')")
    program = "import sys; sys.path.insert(0, sys.argv[1]); import lightmesh.ray"
    done = subprocess.run([sys.executable, "-c", program, str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 1 and "ImportError: lightmesh.ray needs Ray: pip install lightmesh[ray]" in done.stderr


def test_requests_have_all_settings():
    """What is a parameter of its own, and what is not for many processes, is all that is left out of the annotations."""
    own = {"frames", "partial", "layers"}
    every = {*lightmesh.typing.FilmSettings.__annotations__, *lightmesh.typing.OpenSettings.__annotations__}
    named = {*lightmesh.ray.FilmRequest.__annotations__, *lightmesh.ray.PictureRequest.__annotations__}
    assert every - named == own and named - every == {"accel", "grid", "grid_file", "device", "threads"} - every
