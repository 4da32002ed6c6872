"""What goes wrong on a cluster and nowhere else."""

from __future__ import annotations

from .._errors import LightmeshError


class ClusterError(LightmeshError):
    """The cluster cannot do the work: no node holds an actor, or a unit ends every worker that renders it."""


class NodeError(ClusterError):
    """A node cannot take part: Lightmesh is missing there, or is another version."""


class FilesError(NodeError):
    """A node lacks files of the scene, or has others under their names."""


def on_node(error: LightmeshError, unit: str, node: str) -> LightmeshError:
    """The error of a node, of the same class, with its place."""
    return type(error)(f"{unit} on node {node}: {error}")
