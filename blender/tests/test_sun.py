"""Sun studies: the compass, hours among the images, frames of a day, what stops them, and what they say."""

import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import bpy
import lightmesh as package
import numpy as np
import OpenEXR
import pytest
from lightmesh_addon import output, pictures, session
from lightmesh_addon.operators import StudyOperator
from support import box, camera, light, link, look_at, matt, plane, principled, world

SIDE = 48
#: Scene units that the picture shows from its middle to its edge.
REACH = 2.4


@pytest.fixture(autouse=True)
def pole() -> None:
    """A pole one unit high, from above: +Y is up in the picture, +X on its right. At 50° north on a day whose night is as long."""
    plane("Floor", 4.0, matt())
    box("Pole", (0.1, 0.1, 0.5), (0.0, 0.0, 0.5), matt("pole"))
    obj = camera((0.0, 0.0, 10.0), type="ORTHO", ortho_scale=2.0 * REACH)
    obj.rotation_euler = (0.0, 0.0, 0.0)
    scene = bpy.context.scene
    render, settings = scene.render, scene.lightmesh
    render.engine, render.resolution_x, render.resolution_y = "LIGHTMESH", SIDE, SIDE
    settings.device, settings.quality = "cpu", "DRAFT"
    sun = settings.sun
    sun.latitude, sun.longitude, sun.offset = 50.0, 0.0, 0.0
    sun.year, sun.month, sun.day = 2026, 3, 20


def hours_from(begin: float, end: float, step: int = 60) -> np.ndarray:
    """The hours of sun of a study, row 0 at the top."""
    sun = bpy.context.scene.lightmesh.sun
    sun.begin, sun.end, sun.step = begin, end, step
    assert bpy.ops.lightmesh.sun_hours() == {"FINISHED"}
    return values()


def values() -> np.ndarray:
    """Red of the image of numbers, row 0 at the top."""
    made = bpy.data.images[pictures.VALUES]
    pixels = np.empty(4 * made.size[0] * made.size[1], np.float32)
    made.pixels.foreach_get(pixels)
    return pixels.reshape(made.size[1], made.size[0], 4)[::-1, :, 0]


def at(image: np.ndarray, x: float, y: float) -> float:
    """The value at a place of the floor."""
    row, column = (int(SIDE * 0.5 * (1.0 + way / REACH)) for way in (-y, x))
    return float(image[row, column])


#: Hour of the day, north of the scene, and the way that shadows fall as x and y. At six and eighteen, the sun is at the horizon.
SHADOWS = [
    (12.0, 0.0, (0, 1)),
    (8.5, 0.0, (-1, 1)),
    (15.5, 0.0, (1, 1)),
    (12.0, 90.0, (1, 0)),
    (12.0, 180.0, (0, -1)),
]


@pytest.mark.parametrize(("hour", "north", "way"), SHADOWS)
def test_compass(hour: float, north: float, way: tuple[int, int]) -> None:
    """At noon shadows fall towards north, which is +Y, as long as tan 50° of what casts them; in the morning towards west."""
    bpy.context.scene.lightmesh.sun.north = north
    found = hours_from(hour, hour + 1.0 / 60.0, 1)
    x, y = way
    lit = found.max()
    assert lit == pytest.approx(1.0 / 60.0, rel=0.01)
    assert at(found, -0.7 * x, -0.7 * y) == lit
    if 0 in way:
        assert at(found, 0.9 * x, 0.9 * y) == 0.0
        assert at(found, 1.5 * x, 1.5 * y) == lit
    else:
        rows, columns = np.nonzero(found < 0.5 * lit)
        middle = np.array([columns.mean(), -rows.mean()]) - np.array([SIDE / 2, -SIDE / 2])
        assert middle[0] * x > 3.0 and middle[1] * y > 0.0, middle


def test_southern_hemisphere() -> None:
    bpy.context.scene.lightmesh.sun.latitude = -50.0
    found = hours_from(12.0, 12.1, 1)
    assert at(found, 0.0, -0.9) == 0.0 < at(found, 0.0, 0.9)


def test_the_clock_is_that_of_the_place() -> None:
    """Noon in India, half past five hours ahead."""
    sun = bpy.context.scene.lightmesh.sun
    sun.longitude, sun.offset = 82.5, 5.5
    found = hours_from(12.0, 12.1, 1)
    assert at(found, 0.0, 0.9) == 0.0 < at(found, 0.0, -0.9)


def test_hours_are_images_of_the_file(tmp_path: Path) -> None:
    """Picture and numbers are packed; a second study takes the place of the first, wherever that is shown."""
    open_field = hours_from(9.0, 15.0).max()
    assert open_field == pytest.approx(6.0, rel=1e-3)
    holder = bpy.data.textures.new("holder", "IMAGE")
    holder.image = bpy.data.images[pictures.PICTURE]
    bpy.context.scene.render.resolution_x = SIDE + 16
    found = hours_from(9.0, 13.0)
    assert found.shape == (SIDE, SIDE + 16) and found.max() == pytest.approx(4.0, rel=1e-3)
    assert sorted(made.name for made in bpy.data.images) == [pictures.PICTURE, pictures.VALUES]
    picture = bpy.data.images[pictures.PICTURE]
    assert holder.image == picture and picture.packed_file and picture.size[0] > SIDE + 16
    assert bpy.data.images[pictures.VALUES].colorspace_settings.name == "Non-Color"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    np.testing.assert_allclose(values(), found, atol=1e-3)
    assert bpy.data.images[pictures.PICTURE].size[0] > SIDE + 16


def test_a_border_is_studied_alone() -> None:
    render = bpy.context.scene.render
    whole = hours_from(9.0, 15.0)
    render.use_border, render.border_max_x, render.border_max_y = True, 0.5, 0.25
    np.testing.assert_array_equal(hours_from(9.0, 15.0), whole[SIDE * 3 // 4 :, : SIDE // 2])


def day(path: Path, kind: str = "OPEN_EXR", step: int = 180) -> list[Path]:
    """Renders a day from 9 to 15 and returns its files."""
    scene = bpy.context.scene
    sun, render = scene.lightmesh.sun, scene.render
    sun.begin, sun.end, sun.step = 9.0, 15.0, step
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth, render.filepath = kind, "8" if kind == "PNG" else "32", str(path)
    assert bpy.ops.lightmesh.render_day() == {"FINISHED"}
    return sorted(file for file in path.parent.iterdir() if file.suffix != ".json")


def exr(path: Path) -> np.ndarray:
    with OpenEXR.File(str(path)) as file:
        return np.array(file.channels()["RGB"].pixels, np.float32)


def test_frames_of_a_day(tmp_path: Path) -> None:
    """A frame for each moment, named as Blender names frames; shadows go from west over north to east."""
    files = day(tmp_path / "new" / "day_")
    render = bpy.context.scene.render
    assert files == [Path(render.frame_path(frame=number)) for number in (1, 2, 3)]
    # The shadow's middle is 54° west, then 2° west and 51° east of north.
    for file, (x, y) in zip(files, ((-0.98, 0.7), (0.0, 0.9), (0.93, 0.76)), strict=True):
        shown = exr(file)
        dark, lit = at(shown[..., 1], x, y), at(shown[..., 1], -x, -y)
        assert dark < 0.6 * lit, (file, dark, lit)


def test_paths_are_blenders(tmp_path: Path) -> None:
    """Digits and extensions are where Blender has them."""
    render = bpy.context.scene.render
    render.image_settings.file_format = "PNG"
    for name in ("day", "day.png", "day_##", "a#b###c.png", "folder#/day", "day.x"):
        render.filepath = str(tmp_path / name)
        for render.use_file_extension in (True, False):
            path = output.template(render, ".png")
            head, _, tail = path.rpartition("#")
            digits = len(head) - len(head.rstrip("#")) + 1
            assert head.rstrip("#") + f"{7:0{digits}}" + tail == render.frame_path(frame=7), path


def test_frames_that_are_there(tmp_path: Path) -> None:
    """Blender's Overwrite says what becomes of them."""
    render = bpy.context.scene.render
    files = day(tmp_path / "a.##.png", "PNG")
    contents = [file.read_bytes() for file in files]
    files[0].write_bytes(b"kept")
    files[2].unlink()
    render.use_overwrite = False
    assert day(tmp_path / "a.##.png", "PNG") == files
    assert [file.read_bytes() for file in files] == [b"kept", *contents[1:]]
    render.use_overwrite = True
    day(tmp_path / "a.##.png", "PNG")
    assert [file.read_bytes() for file in files] == contents


def test_colours_are_managed(tmp_path: Path) -> None:
    """PNG files have Blender's exposure and view; a sky stands for sun and world."""
    scene = bpy.context.scene
    scene.view_settings.view_transform, scene.view_settings.exposure = "Standard", 1.0
    scene.render.dither_intensity = 0.0
    linear = exr(day(tmp_path / "linear" / "a", step=360)[0])
    file = day(tmp_path / "shown" / "a", "PNG", step=360)[0]
    shown = bpy.data.images.load(str(file))
    shown = np.array(shown.pixels[:]).reshape(SIDE, SIDE, 4)[::-1, :, :3]
    light_ = np.clip(2.0 * linear, 0.0, 1.0)
    encoded = np.where(light_ <= 0.0031308, light_ * 12.92, 1.055 * light_ ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(shown, encoded, atol=0.003)
    light("SUN", 1000.0)
    world((5.0, 0.0, 0.0))
    np.testing.assert_array_equal(exr(day(tmp_path / "alone" / "a", step=360)[0]), linear)


def test_what_is_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    light("SUN", 3.0)
    world((0.1, 0.1, 0.1))
    scene = bpy.context.scene
    scene.view_settings.look = "AgX - Punchy"
    day(tmp_path / "a", "PNG", step=360)
    text = capfd.readouterr().out
    assert "2 frames rendered to" in text and "The sky of the day stands for World “World”, Light “Sun”" in text
    assert "Look, gamma and curves" in text and "kept" not in text


def test_what_renders_show_counts(capfd: pytest.CaptureFixture[str]) -> None:
    """Operators see the scene as viewports do: what renders hide is left out, and what viewports hide is named."""
    pole = bpy.data.objects["Pole"]
    shadow = lambda: at(hours_from(12.0, 12.1, 1), 0.0, 0.9) == 0.0  # noqa: E731
    assert shadow()
    pole.hide_render = True
    assert not shadow()
    pole.hide_render = False
    group = bpy.data.collections.new("Group")
    bpy.context.scene.collection.children.link(group)
    bpy.context.scene.collection.objects.unlink(pole)
    group.objects.link(pole)
    assert shadow()
    group.hide_render = True
    assert not shadow()
    instance = link(None, "Instance")
    instance.instance_type, instance.instance_collection = "COLLECTION", group
    assert shadow()
    instance.hide_render = True
    assert not shadow()
    assert "Hidden in viewports" not in capfd.readouterr().out
    group.hide_render, pole.hide_viewport = False, True
    bpy.data.objects["Floor"].modifiers.new("Fine", "SUBSURF").subdivision_type = "SIMPLE"
    hours_from(12.0, 12.1, 1)
    text = capfd.readouterr().out
    assert "Hidden in viewports, and left out, though renders show it: “Pole”" in text
    assert "Modifiers are those of viewports, not of renders: “Floor”" in text


def failing(operator: Callable[[], set[str]]) -> str:
    with pytest.raises(RuntimeError) as caught:
        operator()
    return str(caught.value)


def test_errors(tmp_path: Path) -> None:
    scene = bpy.context.scene
    sun, hours, frames = scene.lightmesh.sun, bpy.ops.lightmesh.sun_hours, bpy.ops.lightmesh.render_day
    sun.month, sun.day = 2, 31
    assert "2026-02-31" in failing(hours)
    # Hours of a polar night are 0, but there is nothing to render.
    sun.month, sun.day, sun.latitude = 12, 21, 85.0
    assert "below the horizon" in failing(frames)
    sun.latitude, sun.begin, sun.end = 50.0, 12.0, 9.0
    assert "after its beginning" in failing(frames)
    if not hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.file_format = "TIFF"
        assert "not TIFF: choose one" in failing(frames)
        scene.render.image_settings.file_format = "PNG"
    scene.render.filepath, sun.end = str(tmp_path / "file" / "a"), 15.0
    (tmp_path / "file").write_bytes(b"")
    assert "file" in failing(frames)
    scene.camera.data.type = "PANO"
    assert "panoramic" in failing(hours)
    scene.camera = None
    assert "no camera" in failing(hours)
    scene.render.engine = "BLENDER_WORKBENCH"
    assert "poll() failed" in failing(hours)


class Operator(StudyOperator):
    """An operator outside of Blender, whose work `begin_job` is."""

    bl_label = "Test"

    def __init__(self, work: Callable[..., object]) -> None:
        self.reports, self.work = [], work

    def begin_job(self, context: object) -> object:
        from lightmesh_addon.job import Job

        return Job(self.work)

    def finish(self, result: object) -> str:
        return f"found {result}"

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append((*kind, text))


def windowed() -> SimpleNamespace:
    """What an operator asks of a window, which the module does not have; `shown` is what it showed."""
    shown = []
    windows = SimpleNamespace(
        progress_begin=lambda *_: shown.append("begin"),
        progress_update=shown.append,
        progress_end=lambda: shown.append("end"),
        event_timer_add=lambda *_, **__: "timer",
        event_timer_remove=shown.append,
        modal_handler_add=lambda _: None,
    )
    workspace = SimpleNamespace(status_text_set=shown.append)
    return SimpleNamespace(
        window_manager=windows, window="window", workspace=workspace, evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get, shown=shown
    )


def until_it_ends(operator: Operator, context: SimpleNamespace) -> set[str]:
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        status = operator.modal(context, SimpleNamespace(type="TIMER", value="NOTHING"))
        if status != {"PASS_THROUGH"}:
            return status
        time.sleep(0.02)
    raise AssertionError("it goes on")


def test_work_beside_the_user() -> None:
    context, operator = windowed(), Operator(lambda job: 3)
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    assert operator.modal(context, SimpleNamespace(type="MOUSEMOVE", value="NOTHING")) == {"PASS_THROUGH"}
    assert until_it_ends(operator, context) == {"FINISHED"}
    assert operator.reports == [("INFO", "found 3")]
    assert context.shown[0] == "begin" and context.shown[-3:] == ["timer", "end", None]


def test_glass_is_open_unless_it_is_closed() -> None:
    """A pane beside the pole, of which the report tells in the words of the panel."""
    from lightmesh_addon import sun_study

    pane = plane("Window", 0.5, principled("pane", Transmission_Weight=1.0, Roughness=0.0))
    pane.location = (0.0, 0.0, 1.0)
    sun = bpy.context.scene.lightmesh.sun
    hours = {}
    for sun.glass in ("OPEN", "CLOSED"):
        hours[sun.glass] = hours_from(10.0, 14.0).sum()
    assert hours["CLOSED"] < 0.99 * hours["OPEN"]
    assert sun_study.about_glass(["64 samples", "glass=closed counts it as walls"]) == ["Glass “Closed” counts it as walls"]


def test_a_step_that_nobody_set_is_none() -> None:
    from lightmesh_addon import sun_study

    sun = bpy.context.scene.lightmesh.sun
    sun.property_unset("step")
    assert sun_study.day(sun).endswith("06:00-20:00")
    sun.step = 20
    assert sun_study.day(sun).endswith("06:00-20:00/20m")


def test_escape_ends_it() -> None:
    """Escape stops the renderer soon; meanwhile no other study begins."""
    settings = bpy.context.scene.lightmesh
    settings.mode, settings.samples = "AREA", 65535
    bpy.context.scene.render.resolution_percentage = 1000
    settings.sun.step = 5
    context = windowed()
    renderer = session.renderer("cpu")

    def work(job: object) -> object:
        return renderer.sun_hours(operator.study.scene, progress=job.follow(), cancel=job.token, **operator.study.settings)

    operator = Operator(work)
    operator.invoke(context, None)
    for _ in range(10):
        assert operator.modal(context, SimpleNamespace(type="TIMER", value="NOTHING")) == {"PASS_THROUGH"}
        time.sleep(0.05)
    assert "Escape ends it" in failing(bpy.ops.lightmesh.sun_hours)
    begin = time.monotonic()
    assert operator.modal(context, SimpleNamespace(type="ESC", value="PRESS")) == {"RUNNING_MODAL"}
    assert until_it_ends(operator, context) == {"CANCELLED"}
    assert time.monotonic() - begin < 5.0
    assert operator.reports == [("INFO", "Test was stopped")]


def test_errors_of_the_work_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("threading.excepthook", lambda *_: None)
    for raised, expected in ((package.SettingError("no"), "no"), (KeyError("lost"), "Lightmesh failed (KeyError")):

        def work(job: object, raised: Exception = raised) -> object:
            raise raised

        operator, context = Operator(work), windowed()
        operator.invoke(context, None)
        assert until_it_ends(operator, context) == {"CANCELLED"}
        (kind, text), *more = operator.reports
        assert kind == "ERROR" and text.startswith(expected) and not more
    # Another file is opened meanwhile.
    operator, context = Operator(lambda job: time.sleep(0.05)), windowed()
    operator.invoke(context, None)
    operator.cancel(context)
    assert context.shown[-3:] == ["timer", "end", None]


def test_frames_cancelled_stay(tmp_path: Path) -> None:
    """What is finished stays when a day is stopped."""
    from lightmesh_addon import sun_study
    from lightmesh_addon.job import Job
    from lightmesh_addon.notes import Notes

    look_at(bpy.context.scene.camera, (0.0, 0.0, 0.0))
    sun = bpy.context.scene.lightmesh.sun
    sun.begin, sun.end, sun.step = 9.0, 15.0, 60
    # Frames take long enough for somebody to hear of them before they end.
    settings = bpy.context.scene.lightmesh
    settings.mode, settings.samples, settings.pixel_samples = "AREA", 4096, 16
    asked = sun_study.study(bpy.context.evaluated_depsgraph_get(), Notes())
    files = output.Output(tmp_path / "a.#.exr", {"overwrite": True})

    def work(job: Job) -> object:
        follow = job.follow
        # Stopped by whoever follows, when the second of seven frames begins.
        job.follow = lambda: lambda progress: (follow()(progress), progress.done > 1.001 / 7 and job.cancel())
        return sun_study.frames(asked, files, job)

    job = Job(work)
    assert job.wait(60.0) and job.cancelled and job.error is None
    # The second one may be finished by the time that anybody hears of it.
    names = sorted(file.name for file in tmp_path.glob("*.exr"))
    assert names in (["a.1.exr"], ["a.1.exr", "a.2.exr"])
