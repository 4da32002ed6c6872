"""The leader of a run: hands units to actors, takes results, and tells of progress, until all units are finished, whoever dies meanwhile."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ray
import ray.exceptions

from .._errors import DeviceError, HostMemoryError, LightmeshError
from ._actors import Job, Opened
from ._errors import ClusterError, on_node
from ._files import Files, Found, complaint, reason
from ._queue import Queue
from ._report import Failure, Metrics, NodeReport, Progress, Report
from ._team import Member, Node, Share, Team, connect
from ._units import Chosen, Done, Failed, Result, Unit

if TYPE_CHECKING:
    from ._team import Call

logger = logging.getLogger("lightmesh.ray")

#: How long results are waited for at once, in seconds.
TICK = 0.2
#: How long a run waits for a node that can hold an actor.
PATIENCE = 120.0
#: A unit that so many workers did not survive is not tried again.
MOST_LOSSES = 12
#: A node that has no memory for so many units is left alone.
MOST_REFUSALS = 3

#: Sentences of a report, at most: frames may each have their own.
MOST_NOTES = 50

OnProgress = Callable[[Progress], object]
#: Takes the result of a unit, the first that comes.
Take = Callable[[Unit, Result], None]


@dataclass(frozen=True)
class Setup:
    """What nodes are looked at with, and what their actors get."""

    files: Files
    #: The job of actors that share the folder of the output, or do not.
    job: Callable[[bool], Job]
    #: Whether the leader's manifest was lately written with a seal.
    has_written: Callable[[str], bool]


class Leader:
    """Leads the actors of one film or picture."""

    def __init__(self, share: Share, limit: int | None, address: str | None, on_progress: OnProgress | None) -> None:
        connect(address)
        self.team = Team(share, limit)
        self.report = Report()
        self.metrics = Metrics()
        self.on_progress = on_progress
        self.start = time.monotonic()
        self.queue = Queue([])
        #: How many units there will be.
        self.planned = 0
        self._progress = 0.0
        self._shares = (0.0, 1.0)
        #: How many units each node had no memory for.
        self._refusals: dict[str, int] = {}
        self._setup: Setup | None = None
        #: New nodes are looked at beside the work.
        self._beside = ThreadPoolExecutor(1)
        self._looks: list[Future[list[Found]]] = []

    def begin(self, setup: Setup) -> None:
        """Looks at all nodes, and starts actors. Raises what is wrong with any of them."""
        self._setup = setup
        found: list[Found] = []
        while not found:
            found = setup.files.look(self._wait_for_nodes(), setup.has_written)
        error = complaint(found)
        if error is not None:
            raise error
        for each in found:
            self._admit(each)

    def run(self, units: Iterable[Unit], take: Take, shares: tuple[float, float] = (0.0, 1.0)) -> None:
        """Does all units; `take` gets the result of each once. Progress goes from the first share to the second."""
        self.queue, self._shares = Queue(units), shares
        ready_at = time.monotonic()
        while not self.queue.is_finished:
            begin = time.perf_counter()
            self._look_around()
            self._hand_out()
            self.report.leading += time.perf_counter() - begin
            calls = self.team.calls()
            if self.team.ready():
                ready_at = time.monotonic()
            elif time.monotonic() - ready_at > PATIENCE:
                raise ClusterError(f"no actor has been ready for {PATIENCE:.0f} s; {self._needed()}")
            ready = self._wait(list(calls))
            begin = time.perf_counter()
            for call in ready:
                self._settle(calls[call], call, take)
            self._tell()
            self.report.leading += time.perf_counter() - begin
        self.report.retries += self.queue.retries
        self.report.copies += self.queue.copies

    def most_actors(self) -> int:
        """How many actors the nodes hold that take part."""
        return max(len(self.team.members), 1)

    def close(self) -> Report:
        """Ends the actors, also those that still render copies, and cleans up."""
        self._beside.shutdown(wait=False, cancel_futures=True)
        files = None if self._setup is None else self._setup.files
        if files is None:
            self.team.close(None, "", "")
        else:
            self.team.close(files.output, files.shipped_as, files.run)
        self.report.seconds = time.monotonic() - self.start
        return self.report

    def _wait(self, calls: list[Call]) -> list[Call]:
        if not calls:
            time.sleep(TICK / 4)
            return []
        ready, _ = ray.wait(calls, num_returns=1, timeout=TICK)
        return ray.wait(calls, num_returns=len(calls), timeout=0)[0] if ready else []

    def _needed(self) -> str:
        share = self.team.share
        gpus = f" and {share.gpus:g} GPUs" if share.gpus else ""
        return f"nodes with {share.cpus:g} CPUs{gpus} for each actor are needed (cpus_per_actor, gpus_per_actor)"

    def _wait_for_nodes(self) -> list[Node]:
        end = time.monotonic() + PATIENCE
        while not (candidates := self.team.candidates()):
            if time.monotonic() > end:
                raise ClusterError(f"no node of the cluster can hold an actor; {self._needed()}")
            time.sleep(TICK)
        return candidates

    def _look_around(self) -> None:
        """Nodes that are gone, nodes that are new, actors that are to be asked again."""
        for look in [look for look in self._looks if look.done()]:
            self._looks.remove(look)
            for found in look.result():
                self._admit(found)
        if self._setup is not None and self.team.is_time():
            for member in self.team.forget_dead():
                self._lose(member, "the node is gone")
            candidates = [] if self._looks else self.team.candidates()
            if candidates:
                self._looks.append(self._beside.submit(self._setup.files.look, candidates, self._setup.has_written))
        self.team.ask_again()

    def _admit(self, found: Found) -> None:
        assert self._setup is not None
        if found.problems:
            self.team.refused.add(found.node.id)
            self._fail(found.node.name, "", "; ".join(found.problems))
        else:
            self.team.admit(found.node, self._setup.job(found.is_shared))

    def _hand_out(self) -> None:
        members, workers, now = self.team.ready(), self.team.workers(), time.monotonic()
        # Whoever has nothing comes first.
        for member in sorted(members, key=lambda member: len(member.calls)):
            while (unit := self.queue.take(member.worker, workers, now)) is not None:
                member.calls[member.handle.run.remote(unit)] = unit
                if len(member.calls) == 1 and len(members) > 1:
                    break
        for member in members:
            unit = self.queue.take(member.worker, workers, now) if member.calls else None
            if unit is not None:
                member.calls[member.handle.run.remote(unit)] = unit

    def _settle(self, member: Member, call: Call, take: Take) -> None:
        """Takes what came of a call."""
        unit = member.calls.pop(call, None)
        if unit is None and member.opening != call:
            # Its actor was lost meanwhile.
            return
        try:
            answer = ray.get(call)
        except ray.exceptions.TaskCancelledError:
            if unit is not None:
                self.queue.cancelled(unit, member.worker, time.monotonic())
        except ray.exceptions.OutOfMemoryError as error:
            self._refuse(member, unit, HostMemoryError(reason(error)))
            self._lose(member, reason(error))
        except ray.exceptions.ActorUnavailableError as error:
            if unit is None:
                # It is still being restarted.
                self.team.wait_longer(member)
            else:
                self._lose(member, f"a worker was lost: {reason(error)}")
        except ray.exceptions.RayTaskError as error:
            raise ClusterError(f"{unit.name if unit else 'the scene'} on node {member.node.name}: {error}") from error
        except ray.exceptions.RayError as error:
            self._lose(member, f"a worker was lost: {reason(error)}")
        else:
            if isinstance(answer, Failed):
                self._refuse(member, unit, answer.error)
            elif isinstance(answer, Opened):
                self._opened(member, answer)
            elif unit is not None and isinstance(answer, Done):
                self._done(member, unit, answer, take)

    def _opened(self, member: Member, opened: Opened) -> None:
        member.opening, member.opened = None, opened
        self.team.note_process(member, opened.pid)
        node = self.report.nodes.setdefault(member.node.name, NodeReport())
        node.actors = max(node.actors, sum(other.node.id == member.node.id for other in self.team.ready()))
        self._note(opened.notes)
        logger.info("an actor on node %s is ready: %s, %d threads", member.node.name, opened.device, opened.threads)

    def _done(self, member: Member, unit: Unit, done: Done, take: Take) -> None:
        if not self.queue.done(unit, member.worker, time.monotonic()):
            return
        take(unit, done.result)
        for worker in self.queue.copies_of(unit):
            self._cancel(worker.name, unit)
        if isinstance(done.result, Chosen):
            return
        self.report.units += 1
        node = self.report.nodes.setdefault(member.node.name, NodeReport())
        node.units += 1
        node.render += done.render
        node.write += done.write
        self._note(done.said)
        tags = {"node": member.node.name}
        self.metrics.units.inc(1, tags)
        self.metrics.seconds.observe(done.render + done.write, tags)

    def _cancel(self, worker: str, unit: Unit) -> None:
        """A copy that has not begun does not begin."""
        for member in self.team.members:
            if member.worker.name == worker:
                for call in [call for call, other in member.calls.items() if other is unit]:
                    ray.cancel(call)

    def _refuse(self, member: Member, unit: Unit | None, error: LightmeshError) -> None:
        """A node cannot do a unit, or not open the scene."""
        what = unit.name if unit is not None else "the scene"
        self._fail(member.node.name, what, str(error))
        is_of_node = isinstance(error, (HostMemoryError, DeviceError, ClusterError, OSError))
        if not is_of_node:
            raise on_node(error, what, member.node.name)
        if unit is not None:
            self.queue.refuse(unit, member.worker, time.monotonic())
        self._refusals[member.node.id] = self._refusals.get(member.node.id, 0) + 1
        if unit is None or self._refusals[member.node.id] >= MOST_REFUSALS:
            for other in self.team.expel(member.node.id):
                self.queue.lost(other.worker)
        others = self.team.nodes.keys()
        if not others or (unit is not None and not self.queue.can_go_to(unit, others)):
            raise on_node(error, what, member.node.name)

    def _lose(self, member: Member, why: str) -> None:
        """What an actor held goes to others."""
        held = self.queue.lost(member.worker)
        self._fail(member.node.name, held[0].name if held else "", why)
        for call in member.calls:
            ray.cancel(call)
        self.team.lose(member)
        for unit in held:
            if self.queue.losses.get(unit.name, 0) >= MOST_LOSSES:
                count, node = MOST_LOSSES, member.node.name
                raise ClusterError(f"{unit.name}: {count} workers were lost while they rendered it, the last one on node {node}: {why}")

    def _fail(self, node: str, unit: str, message: str) -> None:
        self.report.failures.append(Failure(node, unit, message))
        self.metrics.failures.inc(1, {"node": node})
        logger.warning("node %s: %s: %s", node, unit or "the node", message)

    def _note(self, notes: Iterable[str]) -> None:
        new = [note for note in dict.fromkeys(notes) if note not in self.report.notes]
        self.report.notes += new[: max(MOST_NOTES - len(self.report.notes), 0)]

    def _tell(self) -> None:
        """Tells how far it is, and how long the rest takes at the speed of all actors together."""
        queue, workers = self.queue, self.team.workers()
        self.metrics.left.set(queue.left)
        self.metrics.actors.set(len(workers))
        if self.on_progress is None:
            return
        share = queue.weight_done / queue.total if queue.total else 1.0
        first, last = self._shares
        self._progress = max(self._progress, first + (last - first) * share)
        speed = sum(worker.weight / worker.seconds for worker in workers if worker.seconds)
        left = (queue.total - queue.weight_done) / speed if speed else None
        stage = "rendering" if workers else "waiting"
        # What is chosen before the first frame is none itself.
        finished, total = (0, self.planned) if first == last else (len(queue.units) - queue.left, len(queue.units))
        self.on_progress(Progress(self._progress, time.monotonic() - self.start, left, finished, total, len(workers), stage))
