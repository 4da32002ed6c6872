#!/usr/bin/env python3
"""Kills workers, nodes and the leader of films and pictures on a Ray cluster of this machine, at random, and checks what comes of it.

    python3 bench/ray/kills.py --kills 50 --seed 1

Python needs the wheel, Ray and psutil. Films of 60 frames and pictures of 40 bands are rendered in turn, each while some processes are killed with
SIGKILL: an actor, a node with all its actors (a new one joins soon), or the leader (which is started again with `resume`). After each

* files are the same, to the byte, as those of one process, the manifest included;
* no other file is there;
* no unit was rendered more often than twice, and once for each kill that hit it. A kill of the leader hits what no manifest names, and rows that are not kept.

The first fault ends it with exit code 1.
"""

from __future__ import annotations

import argparse
import collections
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import psutil

#: Nodes with a CPU each, beside the head, which has none.
NODES = 3
#: What is rendered: its settings, and how many kills it is to survive.
FILM = {"turntable": 60, "size": "320x240", "seed": 3}
PICTURE = {"size": "1280x2560"}
SCENE = "builtin:childpark"
#: The leader's program: rendered in a process of its own, so that it can be killed.
LEAD = """
import json, os, sys
import lightmesh.ray
what, address, output, settings = sys.argv[1:]
# The process that a supervisor would end.
report = getattr(lightmesh.ray, what)(os.environ["KILLS_SCENE"], output, address=address, **json.loads(settings))
print(json.dumps({"units": report.units, "retries": report.retries, "copies": report.copies, "leading": report.leading, "seconds": report.seconds}))
"""


class Machine:
    """A cluster of this machine, whose processes can be killed."""

    def __init__(self, nodes: int = NODES, scene: str = SCENE, node_env: dict[str, str] | None = None) -> None:
        from ray.cluster_utils import Cluster

        os.environ["LIGHTMESH_RAY_LOG"] = "INFO"
        os.environ["KILLS_SCENE"] = scene
        self.cluster = Cluster()
        self.cluster.add_node(num_cpus=0, object_store_memory=100_000_000, include_dashboard=False)
        self.nodes = [self.add(node_env if number == 0 else None) for number in range(nodes)]
        self.logs = Path(self.cluster.head_node.get_session_dir_path()) / "logs"
        self.read: dict[str, int] = {}

    def add(self, env: dict[str, str] | None = None):
        more = {"env_vars": env} if env else {}
        return self.cluster.add_node(num_cpus=1, object_store_memory=100_000_000, **more)

    def close(self) -> None:
        self.cluster.shutdown()

    def actors(self) -> list[psutil.Process]:
        """Processes of actors."""
        found = []
        for process in psutil.process_iter(["cmdline", "status"]):
            line = process.info["cmdline"] or [""]
            if line[0].startswith("ray::Actor") and process.info["status"] != psutil.STATUS_ZOMBIE:
                found.append(process)
        return found

    def of_node(self, node) -> list[psutil.Process]:
        """The processes of actors of a node."""
        raylet = node.all_processes["raylet"][0].process.pid
        mine = {child.pid for child in psutil.Process(raylet).children(recursive=True)}
        return [process for process in self.actors() if process.pid in mine]

    def rendered(self) -> list[tuple[int, str]]:
        """What processes have begun to render since this was last asked: process and unit."""
        found = []
        # Ray moves the logs of processes that are gone.
        for path in sorted([*self.logs.glob("worker-*.err"), *self.logs.glob("old/worker-*.err")]):
            try:
                with open(path, "rb") as file:
                    file.seek(self.read.get(path.name, 0))
                    text = file.read()
            except FileNotFoundError:
                # Moved just now: it is read at its new place the next time.
                continue
            whole = text.rfind(b"\n") + 1
            self.read[path.name] = self.read.get(path.name, 0) + whole
            for pid, unit in re.findall(r"lightmesh\.ray INFO \S+ (\d+): rendering (.+)", text[:whole].decode()):
                found.append((int(pid), unit))
        return found


class Trial:
    """A film or a picture while processes are killed."""

    def __init__(self, machine: Machine, what: str, settings: dict, folder: Path, rng: random.Random) -> None:
        self.machine, self.what, self.settings, self.folder, self.rng = machine, what, settings, folder, rng
        self.output = folder / ("f.##.png" if what == "film" else "picture.png")
        self.units: dict[int, list[str]] = collections.defaultdict(list)
        self.hits: collections.Counter[str] = collections.Counter()
        self.killed: collections.Counter[str] = collections.Counter()
        machine.rendered()

    def lead(self) -> subprocess.Popen:
        settings = {**self.settings, "resume": True}
        command = [sys.executable, "-c", LEAD, self.what, self.machine.cluster.address, str(self.output), json.dumps(settings)]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=open(self.folder.parent / f"{self.folder.name}.log", "ab"), text=True)

    def look(self) -> None:
        for pid, unit in self.machine.rendered():
            self.units[pid].append(unit)

    def hit(self, pids: list[int]) -> None:
        """What these processes were last rendering was hit."""
        for pid in pids:
            if self.units[pid]:
                self.hits[self.units[pid][-1]] += 1

    def recorded(self) -> set[str]:
        """Frames that the manifest names, and rows that are kept."""
        if self.what == "picture":
            found = set()
            for path in self.folder.glob("*.bands/*.npz"):
                first, rows = int(path.suffixes[-2][1:]), len(np.load(path)["color"])
                found.add(f"rows {first} to {first + rows - 1}")
            return found
        path = self.folder / "manifest.json"
        films = json.loads(path.read_text())["films"] if path.exists() else {}
        return {f"frame {number}" for film in films.values() for number in film["frames"]}

    def kill(self, kind: str, leader: subprocess.Popen) -> subprocess.Popen:
        """Kills a process of this kind; returns the leader, or a new one."""
        if kind == "worker" and (actors := self.machine.actors()):
            victim = self.rng.choice(actors)
            victim.kill()
            self.settle([victim.pid])
        elif kind == "node":
            node = self.rng.choice(self.machine.nodes)
            pids = [process.pid for process in self.machine.of_node(node)]
            self.machine.nodes.remove(node)
            self.machine.cluster.remove_node(node, allow_graceful=False)
            self.settle(pids)
            self.machine.nodes.append(self.machine.add())
        elif kind == "leader":
            pids = [process.pid for process in self.machine.actors()]
            leader.send_signal(signal.SIGKILL)
            leader.wait()
            end = time.monotonic() + 20
            while any(process.pid in pids for process in self.machine.actors()) and time.monotonic() < end:
                time.sleep(0.1)
            self.settle(pids)
            # What was finished and is not recorded is lost with it.
            gone = {unit for units in self.units.values() for unit in units} - self.recorded()
            self.hits.update(gone - {units[-1] for pid, units in self.units.items() if pid in pids and units})
            leader = self.lead()
        else:
            return leader
        self.killed[kind] += 1
        return leader

    def settle(self, pids: list[int]) -> None:
        """Notes what was hit, once all lines are there."""
        time.sleep(0.3)
        self.look()
        self.hit(pids)

    def run(self, kills: list[str], first: float, pause: tuple[float, float], patience: float = 900.0) -> dict:
        """Renders it, with these kills some time after the first unit has begun."""
        leader, begin = self.lead(), time.monotonic()
        while not self.units and leader.poll() is None:
            time.sleep(0.1)
            self.look()
        time.sleep(first)
        for kind in kills:
            time.sleep(self.rng.uniform(*pause))
            if leader.poll() is not None:
                break
            leader = self.kill(kind, leader)
            self.wait_for_work(leader)
        text, _ = leader.communicate(timeout=patience)
        self.look()
        if leader.returncode:
            raise SystemExit(f"the leader failed: see {self.folder.parent / self.folder.name}.log")
        # Ray prints there what workers print.
        (told,) = [line for line in text.splitlines() if line.startswith('{"units"')]
        return {**json.loads(told), "wall": time.monotonic() - begin}

    def wait_for_work(self, leader: subprocess.Popen) -> None:
        """Waits until something is rendered again, so that the next kill hits it."""
        begun = sum(map(len, self.units.values()))
        while sum(map(len, self.units.values())) == begun and leader.poll() is None:
            time.sleep(0.05)
            self.look()

    def check(self, expected: Path) -> list[str]:
        """What is wrong."""
        want = {path.name: path.read_bytes() for path in expected.iterdir()}
        have = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        faults = [f"{name} is left over" for name in sorted(have.keys() - want.keys())]
        faults += [f"{name} is missing" for name in sorted(want.keys() - have.keys())]
        faults += [f"{name} differs" for name in sorted(want.keys() & have.keys()) if want[name] != have[name]]
        counts = collections.Counter(unit for units in self.units.values() for unit in units)
        for unit, count in sorted(counts.items()):
            if count > 2 + self.hits[unit]:
                faults.append(f"{unit} was rendered {count} times, and {self.hits[unit]} kills hit it")
        return faults


def expected(folder: Path, what: str, settings: dict, scene: str = SCENE) -> Path:
    """The files by one process."""
    folder.mkdir()
    flags = [text for name, value in settings.items() for text in (f"--{name}", str(value))]
    output = folder / ("f.##.png" if what == "film" else "picture.png")
    subprocess.run([sys.executable, "-m", "lightmesh", "render", scene, "-o", str(output), "--device", "cpu", "--quiet", *flags], check=True)
    return folder


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--each", type=int, default=5, help="kills of one film or picture")
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 30))
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    rng, totals, rows = random.Random(arguments.seed), collections.Counter(), []
    folder = Path(tempfile.mkdtemp(prefix="lightmesh-kills-"))
    print(f"seed {arguments.seed}, logs in {folder}", flush=True)
    wanted = {"film": expected(folder / "film", "film", FILM), "picture": expected(folder / "picture", "picture", PICTURE)}
    machine = Machine()
    try:
        number = 0
        while sum(totals.values()) < arguments.kills:
            what = ("film", "picture")[number % 2]
            own = folder / f"{what}-{number}"
            own.mkdir()
            number += 1
            trial = Trial(machine, what, FILM if what == "film" else PICTURE, own, rng)
            kinds = [rng.choice(("worker", "worker", "node", "leader")) for _ in range(min(arguments.each, arguments.kills - sum(totals.values())))]
            told = trial.run(kinds, rng.uniform(0, 1), (0.1, 2.0))
            totals.update(trial.killed)
            faults = trial.check(wanted[what])
            counts = collections.Counter(unit for units in trial.units.values() for unit in units)
            row = {"what": what, "kills": dict(trial.killed), "renders": sum(counts.values()), "most": max(counts.values()), **told, "faults": faults}
            rows.append(row)
            print(json.dumps(row), flush=True)
            if faults:
                return 1
    finally:
        machine.close()
    print(f"{sum(totals.values())} kills survived: {dict(totals)}")
    if arguments.json:
        arguments.json.write_text(json.dumps({"seed": arguments.seed, "kills": dict(totals), "runs": rows}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
