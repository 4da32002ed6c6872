"""The job for Kubernetes that the book shows."""

import json

import pytest
from ray_films import BENCH, command

pytest.importorskip("ray")

import ray

import lightmesh
import lightmesh.ray
from lightmesh.ray import _team

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
