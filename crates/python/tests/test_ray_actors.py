"""What actors own: devices, memory and threads."""

import json

import pytest
from ray_films import SCENE, STORE

pytest.importorskip("ray")

import ray

import lightmesh
import lightmesh.ray
from lightmesh._lightmesh import _BandedPicture
from lightmesh.ray import _actors, _files, _leader, _team


def test_what_an_actor_does_not_own_it_does_not_use():
    job = _actors.Job(SCENE, None, json.dumps({"size": "8x8"}), "", "", False, 0.0)
    assert _actors.Actor(job).request()["device"] == "cpu"
    assert _actors.Actor(_actors.Job(SCENE, None, "{}", "", "", False, 0.5)).request()["device"] == "cuda"
    with pytest.raises(lightmesh.SettingError, match="device='cuda' needs gpus_per_actor"):
        lightmesh.ray.picture(SCENE, device="cuda")
    with pytest.raises(lightmesh.SettingError, match="Ray chooses the GPU of each actor"):
        lightmesh.ray.picture(SCENE, device="cuda:1", gpus_per_actor=1)


def test_a_share_of_a_gpu_has_a_share_of_its_memory(monkeypatch):
    device = {"device": "cuda:0", "usable": True, "memory_bytes": 80_000_000_000}
    monkeypatch.setattr(_actors, "devices", lambda: [{"device": "cpu", "usable": True, "memory_bytes": None}, device])
    request = _actors.Actor(_actors.Job(SCENE, None, "{}", "", "", False, 0.25)).request()
    assert request["memory_limit"] == "20000000000"
    request = _actors.Actor(_actors.Job(SCENE, None, '{"memory_limit": "1G"}', "", "", False, 0.25)).request()
    assert request["memory_limit"] == "1G"


def test_an_actor_has_the_threads_of_its_cpus(cluster):
    node = cluster.add_node(num_cpus=2, object_store_memory=STORE)
    try:
        leader = _leader.Leader(_team.Share(2, 0), None, None, None)
        whole = _BandedPicture(SCENE, None, {"size": (8, 8)})
        files_ = _files.Files(whole.inputs, None, False)
        job = _actors.Job(SCENE, None, whole.request, files_.digest, "", False, 0.0)
        leader.begin(_leader.Setup(files_, lambda _: job, lambda _: False))
        (member,) = leader.team.members
        assert ray.get(member.handle.open.remote(), timeout=60).threads == 2
        leader.close()
    finally:
        cluster.remove_node(node)
