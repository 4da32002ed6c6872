"""The engine in Blender's hands: animation, cancelling, progress, errors, and warnings."""

import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy
import lightmesh as package
import numpy as np
import pytest
from lightmesh_addon import session
from lightmesh_addon.engine import LightmeshEngine, Stopped
from support import agreement, camera, cycles, image, light, lightmesh, prepare, principled, read, shader_of, stage, world


class Recorder:
    """A renderer that records the counts of its frames, and the structures that they were made from."""

    def __init__(self, renderer: package.Renderer) -> None:
        self.renderer = renderer
        self.counts: list[dict[str, int]] = []
        self.before: list[package.PreparedScene | None] = []

    @property
    def device(self) -> str:
        return self.renderer.device

    def prepare(self, scene: package.Scene, **settings: Any) -> package.PreparedScene:
        self.before.append(settings["before"])
        return self.renderer.prepare(scene, **settings)

    def render(self, scene: package.PreparedScene, **settings: Any) -> package.Frame:
        frame = self.renderer.render(scene, **settings)
        self.counts.append(frame.stats["counts"])
        return frame


@pytest.fixture
def recorder(monkeypatch: pytest.MonkeyPatch) -> Recorder:
    made = Recorder(package.Renderer("cpu"))
    monkeypatch.setattr(session, "renderer", lambda *_: made)
    return made


def animation(folder: Path, frames: int = 3) -> list[np.ndarray]:
    """The pictures of all frames."""
    scene = prepare("LIGHTMESH", folder / "frame_")
    scene.frame_start, scene.frame_end = 1, frames
    bpy.ops.render.render(animation=True)
    files = sorted(folder.glob("frame_*"))
    assert len(files) == frames
    return [read(file).rgb for file in files]


def alone(frame: int) -> np.ndarray:
    """The picture of a frame, with nothing kept from others."""
    bpy.context.scene.frame_set(frame)
    return lightmesh().rgb


def moving_camera() -> None:
    obj = bpy.context.scene.camera
    for frame, x in ((1, 0.0), (3, 0.8)):
        obj.location.x = x
        obj.keyframe_insert("location", frame=frame)


@pytest.mark.parametrize("mode", ["LISTS", "HALF_BALL"])
def test_animation_keeps_the_mesh(mode: str, tmp_path: Path, recorder: Recorder) -> None:
    """Light points and gathered light of one frame serve the next ones, whose pictures are the same as without."""
    stage()
    light("POINT", 300.0, shadow_soft_size=0.3)
    world((0.5, 0.6, 0.7), 0.5)
    moving_camera()
    bpy.context.scene.lightmesh.mode = mode
    bpy.context.scene.lightmesh.step = 0.15
    frames = animation(tmp_path)
    first, *later = recorder.counts
    assert recorder.before[0] is None and all(before is not None for before in recorder.before[1:])
    for counts in later:
        assert counts["gather_rays"] < 0.3 * first["gather_rays"]
        if mode == "HALF_BALL":
            assert counts["long_tests"] < 0.3 * first["long_tests"]
    assert not session._prepared and not session._caches, "freed at the end"
    assert np.abs(frames[0] - frames[2]).mean() > 0.01
    np.testing.assert_array_equal(frames[2], alone(3))


def test_animation_of_objects_and_lights(tmp_path: Path) -> None:
    """What moves is where it belongs in each frame, for objects, meshes, lights, materials and the world."""
    stage()
    lamp = light("POINT", 300.0, shadow_soft_size=0.2)
    background = world((1.0, 1.0, 1.0), 0.1).node_tree.nodes["Background"]
    box, ball = bpy.data.objects["Box"], bpy.data.objects["Ball"]
    wave = bpy.data.objects["Floor"].modifiers.new("Wave", "CAST")
    ball.data.materials[0] = principled("painted", Specular_IOR_Level=0.0)
    paint = shader_of(ball.data.materials[0]).inputs["Base Color"]
    for frame, at in ((1, 0.0), (3, 1.0)):
        box.location.x, lamp.location.y, wave.factor = -0.9 + at, -1.0 + 2.0 * at, 0.1 * at
        paint.default_value, background.inputs["Strength"].default_value = (0.8, 0.8 - 0.7 * at, 0.8 - 0.7 * at, 1.0), 0.1 + 0.2 * at
        box.keyframe_insert("location", frame=frame)
        lamp.keyframe_insert("location", frame=frame)
        wave.keyframe_insert("factor", frame=frame)
        paint.keyframe_insert("default_value", frame=frame)
        background.inputs["Strength"].keyframe_insert("default_value", frame=frame)
    frames = animation(tmp_path)
    for frame, rgb in enumerate(frames, 1):
        np.testing.assert_array_equal(rgb, alone(frame))
    assert np.abs(frames[0] - frames[1]).mean() > 0.01 < np.abs(frames[1] - frames[2]).mean()
    agreement("animation_frame_3", lightmesh(), cycles(bounces=14)).check(shadows=0.85)


def test_found_sun_stays(tmp_path: Path) -> None:
    """The sun that was found in a panorama shines in later frames, too."""
    stage()
    moving_camera()
    pixels = np.full((64, 128, 3), 0.1)
    pixels[15:17, 50:52] = 500.0
    tree = world().node_tree
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image("sun", pixels, is_float=True)
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    frames = animation(tmp_path)
    np.testing.assert_array_equal(frames[2], alone(3))


def test_persistent_data(tmp_path: Path, recorder: Recorder) -> None:
    """With persistent data, the next render of a scene goes on from the last one."""
    stage()
    light("POINT", 300.0, shadow_soft_size=0.3)
    world((0.5, 0.6, 0.7), 0.5)
    bpy.context.scene.render.use_persistent_data = True
    first, second = lightmesh().rgb, lightmesh().rgb
    assert recorder.before[1] is not None
    assert recorder.counts[1]["gather_rays"] < 0.3 * recorder.counts[0]["gather_rays"]
    np.testing.assert_array_equal(first, second)
    session.forget()


def test_cancel(monkeypatch: pytest.MonkeyPatch) -> None:
    """Escape stops the work at once. Nobody can press it here, so that a stub of what asks Blender says so after a second."""
    stage()
    light("AREA", 300.0, size=3.0)
    world((0.5, 0.5, 0.5))
    settings = bpy.context.scene.lightmesh
    settings.mode, settings.samples, settings.pixel_samples = "AREA", 16384, 256
    begin = time.monotonic()
    asked = []

    def stop_after_a_second(engine: LightmeshEngine) -> None:
        assert engine.test_break() is False
        asked.append(time.monotonic())
        if asked[-1] > begin + 1.0:
            raise Stopped

    monkeypatch.setattr(LightmeshEngine, "_stop_if_asked", stop_after_a_second)
    written = []
    monkeypatch.setattr(LightmeshEngine, "_write", lambda *_: written.append(True))
    prepare("LIGHTMESH", Path("unused"))
    bpy.ops.render.render()
    assert time.monotonic() - begin < 8.0
    assert len(asked) > 2 and not written
    monkeypatch.undo()
    settings.mode, settings.samples, settings.pixel_samples = "LISTS", 16, 4
    assert lightmesh().rgb.mean() > 0.1, "the next render works"


def test_progress() -> None:
    """Blender shows what is done, and how long it takes."""
    stage()
    light("AREA", 300.0, size=1.0)
    bpy.context.scene.lightmesh.mode, bpy.context.scene.lightmesh.samples = "AREA", 2048
    texts = []
    handler = lambda text, *_: texts.append(str(text))  # noqa: E731
    bpy.app.handlers.render_stats.append(handler)
    try:
        lightmesh()
    finally:
        bpy.app.handlers.render_stats.remove(handler)
    assert any("Lightmesh: reading the scene" in text for text in texts), texts
    assert any(re.search(r"Lightmesh: \w+, \d\d:\d\d\.\d\d left", text) for text in texts), texts


def test_progress_goes_forward(monkeypatch: pytest.MonkeyPatch) -> None:
    stage()
    light("AREA", 300.0, size=1.0)
    bpy.context.scene.lightmesh.mode, bpy.context.scene.lightmesh.samples = "AREA", 2048
    made, shares = LightmeshEngine._progress, []

    def recorded(engine: LightmeshEngine, begin: float, end: float) -> Callable[[package.Progress], None]:
        called = made(engine, begin, end)

        def record(progress: package.Progress) -> None:
            shares.append(begin + (end - begin) * progress.done)
            called(progress)

        return record

    monkeypatch.setattr(LightmeshEngine, "_progress", recorded)
    lightmesh()
    assert shares == sorted(shares) and 0.0 <= shares[0] and 0.5 < shares[-1] <= 1.0


@pytest.fixture
def printed(capfd: pytest.CaptureFixture[str]) -> Iterator[Any]:
    yield lambda: capfd.readouterr().out


def failing_render() -> str:
    """The error of a render that cannot be done."""
    prepare("LIGHTMESH", Path("unused"))
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.render.render(write_still=True)
    return str(caught.value)


def test_unexpected_errors_end_the_render(monkeypatch: pytest.MonkeyPatch, printed: Any) -> None:
    """Blender would crash if it had to write an image that was never made."""
    stage()

    def broken(*_: object) -> None:
        raise KeyError("broken")

    monkeypatch.setattr(LightmeshEngine, "_render", broken)
    assert "KeyError" in failing_render()


def test_panoramic_camera() -> None:
    stage()
    bpy.context.scene.camera.data.type = "PANO"
    assert "Camera “Camera” is panoramic" in failing_render()


def test_clip_planes_without_space() -> None:
    stage()
    bpy.context.scene.camera.data.clip_start, bpy.context.scene.camera.data.clip_end = 9.0, 8.0
    assert "Camera “Camera” sees nothing" in failing_render()


def test_no_camera() -> None:
    stage()
    bpy.context.scene.camera = None
    assert "camera" in failing_render().lower()


def test_empty_scene() -> None:
    """A camera and a world alone: the world is seen."""
    camera()
    world((0.2, 0.4, 0.6))
    np.testing.assert_allclose(lightmesh().rgb.mean((0, 1)), (0.2, 0.4, 0.6), rtol=1e-3)


def test_unsupported_nodes_are_named(printed: Any) -> None:
    """Each node without a counterpart is named once, with its material."""
    material = principled("Marble")
    tree = material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.name = "Veins"
    tree.links.new(noise.outputs[0], shader_of(material).inputs["Base Color"])
    shader_of(material).inputs["Coat Weight"].default_value = 0.5
    toon = bpy.data.materials.new("Comic")
    toon.use_nodes = True
    nodes = toon.node_tree
    output = next(node for node in nodes.nodes if node.type == "OUTPUT_MATERIAL")
    nodes.links.new(nodes.nodes.new("ShaderNodeBsdfToon").outputs[0], output.inputs["Surface"])
    stage(material)
    bpy.data.objects["Ball"].data.materials[0] = toon
    light("SUN", 3.0).data.use_shadow = False
    lightmesh()
    text = printed()
    for part in ("Material “Marble”: the node “Veins”", "Material “Comic”: the node “Toon BSDF”", "a coat", "Light “Sun” casts no shadow"):
        assert text.count(part) == 1, text


def test_missing_image(printed: Any) -> None:
    material = principled("Wall")
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("lost", 4, 4)
    node.image.source, node.image.filepath = "FILE", "//lost.png"
    tree.links.new(node.outputs["Color"], shader_of(material).inputs["Base Color"])
    stage(material)
    light("SUN", 3.0)
    lightmesh()
    assert "Image “lost” cannot be read" in printed()


def test_modes_and_qualities() -> None:
    """All modes show the same scene."""
    stage()
    light("AREA", 300.0, size=0.8)
    reference = cycles()
    settings = bpy.context.scene.lightmesh
    for mode in ("LISTS", "ADAPTIVE", "HALF_BALL", "AREA", "RAY_TRACE"):
        settings.mode, settings.quality = mode, "DRAFT"
        found = agreement(f"mode_{mode.lower()}", lightmesh(), reference)
        assert abs(found.ratio - 1.0) < 0.03 and found.shadows > 0.8, mode


def test_device_is_named_in_the_panel() -> None:
    from lightmesh_addon.properties import device_items

    names = [item[0] for item in device_items()]
    assert names[0] == "auto" and "cpu" in names
    bpy.context.scene.lightmesh.device = "cpu"
    stage()
    light("SUN", 1.0)
    assert lightmesh().rgb.max() > 0.0


def test_panels_are_shown() -> None:
    """Blender's own panels of lights, worlds, materials and output hold for the engine."""
    engines = {panel.__name__: getattr(panel, "COMPAT_ENGINES", set()) for panel in bpy.types.Panel.__subclasses__()}
    for name in (
        "EEVEE_MATERIAL_PT_surface",
        "EEVEE_WORLD_PT_surface",
        "RENDER_PT_format",
        "DATA_PT_lens",
        "VIEWLAYER_PT_layer_passes_cryptomatte",
        "RENDER_PT_color_management",
    ):
        if name in engines:
            assert "LIGHTMESH" in engines[name], name
    assert "LIGHTMESH" not in engines.get("RENDER_PT_freestyle", set())
