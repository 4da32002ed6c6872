"""A program that uses every public name of `lightmesh.ray`, for type checkers: `test_ray_types.py` fails if it lacks one. It is never run."""

from typing_extensions import assert_type

import lightmesh
import lightmesh.ray
from lightmesh.ray import ClusterError, Failure, FilesError, FilmRequest, NodeError, NodeReport, PictureRequest, Progress, Report


def follow(progress: Progress) -> None:
    assert_type(progress.done, float)
    assert_type(progress.seconds, float)
    assert_type(progress.left, float | None)
    assert_type(progress.units, int)
    assert_type(progress.total, int)
    assert_type(progress.actors, int)
    assert_type(progress.stage, str)


def tell(report: Report) -> None:
    assert_type(report.units, int)
    assert_type(report.kept, int)
    assert_type(report.retries, int)
    assert_type(report.copies, int)
    assert_type(report.seconds, float)
    assert_type(report.leading, float)
    assert_type(report.nodes, dict[str, NodeReport])
    assert_type(report.failures, list[Failure])
    assert_type(report.notes, list[str])
    assert_type(report.image, lightmesh.Frame | None)


def tell_of_node(node: NodeReport, failure: Failure) -> None:
    assert_type(node.units, int)
    assert_type(node.render, float)
    assert_type(node.write, float)
    assert_type(node.actors, int)
    assert_type(node.speed, float)
    assert_type(failure.node, str)
    assert_type(failure.unit, str)
    assert_type(failure.message, str)


def render() -> None:
    request: FilmRequest = {"turntable": 48, "size": (640, 360), "resume": True, "camera": "0,2,5;0,1,0;45", "light": ["1,2,3"]}
    film = lightmesh.ray.film(
        "a.toml",
        "f.##.png",
        frames=[1, 2],
        address="127.0.0.1:6379",
        cpus_per_actor=2,
        gpus_per_actor=0.5,
        actors=3,
        ship=True,
        on_progress=follow,
        **request,
    )
    assert_type(film, Report)
    part: PictureRequest = {"quality": "final", "exposure": "auto"}
    picture = lightmesh.ray.picture(
        "a.toml", None, address=None, cpus_per_actor=1, gpus_per_actor=0, actors=None, ship=False, resume=True, on_progress=follow, **part
    )
    assert_type(picture, Report)
    kinds: list[type[lightmesh.LightmeshError]] = [ClusterError, NodeError, FilesError]
    print(kinds)
