#!/usr/bin/env python3
"""How a film grows faster with the number of actors, and what the leader costs for each unit.

    python3 bench/ray/scaling.py --actors 1,2 --json scaling.json

Python needs the wheel and Ray. The same film is rendered by 1, 2, … actors of one CPU each on a cluster of this machine. Efficiency is that of
`seconds.render`: what the images took of the actors' time from the first image to the last, compared with one actor; writing files is apart. The
leader's part is what it computes itself for a unit: handing out, taking the result, the manifest beside it. `--slow N` stops one of N actors nine
tenths of the time by signals, and says what that costs of the whole.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

import psutil
import ray
from ray.cluster_utils import Cluster

import lightmesh.ray

SCENE = "builtin:childpark"
FILM = {"size": "320x240", "turntable": 60}


def cluster(nodes: int) -> Cluster:
    """A head without CPUs, and nodes with one each."""
    made = Cluster()
    made.add_node(num_cpus=0, object_store_memory=100_000_000, include_dashboard=False)
    for _ in range(nodes):
        made.add_node(num_cpus=1, object_store_memory=100_000_000)
    return made


class Clock:
    """From when all actors are ready until all units are finished."""

    def __init__(self, actors: int) -> None:
        self.actors, self.begin, self.first, self.end = actors, 0.0, 0, 0.0

    def __call__(self, progress: lightmesh.ray.Progress) -> None:
        if not self.begin and progress.actors >= self.actors:
            self.begin, self.first = time.monotonic(), progress.units
        if progress.done < 1.0:
            return
        self.end = time.monotonic()
        self.units = progress.units - self.first


def film(address: str, actors: int, clock: Clock) -> lightmesh.ray.Report:
    with tempfile.TemporaryDirectory() as folder:
        return lightmesh.ray.film(SCENE, Path(folder) / "f.##.png", actors=actors, on_progress=clock, **FILM)


def scaling(counts: list[int]) -> list[dict[str, float]]:
    """A row for each number of actors."""
    rows: list[dict[str, float]] = []
    made = cluster(max(counts))
    ray.init(address=made.address, log_to_driver=False)
    for actors in counts:
        clock = Clock(actors)
        report = film(made.address, actors, clock)
        render = sum(node.render for node in report.nodes.values())
        write = sum(node.write for node in report.nodes.values())
        wall = clock.end - clock.begin
        rows.append(
            {
                "actors": actors,
                "units": report.units,
                "copies": report.copies,
                "units_per_second": clock.units / wall,
                "render_per_unit": render / report.units,
                "write_per_unit": write / report.units,
                "busy": render / report.units * clock.units / (wall * actors),
                "leader_ms_per_unit": 1000 * report.leading / report.units,
            }
        )
        first = rows[0]
        rows[-1]["efficiency"] = rows[-1]["units_per_second"] / (actors / first["actors"] * first["units_per_second"])
        # One process has no other beside it that shares caches and memory: this is what images themselves take longer.
        rows[-1]["efficiency_of_render"] = first["render_per_unit"] / rows[-1]["render_per_unit"] * rows[-1]["busy"] / first["busy"]
        print(json.dumps(rows[-1]), flush=True)
    ray.shutdown()
    made.shutdown()
    return rows


class Slow(threading.Thread):
    """Stops a process nine tenths of the time."""

    def __init__(self, pid: int) -> None:
        super().__init__(daemon=True)
        self.pid, self.is_over = pid, False

    def run(self) -> None:
        try:
            while not self.is_over:
                os.kill(self.pid, signal.SIGSTOP)
                time.sleep(0.18)
                os.kill(self.pid, signal.SIGCONT)
                time.sleep(0.02)
        except ProcessLookupError:
            pass


def slow(actors: int) -> dict[str, float]:
    """The same film by equal actors, and by actors one of which is ten times slower; each has the time of one actor of a CPU of its own or less."""
    rows = {}
    made = cluster(actors)
    ray.init(address=made.address, log_to_driver=False)
    for name in ("equal", "slow"):
        clock, slowed = Clock(actors), []

        def watch(progress: lightmesh.ray.Progress) -> None:
            clock(progress)
            if name == "slow" and clock.begin and not slowed:
                mine = [process for process in psutil.process_iter(["cmdline"]) if (process.info["cmdline"] or [""])[0].startswith("ray::Actor")]
                slowed.append(Slow(mine[0].pid))
                slowed[0].start()

        with tempfile.TemporaryDirectory() as folder:
            report = lightmesh.ray.film(SCENE, Path(folder) / "f.##.png", on_progress=watch, **FILM)
        for one in slowed:
            one.is_over = True
        rows[name] = clock.units / (clock.end - clock.begin)
        print(json.dumps({"actors": name, "units_per_second": rows[name], "copies": report.copies}), flush=True)
    ray.shutdown()
    made.shutdown()
    ideal = rows["equal"] * (actors - 0.9) / actors
    return {"equal": rows["equal"], "with_slow": rows["slow"], "ideal_with_slow": ideal, "cost": ideal / rows["slow"] - 1.0}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--actors", default="1,2", help="numbers of actors")
    parser.add_argument("--slow", type=int, metavar="ACTORS", help="so many actors, one of which is slow")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if arguments.slow:
        result: object = slow(arguments.slow)
    else:
        result = scaling([int(count) for count in arguments.actors.split(",")])
    print(json.dumps(result, indent=1))
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
