"""Operators of sun studies. Started from a panel, they work beside the user, and Escape ends them; scripts wait for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from .engine import MISSING
from .notes import Notes
from .panels import ENGINE

if TYPE_CHECKING:
    from .job import Job
    from .sun_study import Day, Hours, Study

#: Seconds between looks at the work.
LOOK = 0.1


class StudyOperator:
    """What both have in common. `begin_job` begins the work, `finish` returns what there is to tell of its result."""

    bl_options = {"REGISTER"}

    #: The work of the last one: there is one at a time. Without a type, for Blender looks for properties in annotations.
    last = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.scene.render.engine != ENGINE:
            return False
        if StudyOperator.last is not None and not StudyOperator.last.ended:
            cls.poll_message_set("A sun study is being computed: Escape ends it")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self.begin(context):
            return {"CANCELLED"}
        windows = context.window_manager
        windows.progress_begin(0, 100)
        while not self.job.wait(LOOK):
            windows.progress_update(100.0 * self.job.share)
        windows.progress_end()
        return self.end()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        if not self.begin(context):
            return {"CANCELLED"}
        windows = context.window_manager
        windows.progress_begin(0, 100)
        self.timer = windows.event_timer_add(LOOK, window=context.window)
        windows.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.job.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self.job.ended:
            self.leave(context)
            return self.end()
        share = 100.0 * self.job.share
        context.window_manager.progress_update(share)
        context.workspace.status_text_set(f"{self.bl_label}: {share:.0f} % (Escape ends it)")
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender calls it when another file is opened, or it quits."""
        self.job.cancel()
        self.leave(context)

    def leave(self, context: bpy.types.Context) -> None:
        windows = context.window_manager
        windows.event_timer_remove(self.timer)
        windows.progress_end()
        if context.workspace:
            context.workspace.status_text_set(None)

    def begin(self, context: bpy.types.Context) -> bool:
        """Exports the scene and begins the work; whether it could."""
        try:
            import lightmesh
        except ImportError as error:
            return self.fail(MISSING.format(error))
        from . import output, sun_study
        from .export.camera import CameraError

        self.notes = Notes()
        try:
            self.study = sun_study.study(context.evaluated_depsgraph_get(), self.notes)
            self.job = StudyOperator.last = self.begin_job(context)
        except (lightmesh.LightmeshError, CameraError, output.OutputError) as error:
            return self.fail(str(error))
        return True

    def end(self) -> set[str]:
        """Tells what came of the work."""
        job = self.job
        if job.error is not None:
            self.fail(job.error)
        elif job.cancelled:
            self.report({"INFO"}, f"{self.bl_label} was stopped")
        if job.result is None:
            return {"CANCELLED"}
        if len(self.notes):
            self.report({"WARNING"}, self.notes.text())
        self.report({"INFO"}, self.finish(job.result))
        return {"FINISHED"}

    def fail(self, text: str) -> bool:
        self.report({"ERROR"}, text)
        return False

    def begin_job(self, context: bpy.types.Context) -> Job:
        raise NotImplementedError

    def finish(self, result: object) -> str:
        raise NotImplementedError


class LIGHTMESH_OT_sun_hours(StudyOperator, bpy.types.Operator):
    """Hours of direct sun on what the camera sees, as a picture with a legend and as numbers, among the images of the file"""

    bl_idname = "lightmesh.sun_hours"
    bl_label = "Hours of Sun"
    bl_options = {"REGISTER", "UNDO"}

    def begin_job(self, context: bpy.types.Context) -> Job:
        from . import sun_study
        from .job import Job

        study = self.study
        return Job(lambda job: sun_study.hours(study, job))

    def finish(self, result: Hours) -> str:
        from . import pictures

        pictures.show(result)
        for note in result.notes:
            self.report({"INFO"}, note)
        return f"Up to {result.values.max():.1f} hours of sun: see the images “{pictures.PICTURE}” and “{pictures.VALUES}”"


class LIGHTMESH_OT_render_day(StudyOperator, bpy.types.Operator):
    """Frames of the day, a picture for each step with the sun above the horizon, in files of the output path"""

    bl_idname = "lightmesh.render_day"
    bl_label = "Render Day"

    def begin_job(self, context: bpy.types.Context) -> Job:
        from . import output, sun_study
        from .job import Job

        study, files = self.study, output.of_scene(context.scene, self.notes)
        self.files = files
        return Job(lambda job: sun_study.frames(study, files, job))

    def finish(self, result: Day) -> str:
        kept = "; frames that were there are kept" if self.files.settings.get("skip_existing") else ""
        told = f"{result.count} frames rendered to {self.files.path}{kept}"
        return f"{told}. The sky of the day stands for {self.study.replaced}" if self.study.replaced else told


CLASSES = (LIGHTMESH_OT_sun_hours, LIGHTMESH_OT_render_day)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
