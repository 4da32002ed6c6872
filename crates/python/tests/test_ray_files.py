"""The files of a scene, and of a film, on nodes that do not share a disk with the leader."""

import os
import tempfile
from pathlib import Path

import pytest
from ray_films import FILM, SCENE, by_one_process, files

pytest.importorskip("ray")

import lightmesh
import lightmesh.ray
from lightmesh._lightmesh import _FilmLog
from lightmesh.ray import _actors, _files, _nodes, _team, _units


@pytest.fixture
def model_files(tmp_path):
    """A scene of several files: TOML, OBJ, MTL and a texture."""
    folder = tmp_path / "scene"
    folder.mkdir()
    lightmesh.Renderer("cpu").render(lightmesh.Scene.builtin(SCENE), size=(8, 8)).save(folder / "wood.png")
    (folder / "floor.mtl").write_text("newmtl wood\nKd 1 1 1\nmap_Kd wood.png\n")
    corners = "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nvt 0 0\nvt 0 1\nvt 1 1\n"
    (folder / "floor.obj").write_text(f"mtllib floor.mtl\n{corners}usemtl wood\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\n")
    (folder / "scene.toml").write_text('[[mesh]]\nfile = "floor.obj"\n[[light]]\nkind = "sphere"\nposition = [0, 3, 0]\nradius = 0.5\n')
    return folder


def test_files_that_differ_are_named_with_their_node(cluster, model_files, tmp_path):
    path, size, xxh3 = (log := _FilmLog(model_files / "scene.toml", tmp_path / "f.#.png", {"turntable": 2})).inputs[1]
    assert [file.name for file, *_ in log.inputs] == ["scene.toml", "floor.mtl", "floor.obj", "wood.png"]
    wrong = [(path, size, "0" * 32), (path.with_name("gone.png"), 1, xxh3)]
    found = _files.Files([*log.inputs, *wrong], None, False).look(_team.nodes(), log.has_written)
    assert len(found) == 3
    error = _files.complaint(found)
    assert isinstance(error, lightmesh.ray.FilesError)
    for node in _team.nodes():
        assert f"node {node.name}: {path} is another file: its checksum differs" in str(error)
        assert f"node {node.name}: {path.with_name('gone.png')} is missing" in str(error)
    assert "ship=True" in str(error)


def test_nothing_begins_if_files_differ(cluster, model_files, tmp_path, monkeypatch):
    """The leader compares, and then the files change under it."""
    scene = model_files / "scene.toml"
    monkeypatch.setattr(_files.Files, "look", changing(_files.Files.look, model_files / "wood.png"))
    with pytest.raises(lightmesh.ray.FilesError, match=r"node .*wood\.png is another file"):
        lightmesh.ray.film(scene, tmp_path / "f.#.png", turntable=2, **FILM)
    assert not list(tmp_path.glob("*.png"))


def changing(look, path):
    def changed(*arguments):
        path.write_bytes(path.read_bytes() + b"more")
        return look(*arguments)

    return changed


def test_another_version_on_a_node_is_an_error():
    problems, _ = _nodes.problems([], None, "0.0.1")
    assert problems == [f"lightmesh is version {lightmesh.__version__} there, and 0.0.1 here: install the same"]


def test_files_are_sent(cluster, model_files, tmp_path, monkeypatch):
    scene, output = model_files / "scene.toml", tmp_path / "many" / "f.#.png"
    output.parent.mkdir()
    by_one_process(scene, tmp_path / "one" / "f.#.png", {**FILM, "turntable": 3})
    monkeypatch.setattr(_files, "PIECE", 100)
    # Once the files are sent, the scene is gone from its own place: actors cannot but open what they got.
    sending = _files.Files.send
    hidden = tmp_path / "hidden"

    def send(self, nodes):
        wrong = sending(self, nodes)
        model_files.rename(hidden)
        return wrong

    monkeypatch.setattr(_files.Files, "send", send)
    report = lightmesh.ray.film(scene, output, turntable=3, ship=True, **FILM)
    assert report.units == 3 and files(output.parent) == files(tmp_path / "one")
    assert not list(_nodes.folder().glob("*/**/floor.obj")), "what was sent is removed"


def test_what_was_left_long_ago_is_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(_nodes, "folder", lambda: tmp_path / "sent")
    for name in ("old", "new"):
        _nodes.receive(name, "/a/b", "node", b"1", True, False)
        _nodes.receive(name, "/a/b", "node", b"2", False, True)
    os.utime(tmp_path / "sent" / "old", (0, 0))
    _nodes.receive("new", "/a/c", "node", b"", True, True)
    assert not (tmp_path / "sent" / "old").exists() and (tmp_path / "sent" / "new" / "a" / "b").read_bytes() == b"12"
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    with pytest.raises(lightmesh.SaveError, match="belongs to another user"):
        _nodes.receive("new", "/a/d", "node", b"", True, True)


def test_frames_come_to_a_leader_whose_disk_is_its_own(cluster, tmp_path, monkeypatch):
    by_one_process(SCENE, tmp_path / "one" / "f.#.png", {**FILM, "turntable": 3})
    (tmp_path / "many").mkdir()
    monkeypatch.setattr(_files.Files, "sees", lambda *_: False)
    before = set(Path(tempfile.gettempdir()).glob("lightmesh-frames-*"))
    lightmesh.ray.film(SCENE, tmp_path / "many" / "f.#.png", turntable=3, **FILM)
    assert files(tmp_path / "many") == files(tmp_path / "one")
    assert set(Path(tempfile.gettempdir()).glob("lightmesh-frames-*")) == before, "folders of actors are removed"


def test_a_damaged_frame_is_not_published(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    log = _FilmLog(SCENE, tmp_path / "f.#.png", {**FILM, "turntable": 1})
    actor = _actors.Actor(_actors.Job(SCENE, str(tmp_path / "f.#.png"), log.request, _nodes.digest_of_all(log.inputs), "", False, 0.0))
    chosen = actor.run(_units.Choose()).result.text
    log.choose(chosen)
    done = actor.run(_units.Frame(1, chosen))
    assert not (tmp_path / "f.1.png").exists()
    with pytest.raises(lightmesh.SettingError, match="is not as its worker has written it"):
        log.publish(1, done.result.content[:-1], done.result.files)
    log.publish(1, done.result.content, done.result.files)
    log.finished(1, done.result.files)
    log.close()
    assert _FilmLog(SCENE, tmp_path / "f.#.png", {**FILM, "turntable": 1, "resume": True}).numbers == []
