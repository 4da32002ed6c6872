"""What goes wrong on a Ray cluster, and what comes and goes: the film is that of one process nevertheless."""

import importlib
import os
import pickle
import random
import sys
import time

import pytest
from ray_films import BENCH, FILM, SCENE, STORE, by_one_process, files

pytest.importorskip("ray")

import lightmesh
import lightmesh.ray
from lightmesh._lightmesh import _FilmLog
from lightmesh.ray import _actors, _errors, _files, _films, _leader, _team, _units


def waiting_for(actors):
    """A callback that holds the leader up until there are so many actors: meanwhile those that are there finish what they hold, and no more."""
    return lambda progress: time.sleep(0.5 if progress.actors < actors else 0.0)


def test_a_node_without_memory_leaves_its_units_to_others(cluster, tmp_path):
    by_one_process(SCENE, tmp_path / "one" / "f.##.png", {**FILM, "turntable": 12})
    (tmp_path / "many").mkdir()
    small = cluster.add_node(num_cpus=1, object_store_memory=STORE, env_vars={_actors.MEMORY_LIMIT: "1M"})
    try:
        report = lightmesh.ray.film(SCENE, tmp_path / "many" / "f.##.png", turntable=12, on_progress=waiting_for(3), **FILM)
    finally:
        cluster.remove_node(small)
    assert files(tmp_path / "many") == files(tmp_path / "one")
    failures = [failure for failure in report.failures if "memory" in failure.message]
    (name,) = {failure.node for failure in failures}
    # Of the two units that an actor holds, one may be refused after the node was given up.
    assert 1 <= len(failures) <= _leader.MOST_REFUSALS + 1 and report.nodes[name].units == 0
    with pytest.raises(lightmesh.HostMemoryError, match="on node .*memory"):
        lightmesh.ray.film(SCENE, tmp_path / "f.#.png", turntable=4, memory_limit="1M", **FILM)


def test_a_node_that_joins_late_is_used(cluster, tmp_path):
    joined = []

    def join(progress):
        time.sleep(0.5 if progress.actors < 3 else 0.0)
        if not joined:
            joined.append(cluster.add_node(num_cpus=1, object_store_memory=STORE))

    before = {node.id for node in _team.nodes()}
    report = lightmesh.ray.film(SCENE, tmp_path / "f.###.png", turntable=600, frames="1-40", on_progress=join, **FILM)
    (late,) = [node.name for node in _team.nodes() if node.id not in before]
    cluster.remove_node(joined[0])
    assert report.units == 40 and report.nodes[late].units > 0


def test_kills(tmp_path):
    """Five kills of actors, nodes and leaders, as `bench/ray/kills.py` has them by the dozen."""
    sys.path.insert(0, str(BENCH))
    kills = importlib.import_module("kills")
    settings = {"turntable": 60, "size": "128x96", "seed": 3}
    want = kills.expected(tmp_path / "one", "film", settings)
    (tmp_path / "many").mkdir()
    machine = kills.Machine()
    try:
        trial = kills.Trial(machine, "film", settings, tmp_path / "many", random.Random(5))
        report = trial.run(["worker", "node", "worker", "leader", "worker"], 0.0, (0.0, 0.3), patience=100)
    finally:
        machine.close()
    assert trial.check(want) == []
    assert sum(trial.killed.values()) == 5, report


def test_what_a_trial_finds(tmp_path):
    """The test above can fail."""
    sys.path.insert(0, str(BENCH))
    kills = importlib.import_module("kills")
    for name in ("one", "many"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a").write_text(name)
    (tmp_path / "many" / ".lightmesh-1.tmp").write_text("")
    trial = object.__new__(kills.Trial)
    trial.folder, trial.units, trial.hits = tmp_path / "many", {1: ["frame 1"] * 3, 2: ["frame 2"] * 3}, {"frame 1": 1, "frame 2": 0}
    assert trial.check(tmp_path / "one") == [".lightmesh-1.tmp is left over", "a differs", "frame 2 was rendered 3 times, and 0 kills hit it"]


def errors(module):
    return [thing for thing in vars(module).values() if isinstance(thing, type) and issubclass(thing, lightmesh.LightmeshError)]


@pytest.mark.parametrize("kind", {*errors(lightmesh), *errors(_errors)}, ids=lambda kind: kind.__name__)
def test_exceptions_survive_pickling(kind):
    error = pickle.loads(pickle.dumps(kind("what, where, and what to do")))
    assert type(error) is kind and str(error) == "what, where, and what to do"
    placed = _errors.on_node(error, "frame 3", "10.0.0.1")
    assert type(placed) is kind and str(placed) == "frame 3 on node 10.0.0.1: what, where, and what to do"


def test_failures_reach_the_metrics():
    metrics = lightmesh.ray._report.Metrics()
    names = {metric.info["name"] for metric in vars(metrics).values()}
    assert names == {"lightmesh_units", "lightmesh_failures", "lightmesh_unit_seconds", "lightmesh_units_left", "lightmesh_actors"}


def test_a_unit_that_kills_its_workers_is_given_up(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(_leader, "MOST_LOSSES", 2)
    leader = _leader.Leader(_team.Share(1, 0), None, None, None)
    with pytest.raises(lightmesh.ray.ClusterError, match="frame 1: 2 workers were lost while they rendered it"):
        try:
            log = _FilmLog(SCENE, tmp_path / "f.#.png", {**FILM, "turntable": 1})
            files_ = _files.Files(log.inputs, tmp_path / "f.#.png", False)
            job = _actors.Job(SCENE, str(tmp_path / "f.#.png"), log.request, files_.digest, "", True, 0.0)
            leader.begin(_leader.Setup(files_, job.shared, log.has_written))
            leader.run([Deadly(1, "{}")], lambda *_: None)
        finally:
            leader.close()


class Deadly(_units.Frame):
    """A unit that ends its worker."""

    def __reduce__(self):
        return (os._exit, (1,))


def test_a_cluster_that_is_not_there(monkeypatch):
    def refuse(**_):
        raise ConnectionError("nobody answers")

    monkeypatch.setattr(_team.ray, "is_initialized", lambda: False)
    monkeypatch.setattr(_team.ray, "init", refuse)
    with pytest.raises(lightmesh.ray.ClusterError, match="cannot connect to the cluster at 10.0.0.1:6379: nobody answers; check that it runs"):
        _team.connect("10.0.0.1:6379")


class Full:
    """A log on a disk that is full."""

    def finished(self, number, files):
        raise lightmesh.SaveError(f"frame {number} cannot be recorded")


def test_what_cannot_be_recorded_ends_the_film():
    written = _units.Written("[]", None)
    with pytest.raises(lightmesh.SaveError, match="frame 1 cannot be recorded"), _films.Recorder(Full()) as recorder:
        recorder.take(_units.Frame(1, "{}"), written)
        while not recorder.calls[0].done():
            time.sleep(0.01)
        recorder.take(_units.Frame(2, "{}"), written)
        raise AssertionError("the next frame is not taken")
    with pytest.raises(lightmesh.SaveError, match="frame 3 cannot be recorded"), _films.Recorder(Full()) as recorder:
        recorder.take(_units.Frame(3, "{}"), written)
