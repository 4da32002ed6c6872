"""Films and pictures on a Ray cluster of this machine: the files of one process, whatever happens meanwhile."""

import importlib
import json
import os
import pickle
import random
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("ray")

import ray
from ray.cluster_utils import Cluster

import lightmesh
import lightmesh.ray
import lightmesh.typing
from lightmesh._lightmesh import _BandedPicture, _FilmLog, _Worker
from lightmesh.ray import _actors, _errors, _files, _leader, _nodes, _team, _units

#: Tests report to nobody.
os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
BENCH = Path(__file__).resolve().parents[3] / "bench" / "ray"
SCENE = "builtin:gazebo"
FILM = {"size": (48, 36), "quality": "draft"}
STORE = 100_000_000


def command(*arguments):
    subprocess.run([sys.executable, "-m", "lightmesh", *map(str, arguments), "--quiet"], check=True, timeout=300)


def flags(settings):
    text = {name: "x".join(map(str, value)) if isinstance(value, tuple) else str(value) for name, value in settings.items()}
    return [part for name, value in text.items() for part in ([f"--{name}"] if value == "True" else [f"--{name}", value])]


def by_one_process(scene, output, settings):
    output.parent.mkdir(exist_ok=True)
    command("render", scene, "-o", output, "--device", "cpu", *flags(settings))


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def cluster():
    """A head without CPUs, a node with one CPU, and another whose environment limits its memory when a test says so."""
    cluster = Cluster()
    cluster.add_node(num_cpus=0, object_store_memory=STORE, include_dashboard=False)
    for _ in range(2):
        cluster.add_node(num_cpus=1, object_store_memory=STORE)
    ray.init(address=cluster.address, log_to_driver=False)
    yield cluster
    ray.shutdown()
    cluster.shutdown()


@pytest.fixture
def model_files(tmp_path):
    """A scene of several files: TOML, OBJ, MTL and a texture."""
    folder = tmp_path / "scene"
    folder.mkdir()
    lightmesh.Renderer("cpu").render(lightmesh.Scene.builtin(SCENE), size=(8, 8)).save(folder / "wood.png")
    (folder / "floor.mtl").write_text("newmtl wood\nKd 1 1 1\nmap_Kd wood.png\n")
    (folder / "floor.obj").write_text("mtllib floor.mtl\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nvt 0 0\nvt 0 1\nvt 1 1\nusemtl wood\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\n")
    (folder / "scene.toml").write_text('[[mesh]]\nfile = "floor.obj"\n[[light]]\nkind = "sphere"\nposition = [0, 3, 0]\nradius = 0.5\n')
    return folder


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
        arguments = [part.replace("--crop", "--crop=" + settings["crop"]) if part == "--crop" else part for part in flags(settings) if part != settings.get("crop")]
        command("render", SCENE, "-o", one, "--device", "cpu", *arguments)
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
    assert not _nodes.root_of(_nodes.digest_of_all(inputs(hidden))).exists(), "what was sent is removed"


def inputs(folder):
    return [(path, *lightmesh._lightmesh._digest(path)) for path in [folder / "scene.toml", folder / "floor.mtl", folder / "floor.obj", folder / "wood.png"]]


def test_frames_come_to_a_leader_whose_disk_is_its_own(cluster, tmp_path, monkeypatch):
    by_one_process(SCENE, tmp_path / "one" / "f.#.png", {**FILM, "turntable": 3})
    (tmp_path / "many").mkdir()
    monkeypatch.setattr(_files.Files, "sees", lambda *_: False)
    lightmesh.ray.film(SCENE, tmp_path / "many" / "f.#.png", turntable=3, **FILM)
    assert files(tmp_path / "many") == files(tmp_path / "one")


def test_a_damaged_frame_is_not_published(tmp_path):
    log = _FilmLog(SCENE, tmp_path / "f.#.png", {**FILM, "turntable": 1})
    actor = _actors.Actor(_actors.Job(SCENE, str(tmp_path / "f.#.png"), log.request, _nodes.digest_of_all(log.inputs), False, False, 0.0))
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
    assert 1 <= len(failures) <= _leader.MOST_REFUSALS and report.nodes[name].units == 0
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


def test_what_an_actor_does_not_own_it_does_not_use():
    job = _actors.Job(SCENE, None, json.dumps({"size": "8x8"}), "", False, False, 0.0)
    assert _actors.Actor(job).request()["device"] == "cpu"
    assert _actors.Actor(_actors.Job(SCENE, None, "{}", "", False, False, 0.5)).request()["device"] == "cuda"
    with pytest.raises(lightmesh.SettingError, match="device='cuda' needs gpus_per_actor"):
        lightmesh.ray.picture(SCENE, device="cuda")


def test_a_share_of_a_gpu_has_a_share_of_its_memory(monkeypatch):
    device = {"device": "cuda:0", "usable": True, "memory_bytes": 80_000_000_000}
    monkeypatch.setattr(_actors, "devices", lambda: [{"device": "cpu", "usable": True, "memory_bytes": None}, device])
    request = _actors.Actor(_actors.Job(SCENE, None, "{}", "", False, False, 0.25)).request()
    assert request["memory_limit"] == "20000000000"
    request = _actors.Actor(_actors.Job(SCENE, None, '{"memory_limit": "1G"}', "", False, False, 0.25)).request()
    assert request["memory_limit"] == "1G"


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
    line = [sys.executable, "-m", "lightmesh.ray", "film", SCENE, "-o", str(tmp_path / "many" / "f.#.png"), "--address", cluster.address, "--turntable", "2"]
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
            job = _actors.Job(SCENE, str(tmp_path / "f.#.png"), log.request, files_.digest, False, True, 0.0)
            leader.begin(_leader.Setup(files_, job.shared, log.has_written))
            leader.run([Deadly(1, "{}")], lambda *_: None)
        finally:
            leader.close()


class Deadly(_units.Frame):
    """A unit that ends its worker."""

    def __reduce__(self):
        return (deadly, ())


def deadly():
    os._exit(1)


#: What KubeRay's `RayJob` (ray.io/v1) takes of what the example uses, by the names of its definition. Anything else would be dropped without a word.
POD = {
    "type": "object",
    "required": ["spec"],
    "additionalProperties": False,
    "properties": {
        "spec": {
            "type": "object",
            "required": ["containers"],
            "additionalProperties": False,
            "properties": {
                "containers": {
                    "type": "array",
                    "minItems": 1,
                    "items": {
                        "type": "object",
                        "required": ["name", "image", "resources"],
                        "additionalProperties": False,
                        "properties": {
                            "name": {"type": "string", "pattern": "^[a-z0-9]([-a-z0-9]*[a-z0-9])?$"},
                            "image": {"type": "string"},
                            "ports": {"type": "array", "items": {"required": ["containerPort", "name"]}},
                            "resources": {"required": ["requests", "limits"]},
                            "volumeMounts": {"type": "array", "items": {"required": ["name", "mountPath"]}},
                        },
                    },
                },
                "volumes": {"type": "array", "items": {"required": ["name", "persistentVolumeClaim"]}},
            },
        }
    },
}
GROUP = {"rayStartParams": {"type": "object", "additionalProperties": {"type": "string"}}, "template": POD}
COUNT = {"type": "integer", "minimum": 0}
RAYJOB = {
    "type": "object",
    "required": ["apiVersion", "kind", "metadata", "spec"],
    "additionalProperties": False,
    "properties": {
        "apiVersion": {"const": "ray.io/v1"},
        "kind": {"const": "RayJob"},
        "metadata": {"required": ["name"]},
        "spec": {
            "type": "object",
            "required": ["entrypoint", "rayClusterSpec"],
            "additionalProperties": False,
            "properties": {
                "entrypoint": {"type": "string"},
                "backoffLimit": COUNT,
                "shutdownAfterJobFinishes": {"type": "boolean"},
                "ttlSecondsAfterFinished": COUNT,
                "rayClusterSpec": {
                    "type": "object",
                    "required": ["headGroupSpec"],
                    "additionalProperties": False,
                    "properties": {
                        "rayVersion": {"type": "string"},
                        "headGroupSpec": {"type": "object", "required": ["template"], "additionalProperties": False, "properties": GROUP},
                        "workerGroupSpecs": {
                            "type": "array",
                            "items": {
                                "type": "object",
                                "required": ["groupName", "template"],
                                "additionalProperties": False,
                                "properties": {
                                    **GROUP,
                                    "groupName": {"type": "string"},
                                    "replicas": COUNT,
                                    "minReplicas": COUNT,
                                    "maxReplicas": COUNT,
                                },
                            },
                        },
                    },
                },
            },
        },
    },
}


def test_the_job_for_kubernetes(tmp_path):
    """It has the form of a RayJob, its volumes are there, its command is understood, and its actors fit into its pods."""
    jsonschema, yaml = pytest.importorskip("jsonschema"), pytest.importorskip("yaml")
    job = yaml.safe_load((BENCH.parents[1] / "docs" / "ray" / "rayjob.yaml").read_text())
    jsonschema.validate(job, RAYJOB)
    cluster_spec = job["spec"]["rayClusterSpec"]
    assert cluster_spec["rayVersion"] == ray.__version__
    groups = [cluster_spec["headGroupSpec"], *cluster_spec["workerGroupSpecs"]]
    for group in groups:
        pod = group["template"]["spec"]
        (container,) = pod["containers"]
        assert {mount["name"] for mount in container["volumeMounts"]} == {volume["name"] for volume in pod["volumes"]}
    python, _, module, what, *others = job["spec"]["entrypoint"].split()
    assert (python, module, what) == ("python", "lightmesh.ray", "film")
    from lightmesh.ray.__main__ import parser

    own, flags_of_render = parser().parse_known_args([what, *others])
    scene, output, request = lightmesh._lightmesh._parse(flags_of_render)
    mount = groups[1]["template"]["spec"]["containers"][0]["volumeMounts"][0]["mountPath"]
    assert str(scene).startswith(mount) and str(output).startswith(mount) and json.loads(request)["resume"] is True
    cpus = float(groups[1]["template"]["spec"]["containers"][0]["resources"]["limits"]["cpu"])
    assert _team.Share(own.cpus_per_actor, own.gpus_per_actor).count_in({"CPU": cpus}) == 2
    for wrong in ({**job, "kind": "RayCluster"}, {**job, "spec": {**job["spec"], "entryPoint": "python"}}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, RAYJOB)


def test_requests_have_all_settings():
    """What is a parameter of its own, and what is not for many processes, is all that is left out of the annotations."""
    own = {"frames", "partial", "layers"}
    every = {*lightmesh.typing.FilmSettings.__annotations__, *lightmesh.typing.OpenSettings.__annotations__}
    named = {*lightmesh.ray.FilmRequest.__annotations__, *lightmesh.ray.PictureRequest.__annotations__}
    assert every - named == own and named - every == {"accel", "grid", "grid_file", "device", "threads"} - every


def test_an_actor_has_the_threads_of_its_cpus(cluster):
    node = cluster.add_node(num_cpus=2, object_store_memory=STORE)
    try:
        leader = _leader.Leader(_team.Share(2, 0), None, None, None)
        whole = _BandedPicture(SCENE, None, {"size": (8, 8)})
        files_ = _files.Files(whole.inputs, None, False)
        job = _actors.Job(SCENE, None, whole.request, files_.digest, False, False, 0.0)
        leader.begin(_leader.Setup(files_, lambda _: job, lambda _: False))
        (member,) = leader.team.members
        assert ray.get(member.handle.open.remote(), timeout=60).threads == 2
        leader.close()
    finally:
        cluster.remove_node(node)
