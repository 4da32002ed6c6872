"""Settings of scenes and view layers."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from .choices import AMBIENT, GLASS, QUALITIES, TECHNIQUES

#: Kept, because Blender does not keep the texts of items that a function returns.
_devices = []


def device_items(self=None, context: bpy.types.Context | None = None) -> list[tuple[str, str, str, int]]:
    """The devices of this machine; numbers stay the same on machines with others."""
    if not _devices:
        _devices.append(("auto", "Automatic", "A CUDA device if one can be used, else the CPU", 0))
        try:
            import lightmesh

            found = lightmesh.devices()
        except Exception:  # Without the package, rendering says what is missing.
            found = []
        for device in found:
            name = device["device"]
            if device.get("usable"):
                label = device.get("name") or name
                number = 1 if name == "cpu" else 2 if name == "cuda" else 10 + int(name.rpartition(":")[2])
                _devices.append((name, f"{label} ({name})" if label != name else name, device.get("remark") or "", number))
    return _devices


class LightmeshSunSettings(bpy.types.PropertyGroup):
    """A day at a place; numbers are those of `--sun` and `--sky`."""

    latitude: FloatProperty(name="Latitude", min=-90.0, max=90.0, default=54.98, precision=4, step=100, description="Degrees north")
    longitude: FloatProperty(name="Longitude", min=-180.0, max=180.0, default=82.9, precision=4, step=100, description="Degrees east")
    north: FloatProperty(
        name="North", min=-360.0, max=360.0, default=0.0, precision=1, step=100, description="Degrees of north, clockwise from +Y, seen from above"
    )
    year: IntProperty(name="Year", min=1901, max=2099, default=2026, description="Year of the day")
    month: IntProperty(name="Month", min=1, max=12, default=6, description="Month of the day")
    day: IntProperty(name="Day", min=1, max=31, default=21, description="Day of the month")
    offset: FloatProperty(
        name="UTC Offset",
        min=-18.0,
        max=18.0,
        default=7.0,
        precision=2,
        step=50,
        description="Hours by which the clock is ahead of universal time, with summer time if there is any",
    )
    begin: FloatProperty(name="From", min=0.0, max=24.0, default=6.0, precision=2, step=50, description="Hour at which the study begins")
    end: FloatProperty(name="To", min=0.0, max=24.0, default=20.0, precision=2, step=50, description="Hour at which the study ends")
    step: IntProperty(
        name="Step",
        min=1,
        max=1440,
        default=15,
        soft_max=120,
        description="Minutes from one frame of a day to the next. Hours of sun are those of all times, unless a step is set",
    )
    glass: EnumProperty(
        name="Glass",
        items=GLASS,
        default="OPEN",
        description="What panes and other surfaces that let light through do to hours of sun",
    )
    strength: FloatProperty(
        name="Sky Strength",
        min=0.0,
        soft_max=10.0,
        default=1.0,
        description="Factor of sky and sun in the frames of a day; with 1, white that faces the sun shows about 1",
    )


class LightmeshSceneSettings(bpy.types.PropertyGroup):
    quality: EnumProperty(name="Quality", items=QUALITIES, default="GOOD", description="How smooth soft shadows and edges are")
    mode: EnumProperty(name="Shadows", items=TECHNIQUES, default="LISTS", description="How visibility of lights is computed")
    device: EnumProperty(name="Device", items=device_items, description="What renders")
    samples: IntProperty(name="Light Samples", min=0, max=65535, default=0, description="Samples of each light; 0: by quality")
    pixel_samples: IntProperty(name="Pixel Samples", min=0, max=65536, soft_max=64, default=0, description="Samples of each pixel; 0: by quality")
    bounces: IntProperty(name="Mirror Bounces", min=0, max=64, default=2, description="Greatest depth of mirror reflections")
    ambient_light: EnumProperty(
        name="Ambient Light", items=AMBIENT, default="AUTO", description="What stands for light that comes from no light directly"
    )
    step: FloatProperty(
        name="Step",
        min=0.0,
        default=0.0,
        subtype="DISTANCE",
        unit="LENGTH",
        description="Distance of light points; 0: from the size of a pixel in the scene",
    )
    radius: FloatProperty(name="Radius", min=1.0, soft_max=5.0, default=2.1, description="Radius of interpolation in steps")
    seed: IntProperty(name="Seed", min=0, default=0, description="Seed of the sampling pattern: the same seed gives the same image")
    sun: PointerProperty(type=LightmeshSunSettings)


class LightmeshViewLayerSettings(bpy.types.PropertyGroup):
    use_pass_visibility: BoolProperty(
        name="Light Visibility",
        default=False,
        description="A pass for each light: the share of it that is seen",
        update=lambda self, context: context.view_layer.update_render_passes(),
    )


CLASSES = (LightmeshSunSettings, LightmeshSceneSettings, LightmeshViewLayerSettings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.lightmesh = PointerProperty(type=LightmeshSceneSettings)
    bpy.types.ViewLayer.lightmesh = PointerProperty(type=LightmeshViewLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.lightmesh
    del bpy.types.Scene.lightmesh
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
