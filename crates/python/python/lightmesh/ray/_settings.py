"""The settings that films and pictures on a cluster take as keyword arguments. Made by `cargo xtask settings`."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict, Union

from numpy.typing import ArrayLike

_Path = Union[str, PathLike[str]]
_Color = Union[float, ArrayLike]

class PictureRequest(TypedDict, total=False):
    """Settings of a picture on a cluster: those of `lightmesh render`. What is left out, or `None`, is as there."""

    scene_format: Literal["toml", "obj", "gltf", "glb", "ply", "stl"] | None
    """Read the scene in this format [default: by the extension]"""
    allow_outside: bool | None
    """Allow references to files outside the scene's folder"""
    strict: bool | None
    """Treat warnings as errors (exit code 2)"""
    memory_limit: int | str | None
    """Use at most this much memory, as in 512M, on host and device each; if work cannot be split to fit, the exit code is 3 [default: free memory minus a reserve]"""
    animation: str | None
    """Play the animation of this name in a glTF file [default: all that do not conflict]"""
    smooth: float | Literal["off"] | None
    """Smooth edges below this crease angle in OBJ, PLY and STL files without normals; off shows facets [default: 30; off with lookup half-ball]"""
    instances: Literal["auto", "always", "never"] | None
    """Store meshes in many places once: less memory, slower rays [default: auto]"""
    format: Literal["bmp", "png", "exr", "jpg"] | None
    """Write the image in this format [default: by the extension]"""
    transfer: Literal["srgb", "linear"] | None
    """Encode 8-bit and 16-bit files by this function; exr files stay linear [default: srgb]"""
    view: Literal["standard", "neutral", "agx"] | None
    """Show colours brighter than white in this way; exr files stay linear [default: standard]"""
    bit_depth: Literal[8, 16] | None
    """Write png files with this many bits per channel [default: 8]"""
    dither: bool | None
    """Dither 8-bit files against bands in smooth gradients; files become larger [default: off]"""
    exr_type: Literal["float", "half"] | None
    """Store exr files as these numbers [default: float]"""
    exr_compression: Literal["zip", "zips", "piz", "rle", "none"] | None
    """Compress exr files without loss [default: zip]"""
    exr_parts: Literal["single", "multi"] | None
    """Divide the channels of layers into parts [default: single]"""
    exposure: float | Literal["auto"] | None
    """Brighten 8-bit and 16-bit files by this many stops; auto suits any light; exr stays linear [default: auto with photometric lights, by what is seen under sky, else 0]"""
    mode: Literal["light-mesh", "ray-trace", "area"] | None
    """Compute shadows by this method [default: light-mesh]"""
    bounces: int | None
    """Follow mirror reflections to this depth, in any mode; in the studio, at least to 1 [default: 0]"""
    step: float | Literal["auto"] | None
    """Set the light-mesh step h in scene units; auto derives it from the size of a pixel in the scene [default: the scene's, else auto]"""
    radius: float | None
    """Set the interpolation radius in steps, r/h [default: the scene's, else 2.1]"""
    weight: Literal["constant", "quadratic", "smooth"] | None
    """Weight light points at distance d by their q = d/r [default: the scene's, else smooth]"""
    lookup: Literal["auto", "lists", "half-ball", "adaptive"] | None
    """Find the visibility of lights in light-mesh mode by this method [default: auto]"""
    quality: Literal["draft", "good", "final"] | None
    """Choose the number of samples of lights with a size and of pixels [default: good]"""
    aa: int | None
    """Take N samples of each pixel, in any mode; 1 is its centre [default: by quality; 1 with half-ball, ray-trace and area]"""
    filter: Literal["box", "gauss", "blackman-harris"] | None
    """Average the samples of a pixel by this filter [default: blackman-harris]"""
    short_tests: Literal["cells", "plain"] | None
    """Evaluate short tests by this method; the image is the same [default: cells]"""
    samples: int | None
    """Take N samples of each light with a size, in each pixel or, with half-ball, at each light point [default: by quality; area 225, half-ball 4]"""
    seed: int | None
    """Seed the sampling pattern: same seed, same image [default: 0]"""
    size: tuple[int, int] | str | None
    """Set width and height in pixels [default: 1024x1024]"""
    crop: tuple[int, int, int, int] | str | None
    """Render only this part, also beyond the edges: column and row of its first pixel, width and height; pixels stay the same [default: the whole image]"""
    background: _Color | str | None
    """Set the background: one number, r,g,b, '#rrggbb' (sRGB) or transparent, which gives png and exr files an alpha channel [default: the scene's, else black or the studio's]"""
    ground: bool | None
    """Add a ground below the scene that catches its shadows and shows the background, or is transparent with it"""
    studio: bool | None
    """Light the model in a studio, in interiors, too; not beside other light [default: where there is no light and no background]"""
    no_studio: bool | None
    """Give a model without lights a key light and a fill light only, and under sky no ground and horizon"""
    camera: str | None
    """Place the camera: position, target and vertical field of view in degrees, as in '0,2,5;0,1,0;45' [default: the scene's first, else one that frames the scene]"""
    camera_name: str | None
    """Use the scene's camera of this name [default: the first]"""
    up: Literal["auto", "y", "z"] | None
    """Set the up axis for camera, and for scenes without a camera [default: auto]"""
    light: str | Sequence[str] | None
    """Replace the scene's lights: position, intensity (one number or r,g,b) and radius, as in '3,8,2;0.9;0.25'; repeatable [default: the scene's, else a studio]"""
    falloff: Literal["none", "inverse-square"] | None
    """Set how the lights of light fall off with distance [default: none]"""
    ambient: _Color | str | None
    """Set the ambient intensity, one number or r,g,b [default: the mean of the sky or environment, else the scene's, else 0.1 or suited to the lights]"""
    ambient_light: Literal["auto", "constant", "mesh", "rays"] | None
    """Choose how surfaces get light from the sky and from each other [default: auto]"""
    sky: str | None
    """Set the sky: clear, uniform or gradient, as in 'clear;sun=40,225'; also place, time, turbidity, ground, color, zenith, horizon, north, strength, alone [default: none]"""
    environment: _Path | None
    """Put the scene into an equirectangular .hdr or .exr panorama, as in 'street.hdr;rotation=90;strength=2;alone' [default: none]"""
    accel: Literal["auto", "grid", "bvh"] | None
    """Choose the acceleration structure [default: auto]"""
    grid: tuple[int, int, int] | str | None
    """Set the cells of the grid along each axis; implies accel grid [default: from the number of triangles]"""
    grid_file: _Path | None
    """Load the grid that `lightmesh grid` saved; implies accel grid [default: none]"""
    device: str | None
    """Render on cpu, cuda (the first that works), cuda:N, several (cuda:all, cuda:0,1) or auto, the fastest; `lightmesh info --devices` lists them [default: auto]"""
    threads: int | None
    """Use N CPU threads [default: all]"""

class FilmRequest(PictureRequest, total=False):
    """The same of a film."""

    turntable: int | None
    """Turn the camera once around the scene in N frames; `####` or `%04d` in file names stands for the number of the frame [default: off]"""
    sun: str | None
    """Render a day under a clear sky, a frame for each STEP in minutes or hours, as in '54.98,82.9,2026-06-21+07:00,06:00-20:00/15m'; hours need no STEP [default: off]"""
    glass: Literal["open", "closed", "tinted"] | None
    """Count panes and other surfaces that let light through as this in hours of direct sun [default: open]"""
    fps: float | str | None
    """Set the frames per second of animation and movie, as a decimal or a ratio such as 30000/1001 [default: 24]"""
    resume: bool | None
    """Resume an interrupted film, with an identical result, or begin it; fails if scene or settings differ from those in manifest.json"""
    skip_existing: bool | None
    """Keep frames whose image exists, and render the others"""
    overwrite: bool | None
    """Replace frames whose image exists"""
