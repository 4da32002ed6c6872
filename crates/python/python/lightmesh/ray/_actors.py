"""Actors: each keeps a scene prepared on its device, and does units of work.

An actor that is restarted gets the arguments of the first start. So these are small and complete: names, checksums and a request, never an object
of Ray's store, which may be gone by then. It opens the scene at the first call, so that what is wrong with that is an answer and not a death.
"""

from __future__ import annotations

import json
import logging
import os
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import ray

from .. import devices
from .._errors import LightmeshError
from .._lightmesh import _Worker
from . import _nodes
from ._errors import FilesError
from ._units import Done, Failed, Place, Unit

logger = logging.getLogger("lightmesh.ray")

#: What a node may say of its own memory, as `lightmesh render` reads it.
MEMORY_LIMIT = "LIGHTMESH_MEMORY_LIMIT"


@dataclass(frozen=True)
class Job:
    """What actors work on."""

    scene: str
    output: str | None
    #: The request, as text.
    request: str
    #: The checksum of all files that the scene is read from.
    digest: str
    #: The name of the folder that the files were sent to; empty if they were not.
    shipped_as: str
    #: Whether the node sees the folder of the output.
    is_shared: bool
    #: The share of a GPU that it may use, or how many.
    gpus: float
    #: Which run it is of: what actors leave on a node is found by it.
    run: str = ""

    def shared(self, is_shared: bool) -> Job:
        """The same for a node that sees the folder of the output, or does not."""
        return replace(self, is_shared=is_shared)


@dataclass(frozen=True)
class Opened:
    """An actor that is ready."""

    pid: int
    device: str
    threads: int
    notes: tuple[str, ...]


class Actor:
    """What an actor runs."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.worker: _Worker | None = None
        self.place: Place | None = None

    def open(self) -> Opened | Failed:
        """Opens the scene, if that is still to do."""
        try:
            worker, request = self.opened(), self.request()
            notes = [*worker.notes, *self.device_notes()]
            return Opened(os.getpid(), str(request["device"]), worker.threads, tuple(notes))
        except LightmeshError as error:
            return Failed(error)

    def run(self, unit: Unit) -> Done | Failed:
        """Does a unit of work."""
        try:
            worker = self.opened()
            logger.info("rendering %s", unit.name)
            assert self.place is not None
            return unit.run(worker, self.place)
        except LightmeshError as error:
            return Failed(error)

    def opened(self) -> _Worker:
        if self.worker is None:
            _nodes.begin_log()
            scene = _nodes.shipped(self.job.shipped_as, self.job.scene) if self.job.shipped_as else self.job.scene
            self.place = place = self.placed()
            worker = _Worker(scene, place.output, json.dumps(self.request()))
            if _nodes.digest_of_all(worker.inputs) != self.job.digest:
                raise FilesError(f"{scene}: files that it refers to are others than the leader has; use a folder that all share, or ship=True")
            self.worker = worker
        return self.worker

    def placed(self) -> Place:
        """Where it writes. What the leader does not see goes to a folder of its own and from there to the leader."""
        if self.job.output is None or self.job.is_shared:
            return Place(None if self.job.output is None else Path(self.job.output), self.job.is_shared)
        folder = Path(tempfile.mkdtemp(prefix=_nodes.frames_of(self.job.run)))
        return Place(folder / Path(self.job.output).name, is_shared=False)

    def request(self) -> dict[str, object]:
        """The request, with the device and the memory that are this actor's."""
        request: dict[str, object] = json.loads(self.job.request)
        if self.job.shipped_as:
            for name in ("environment", "grid_file"):
                if name in request:
                    request[name] = _nodes.shipped(self.job.shipped_as, str(request[name]))
        if request.get("device", "auto") == "auto":
            # A task that owns no GPU sees all of its node, which belong to others.
            request["device"] = "cuda" if self.job.gpus > 0 else "cpu"
        limit = os.environ.get(MEMORY_LIMIT)
        if "memory_limit" not in request and limit:
            request["memory_limit"] = limit
        elif "memory_limit" not in request and 0 < self.job.gpus < 1:
            usable = [device["memory_bytes"] for device in devices() if device["usable"] and device["device"] != "cpu"]
            memory = next((size for size in usable if size), None)
            if memory:
                request["memory_limit"] = str(int(memory * self.job.gpus))
        return request

    def device_notes(self) -> list[str]:
        is_auto = json.loads(self.job.request).get("device", "auto") == "auto"
        if is_auto and not self.job.gpus:
            return ["device auto: using cpu, since actors own no GPU (gpus_per_actor=1 gives each one)"]
        return []


#: A call that is lost is not repeated by Ray, which would wait for the same actor: the leader hands the unit to whoever is free.
RemoteActor = ray.remote(max_restarts=-1, max_task_retries=0)(Actor)
