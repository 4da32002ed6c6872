"""What tests share: a small scene of arrays, and a renderer on the CPU."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import lightmesh

#: Corners of a cube of side 1 around the origin, and its triangles, counterclockwise seen from outside.
CUBE = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], np.float32)
CUBE_TRIANGLES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
)
SIZE = (64, 48)


def at(x: float, y: float, z: float) -> np.ndarray:
    """The transform that moves to this place."""
    transform = np.eye(4)
    transform[:3, 3] = (x, y, z)
    return transform


def floor(side: float = 6.0) -> lightmesh.Geometry:
    """A square in the plane y = 0, that faces up."""
    half = side / 2.0
    corners = np.array([(-half, 0, -half), (-half, 0, half), (half, 0, half), (half, 0, -half)], np.float32)
    return lightmesh.Geometry.from_arrays(corners, [(0, 1, 2), (0, 2, 3)], material=lightmesh.Material(0.7, name="stone"), name="floor")


def cube(material: lightmesh.Material | None = None) -> lightmesh.Geometry:
    """A cube that floats above the middle of the floor."""
    clay = material or lightmesh.Material.principled((0.8, 0.3, 0.2), roughness=1.0, name="clay")
    return lightmesh.Geometry.from_arrays(CUBE, CUBE_TRIANGLES, material=clay, transforms=at(0.0, 1.0, 0.0), name="cube")


def camera() -> lightmesh.Camera:
    return lightmesh.Camera((4.0, 3.0, 5.0), (0.0, 0.7, 0.0))


@pytest.fixture
def scene() -> lightmesh.Scene:
    """A cube above a floor, lit from a ball."""
    return lightmesh.Scene([floor(), cube()], [lightmesh.Light.sphere((2.0, 4.0, 1.0), 0.5)], camera(), name="cube")


@pytest.fixture(scope="session")
def renderer() -> lightmesh.Renderer:
    return lightmesh.Renderer("cpu")


@pytest.fixture
def model() -> Callable[[str], Path]:
    """The path of a file of the shared scenes; the test is skipped where they are not there."""
    folder = Path(__file__).resolve().parents[4] / "shared" / "scenes"

    def find(path: str) -> Path:
        if not folder.is_dir():
            pytest.skip(f"{folder} does not exist")
        return folder / path

    return find


@pytest.fixture(scope="session")
def cluster():
    """A Ray cluster of this machine: a head without CPUs, and two nodes with one each."""
    ray = pytest.importorskip("ray")
    from ray.cluster_utils import Cluster

    # Tests report to nobody.
    os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
    cluster = Cluster()
    cluster.add_node(num_cpus=0, object_store_memory=100_000_000, include_dashboard=False)
    for _ in range(2):
        cluster.add_node(num_cpus=1, object_store_memory=100_000_000)
    ray.init(address=cluster.address, log_to_driver=False)
    yield cluster
    ray.shutdown()
    cluster.shutdown()
