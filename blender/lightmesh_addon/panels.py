"""Panels of the engine's own settings; Blender's own ones of lights, materials, cameras and output are shown for it, too."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

ENGINE = "LIGHTMESH"
#: Blender's panels that are made for other engines, and hold for this one, too.
ALSO = {
    "DATA_PT_EEVEE_light",
    "DATA_PT_area",
    "DATA_PT_spot",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "VIEWLAYER_PT_layer_passes_cryptomatte",
}
#: Those that set what this engine does not have.
NOT = {
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "VIEWLAYER_PT_freestyle",
    "RENDER_PT_freestyle",
    "RENDER_PT_simplify",
    "DATA_PT_light",
    "DATA_PT_camera_dof",
}


class RenderPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.show(layout, context)


class LIGHTMESH_PT_sampling(RenderPanel, bpy.types.Panel):
    bl_label = "Shadows"

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        settings = context.scene.lightmesh
        layout.prop(settings, "device")
        layout.prop(settings, "mode")
        column = layout.column()
        column.active = settings.mode in ("LISTS", "ADAPTIVE")
        column.prop(settings, "quality")
        column = layout.column(align=True)
        column.active = settings.mode != "RAY_TRACE"
        column.prop(settings, "samples")
        layout.prop(settings, "pixel_samples")


class LIGHTMESH_PT_light_mesh(RenderPanel, bpy.types.Panel):
    bl_label = "Light Mesh"
    bl_parent_id = "LIGHTMESH_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        settings = context.scene.lightmesh
        column = layout.column()
        column.active = settings.mode == "HALF_BALL"
        column.prop(settings, "step")
        column.prop(settings, "radius")
        layout.prop(settings, "seed")


class LIGHTMESH_PT_light_paths(RenderPanel, bpy.types.Panel):
    bl_label = "Reflections and Ambient Light"

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        settings = context.scene.lightmesh
        layout.prop(settings, "bounces")
        layout.prop(settings, "ambient_light")


class LIGHTMESH_PT_film(RenderPanel, bpy.types.Panel):
    bl_label = "Film"

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        layout.prop(context.scene.render, "film_transparent", text="Transparent")


class LIGHTMESH_PT_sun_study(RenderPanel, bpy.types.Panel):
    bl_label = "Sun Study"
    bl_options = {"DEFAULT_CLOSED"}

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        sun = context.scene.lightmesh.sun
        for names in (("latitude", "longitude", "north"), ("year", "month", "day", "offset"), ("begin", "end", "step")):
            column = layout.column(align=True)
            for name in names:
                column.prop(sun, name)
        layout.prop(sun, "glass")
        layout.prop(sun, "strength")
        layout.operator("lightmesh.sun_hours", icon="LIGHT_SUN")
        layout.operator("lightmesh.render_day", icon="RENDER_ANIMATION")


class LIGHTMESH_PT_passes(RenderPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def show(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        layer = context.view_layer
        column = layout.column(heading="Data")
        column.prop(layer, "use_pass_z", text="Z")
        column.prop(layer, "use_pass_position")
        column.prop(layer, "use_pass_normal")
        column = layout.column(heading="Indices")
        column.prop(layer, "use_pass_object_index")
        column.prop(layer, "use_pass_material_index")
        column = layout.column(heading="Light")
        column.prop(layer.lightmesh, "use_pass_visibility")


CLASSES = (
    LIGHTMESH_PT_sampling,
    LIGHTMESH_PT_light_mesh,
    LIGHTMESH_PT_light_paths,
    LIGHTMESH_PT_film,
    LIGHTMESH_PT_sun_study,
    LIGHTMESH_PT_passes,
)


def shared() -> Iterator[type[bpy.types.Panel]]:
    """Blender's panels that hold for this engine."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel.__name__ in NOT or panel in CLASSES:
            continue
        if "BLENDER_RENDER" in engines or panel.__name__ in ALSO:
            yield panel


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for panel in shared():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    for panel in bpy.types.Panel.__subclasses__():
        if panel not in CLASSES and hasattr(panel, "COMPAT_ENGINES"):
            panel.COMPAT_ENGINES.discard(ENGINE)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
