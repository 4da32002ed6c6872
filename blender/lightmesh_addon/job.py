"""Work in a thread of its own, so that Blender goes on meanwhile. It must not touch Blender's data."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import lightmesh

from .notes import fault


class Job:
    """Begins at once. `work` gets the job, and returns its result."""

    def __init__(self, work: Callable[[Job], Any]) -> None:
        self.token = lightmesh.Cancel()
        #: What is done, from 0 to 1.
        self.share = 0.0
        self.result = None
        self.cancelled = False
        #: What went wrong, as text.
        self.error = None
        self._work = work
        self._thread = threading.Thread(target=self._run, name="lightmesh study", daemon=True)
        self._thread.start()

    @property
    def ended(self) -> bool:
        return not self._thread.is_alive()

    def wait(self, seconds: float) -> bool:
        """Waits for its end, not longer than that; whether it has ended."""
        self._thread.join(seconds)
        return self.ended

    def cancel(self) -> None:
        """Stops the work soon."""
        self.token.cancel()

    def follow(self) -> Callable[[lightmesh.Progress], None]:
        """What a renderer tells its progress."""

        def called(progress: lightmesh.Progress) -> None:
            self.share = progress.done

        return called

    def _run(self) -> None:
        try:
            self.result = self._work(self)
        except lightmesh.Cancelled:
            self.cancelled = True
        except (lightmesh.LightmeshError, OSError) as error:
            self.error = str(error)
        except Exception as error:
            self.error = fault(error)
            raise
