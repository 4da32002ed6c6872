"""The render engine: final images with their passes, and viewports."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy
import numpy as np

from . import passes, settings
from .notes import Notes, fault

if TYPE_CHECKING:
    import lightmesh

    from .viewport import Viewport

#: The share of the progress bar that preparing takes.
PREPARING = 0.15
MISSING = "The Python package “lightmesh” is missing: install the add-on from its zip file, which contains it ({})"


class Stopped(Exception):
    """The user stopped the render."""


class LightmeshEngine(bpy.types.RenderEngine):
    bl_idname = "LIGHTMESH"
    bl_label = "Lightmesh"
    # Icons of materials are left to Blender.
    bl_use_preview = False
    # Textures and lights are seen in Material Preview as Eevee shows them.
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    #: What shows the viewport, made when it is first needed.
    viewport = None

    def update_render_passes(self, scene: bpy.types.Scene = None, renderlayer: bpy.types.ViewLayer = None) -> None:
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for wanted in passes.wanted(renderlayer, light_names(scene, renderlayer)):
            self.register_pass(scene, renderlayer, wanted.name, len(wanted.channels), wanted.channels, wanted.kind)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        notes = Notes()
        try:
            import lightmesh
        except ImportError as error:
            return self._fail(MISSING.format(error))
        from .export.camera import CameraError

        try:
            self._render(depsgraph, notes)
        except (Stopped, lightmesh.Cancelled):
            return
        except (lightmesh.LightmeshError, CameraError) as error:
            self._fail(str(error))
        except Exception as error:
            # Without an image, Blender goes on only if it knows of an error.
            self._fail(fault(error))
            raise
        if len(notes):
            self.report({"WARNING"}, notes.text())

    def _fail(self, text: str) -> None:
        self.report({"ERROR"}, text)
        self.error_set(text)

    def _render(self, depsgraph: bpy.types.Depsgraph, notes: Notes) -> None:
        from . import session
        from .export import camera
        from .export.scene import Exporter

        scene, view_layer = depsgraph.scene, depsgraph.view_layer
        self.update_stats("", "Lightmesh: reading the scene")
        self._warn_of(scene, view_layer, notes)

        # 1. The scene, and what the camera sees of it.
        view, framing = camera.of_scene(depsgraph, self.camera_override)
        exported = Exporter(depsgraph, notes).run(self._stop_if_asked)
        wanted = passes.wanted(view_layer, exported.light_names)
        camera.warn_of(depsgraph, notes, self.camera_override)
        chosen = {**settings.of_scene(scene), **exported.settings, **framing, "layers": bool(wanted) or exported.has_holdouts}

        # 2. The image. What the next frame can use is kept.
        renderer = session.renderer(*settings.device(scene))
        key = (scene.name_full, view_layer.name)
        prepared = session.prepared(key, renderer, exported, view, chosen, self._progress(0.0, PREPARING))
        frame = renderer.render(prepared, cache=session.cache(key), progress=self._progress(PREPARING, 1.0), **chosen)
        for text in prepared.scene.warnings:
            notes.add(text)

        # 3. Its passes.
        looking = (self.camera_override or scene.camera).evaluated_get(depsgraph)
        layers = passes.Layers(frame, exported, view)
        self._write(frame, layers, wanted, view_layer, camera.is_mirrored(looking))
        self.update_stats("", f"Lightmesh: {renderer.device}")

    def _write(self, frame: lightmesh.Frame, layers: passes.Layers, wanted: list[passes.Pass], view_layer: bpy.types.ViewLayer, mirrored: bool) -> None:
        turned = (lambda pixels: pixels[:, ::-1]) if mirrored else (lambda pixels: pixels)
        for layer in wanted:
            self.add_pass(layer.name, len(layer.channels), layer.channels, layer=view_layer.name)
        width, height = frame.size
        result = self.begin_result(0, 0, width, height, layer=view_layer.name)
        found = result.layers[0].passes
        fill(found["Combined"], turned(passes.combined(frame, layers.exported)))
        for layer in wanted:
            fill(found[layer.name], turned(layers.of(layer)))
        self.end_result(result)
        for name, value in layers.metadata(view_layer).items():
            self.get_result().stamp_data_add_field(name, value)

    def _progress(self, begin: float, end: float) -> Callable[[lightmesh.Progress], None]:
        def called(progress: lightmesh.Progress) -> None:
            self._stop_if_asked()
            self.update_progress(begin + (end - begin) * progress.done)
            left = f", {clock(progress.left)} left" if progress.left is not None else ""
            self.update_stats("", f"Lightmesh: {progress.stage}{left}")

        return called

    def _stop_if_asked(self) -> None:
        if self.test_break():
            raise Stopped

    def _warn_of(self, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, notes: Notes) -> None:
        render = scene.render
        if render.pixel_aspect_x != render.pixel_aspect_y:
            notes.add("Pixels are not square in the scene, but are here")
        if render.use_motion_blur:
            notes.add("Motion blur is left out")
        if render.use_multiview:
            notes.add("Stereo views are all rendered from the camera itself")
        if view_layer.material_override:
            notes.add("The material override of the view layer is left out")
        for name in passes.unsupported(view_layer):
            notes.add(f"The pass {name} is left out")
        space = getattr(getattr(bpy.data, "colorspace", None), "working_space", "Linear Rec.709")
        if space not in ("Linear Rec.709", "Linear Rec. 709"):
            notes.add(f"The file works in {space}: colours are taken for Rec. 709")

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        self._viewport().update(context, depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        self._viewport().draw(context, depsgraph)

    def _viewport(self) -> Viewport:
        if self.viewport is None:
            from .viewport import Viewport

            self.viewport = Viewport(self)
            # The engine goes without notice when its viewport does.
            weakref.finalize(self, self.viewport.stop)
        return self.viewport


def fill(render_pass: bpy.types.RenderPass, pixels: np.ndarray) -> None:
    """Writes the pixels, (H, W, channels), of a pass of a result."""
    render_pass.rect.foreach_set(pixels.reshape(-1))


def light_names(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[str]:
    """Names of the lights of a view layer, as far as they are known before it is evaluated."""
    return [obj.name for obj in view_layer.objects if obj.type == "LIGHT" and not obj.hide_render]


def clock(seconds: float) -> str:
    """Minutes and seconds, as Blender shows times."""
    return f"{int(seconds) // 60:02}:{seconds % 60:05.2f}"
