"""What a viewport shows, from Blender's side: exports when something changed, and draws what the refiner has."""

from __future__ import annotations

import weakref

import bpy
import numpy as np

from . import session, settings
from .export import camera
from .export.scene import Exporter, MeshStore
from .notes import Notes
from .painter import Painter
from .refiner import Refiner

#: Seconds between looks at the refiner, while it works and while it rests.
WORKING, RESTING = 0.03, 0.25


class Viewport:
    """Belongs to one engine. `painter` draws; tests have one of their own."""

    def __init__(self, engine: bpy.types.RenderEngine, painter: Painter | None = None) -> None:
        self._engine = weakref.ref(engine)
        self.painter = painter or Painter()
        self.refiner = Refiner()
        self.store = MeshStore()
        self.exported = None
        self._view = None
        self._drawn = 0
        self._told = None
        self._stopped = False
        # Only the main thread may ask for a redraw.
        bpy.app.timers.register(self._look, first_interval=WORKING)

    def update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Exports the scene; called when anything in it changed."""
        self.store.forget(depsgraph.updates)
        notes = Notes()
        self.exported = Exporter(depsgraph, notes, self.store, context.space_data).run()
        self._view = None
        text = notes.text()
        engine = self._engine()
        if engine and text and text != self._told:
            self._told = text
            engine.report({"WARNING"}, text)
        self._request(context, depsgraph)

    def draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draws what there is; if the view has changed, a new picture is begun."""
        self._request(context, depsgraph)
        engine, pixels = self._engine(), self.refiner.pixels
        self._drawn = self.refiner.version
        if engine is None:
            return
        if self.refiner.error:
            engine.update_stats("Lightmesh", self.refiner.error)
        else:
            engine.update_stats("Lightmesh", "Rendering" if self.refiner.busy else "")
        if pixels is not None:
            region = context.region
            if camera.is_mirroring(np.array(context.region_data.view_matrix)):
                pixels = np.ascontiguousarray(pixels[:, ::-1])
            self.painter.draw(engine, depsgraph.scene, pixels, (region.width, region.height))

    def stop(self) -> None:
        self._stopped = True
        self.refiner.stop()

    def _request(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        if self.exported is None:
            return
        scene, region, view = depsgraph.scene, context.region, context.region_data
        depths = camera.Depths.of_view(view, context.space_data, scene, self.exported.bounds)
        size = (max(1, region.width), max(1, region.height))
        chosen = {**settings.of_scene(scene), **self.exported.settings, "layers": self.exported.has_holdouts}
        device = settings.device(scene)
        key = (size, tuple(sorted(chosen.items())), device, depths, *(tuple(map(tuple, m)) for m in (view.view_matrix, view.window_matrix)))
        if key == self._view:
            return
        self._view = key
        world, window = np.linalg.inv(np.array(view.view_matrix)), np.array(view.window_matrix)
        looking = lambda: camera.of_matrices(world, window, size, depths=depths)  # noqa: E731
        self.refiner.show(lambda: session.renderer(*device), self.exported, looking, chosen, size)

    def _look(self) -> float | None:
        """Called by Blender's timer; asks for a redraw when there is a new picture."""
        engine = self._engine()
        if engine is None or self._stopped:
            self.stop()
            return None
        try:
            if self._drawn != self.refiner.version:
                engine.tag_redraw()
        except ReferenceError:  # Blender has freed it.
            self.stop()
            return None
        return WORKING if self.refiner.busy else RESTING
