"""A program that uses every public name, for type checkers: `test_types.py` fails if it lacks one. It is checked, and never run.

Functions say of which class their arguments are, which is how the test knows whose members they use. `assert_type` fails where a type is another one,
such as `Any`.
"""

import copy
from collections.abc import Callable
from typing import IO, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import assert_type

import lightmesh
from lightmesh import (
    Camera,
    Cancel,
    Environment,
    Film,
    Frame,
    Geometry,
    Light,
    Material,
    Mattes,
    MeshCache,
    PreparedScene,
    Progress,
    Renderer,
    Scene,
    SunHours,
    Texture,
)
from lightmesh.typing import (
    AnimationInfo,
    Bar,
    BoundsInfo,
    CameraInfo,
    CameraStats,
    Color,
    Counts,
    DeviceInfo,
    DeviceStats,
    Falloff,
    FilmSettings,
    FrameStats,
    ImageSettings,
    Instances,
    LatticeStats,
    LightInfo,
    MemoryStats,
    OpenSettings,
    Path,
    ProgressCallback,
    Quality,
    SaveSettings,
    SceneInfo,
    SceneStats,
    Seconds,
    SettingsStats,
    UpInfo,
    Vector,
    WrapMode,
)

Floats = NDArray[np.float32]
Numbers = NDArray[np.uint32]
Triple = tuple[float, float, float]


def textures(wrap: WrapMode) -> Texture:
    texture = Texture(np.zeros((2, 2, 3), np.uint8), wrap=wrap, transform=[[1, 0, 0], [0, 1, 0]], name="t")
    assert_type(texture, Texture)
    return texture.placed(wrap=("clamp", "mirror"), transform=np.eye(3)[:2])


def of_texture(texture: Texture) -> None:
    assert_type(texture.size, tuple[int, int])
    assert_type(texture.name, str)


def materials(texture: Texture, color: Color) -> list[Material]:
    plain = Material(
        color,
        specular=0.1,
        shininess=20.0,
        emission=(0, 0, 1),
        texture=texture,
        emission_texture=texture,
        normal_texture=texture,
        normal_scale=1.0,
        opacity=0.5,
        catcher=False,
        name="plain",
    )
    principled = Material.principled(
        color,
        metallic=0.5,
        roughness=0.5,
        ior=1.5,
        specular=1.0,
        specular_tint=(1, 1, 1),
        transmission=0.0,
        thin=False,
        emission=0.0,
        alpha=1.0,
        alpha_mode="mask",
        alpha_cutoff=0.5,
        texture=texture,
        emission_texture=texture,
        normal_texture=texture,
        normal_scale=1.0,
        metallic_roughness_texture=texture,
        name="principled",
    )
    assert_type(plain, Material)
    return [plain, principled]


def of_material(material: Material) -> None:
    assert_type(material.name, str)


def geometries(material: Material) -> list[Geometry]:
    corners = np.zeros((3, 3))
    one = Geometry.from_arrays(
        corners,
        [(0, 1, 2)],
        normals=corners,
        uvs=corners[:, :2],
        colors=np.zeros((3, 3), np.uint8),
        material=material,
        transforms=np.eye(4),
        name="one",
    )
    many = Geometry.from_arrays(vertices=corners, triangles=[(0, 1, 2)], materials=[material], material_indices=[0])
    return [one, many]


def of_geometry(geometry: Geometry) -> None:
    assert_type(geometry.name, str)
    assert_type(geometry.vertex_count, int)
    assert_type(geometry.triangle_count, int)
    assert_type(geometry.placed(np.eye(4), name="there"), Geometry)


def lights(position: Vector, color: Color, falloff: Falloff) -> list[Light]:
    return [
        Light.point(position, spread=0.1, intensity=color, falloff=falloff, name="point"),
        Light.directional(position, angle=0.53, intensity=color, falloff=falloff, name="directional"),
        Light.spot(position, position, inner=10.0, outer=20.0, radius=0.1, intensity=color, falloff=falloff, name="spot"),
        Light.sphere(position, 0.5, intensity=color, falloff=falloff, name="sphere"),
        Light.disk(position, position, 0.5, one_sided=False, intensity=color, falloff=falloff, name="disk"),
        Light.rectangle(position, (1, 0, 0), (0, 1, 0), one_sided=False, intensity=color, falloff=falloff, name="rectangle"),
    ]


def of_light(light: Light) -> None:
    assert_type(light.kind, str)
    assert_type(light.name, str)
    assert_type(light.intensity, Triple)
    assert_type(light.falloff, Falloff)
    assert_type(light.position, Triple | None)
    assert_type(light.direction, Triple | None)
    assert_type(light.replaced(position=(0, 0, 0), direction=(0, 0, 1), intensity=2.0, name="other"), Light)
    assert_type(copy.deepcopy(light), Light)


def cameras() -> list[Camera]:
    return [
        Camera((0, 0, 0), (0, 0, 1), up=(0, 1, 0), vfov=45.0, shift=(0.0, 0.1), name="front"),
        Camera((0, 0, 0), direction=(0, 0, 1), hfov=45.0),
        Camera((0, 0, 0), direction=(0, 0, 1), height=2.0, near=0.5, far=None),
        Camera((0, 0, 0), direction=(0, 0, 1), far=9.0),
    ]


def of_camera(camera: Camera) -> None:
    assert_type(camera.name, str)
    assert_type(camera.position, Triple)
    assert_type(camera.direction, Triple)
    assert_type(camera.up, Triple)


def environments(pixels: Floats, path: Path) -> list[Environment]:
    return [
        Environment(pixels, up="z", rotation=90.0, strength=2.0, find_sun=False, name="sky"),
        Environment.open(path, up="y", rotation=90.0, strength=2.0),
    ]


def of_environment(environment: Environment) -> None:
    assert_type(environment.size, tuple[int, int])


def scenes(geometry: Geometry, light: Light, camera: Camera, environment: Environment, path: Path, settings: OpenSettings) -> list[Scene]:
    return [
        Scene(
            [geometry],
            [light],
            camera,
            environment=environment,
            ambient=0.1,
            background=(0, 0, 0),
            instances="auto",
            lamps=False,
            name="scene",
        ),
        Scene(geometry, light),
        Scene.open(path, **settings),
        Scene.builtin("gazebo"),
    ]


def of_scene(scene: Scene, geometry: Geometry, light: Light, camera: Camera, environment: Environment, instances: Instances) -> None:
    assert_type(scene.lights, list[Light])
    scene.lights = light
    scene.lights = [*scene.lights, light]
    assert_type(scene.cameras, list[Camera])
    scene.cameras = [camera]
    assert_type(scene.camera, Camera | None)
    scene.camera = camera
    assert_type(scene.ambient, Triple | None)
    scene.ambient = 0.1
    assert_type(scene.background, Triple | None)
    scene.background = None
    assert_type(scene.environment, Environment | None)
    scene.environment = environment
    assert_type(scene.name, str)
    assert_type(scene.triangle_count, int)
    assert_type(scene.bounds, tuple[Triple, Triple] | None)
    assert_type(scene.origin, Triple)
    assert_type(scene.vertices, Floats)
    assert_type(scene.triangles, Numbers)
    assert_type(scene.normals, Floats | None)
    assert_type(scene.uvs, Floats | None)
    assert_type(scene.colors, Floats | None)
    assert_type(scene.material_indices, Numbers)
    assert_type(scene.object_ranges, Numbers)
    assert_type(scene.objects, list[str])
    assert_type(scene.materials, list[str])
    assert_type(scene.warnings, list[str])
    assert_type(scene.duration, float | None)
    assert_type(scene.at(0.5), Scene)
    assert_type(scene.with_geometry([geometry], instances=instances), Scene)
    assert_type(scene.info(), SceneInfo)


def of_prepared_scene(prepared: PreparedScene, light: Light, camera: Camera) -> None:
    assert_type(prepared.scene, Scene)
    assert_type(prepared.memory, int)
    assert_type(prepared.with_lights(light), PreparedScene)
    assert_type(prepared.with_lights([light]), PreparedScene)
    assert_type(prepared.with_camera(camera), PreparedScene)


def of_mesh_cache(path: Path, prepared: PreparedScene) -> None:
    cache = MeshCache()
    cache = MeshCache.load(path, prepared)
    assert_type(cache.save(path, prepared), int)
    assert_type(len(cache), int)
    assert_type(cache.memory, int)
    cache.clear()


def of_progress(progress: Progress) -> None:
    assert_type(progress.done, float)
    assert_type(progress.seconds, float)
    assert_type(progress.left, float | None)
    assert_type(progress.stage, str)


def of_cancel() -> None:
    cancel = Cancel()
    cancel.cancel()
    assert_type(cancel.cancelled, bool)


def of_mattes(mattes: Mattes) -> None:
    assert_type(mattes.names, list[str])
    assert_type(mattes.nearest, Numbers)
    assert_type(mattes.ranks, list[tuple[Numbers, Floats]])
    assert_type(mattes.cryptomatte(), list[Floats])
    assert_type(mattes.manifest(), str)


def of_frame(frame: Frame, path: Path, file: IO[bytes], settings: SaveSettings) -> None:
    assert_type(frame.size, tuple[int, int])
    assert_type(frame.rgb, Floats)
    assert_type(frame.alpha, Floats | None)
    assert_type(frame.depth, Floats)
    assert_type(frame.normal, Floats)
    assert_type(frame.position, Floats)
    assert_type(frame.visibility, list[Floats])
    assert_type(frame.lights, list[Floats])
    assert_type(frame.rest, Floats | None)
    assert_type(frame.used, Numbers)
    assert_type(frame.ids, Mattes)
    assert_type(frame.material_ids, Mattes)
    assert_type(frame.stats, FrameStats)
    assert_type(frame.exposure, float)
    assert_type(frame.number, int | None)
    assert_type(frame.when, str)
    assert_type(frame.finished_rows, int)
    assert_type(frame.notes, list[str])
    frame.save(path, **settings)
    frame.save(file, format="png")
    frame.save_layers(path, **settings)
    frame.save_layers(file)
    assert_type(frame.to_png(**settings), bytes)
    assert_type(np.asarray(frame, dtype=np.float32), Floats)


def of_film(film: Film) -> None:
    assert_type(len(film), int)
    assert_type(film.notes, list[str])
    assert_type(next(film), Frame)
    for frame in film:
        assert_type(frame, Frame)


def of_sun_hours(hours: SunHours, path: Path, file: IO[bytes]) -> None:
    assert_type(hours.hours, Floats)
    assert_type(hours.mask, NDArray[np.bool_])
    assert_type(hours.table, str)
    assert_type(hours.notes, list[str])
    assert_type(hours.table_notes, list[str])
    hours.save(path)
    hours.save(file, format="csv")


def of_renderer(
    scene: Scene,
    light: Light,
    path: Path,
    progress: ProgressCallback,
    cancel: Cancel,
    cache: MeshCache,
    settings: ImageSettings,
    film_settings: FilmSettings,
) -> None:
    renderer = Renderer("auto", threads=2)
    assert_type(renderer.device, str)
    assert_type(renderer.reason, str)
    assert_type(renderer.threads, int)
    before = renderer.prepare(scene)
    prepared = renderer.prepare(scene, before=before, lights=light, progress=progress, cancel=cancel, **settings)
    assert_type(prepared, PreparedScene)
    frame = renderer.render(prepared, cache=cache, lights=[light], progress=progress, cancel=cancel, **settings)
    assert_type(frame, Frame)
    film = renderer.film(
        path,
        path,
        layers_file=path,
        stats=path,
        mesh_file=path,
        lights=light,
        progress=progress,
        cancel=cancel,
        **film_settings,
    )
    assert_type(film, Film)
    assert_type(renderer.sun_hours(scene, progress=progress, cancel=cancel, **film_settings), SunHours)
    points = np.zeros((1, 3))
    shares = renderer.visibility(points, points, scene, light, progress=progress, cancel=cancel, **settings)
    assert_type(shares, Floats)


def image_settings(light: Light, camera: Camera, environment: Environment, path: Path, quality: Quality) -> ImageSettings:
    settings: ImageSettings = {
        "memory_limit": "1G",
        "exposure": "auto",
        "mode": "light-mesh",
        "bounces": 1,
        "step": 0.1,
        "radius": 2.1,
        "weight": "smooth",
        "lookup": "lists",
        "quality": quality,
        "aa": 4,
        "filter": "gauss",
        "short_tests": "cells",
        "samples": 16,
        "seed": 1,
        "size": (64, 48),
        "crop": (0, 0, 8, 8),
        "background": "transparent",
        "ground": True,
        "studio": False,
        "no_studio": False,
        "partial": True,
        "camera": camera,
        "camera_name": None,
        "up": "y",
        "light": [light],
        "falloff": "none",
        "ambient": (0.1, 0.1, 0.1),
        "ambient_light": "mesh",
        "sky": "uniform",
        "environment": environment,
        "accel": "bvh",
        "grid": (1, 2, 3),
        "grid_file": path,
        "layers": True,
    }
    return settings


def film_settings() -> FilmSettings:
    settings: FilmSettings = {
        "turntable": 3,
        "glass": "open",
        "sun": None,
        "frames": "1-3",
        "fps": 24.0,
        "resume": True,
        "skip_existing": False,
        "overwrite": False,
    }
    return settings


def save_settings() -> SaveSettings:
    settings: SaveSettings = {
        "format": "png",
        "transfer": "srgb",
        "view": "agx",
        "bit_depth": 16,
        "dither": True,
        "exr_type": "half",
        "exr_compression": "zip",
        "exr_parts": "multi",
        "exposure": 1.0,
    }
    return settings


def open_settings() -> OpenSettings:
    settings: OpenSettings = {
        "scene_format": "obj",
        "allow_outside": True,
        "strict": True,
        "animation": "walk",
        "smooth": 30.0,
        "instances": "never",
        "memory_limit": 1 << 30,
    }
    return settings


def of_scene_info(info: SceneInfo) -> None:
    assert_type(info["triangles"], int)
    assert_type(info["instances"], int)
    assert_type(info["normals"], int)
    assert_type(info["smooth_normals"], int)
    assert_type(info["bounds"], BoundsInfo | None)
    assert_type(info["lights"], list[LightInfo])
    assert_type(info["cameras"], list[CameraInfo])
    assert_type(info["materials"], int)
    assert_type(info["cut_outs"], int)
    assert_type(info["see_through"], int)
    assert_type(info["textures"], int)
    assert_type(info["up"], UpInfo | None)
    assert_type(info["animation"], AnimationInfo | None)
    assert_type(info["warnings"], list[str])


def of_parts_of_info(bounds: BoundsInfo, light: LightInfo, camera: CameraInfo, up: UpInfo, animation: AnimationInfo) -> None:
    assert_type(bounds["min"], list[float])
    assert_type(light.get("radius"), float | None)
    assert_type(camera["vfov"], float | None)
    assert_type(up["axis"], Literal["y", "z"])
    assert_type(animation["seconds"], float)


def of_stats(stats: FrameStats) -> None:
    assert_type(stats["version"], int)
    assert_type(stats["scene"], SceneStats)
    assert_type(stats["device"], DeviceStats)
    assert_type(stats["settings"], SettingsStats)
    assert_type(stats["settings"]["camera"], CameraStats)
    assert_type(stats["settings"]["lattice"], LatticeStats | None)
    assert_type(stats["counts"], Counts)
    assert_type(stats["seconds"], Seconds)
    assert_type(stats["seconds"]["build"], float)
    assert_type(stats["memory"], MemoryStats)
    assert_type(stats.get("finished_rows"), int | None)


def of_the_module(scene: Scene, light: Light, bar: Bar, settings: ImageSettings) -> None:
    points = np.zeros((1, 3))
    assert_type(lightmesh.visibility(points, points, scene, light, device="cpu", **settings), Floats)
    assert_type(lightmesh.devices(), list[DeviceInfo])
    assert_type(lightmesh.follow(bar), Callable[[Progress], None])
    assert_type(lightmesh.__version__, str)


def errors() -> None:
    for kind in (
        lightmesh.ArgumentError,
        lightmesh.Cancelled,
        lightmesh.DeviceError,
        lightmesh.DeviceMemoryError,
        lightmesh.GeometryError,
        lightmesh.HostMemoryError,
        lightmesh.LayersError,
        lightmesh.MeshFileError,
        lightmesh.SaveError,
        lightmesh.SceneError,
        lightmesh.SettingError,
    ):
        error: lightmesh.LightmeshError = kind("text")
        error.add_note("note")
    for category in (lightmesh.LightmeshWarning, lightmesh.MeshFileWarning, lightmesh.SceneWarning):
        warning: UserWarning = category("text")
        print(warning)
