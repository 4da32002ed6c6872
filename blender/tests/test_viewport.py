"""The viewport's logic with a stub of the engine and of the painter: the `bpy` module has no window and no OpenGL. Everything but the drawing
of a finished picture is real, with the 3D view of Blender's factory settings."""

import gc
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from lightmesh_addon import engine as engine_module
from lightmesh_addon.export import camera
from lightmesh_addon.viewport import Viewport
from mathutils import Vector
from support import HEIGHT, WIDTH, light, lightmesh, stage

#: Seconds within which a picture of a small scene is finished.
SOON = 30.0


class Engine:
    """What a viewport asks of its engine."""

    def __init__(self) -> None:
        self.stats: list[str] = []
        self.reports: list[str] = []
        self.redraws = 0

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append(text)

    def update_stats(self, stats: str, info: str) -> None:
        self.stats.append(info)

    def tag_redraw(self) -> None:
        self.redraws += 1


@dataclass
class Painter:
    """Keeps what would be drawn."""

    drawn: list[np.ndarray] = field(default_factory=list)
    size: tuple[int, int] | None = None

    def draw(self, engine: Engine, scene: bpy.types.Scene, pixels: np.ndarray, size: tuple[int, int]) -> None:
        if not self.drawn or self.drawn[-1] is not pixels:
            self.drawn.append(pixels)
        self.size = size


class View:
    """A viewport of `size` pixels that looks through the scene's camera, as Blender's context describes it."""

    space: SimpleNamespace | None = None

    def __init__(self, size: tuple[int, int] = (WIDTH, HEIGHT)) -> None:
        self.engine, self.painter = Engine(), Painter()
        self.viewport = Viewport(self.engine, self.painter)
        self.region = SimpleNamespace(width=size[0], height=size[1])
        self.view = SimpleNamespace(view_perspective="CAMERA", view_distance=10.0)

    @property
    def depsgraph(self) -> bpy.types.Depsgraph:
        return bpy.context.evaluated_depsgraph_get()

    def context(self) -> SimpleNamespace:
        depsgraph = self.depsgraph
        obj = bpy.context.scene.camera.evaluated_get(depsgraph)
        self.view.view_matrix = obj.matrix_world.inverted()
        self.view.window_matrix = obj.calc_matrix_camera(depsgraph, x=self.region.width, y=self.region.height)
        return SimpleNamespace(region=self.region, region_data=self.view, space_data=self.space)

    def update(self) -> None:
        # Which objects a view shows can be asked of one in a window alone.
        context = self.context()
        context.space_data = None
        self.viewport.update(context, self.depsgraph)

    def draw(self) -> None:
        self.viewport.draw(self.context(), self.depsgraph)

    def settle(self) -> np.ndarray:
        """Draws as Blender does until the picture is finished, and returns it."""
        end = time.monotonic() + SOON
        self.draw()
        while self.viewport.refiner.busy or self.viewport._drawn != self.viewport.refiner.version:
            assert time.monotonic() < end, "the viewport does not come to an end"
            time.sleep(0.005)
            self.viewport._look()
            self.draw()
        return self.painter.drawn[-1]


@pytest.fixture
def view() -> Iterator[View]:
    bpy.context.preferences.view.show_splash = False
    bpy.context.scene.render.engine = "LIGHTMESH"
    stage()
    light("AREA", 300.0, size=1.0)
    made = View()
    yield made
    made.viewport.stop()
    made.viewport.refiner.join(SOON)


def test_refines(view: View) -> None:
    """A small picture comes at once, and better ones follow, the last as F12 gives it."""
    view.update()
    last = view.settle()
    sizes = [pixels.shape[:2] for pixels in view.painter.drawn]
    assert sizes[-1] == (HEIGHT, WIDTH) and view.painter.size == (WIDTH, HEIGHT)
    assert len(sizes) >= 2 or view.viewport.refiner.version == 3
    assert view.engine.redraws >= 1 and "Rendering" in view.engine.stats and view.engine.stats[-1] == ""
    final = lightmesh()
    np.testing.assert_allclose(last[::-1, :, :3].mean(), final.rgb.mean(), rtol=0.01)
    assert np.abs(last[::-1, :, :3] - final.rgb).mean() < 0.01 * final.rgb.mean()


def test_stages_are_shown(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each stage is published, from a quarter of the size on."""
    seen = []
    publish = view.viewport.refiner._publish
    monkeypatch.setattr(view.viewport.refiner, "_publish", lambda **found: (seen.append(found["pixels"].shape[:2]), publish(**found)))
    view.update()
    view.settle()
    assert seen == [(HEIGHT // 4, WIDTH // 4), (HEIGHT, WIDTH), (HEIGHT, WIDTH)]


def test_moving_the_view(view: View) -> None:
    """Another view needs no export: only the camera is new."""
    view.update()
    before = view.settle()
    exported = view.viewport.exported
    bpy.context.scene.camera.location.x += 1.5
    bpy.context.view_layer.update()
    after = view.settle()
    assert view.viewport.exported is exported
    assert np.abs(before - after).mean() > 0.01
    np.testing.assert_allclose(after[::-1, :, :3].mean(), lightmesh().rgb.mean(), rtol=0.01)


def test_changes_are_seen(view: View) -> None:
    """Objects, meshes, lights and materials that change are shown as they are."""
    view.update()
    view.settle()
    box = bpy.data.objects["Box"]

    def larger() -> None:
        for vertex in box.data.vertices:
            vertex.co *= 1.3
        box.data.update()

    def bluer() -> None:
        node = next(node for node in bpy.data.materials["matt"].node_tree.nodes if node.type == "BSDF_DIFFUSE")
        node.inputs["Color"].default_value = (0.1, 0.2, 0.8, 1.0)

    def moved() -> None:
        box.location.x -= 0.5

    def brighter() -> None:
        bpy.data.lights["Area"].energy *= 1.5

    updates: list = []
    for change in (moved, larger, bluer, brighter):
        change()
        # Blender hands over the changes only in a handler.
        handler = lambda scene, depsgraph: (updates.append(change.__name__), view.viewport.update(view.context(), depsgraph))  # noqa: B023, E731
        bpy.app.handlers.depsgraph_update_post.append(handler)
        bpy.context.view_layer.update()
        bpy.app.handlers.depsgraph_update_post.remove(handler)
        assert updates and updates[-1] == change.__name__
        shown = view.settle()[::-1, :, :3]
        final = lightmesh().rgb
        assert np.abs(shown - final).mean() < 0.01 * final.mean(), change.__name__


def test_only_changed_meshes_are_read(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    from lightmesh_addon.export import geometry

    names = []
    read = geometry.read
    monkeypatch.setattr(geometry, "read", lambda mesh, *rest: (names.append(mesh.name), read(mesh, *rest))[1])
    view.update()
    assert sorted(names) == ["Ball", "Box", "Floor"]
    names.clear()
    view.update()
    assert not names


def test_a_new_request_stops_the_old_one(view: View) -> None:
    """A picture of many minutes does not keep the next one waiting: it would for longer than `settle` waits."""
    settings = bpy.context.scene.lightmesh
    settings.mode, settings.samples, settings.pixel_samples = "AREA", 16384, 128
    view.update()
    view.draw()
    time.sleep(0.5)
    settings.mode, settings.samples, settings.pixel_samples = "LISTS", 16, 4
    view.settle()


def test_stop_ends_the_thread(view: View) -> None:
    view.update()
    view.draw()
    view.viewport.stop()
    view.viewport.refiner.join(SOON)
    assert not view.viewport.refiner._thread.is_alive()
    assert view.viewport._look() is None, "the timer ends, too"


def test_errors_are_shown(view: View) -> None:
    bpy.context.scene.lightmesh.mode, bpy.context.scene.lightmesh.step = "HALF_BALL", 1e-7
    view.update()
    end = time.monotonic() + SOON
    while view.viewport.refiner.error is None and time.monotonic() < end:
        time.sleep(0.01)
    view.draw()
    assert view.viewport.refiner.error and view.engine.stats[-1] == view.viewport.refiner.error
    bpy.context.scene.lightmesh.mode = "LISTS"
    assert view.settle().mean() > 0.0
    assert view.viewport.refiner.error is None


def test_orthographic_view(view: View) -> None:
    """What is behind the eye of a parallel view is seen."""
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale = "ORTHO", 8.0
    obj = bpy.context.scene.camera
    view.update()
    expected = view.settle()
    obj.location = obj.matrix_world.translation + obj.matrix_world.to_3x3() @ Vector((0.0, 0.0, -8.0))
    bpy.context.view_layer.update()
    view.view.view_perspective = "ORTHO"
    inside = view.settle()
    assert np.abs(inside - expected).mean() < 0.02 * expected.mean()


def test_clip_planes_of_the_camera(view: View) -> None:
    """A camera view shows what the final render does, and what cannot be seen is an error that goes away."""
    data = bpy.context.scene.camera.data
    data.clip_start, data.clip_end = 8.2, 1000.0
    view.update()
    shown, final = view.settle()[::-1, :, :3], lightmesh().rgb
    assert np.abs(shown - final).mean() < 0.01 * final.mean()
    data.clip_start = 0.1
    assert np.abs(view.settle()[::-1, :, :3] - final).mean() > 0.05 * final.mean()
    data.clip_start, data.clip_end = 9.0, 8.0
    view.settle()
    assert view.engine.stats[-1] and "far" in view.engine.stats[-1]
    data.clip_end = 1000.0
    view.settle()
    assert view.engine.stats[-1] == ""


def test_clip_planes_of_the_view(view: View) -> None:
    """As in Cycles: those of a perspective view are its own, a parallel one sees half of Clip End before and behind its eye, and a camera of the view
    comes before that of the scene."""
    scene, bounds = bpy.context.scene, ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
    other = SimpleNamespace(type="CAMERA", data=SimpleNamespace(clip_start=2.0, clip_end=3.0))
    space = SimpleNamespace(clip_start=0.5, clip_end=40.0, use_local_camera=False, camera=other)
    seen = lambda kind, distance=10.0: camera.Depths.of_view(SimpleNamespace(view_perspective=kind, view_distance=distance), space, scene, bounds)  # noqa: E731
    assert seen("PERSP") == (0.5, 40.0, 0.0)
    assert seen("CAMERA") == pytest.approx((scene.camera.data.clip_start, scene.camera.data.clip_end, 0.0))
    diagonal = float(np.linalg.norm([2.0, 2.0, 2.0]))
    assert seen("ORTHO") == pytest.approx((0.0, 20.0 + 10.0 + diagonal, 10.0 + diagonal))
    assert seen("ORTHO", 100.0) == (0.0, 40.0, 20.0)
    space.use_local_camera = True
    assert seen("CAMERA") == (2.0, 3.0, 0.0)

    view.space, view.view.view_perspective = SimpleNamespace(clip_start=8.2, clip_end=1000.0), "PERSP"
    view.update()
    cut = view.settle()
    bpy.context.scene.camera.data.clip_start = 8.2
    np.testing.assert_allclose(cut[::-1, :, :3].mean(), lightmesh().rgb.mean(), rtol=0.01)


def test_engine_makes_a_viewport() -> None:
    """`view_update` and `view_draw` of the engine are those of its viewport."""
    calls = []
    stub = SimpleNamespace(
        _viewport=lambda: SimpleNamespace(update=lambda *given: calls.append(("update", given)), draw=lambda *given: calls.append(("draw", given)))
    )
    engine_module.LightmeshEngine.view_update(stub, "context", "depsgraph")
    engine_module.LightmeshEngine.view_draw(stub, "context", "depsgraph")
    assert calls == [("update", ("context", "depsgraph")), ("draw", ("context", "depsgraph"))]


def test_a_real_engine_has_a_viewport(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blender's own object can hold one, and stops it when it goes."""
    stage()
    made = []
    monkeypatch.setattr(engine_module.LightmeshEngine, "_render", lambda engine, *_: made.extend([engine._viewport(), engine._viewport()]))
    bpy.context.scene.render.engine = "LIGHTMESH"
    bpy.ops.render.render()
    assert isinstance(made[0], Viewport) and made[0] is made[1]
    gc.collect()
    assert made[0]._stopped
