"""What `Scene.info`, `Frame.stats` and `devices` return: dictionaries with these keys. Those of classes that are not `total` may be missing."""

from __future__ import annotations

from typing import Literal, TypedDict


class BoundsInfo(TypedDict):
    """A box, world coordinates."""

    min: list[float]
    max: list[float]


class _Light(TypedDict):
    kind: Literal["point", "directional", "spot", "sphere", "disk", "rectangle"]
    position: list[float] | None
    """`None` of a directional light."""
    direction: list[float] | None
    """The way that it shines, or the axis of a disk or rectangle; `None` of a point or sphere."""
    intensity: list[float]
    falloff: Literal["none", "inverse-square"]


class LightInfo(_Light, total=False):
    """A light. What its kind does not have is missing. Angles are in degrees."""

    name: str
    radius: float
    spread: float
    angle: float
    one_sided: bool
    size: list[float]
    inner: float
    outer: float


class _Camera(TypedDict):
    name: str
    position: list[float]
    direction: list[float]
    up: list[float]
    vfov: float | None
    """Degrees; `None` of an orthographic camera."""


class CameraInfo(_Camera, total=False):
    """A camera. What it does not have is missing."""

    hfov: float
    height: float
    shift: list[float]
    near: float
    far: float


class UpInfo(TypedDict):
    """Which axis is up, and what indicates it."""

    axis: Literal["y", "z"]
    reason: str


class AnimationInfo(TypedDict):
    """How a scene moves."""

    seconds: float
    moves_surfaces: bool
    played: list[str]
    others: list[str]
    """Animations that are not played, since they move what another one moves."""


class SceneInfo(TypedDict):
    """What is in a scene."""

    triangles: int
    """In all places."""
    instances: int
    """Places of shapes that are stored once."""
    normals: int
    smooth_normals: int
    """How many normals were made while the scene was read."""
    bounds: BoundsInfo | None
    lights: list[LightInfo]
    cameras: list[CameraInfo]
    materials: int
    cut_outs: int
    see_through: int
    textures: int
    up: UpInfo | None
    animation: AnimationInfo | None
    warnings: list[str]


class SceneStats(TypedDict):
    """What was rendered."""

    name: str
    triangles: int
    lights: int


class DeviceStats(TypedDict):
    """The device that rendered it."""

    kind: Literal["cpu", "cuda", "cuda,cpu"]
    name: str


class _CameraStats(TypedDict):
    position: list[float]
    direction: list[float]
    up: list[float]
    vfov: float | None
    height: float | None


class CameraStats(_CameraStats, total=False):
    """The camera, world coordinates."""

    shift: list[float]
    near: float
    far: float


class LatticeStats(TypedDict):
    """The lattice of light points: point i, j, k is at origin + step · (i, j, k)."""

    origin: list[float]
    step: float
    dims: list[int]


class SettingsStats(TypedDict):
    """Every setting as used, named as the flags are."""

    mode: str
    bounces: int
    size: list[int]
    crop: list[int] | None
    device: str
    threads: int
    step: float | None
    step_auto: bool
    radius: float | None
    weight: str | None
    lookup: str | None
    quality: str | None
    aa: int
    filter: str | None
    short_tests: str | None
    samples: int
    accel: str
    camera: CameraStats
    ambient: list[float]
    ambient_light: str
    background: list[float]
    environment: str | None
    transparent: bool
    seed: int
    memory_limit: int | None
    rows_per_band: int
    lattice: LatticeStats | None


class Counts(TypedDict):
    """How often each event happened. Means are taken over the surface points, including those seen in mirrors."""

    pixels: int
    template: int
    non_finite_pixels: int
    rays: int
    hits: int
    surface_points: int
    half_ball_mean: float
    used_mean: float
    fallback_share: float
    light_points: int
    short_tests: int
    short_tests_culled: int
    long_tests: int
    long_tests_saved: int
    shadow_rays: int
    gather_rays: int
    overruns: int


class Seconds(TypedDict):
    """Time spent in each stage."""

    load: float
    build: float
    upload: float
    camera_rays: float
    primary_rays: float
    pixel_samples: float
    fragments: float
    cells: float
    items: float
    short_tests: float
    collect: float
    long_tests: float
    interpolate: float
    shadow_rays: float
    area_shadows: float
    adaptive_shadows: float
    occluder_lists: float
    filters: float
    gather: float
    shade: float
    mirror_rays: float
    merged_rays: float
    film: float
    download: float
    render: float
    """The whole image, from prepared scene to frame."""
    write: float


class MemoryStats(TypedDict):
    """Peak memory in bytes; 0 if the system does not report it."""

    host_peak_bytes: int
    device_peak_bytes: int


class _Frame(TypedDict):
    version: int
    scene: SceneStats
    device: DeviceStats
    settings: SettingsStats
    counts: Counts
    seconds: Seconds
    memory: MemoryStats


class FrameStats(_Frame, total=False):
    """Counts, seconds, memory and settings of a frame."""

    finished_rows: int
    """Only of a render that was stopped: the rows that are finished, from the top."""


class DeviceInfo(TypedDict):
    """A device that was found or searched for, and whether it can be used."""

    device: str
    name: str
    usable: bool
    remark: str
    """If it cannot be used, why not and what to do."""
    memory_bytes: int | None
    free_bytes: int | None
    compute_capability: str | None
    driver_cuda_version: str | None
