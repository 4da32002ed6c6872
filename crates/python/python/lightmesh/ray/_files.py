"""The files of a scene on the nodes of a cluster: compared before any work begins, and sent if that is asked for."""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import ray
import ray.exceptions

from .. import __version__
from . import _nodes
from ._errors import FilesError, NodeError
from ._team import Node, on

if TYPE_CHECKING:
    from ._team import Call

#: A file is sent in pieces of so many bytes.
PIECE = 32 << 20
#: How long a node may take to compare its files, in seconds, and one more for so many bytes.
PATIENCE = 60.0
RATE = 20e6
#: How often a folder is looked at that a network shows late, and how long is waited in between.
LOOKS = 5
PAUSE = 0.5


@dataclass(frozen=True)
class Found:
    """What a node has."""

    node: Node
    problems: tuple[str, ...]
    #: Whether it sees the folder of the output.
    is_shared: bool


class Files:
    """The files that all nodes need."""

    def __init__(self, inputs: Sequence[_nodes.File], output: Path | None, ship: bool) -> None:
        self.inputs = list(inputs)
        self.digest = _nodes.digest_of_all(self.inputs)
        self.output = output
        #: The name of this run.
        self.run = uuid.uuid4().hex[:12]
        #: A scene without files, such as a built-in one, has nothing to send.
        self.ship = ship and bool(self.inputs)
        #: The name of the folder on the nodes: each run has its own, so that none takes away what another reads.
        self.shipped_as = f"{self.digest}-{self.run}" if self.ship else ""
        self._look = ray.remote(num_cpus=0, max_retries=3)(_nodes.problems)
        self._lacking = ray.remote(num_cpus=0, max_retries=3)(_nodes.lacking)
        self._receive = ray.remote(num_cpus=0, max_retries=0)(_nodes.receive)

    def look(self, nodes: Sequence[Node], has_written: Callable[[str], bool]) -> list[Found]:
        """What nodes have, all at once, but for those that are gone by then. `has_written` knows the seals of the leader's manifest."""
        wrong = self.send(nodes) if self.ship else {}
        # What was sent is compared there when the scene is opened.
        files = [] if self.ship else self.inputs
        patience = PATIENCE + sum(size for _, size, _ in files) / RATE
        # Put into the store once, whatever the number of nodes: the leader lives as long as these calls.
        listed = cast(Any, ray.put(files))
        ask = [self._look.options(scheduling_strategy=on(node)).remote(listed, self.output, __version__) for node in nodes]
        ready, _ = ray.wait(ask, num_returns=len(ask), timeout=patience) if ask else ([], [])
        found: list[Found] = []
        for node, call in zip(nodes, ask):
            if call not in ready:
                ray.cancel(call)
                found.append(Found(node, (f"it did not answer within {patience:.0f} s",), False))
                continue
            try:
                problems, seal = ray.get(call)
            except ray.exceptions.TaskUnschedulableError:
                # It is gone. If it is not, it is looked at again.
                continue
            except (ray.exceptions.RayError, ImportError) as error:
                found.append(Found(node, (reason(error),), False))
            else:
                problems += [wrong[node.id]] if node.id in wrong else []
                found.append(Found(node, tuple(problems), self.sees(node, seal, has_written)))
        return found

    def sees(self, node: Node, seal: str | None, has_written: Callable[[str], bool]) -> bool:
        """Whether a node sees the leader's manifest in the folder of the output."""
        if self.output is None:
            return False
        for _ in range(LOOKS):
            if seal is not None and has_written(seal):
                return True
            if seal is None:
                return False
            time.sleep(PAUSE)
            _, seal = ray.get(self._look.options(scheduling_strategy=on(node)).remote([], self.output, __version__))
        return False

    def send(self, nodes: Sequence[Node]) -> dict[str, str]:
        """Sends each file to the nodes that lack it, read once and piece by piece. Returns what went wrong, by the id of the node."""
        wrong: dict[str, str] = {}
        asked = {node.id: self._lacking.options(scheduling_strategy=on(node)).remote(self.inputs, self.shipped_as) for node in nodes}
        lacks = {node_id: places for node_id, places in self._got(asked, wrong).items() if places}
        by_id = {node.id: node for node in nodes}
        for place, (path, _, _) in enumerate(self.inputs):
            receivers = [node_id for node_id, places in lacks.items() if place in places]
            for number, (content, is_last) in enumerate(pieces(path) if receivers else ()):
                piece = ray.put(content)
                sent = {
                    # Nodes of one machine write apart.
                    node_id: self._receive.options(scheduling_strategy=on(by_id[node_id])).remote(
                        self.shipped_as, str(path), node_id[:8], piece, number == 0, is_last
                    )
                    for node_id in receivers
                    if node_id not in wrong
                }
                self._got(sent, wrong)
        return wrong

    @staticmethod
    def _got(calls: dict[str, Call], wrong: dict[str, str]) -> dict[str, list[int]]:
        """What nodes answer; what goes wrong is noted."""
        answers: dict[str, list[int]] = {}
        for node_id, call in calls.items():
            try:
                answers[node_id] = ray.get(call)
            except ray.exceptions.RayError as error:
                wrong[node_id] = f"files cannot be sent there: {reason(error)}"
        return answers


def pieces(path: Path) -> Iterator[tuple[bytes, bool]]:
    """The content of a file in pieces, each with whether it is the last one. An empty file has one piece."""
    with open(path, "rb") as file:
        content = file.read(PIECE)
        while True:
            following = file.read(PIECE) if content else b""
            yield content, not following
            if not following:
                return
            content = following


def reason(error: BaseException) -> str:
    """What a node says, in one line."""
    text = str(error).strip()
    if "No module named 'lightmesh" in text:
        return f"lightmesh is not installed there: pip install lightmesh[ray]=={__version__}"
    return text.splitlines()[-1] if text else type(error).__name__


def complaint(found: Sequence[Found]) -> NodeError | None:
    """The error of all nodes that cannot take part, if there are any."""
    bad = [node for node in found if node.problems]
    if not bad:
        return None
    lines = [f"node {each.node.name}: {problem}" for each in bad for problem in each.problems]
    is_of_files = all("is missing" in line or "checksum" in line for line in lines)
    if is_of_files:
        return FilesError("; ".join(lines) + "; copy the files there, use a folder that all nodes share, or send them (ship=True)")
    return NodeError("; ".join(lines))
