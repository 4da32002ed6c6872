"""Films and sun studies: the frames that the command line writes, one by one."""

import io
import subprocess
import sys

import numpy as np
import pytest

import lightmesh
import lightmesh.typing

SETTINGS = {"size": (48, 36), "quality": "draft"}
FLAGS = ("--device", "cpu", "--size", "48x36", "--quality", "draft", "--quiet")
DAY = "54.98,82.9,2026-06-21+07:00,09:00-15:00/3h"


def command(folder, *arguments):
    subprocess.run([sys.executable, "-m", "lightmesh", "render", "builtin:gazebo", *FLAGS, *arguments], cwd=folder, check=True, timeout=300)


@pytest.mark.parametrize(("flags", "settings"), [(("--turntable", "3"), {"turntable": 3}), (("--sun", DAY), {"sun": DAY})], ids=["turntable", "sun"])
def test_frames_are_those_of_the_command_line(renderer, tmp_path, flags, settings):
    command(tmp_path, *flags, "-o", "a.#.png")
    film = renderer.film("builtin:gazebo", **SETTINGS, **settings)
    assert len(film) == 3
    frames = list(film)
    assert [frame.number for frame in frames] == [1, 2, 3] and len(film) == 0
    assert [frame.when for frame in frames] == (["09:00", "12:00", "15:00"] if "sun" in settings else [""] * 3)
    for frame in frames:
        frame.save(tmp_path / "b.png")
        assert (tmp_path / "b.png").read_bytes() == (tmp_path / f"a.{frame.number}.png").read_bytes()


def test_files_are_written_and_a_film_goes_on(renderer, tmp_path):
    output = tmp_path / "f.##.png"
    film = renderer.film("builtin:gazebo", output, turntable=4, resume=True, **SETTINGS)
    assert next(film).number == 1 and (tmp_path / "f.01.png").exists() and not (tmp_path / "f.02.png").exists()
    del film
    assert [frame.number for frame in renderer.film("builtin:gazebo", output, turntable=4, resume=True, **SETTINGS)] == [2, 3, 4]
    command(tmp_path, "--turntable", "4", "-o", "f.##.png", "--resume")
    with pytest.raises(lightmesh.SettingError, match="seed was 0 and is 5.*overwrite=True"):
        renderer.film("builtin:gazebo", output, turntable=4, resume=True, seed=5, **SETTINGS)
    with pytest.raises(lightmesh.SettingError, match="exists and 3 more; add skip_existing=True"):
        renderer.film("builtin:gazebo", output, turntable=4, **SETTINGS)


def test_frames_are_stored_as_the_film_says(renderer, scene, tmp_path):
    settings = {"turntable": 1, "size": (32, 24), "bit_depth": 16, "view": "neutral", "exposure": 1.5}
    (frame,) = renderer.film(scene, tmp_path / "a.#.png", **settings)
    frame.save(tmp_path / "b.png")
    assert (tmp_path / "a.1.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert frame.exposure == 1.5
    frame.save(tmp_path / "c.png", bit_depth=8)
    assert (tmp_path / "c.png").stat().st_size < (tmp_path / "b.png").stat().st_size


def test_a_scene_of_arrays(renderer, scene, tmp_path):
    rgb = [frame.rgb.mean() for frame in renderer.film(scene, turntable=2, size=(32, 24))]
    assert len(rgb) == 2 and rgb[0] != rgb[1]
    with pytest.raises(lightmesh.SettingError, match="resume needs the file of a scene"):
        renderer.film(scene, tmp_path / "f.#.png", turntable=2, resume=True)


def test_what_is_no_film(renderer, scene):
    with pytest.raises(lightmesh.SettingError, match="^nothing moves, so there is no film; add turntable, sun, frames or fps$"):
        renderer.film(scene, size=(32, 24))
    with pytest.raises(lightmesh.SettingError, match="^overwrite is for films; add turntable, sun, frames or fps, or leave it out$"):
        renderer.film(scene, size=(32, 24), overwrite=True)
    with pytest.raises(lightmesh.SettingError, match="^skip_existing needs output; give it, too, or leave skip_existing out$"):
        renderer.film(scene, turntable=3, size=(32, 24), skip_existing=True)
    with pytest.raises(lightmesh.ArgumentError, match="unexpected keyword argument 'turntabel'. Did you mean 'turntable'?"):
        renderer.film(scene, turntabel=3)
    with pytest.raises(lightmesh.SettingError, match="turntable cannot be 0: 0 is not in 1..=1000000"):
        renderer.film(scene, turntable=0)
    with pytest.raises(lightmesh.SettingError, match="sun is needed"):
        renderer.sun_hours(scene, size=(32, 24))
    for setting, value in [("overwrite", True), ("frames", "1-2"), ("fps", 12)]:
        with pytest.raises(lightmesh.SettingError, match=f"{setting} .*frames"):
            renderer.sun_hours(scene, sun=DAY, size=(32, 24), **{setting: value})


def test_what_is_to_know_of_a_film_is_told(tmp_path, scene):
    """Its settings, and what its file has that is not as it should be."""
    (tmp_path / "a.obj").write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.warns(lightmesh.SceneWarning, match="none"):
        renderer = lightmesh.Renderer("cpu", threads=1000)
        renderer.film(tmp_path / "a.obj", turntable=1, size=(16, 12))
    with pytest.warns(lightmesh.LightmeshWarning, match="f.#?1?.png is a bmp file, as format says"):
        film = renderer.film(scene, tmp_path / "f.#.png", turntable=1, size=(16, 12), format="bmp")
    assert renderer.threads < 1000 and any(note.startswith(f"threads=1000: using {renderer.threads}, ") for note in film.notes)
    notes = renderer.render(scene, size=(16, 12)).notes
    assert any(note.startswith("threads=1000: using ") for note in notes)
    assert not any(note.startswith("threads") for note in lightmesh.Renderer("cpu", threads=2).render(scene, size=(16, 12)).notes)


def test_cancelled(renderer, scene):
    cancel = lightmesh.Cancel()
    film = renderer.film(scene, turntable=3, size=(32, 24), cancel=cancel)
    next(film)
    cancel.cancel()
    with pytest.raises(lightmesh.Cancelled):
        next(film)
    assert list(film) == []


def test_progress_is_of_the_whole_film(renderer, scene):
    seen, ends = [], []
    for _ in renderer.film(scene, turntable=4, size=(64, 48), progress=seen.append):
        ends.append(seen[-1].done)
    shares = [progress.done for progress in seen]
    assert shares == sorted(shares) and ends == [0.25, 0.5, 0.75, 1.0] and shares[-1] == 1.0
    assert all(a.seconds <= b.seconds for a, b in zip(seen, seen[1:]))


def test_progress_of_a_film_that_goes_on(renderer, tmp_path):
    film = {"output": tmp_path / "f.#.png", "turntable": 4, "resume": True, **SETTINGS}
    next(renderer.film("builtin:gazebo", **film))
    ends, seen = [], []
    for _ in renderer.film("builtin:gazebo", progress=seen.append, **film):
        ends.append(seen[-1].done)
    assert ends == pytest.approx([1 / 3, 2 / 3, 1.0])


def test_hours_of_direct_sun(renderer, tmp_path):
    command(tmp_path, "--sun", DAY, "--sun-hours", "a.exr", "--sun-hours", "a.png", "--sun-hours", "a.csv")
    found = renderer.sun_hours("builtin:gazebo", sun=DAY, **SETTINGS)
    assert found.hours.shape == (36, 48) and found.hours.dtype == np.float32 and 0 < found.hours.max() < 6.01
    for extension in ("exr", "png", "csv"):
        found.save(tmp_path / f"b.{extension}")
        assert (tmp_path / f"a.{extension}").read_bytes() == (tmp_path / f"b.{extension}").read_bytes()
    assert found.table.startswith("object,pixels,")
    for extension in ("exr", "png", "csv"):
        memory = io.BytesIO()
        found.save(memory, format=extension)
        assert memory.getvalue() == (tmp_path / f"a.{extension}").read_bytes()
    with pytest.warns(lightmesh.LightmeshWarning, match=r"path .*c\.png is a csv file, as format says, but its extension is that of png files"):
        found.save(tmp_path / "c.png", format="csv")
    found.save(tmp_path / "c", format="csv")
    assert (tmp_path / "c").read_text() == found.table
    with pytest.raises(lightmesh.SettingError, match="exr, png or csv"):
        found.save(io.BytesIO())
    with pytest.raises(lightmesh.SettingError, match="no format of hours `bmp`"):
        found.save(tmp_path / "d", format="bmp")
    with pytest.raises(lightmesh.SettingError, match="unknown format"):
        found.save(tmp_path / "b.txt")


def test_glass_of_hours(renderer, tmp_path):
    """Panes hide no sun unless they are to, and are told of."""
    pane = '[[material]]\nname = "pane"\nior = 1.5\nthin = true\n[[plane]]\nname = "window"\npoint = [0, 2, 0]\nnormal = [0, 1, 0]\nsize = [2, 2]\nmaterial = "pane"\n'
    floor = '[camera]\nposition = [0, 5, 9]\ntarget = [0, 0, 0]\n[[plane]]\nname = "floor"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [9, 9]\n'
    (tmp_path / "a.toml").write_text(floor + pane)
    day = "48,0,2026-06-21Z,08:00-16:00"
    found = {glass: renderer.sun_hours(tmp_path / "a.toml", sun=day, glass=glass, **SETTINGS) for glass in ("open", "tinted", "closed")}
    seen = found["open"].mask
    np.testing.assert_allclose(found["open"].hours[seen], 8.0, atol=1e-3)
    sums = [float(found[glass].hours.sum()) for glass in ("open", "tinted", "closed")]
    assert sums[0] > sums[1] + 1.0 > sums[2] + 2.0
    assert any("glass=closed counts it as walls" in note for note in found["open"].notes)
    assert any("(glass=tinted)" in note for note in found["tinted"].notes)
    assert found["open"].table_notes == []
    with pytest.raises(lightmesh.SettingError, match="sun"):
        renderer.film("builtin:gazebo", turntable=2, glass="closed", **SETTINGS)


def test_no_sun_is_not_no_surface(renderer, scene):
    """The mask is what a frame of the same view sees, and what the table counts."""
    # Of the cube's north, which the sun does not see.
    scene.camera = lightmesh.Camera((-1.0, 3.0, -5.0), (0.0, 0.7, 0.0))
    found = renderer.sun_hours(scene, sun=DAY, no_studio=True, **SETTINGS)
    seen = np.isfinite(renderer.render(scene, layers=True, aa=1, **SETTINGS).depth)
    assert found.mask.shape == found.hours.shape and found.mask.dtype == np.bool_
    np.testing.assert_array_equal(found.mask, seen)
    assert (found.hours[~found.mask] == 0).all() and (found.hours[found.mask] == 0).any() and (~found.mask).any()
    rows = found.table.strip().splitlines()[1:]
    assert sum(int(row.rsplit(",", 7)[1]) for row in rows) == found.mask.sum()
    with pytest.raises(ValueError, match="WRITEABLE"):
        found.mask.flags.writeable = True


@pytest.mark.parametrize("function", ["film", "sun_hours", "render", "prepare", "visibility"])
def test_help_has_every_keyword(function):
    types = {"film": lightmesh.typing.FilmSettings, "sun_hours": lightmesh.typing.FilmSettings}.get(function, lightmesh.typing.ImageSettings)
    text = getattr(lightmesh.Renderer, function).__doc__
    for keyword in types.__annotations__:
        assert f"\n{keyword}: " in text, keyword
