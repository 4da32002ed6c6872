"""The actors of a run: one for each share of each node. Nodes and actors come and go; what they hold is handed to others.

Each actor belongs to one node, where Ray restarts it as often as its process dies. With its node it is gone, and a new node gets actors of its own.
"""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

import ray
import ray.exceptions
from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

from . import _nodes
from ._actors import Job, Opened, RemoteActor
from ._errors import ClusterError
from ._queue import Worker
from ._units import Unit

if TYPE_CHECKING:
    #: A call that is under way.
    Call = ray.ObjectRef[Any]

logger = logging.getLogger("lightmesh.ray")

#: How often nodes are looked at, and how soon a lost actor is asked again, in seconds.
LOOK = 1.0
AGAIN = 0.2


class Method(Protocol):
    """A method of an actor."""

    def remote(self, *arguments: object) -> Call:
        """Calls it."""
        ...


class Handle(Protocol):
    """An actor, from afar."""

    open: Method
    run: Method


@dataclass(frozen=True)
class Share:
    """What an actor gets of a node."""

    cpus: float
    gpus: float

    def count_in(self, resources: dict[str, float]) -> int:
        """How many actors a node holds."""
        of = [int(resources.get(name, 0.0) / share + 1e-9) for name, share in (("CPU", self.cpus), ("GPU", self.gpus)) if share > 0]
        return min(of, default=0)


@dataclass(frozen=True)
class Node:
    """A node of the cluster."""

    id: str
    #: Its address and the beginning of its id.
    name: str
    resources: dict[str, float]


def nodes() -> list[Node]:
    """The nodes that are alive."""
    every = cast("list[dict[str, Any]]", cast(Any, ray).nodes())
    alive = [node for node in every if node["Alive"]]
    return [Node(node["NodeID"], f"{node['NodeManagerAddress']} ({node['NodeID'][:6]})", node["Resources"]) for node in alive]


def on(node: Node) -> NodeAffinitySchedulingStrategy:
    """Where a task or an actor of this node runs."""
    return NodeAffinitySchedulingStrategy(node.id, soft=False)


@dataclass(eq=False)
class Member:
    """An actor."""

    handle: Handle
    node: Node
    worker: Worker
    #: The call that opens the scene, while it is under way; then what it returned.
    opening: Call | None = None
    opened: Opened | None = None
    #: When it is asked again, if it was lost.
    retry: float = 0.0
    pause: float = AGAIN
    #: The calls that it has, and their units.
    calls: dict[Call, Unit] = field(default_factory=dict)


class Team:
    """All actors of a run."""

    def __init__(self, share: Share, limit: int | None) -> None:
        self.share = share
        self.limit = limit
        self.members: list[Member] = []
        #: Nodes that take part, that were looked at and do not, and processes that actors had, by node.
        self.nodes: dict[str, Node] = {}
        self.refused: set[str] = set()
        self.pids: dict[str, set[int]] = {}
        self._next_look = 0.0

    def candidates(self) -> list[Node]:
        """Nodes with room for an actor that have not been looked at."""
        known = self.nodes.keys() | self.refused
        return [node for node in nodes() if node.id not in known and self.share.count_in(node.resources)]

    def is_time(self) -> bool:
        """Whether to look at the nodes again."""
        if time.monotonic() < self._next_look:
            return False
        self._next_look = time.monotonic() + LOOK
        return True

    def admit(self, node: Node, job: Job) -> None:
        """A node takes part: it gets actors, as many as it holds."""
        self.nodes[node.id] = node
        for _ in range(self.share.count_in(node.resources)):
            if self.limit is not None and len(self.members) >= self.limit:
                break
            start = cast(Any, RemoteActor).options(num_cpus=self.share.cpus, num_gpus=self.share.gpus, scheduling_strategy=on(node))
            handle = cast(Handle, start.remote(job))
            member = Member(handle, node, Worker(f"{node.name}#{len(self.members)}", node.id))
            member.opening = handle.open.remote()
            self.members.append(member)
        logger.info("node %s joins", node.name)

    def forget_dead(self) -> list[Member]:
        """The actors of nodes that are gone; they are no longer members."""
        alive = {node.id for node in nodes()}
        gone = [member for member in self.members if member.node.id not in alive]
        for node in [node for node in self.nodes.values() if node.id not in alive]:
            logger.warning("node %s is gone", node.name)
            del self.nodes[node.id]
        self.members = [member for member in self.members if member.node.id in alive]
        return gone

    def expel(self, node_id: str) -> list[Member]:
        """A node takes part no longer; returns its actors."""
        self.refused.add(node_id)
        self.nodes.pop(node_id, None)
        gone = [member for member in self.members if member.node.id == node_id]
        self.members = [member for member in self.members if member.node.id != node_id]
        for member in gone:
            ray.kill(cast(Any, member.handle))
        return gone

    def lose(self, member: Member) -> None:
        """An actor's process has died: it is asked again soon."""
        member.calls.clear()
        member.opening, member.opened = None, None
        member.pause = AGAIN
        member.retry = time.monotonic() + member.pause

    def wait_longer(self, member: Member) -> None:
        """An actor is not back yet."""
        member.opening = None
        member.pause = min(2 * member.pause, LOOK)
        member.retry = time.monotonic() + member.pause

    def ask_again(self) -> None:
        """Asks actors whose process died to open the scene."""
        for member in self.members:
            if member.opening is None and member.opened is None and time.monotonic() >= member.retry:
                member.opening = member.handle.open.remote()

    def ready(self) -> list[Member]:
        """Actors that have opened the scene."""
        return [member for member in self.members if member.opened is not None]

    def workers(self) -> list[Worker]:
        """The same as the queue knows them."""
        return [member.worker for member in self.ready()]

    def calls(self) -> dict[Call, Member]:
        """All calls that are under way."""
        return dict(self._calls())

    def _calls(self) -> Iterator[tuple[Call, Member]]:
        for member in self.members:
            if member.opening is not None:
                yield member.opening, member
            for call in member.calls:
                yield call, member

    def note_process(self, member: Member, pid: int) -> None:
        """An actor runs in this process, whose traces are removed in the end."""
        self.pids.setdefault(member.node.id, set()).add(pid)

    def close(self, output: Path | None, shipped_as: str, run: str) -> None:
        """Ends all actors, and cleans up on every node that is there."""
        try:
            self._end(output, shipped_as, run)
        except ray.exceptions.RayError as error:
            # What ended the run is told, not that its cluster is gone.
            logger.warning("the cluster cannot be cleaned up: %s", error)
        _nodes.clean(output, [], "", run)

    def _end(self, output: Path | None, shipped_as: str, run: str) -> None:
        calls_left = list(self.calls())
        for member in self.members:
            ray.kill(cast(Any, member.handle))
        self.members = []
        if calls_left:
            # They end with their actors: then nobody writes any more, nor does one that was still opening the scene.
            ray.wait(calls_left, num_returns=len(calls_left), timeout=_nodes.PATIENCE)
        clean = ray.remote(num_cpus=0, max_retries=0)(_nodes.clean)
        calls = [
            clean.options(scheduling_strategy=on(node)).remote(output, sorted(self.pids.get(node.id, ())), shipped_as, run)
            for node in nodes()
            if node.id in self.pids or node.id in self.nodes
        ]
        if calls:
            ray.wait(calls, num_returns=len(calls), timeout=2 * _nodes.PATIENCE)


def connect(address: str | None) -> None:
    """Connects to a cluster; the one that the program is connected to stays."""
    if not ray.is_initialized():
        address = address or os.environ.get("RAY_ADDRESS")
        try:
            ray.init(address=address, log_to_driver=True, logging_level=logging.WARNING)
        except (ConnectionError, ray.exceptions.AuthenticationError) as error:
            where = f"at {address}" if address else "on this machine"
            remedy = "check that it runs (ray status), its address, and its token if it asks for one (RAY_AUTH_MODE=token)"
            raise ClusterError(f"cannot connect to the cluster {where}: {error}; {remedy}") from error
