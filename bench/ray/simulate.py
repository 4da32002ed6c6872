#!/usr/bin/env python3
"""A film on a cluster of up to 1000 nodes, on paper: the queue of `lightmesh.ray` in simulated time.

    python3 bench/ray/simulate.py                               # a table: what a film takes, and what is busy, by the number of nodes
    python3 bench/ray/simulate.py --check scaling.json          # against what bench/ray/scaling.py has measured
    python3 bench/ray/simulate.py --measure                     # what the leader costs on this machine, by the number of actors

Python needs the wheel, Ray and SimPy. Simulated are nodes that start, read the scene from one file server, build its structure, render and publish
frames, break down and are replaced; some are slow. The queue is the one that the leader uses (`lightmesh/ray/_queue.py`), with its own cost: what the leader
computes takes the seconds that `--measure` found, and everybody waits for it in turn. Not simulated are the network between nodes but for the file
server, and Ray's own head.
"""

from __future__ import annotations

import argparse
import json
import random
import statistics
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import simpy

from lightmesh.ray._queue import Queue, Worker
from lightmesh.ray._units import Frame

#: What events wait for: a step of the simulation.
Step = Iterator[simpy.Event]


@dataclass(frozen=True)
class Cluster:
    """What is assumed. Seconds and bytes."""

    nodes: int
    actors_per_node: int = 2
    #: From the start of a node until its actors' processes run, and the building of the structure.
    start: float = 8.0
    build: float = 5.0
    #: A frame of one actor: the median, and how it is spread (sigma of the logarithm).
    frame: float = 20.0
    spread: float = 0.3
    #: One node in so many is ten times slower.
    slow_one_in: int = 100
    #: A node breaks down after so long, on average, and is replaced.
    failure: float = 50 * 3600.0
    replaced: float = 120.0
    scene_bytes: float = 1e9
    frame_bytes: float = 8e6
    #: What the file server moves in a second, all clients together, and one client alone.
    server: float = 2.5e9
    client: float = 1e9
    #: What the leader computes for a unit that is finished; for each actor in every round; and for each node once a second.
    unit: float = 3.0e-3
    per_actor: float = 10e-6
    per_node: float = 20e-6


class Server:
    """A file server that all share evenly: a transfer takes its turn in pieces, as many at a time as its bandwidth feeds at full speed."""

    PIECE = 64e6

    def __init__(self, env: simpy.Environment, cluster: Cluster) -> None:
        self.env, self.cluster, self.busy = env, cluster, 0.0
        self.lanes = simpy.Resource(env, max(1, round(cluster.server / cluster.client)))

    def move(self, size: float) -> Step:
        left = size
        while left > 0:
            piece = min(left, self.PIECE)
            with self.lanes.request() as turn:
                yield turn
                yield self.env.timeout(piece / self.cluster.client)
            self.busy += piece / self.cluster.server
            left -= piece


@dataclass
class Told:
    """What came of a film."""

    seconds: float = 0.0
    frames: int = 0
    leader: float = 0.0
    server: float = 0.0
    rendering: float = 0.0
    ready: list[float] = field(default_factory=list)
    failures: int = 0
    retries: int = 0
    copies: int = 0


class Film:
    """A film, whose frames are rendered by simulated actors."""

    def __init__(self, cluster: Cluster, frames: int, seed: int) -> None:
        self.cluster, self.rng, self.env = cluster, random.Random(seed), simpy.Environment()
        self.queue = Queue([Frame(number, "{}") for number in range(1, frames + 1)])
        self.server = Server(self.env, cluster)
        #: Units that are rendered and not yet settled, with what tells the actor that they are, and what wakes the leader.
        self.arrived: list[tuple[Worker, Frame, simpy.Event]] = []
        self.news = self.env.event()
        self.workers: dict[str, Worker] = {}
        self.told, self.over = Told(frames=frames), self.env.event()

    def run(self) -> Told:
        for number in range(self.cluster.nodes):
            self.env.process(self.node(number))
        self.env.process(self.lead())
        self.env.run(until=self.over)
        told, queue = self.told, self.queue
        told.seconds, told.retries, told.copies = self.env.now, queue.retries, queue.copies
        told.leader, told.server = told.leader / self.env.now, self.server.busy / self.env.now
        actors = self.cluster.nodes * self.cluster.actors_per_node
        told.rendering = told.rendering / (self.env.now * actors)
        return told

    def lead(self) -> Step:
        """The leader's rounds: it waits for results, looks over all actors, and settles what has arrived, one unit after the other."""
        looked = 0.0
        while not self.queue.is_finished:
            if not self.arrived:
                yield self.news
            self.news = self.env.event()
            ready, self.arrived = self.arrived, []
            cost = self.cluster.per_actor * len(self.workers)
            if self.env.now >= looked + 1.0:
                looked, cost = self.env.now, cost + self.cluster.per_node * self.cluster.nodes
            yield from self.compute(cost)
            for worker, unit, told in ready:
                yield from self.compute(self.cluster.unit)
                if worker.name in self.workers:
                    self.queue.done(unit, worker, self.env.now)
                told.succeed()
        self.over.succeed()

    def compute(self, seconds: float) -> Step:
        yield self.env.timeout(seconds)
        self.told.leader += seconds

    def node(self, number: int) -> Step:
        """A node, its breakdowns, and the ones that replace it."""
        is_slow = self.rng.random() < 1 / self.cluster.slow_one_in
        pace = 10.0 if is_slow else self.rng.lognormvariate(0.0, 0.05)
        life = 0
        while not self.queue.is_finished:
            life += 1
            actors = [self.env.process(self.actor(f"{number}.{life}.{actor}", str(number), pace)) for actor in range(self.cluster.actors_per_node)]
            yield self.env.timeout(self.rng.expovariate(1 / self.cluster.failure))
            self.told.failures += 1
            for actor in actors:
                if actor.is_alive:
                    actor.interrupt()
            yield self.env.timeout(self.cluster.replaced)

    def actor(self, name: str, node: str, pace: float) -> Step:
        worker = Worker(name, node)
        try:
            yield self.env.timeout(self.cluster.start)
            yield from self.server.move(self.cluster.scene_bytes / self.cluster.actors_per_node)
            yield self.env.timeout(self.cluster.build * pace)
            self.told.ready.append(self.env.now)
            self.workers[name] = worker
            while not self.queue.is_finished:
                yield from self.work(worker, pace)
        except simpy.Interrupt:
            self.workers.pop(name, None)
            self.queue.lost(worker)

    def work(self, worker: Worker, pace: float) -> Step:
        """The next unit, which the leader has handed out in advance if it could."""
        while self.queue.take(worker, self.workers.values(), self.env.now) is not None:
            pass
        if not worker.held:
            yield self.env.timeout(0.2)
            return
        unit = self.queue.units[next(iter(worker.held))]
        seconds = self.cluster.frame * self.rng.lognormvariate(0.0, self.cluster.spread) * pace
        yield self.env.timeout(seconds)
        self.told.rendering += seconds
        yield from self.server.move(self.cluster.frame_bytes)
        settled = self.env.event()
        self.arrived.append((worker, unit, settled))
        if not self.news.triggered:
            self.news.succeed()
        if len(worker.held) < 2:
            # It has nothing else until the leader has heard of this.
            yield settled
        else:
            # The one that waits is the first from now on.
            worker.held.pop(unit.name, None)
            worker.held[unit.name] = self.env.now


def table(arguments: argparse.Namespace) -> list[dict[str, float]]:
    """Films of 20 frames for each actor, by the number of nodes."""
    rows = []
    for nodes in [int(count) for count in arguments.nodes.split(",")]:
        cluster = replace(Cluster(nodes), **json.loads(arguments.assume))
        actors = nodes * cluster.actors_per_node
        frames = arguments.frames or 20 * actors
        begin = time.perf_counter()
        told = Film(cluster, frames, arguments.seed).run()
        # The same work by actors that are there from the beginning, are never slow and wait for nobody.
        mean = cluster.frame * 2.718281828 ** (cluster.spread**2 / 2)
        rows.append(
            {
                "nodes": nodes,
                "actors": actors,
                "frames": frames,
                "seconds": told.seconds,
                "ideal": frames * mean / actors,
                "efficiency": frames * mean / actors / told.seconds,
                "ready_last": max(told.ready),
                "leader": told.leader,
                "server": told.server,
                "failures": told.failures,
                "retries": told.retries,
                "copies": told.copies,
            }
        )
        print(json.dumps({name: round(value, 3) for name, value in rows[-1].items()}), f"({time.perf_counter() - begin:.0f} s)", flush=True)
    return rows


def check(path: Path) -> None:
    """What scaling.py has measured beside what a simulation of the same says."""
    for row in json.loads(path.read_text()):
        actors = int(row["actors"])
        cluster = Cluster(
            actors, 1, start=0.0, build=0.0, frame=row["render_per_unit"] + row["write_per_unit"], spread=0.05, slow_one_in=10**9, failure=1e12,
            scene_bytes=1.0, frame_bytes=1.0, unit=row["leader_ms_per_unit"] / 1000,
        )  # fmt: skip
        told = [Film(cluster, int(row["units"]), seed).run() for seed in range(5)]
        simulated = statistics.mean(row["units"] / one.seconds for one in told)
        measured = row["units_per_second"]
        print(f"{actors} actors: measured {measured:.2f} units/s, simulated {simulated:.2f} ({simulated / measured - 1:+.1%})")


def measure() -> None:
    """What a round of the leader costs, by the number of actors: Ray's `wait` twice, and the leader's own look over them."""
    import types

    import ray
    from lightmesh.ray._leader import Leader
    from lightmesh.ray._team import Member, Node, Share, Team

    ray.init("local", num_cpus=1, object_store_memory=100_000_000, include_dashboard=False, log_to_driver=False)
    never = ray.remote(num_cpus=1000)(lambda: None)
    for actors in (10, 100, 1000, 2000, 4000):
        team, queue = Team(Share(1, 0), None), Queue([Frame(number, "{}") for number in range(20 * actors)])
        node = Node("", "", {})
        team.members = [Member(None, node, Worker(str(number), ""), opened=True) for number in range(actors)]  # type: ignore[arg-type]
        for member in team.members:
            while (unit := queue.take(member.worker, team.members, 0.0)) is not None:  # type: ignore[arg-type]
                member.calls[never.remote()] = unit
        leader = types.SimpleNamespace(team=team, queue=queue)
        begin, rounds = time.perf_counter(), 20
        for _ in range(rounds):
            Leader._hand_out(leader)  # type: ignore[arg-type]
            calls = list(team.calls())
        looked = (time.perf_counter() - begin) / rounds
        begin = time.perf_counter()
        for _ in range(rounds):
            ray.wait(calls, num_returns=1, timeout=0)
            ray.wait(calls, num_returns=len(calls), timeout=0)
        waited = (time.perf_counter() - begin) / rounds
        for call in calls:
            ray.cancel(call)
        each = 1e6 * (looked + waited) / actors
        print(f"{actors} actors: {1e3 * looked:.2f} ms for a look, {1e3 * waited:.2f} ms for two waits: {each:.1f} us an actor", flush=True)
    ray.shutdown()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", default="1,10,100,300,1000")
    parser.add_argument("--frames", type=int, help="of the film, in place of 20 for each actor")
    parser.add_argument("--assume", default="{}", help="other assumptions, as JSON: '{\"server\": 1e9}'")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--check", type=Path, metavar="SCALING.json")
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if arguments.measure:
        measure()
    elif arguments.check:
        check(arguments.check)
    else:
        rows = table(arguments)
        if arguments.json:
            arguments.json.write_text(json.dumps({"assume": json.loads(arguments.assume), "rows": rows}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
