"""Which unit is whose: the queue of units, without Ray, processes or clocks. `bench/ray/simulate.py` runs it in simulated time.

1. A worker that holds fewer than two units gets the next one: one is rendered while the other waits, and no worker waits for the leader.
2. The last units, as many as there are workers, are not handed out in advance.
3. When none is left, a worker without any gets a copy of the one that will be finished last. No unit has more than two copies, and the first
   result wins.
4. What a lost worker held goes to the front. What a node has no memory for goes elsewhere.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from itertools import islice

from ._units import Unit

#: Units that a worker holds, at most.
DEPTH = 2
#: Copies of a unit that are out at a time, at most.
COPIES = 2
#: So many units, those that were handed out first, are looked at for a copy: whoever is slow has held them longest.
CANDIDATES = 64


@dataclass(eq=False)
class Worker:
    """A worker as the queue knows it."""

    name: str
    node: str
    #: Units that it holds, in their order, with the time of handing out.
    held: dict[str, float] = field(default_factory=dict)
    #: Since when it has worked on the first of them.
    since: float = 0.0
    #: What it has done: weight, and the seconds that this took.
    weight: float = 0.0
    seconds: float = 0.0

    def expected(self, unit: Unit, units: dict[str, Unit], usual: float) -> float:
        """When a unit that it holds will be finished, if a unit of weight 1 takes `usual` seconds where nothing is known."""
        pace = self.seconds / self.weight if self.weight else usual
        until = self.since
        for name in self.held:
            until += pace * units[name].weight
            if name == unit.name:
                break
        return until


class Queue:
    """The units of a run."""

    def __init__(self, units: Iterable[Unit]) -> None:
        self.units = {unit.name: unit for unit in units}
        self.total = sum(unit.weight for unit in self.units.values())
        self.finished: set[str] = set()
        self.weight_done = 0.0
        #: Units that were handed out again because a worker was lost, and copies.
        self.retries = 0
        self.copies = 0
        #: How many workers were lost while they rendered a unit.
        self.losses: dict[str, int] = {}
        #: Nodes that a unit is not given to again.
        self.refused: dict[str, set[str]] = {}
        self._waiting = deque(self.units)
        self._holders: dict[str, list[Worker]] = {}
        #: Units that one worker holds, in the order of their handing out.
        self._alone: dict[str, None] = {}

    @property
    def is_finished(self) -> bool:
        """Whether all units are."""
        return len(self.finished) == len(self.units)

    @property
    def left(self) -> int:
        """How many units are not finished."""
        return len(self.units) - len(self.finished)

    def take(self, worker: Worker, workers: Collection[Worker], now: float) -> Unit | None:
        """The unit that a worker gets now, if it gets one."""
        if len(worker.held) >= DEPTH:
            return None
        if worker.held and len(self._waiting) <= len(workers):
            return None
        name = self._next(worker.node)
        if name is None and not worker.held:
            name = self._slowest(worker, workers)
            self.copies += name is not None
        if name is None:
            return None
        if not worker.held:
            worker.since = now
        worker.held[name] = now
        self._holders.setdefault(name, []).append(worker)
        self._count(name)
        return self.units[name]

    def done(self, unit: Unit, worker: Worker, now: float) -> bool:
        """A worker has finished a unit; whether it is the first that has."""
        worker.weight += unit.weight
        worker.seconds += now - worker.since
        self._release(unit.name, worker, now)
        if unit.name in self.finished:
            return False
        self.finished.add(unit.name)
        self._count(unit.name)
        self.weight_done += unit.weight
        return True

    def cancelled(self, unit: Unit, worker: Worker, now: float) -> None:
        """A worker has let go of a unit that another has finished."""
        self._release(unit.name, worker, now)

    def refuse(self, unit: Unit, worker: Worker, now: float) -> None:
        """A unit cannot be done on a worker's node: others get it."""
        self.refused.setdefault(unit.name, set()).add(worker.node)
        self._release(unit.name, worker, now)
        self._again(unit.name)

    def lost(self, worker: Worker) -> list[Unit]:
        """A worker is lost with what it held; returns that."""
        held = [self.units[name] for name in worker.held]
        for position, unit in enumerate(held):
            self._release(unit.name, worker, 0.0)
            if unit.name not in self.finished and position == 0:
                self.losses[unit.name] = self.losses.get(unit.name, 0) + 1
        # The first one stays the first.
        for unit in reversed(held):
            self._again(unit.name)
        return held

    def can_go_to(self, unit: Unit, nodes: Iterable[str]) -> bool:
        """Whether a unit can be done on one of these nodes."""
        refused = self.refused.get(unit.name, set())
        return any(node not in refused for node in nodes)

    def copies_of(self, unit: Unit) -> list[Worker]:
        """The workers that hold a unit."""
        return list(self._holders.get(unit.name, []))

    def _next(self, node: str) -> str | None:
        for _ in range(len(self._waiting)):
            name = self._waiting.popleft()
            if name in self.finished:
                continue
            if node not in self.refused.get(name, ()):
                return name
            self._waiting.append(name)
        return None

    def _slowest(self, worker: Worker, workers: Iterable[Worker]) -> str | None:
        usual = self.pace(workers) if self._alone else 1.0
        last: tuple[float, str] | None = None
        for name in islice(self._alone, CANDIDATES):
            if worker.node in self.refused.get(name, ()):
                continue
            until = self._holders[name][0].expected(self.units[name], self.units, usual)
            if last is None or until > last[0]:
                last = (until, name)
        return last[1] if last else None

    @staticmethod
    def pace(workers: Iterable[Worker]) -> float:
        """Seconds for a weight of 1, over all workers; 1 if nothing is known."""
        known = [worker for worker in workers if worker.weight]
        return sum(worker.seconds for worker in known) / sum(worker.weight for worker in known) if known else 1.0

    def _release(self, name: str, worker: Worker, now: float) -> None:
        if next(iter(worker.held), None) == name:
            worker.since = now
        worker.held.pop(name, None)
        holders = self._holders.get(name, [])
        if worker in holders:
            holders.remove(worker)
        if not holders:
            self._holders.pop(name, None)
        self._count(name)

    def _count(self, name: str) -> None:
        """Notes whether a unit may get a copy."""
        if name not in self.finished and len(self._holders.get(name, ())) == 1 < COPIES:
            self._alone.setdefault(name)
        else:
            self._alone.pop(name, None)

    def _again(self, name: str) -> None:
        if name in self.finished or self._holders.get(name) or name in self._waiting:
            return
        self.retries += 1
        self._waiting.appendleft(name)
