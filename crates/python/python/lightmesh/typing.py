"""Types for annotations of programs that use Lightmesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Literal, TypedDict, Union

from numpy.typing import ArrayLike

from ._lightmesh import Camera, Environment, Progress

Path = Union[str, PathLike[str]]
#: Three numbers: a position or a way in scene units, world coordinates.
Vector = ArrayLike
#: Linear radiance or reflectance with Rec. 709 primaries: one number for grey, or red, green and blue.
Color = Union[float, ArrayLike]
Quality = Literal["draft", "good", "final"]
Falloff = Literal["none", "inverse-square"]
Instances = Literal["auto", "always", "never"]
WrapMode = Literal["repeat", "mirror", "clamp"]

class ImageSettings(TypedDict, total=False):
    """Settings of an image: the flags of `lightmesh render` by their names, with `_` for `-`. What is left out, or `None`, is as there."""

    mode: Literal["light-mesh", "ray-trace", "area"] | None
    lookup: Literal["auto", "lists", "adaptive", "half-ball"] | None
    quality: Quality | None
    bounces: int | None
    step: float | Literal["auto"] | None
    radius: float | None
    weight: Literal["constant", "quadratic", "smooth"] | None
    samples: int | None
    aa: int | None
    filter: Literal["box", "gauss", "blackman-harris"] | None
    short_tests: Literal["cells", "plain"] | None
    seed: int | None
    size: tuple[int, int] | str | None
    crop: tuple[int, int, int, int] | str | None
    background: Color | str | None
    ground: bool | None
    studio: bool | None
    no_studio: bool | None
    camera: Camera | str | None
    light: str | Sequence[str] | None
    falloff: Falloff | None
    camera_name: str | None
    up: Literal["auto", "y", "z"] | None
    ambient: Color | str | None
    ambient_light: Literal["auto", "constant", "mesh", "rays"] | None
    sky: str | None
    environment: Environment | Path | None
    exposure: float | Literal["auto"] | None
    partial: bool | None
    layers: bool | None
    accel: Literal["auto", "grid", "bvh"] | None
    grid: tuple[int, int, int] | str | None
    grid_file: Path | None
    memory_limit: int | str | None

class SaveSettings(TypedDict, total=False):
    """How an image file shows a frame: the flags of `lightmesh render` by their names."""

    format: Literal["bmp", "png", "exr", "jpg"] | None
    transfer: Literal["srgb", "linear"] | None
    exposure: float | Literal["auto"] | None
    view: Literal["standard", "neutral", "agx"] | None
    bit_depth: Literal[8, 16] | None
    dither: bool | None
    exr_type: Literal["float", "half"] | None
    exr_compression: Literal["zip", "zips", "piz", "rle", "none"] | None
    exr_parts: Literal["single", "multi"] | None

class OpenSettings(TypedDict, total=False):
    """How a scene file is read: the flags of `lightmesh render` by their names."""

    scene_format: str | None
    smooth: float | Literal["off"] | None
    instances: Instances | None
    animation: str | None
    allow_outside: bool | None
    strict: bool | None
    memory_limit: int | str | None

#: Called now and then by the thread that asked for the render. What it raises stops the render, and is raised there.
ProgressCallback = Callable[[Progress], object]
