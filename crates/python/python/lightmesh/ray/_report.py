"""What is told of a run: while it lasts, and in the end."""

from __future__ import annotations

from dataclasses import dataclass, field

from ray.util import metrics

from .._lightmesh import Frame


@dataclass(frozen=True)
class Progress:
    """How far a run has come, over the whole cluster."""

    #: The share of all work that is done, from 0 to 1; it never falls.
    done: float
    #: Since the beginning.
    seconds: float
    #: Seconds that remain at the speed of all actors together, if that can be told.
    left: float | None
    #: Units that are finished, and all.
    units: int
    total: int
    #: Actors that are ready.
    actors: int
    #: What is being done: `rendering`, or `waiting` while no actor is ready.
    stage: str


@dataclass(frozen=True)
class Failure:
    """Something that went wrong on a node and was mended elsewhere, or not."""

    node: str
    #: What it happened to; empty if it is about the node as a whole.
    unit: str
    #: What the node says.
    message: str


@dataclass
class NodeReport:
    """What a node did."""

    #: Units whose result was taken.
    units: int = 0
    #: Seconds that their images and their files took, summed over its actors.
    render: float = 0.0
    write: float = 0.0
    #: The most actors that it had at a time.
    actors: int = 0

    @property
    def speed(self) -> float:
        """Units in a second of one actor; 0 if it finished none."""
        return self.units / (self.render + self.write) if self.render + self.write > 0.0 else 0.0


@dataclass
class Report:
    """What was done, by whom."""

    #: Units that were finished in this run, and those that were there before.
    units: int = 0
    kept: int = 0
    #: Units that were handed out again because a worker was lost or had no memory, and second copies of the last ones.
    retries: int = 0
    copies: int = 0
    #: The whole run, in seconds, and the leader's part of it: what it computed and wrote itself.
    seconds: float = 0.0
    leading: float = 0.0
    #: By the address of the node and the beginning of its id.
    nodes: dict[str, NodeReport] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)
    #: What was chosen, corrected or guessed, as sentences.
    notes: list[str] = field(default_factory=list)
    #: The picture, if it was not written.
    image: Frame | None = None

    def __str__(self) -> str:
        kept = f", {self.kept} kept" if self.kept else ""
        lines = [f"{self.units} units{kept}: {self.seconds:.3f} s, {self.retries} handed out again, {self.copies} copies"]
        for name, node in sorted(self.nodes.items()):
            lines.append(f"  node {name}: {node.units} units by {node.actors} actors, {node.speed:.3g} per second and actor")
        lines += [f"  failed on node {failure.node}: {failure.unit or 'the node'}: {failure.message}" for failure in self.failures]
        return "\n".join(lines)


class Metrics:
    """Numbers for Ray's dashboard and for Prometheus."""

    def __init__(self) -> None:
        self.units = metrics.Counter("lightmesh_units", "Units of work that are finished.", ("node",))
        self.failures = metrics.Counter("lightmesh_failures", "Units that came to nothing on a node, and workers that were lost.", ("node",))
        self.seconds = metrics.Histogram("lightmesh_unit_seconds", "Seconds of a unit.", [0.01, 0.1, 1.0, 10.0, 100.0, 1000.0], ("node",))
        self.left = metrics.Gauge("lightmesh_units_left", "Units that are not finished.")
        self.actors = metrics.Gauge("lightmesh_actors", "Actors that are ready.")
