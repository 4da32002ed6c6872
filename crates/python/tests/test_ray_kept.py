"""Pictures whose leader dies: a new one goes on with the bands that are on disk."""

import numpy as np
import pytest
from ray_films import SCENE, by_one_process

pytest.importorskip("ray")

import lightmesh
import lightmesh.ray
from lightmesh.ray import _kept

PICTURE = {"size": (64, 500), "quality": "draft"}
#: Its bands: none is lower than 64 rows.
BANDS = 7


@pytest.fixture
def left(cluster, tmp_path, monkeypatch):
    """A picture whose leader has died after three bands."""
    by_one_process(SCENE, tmp_path / "one.png", PICTURE)
    add, count = _kept.Kept.add, 0

    def dies(self, render_pass, band):
        nonlocal count
        add(self, render_pass, band)
        count += 1
        if count == 3:
            raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(_kept.Kept, "add", dies)
        with pytest.raises(KeyboardInterrupt):
            lightmesh.ray.picture(SCENE, tmp_path / "many.png", **PICTURE)
    assert len(bands(tmp_path)) == 3
    return tmp_path


def bands(folder):
    return sorted((folder / "many.png.bands").glob("*.npz"))


def finish(folder, **more):
    """Renders the picture again; returns how many units that took."""
    report = lightmesh.ray.picture(SCENE, folder / "many.png", **{**PICTURE, **more})
    assert not (folder / "many.png.bands").exists()
    return report.units


def test_bands_that_are_there_are_not_rendered_again(left):
    assert finish(left, resume=True) == BANDS - 3
    assert (left / "many.png").read_bytes() == (left / "one.png").read_bytes()


def test_without_resume_all_is_rendered(left):
    assert finish(left) == BANDS
    assert (left / "many.png").read_bytes() == (left / "one.png").read_bytes()


def test_bands_of_other_pictures_and_damaged_ones_are_not_taken(left):
    damaged = bands(left)[0]
    damaged.write_bytes(damaged.read_bytes()[:-100])
    assert finish(left, resume=True) == BANDS - 2
    assert (left / "many.png").read_bytes() == (left / "one.png").read_bytes()


def test_other_settings_are_another_picture(left):
    assert finish(left, resume=True, seed=5) == BANDS


def test_gaps_are_what_no_band_has():
    band = lambda first, rows: (first, np.zeros((rows, 4, 3), np.float32), None, "")  # noqa: E731
    assert _kept.gaps(range(-5, 20), []) == [range(-5, 20)]
    assert _kept.gaps(range(-5, 20), [band(-5, 5), band(3, 4), band(10, 10)]) == [range(0, 3), range(7, 10)]


def test_a_folder_of_something_else_stays(tmp_path):
    other = tmp_path / "a.png.bands"
    other.mkdir()
    (other / "notes.txt").write_text("mine")
    _kept.Kept(tmp_path / "a.png", False, "", []).close(True)
    assert (other / "notes.txt").exists()
