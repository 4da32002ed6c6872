"""Renders the picture of a viewport in a thread of its own: a small one at once, then better ones. A new request ends the one before."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import lightmesh
import numpy as np

from . import passes, settings

if TYPE_CHECKING:
    from .export.scene import Exported


class Refiner:
    """`changed` is called by the thread whenever there is something new to show."""

    def __init__(self, changed: Callable[[], None] = lambda: None) -> None:
        self._changed = changed
        self._wake = threading.Condition()
        self._request = None
        self._cancel = None
        self._thread = None
        self._stopped = False
        self.pixels = None
        self.error = None
        #: Requests that are not finished.
        self.busy = False
        #: Counts pictures and errors.
        self.version = 0

    def show(
        self,
        renderer: Callable[[], lightmesh.Renderer],
        exported: Exported,
        camera: Callable[[], lightmesh.Camera],
        chosen: dict[str, Any],
        size: tuple[int, int],
    ) -> None:
        """Renders this from now on. `renderer` is called in the thread, for a device may take a while to start, and `camera` is, too: one that cannot
        be used is an error of the picture."""
        with self._wake:
            self._request = (renderer, exported, camera, chosen, size)
            self.busy = True
            if self._cancel:
                self._cancel.cancel()
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="lightmesh viewport", daemon=True)
                self._thread.start()
            self._wake.notify()

    def stop(self) -> None:
        """Ends the thread. Can be called from any thread, more than once."""
        with self._wake:
            self._stopped = True
            if self._cancel:
                self._cancel.cancel()
            self._wake.notify()

    def join(self, timeout: float | None = None) -> None:
        if self._thread is not None:
            self._thread.join(timeout)

    def _run(self) -> None:
        prepared, shown = None, None
        while True:
            with self._wake:
                while self._request is None and not self._stopped:
                    self._wake.wait()
                if self._stopped:
                    return
                renderer, exported, camera, chosen, size = self._request
                self._request = None
                cancel = self._cancel = lightmesh.Cancel()
            try:
                device = renderer()
                looking = camera()
                if exported is not shown or prepared is None:
                    scene = exported.scene(looking, shown, prepared)
                    prepared = device.prepare(scene, before=prepared, cancel=cancel, size=size, **chosen)
                    shown = exported
                else:
                    prepared = prepared.with_camera(looking)
                for share, stage in settings.stages(chosen):
                    part = tuple(max(1, round(share * side)) for side in size)
                    frame = device.render(prepared, cancel=cancel, size=part, **stage)
                    self._publish(pixels=passes.combined(frame, exported))
            except lightmesh.Cancelled:
                pass
            except lightmesh.LightmeshError as error:
                # A structure may be half built; what comes next begins anew.
                prepared, shown = None, None
                self._publish(error=str(error))
            with self._wake:
                self.busy = self._request is not None
            self._changed()

    def _publish(self, pixels: np.ndarray | None = None, error: str | None = None) -> None:
        with self._wake:
            if self._stopped:
                return
            self.error = error
            if pixels is not None:
                self.pixels = pixels
            self.version += 1
        self._changed()
