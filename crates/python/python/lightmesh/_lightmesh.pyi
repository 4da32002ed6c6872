"""The compiled module: everything that `lightmesh` exports comes from here, but for exceptions and helpers of progress bars."""

import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import IO, Literal, final

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray
from typing_extensions import Self, Unpack

from ._info import DeviceInfo, FrameStats, SceneInfo
from .typing import Color, Falloff, FilmSettings, ImageSettings, Instances, OpenSettings, Path, ProgressCallback, SaveSettings, Vector, WrapMode

__all__ = [
    "Camera",
    "Cancel",
    "Environment",
    "Film",
    "Frame",
    "Geometry",
    "Light",
    "Material",
    "Mattes",
    "MeshCache",
    "PreparedScene",
    "Progress",
    "Renderer",
    "Scene",
    "SunHours",
    "Texture",
    "__version__",
    "command",
    "devices",
    "visibility",
]

@final
class Texture:
    """An image on a surface, with the way it is placed.

    `pixels` has shape (H, W, 3) or (H, W, 4), `uint8`, row 0 at the top: colours as sRGB, data (normals, roughness) as they are. `wrap`
    says how it goes on beyond its edges, across and down. `transform`, shape (2, 3), takes the texture coordinates of vertices to those
    of the image, whose origin is the upper left corner. `name` is for display.
    """

    def __new__(
        cls,
        pixels: NDArray[np.uint8],
        *,
        wrap: WrapMode | tuple[WrapMode, WrapMode] = "repeat",
        transform: ArrayLike | None = None,
        name: str = "",
    ) -> Self: ...
    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    def placed(self, *, wrap: WrapMode | tuple[WrapMode, WrapMode] | None = None, transform: ArrayLike | None = None) -> Texture:
        """The same image, placed otherwise; nothing is copied."""
    def __copy__(self) -> Texture: ...
    def __deepcopy__(self, _memo: object) -> Texture: ...

@final
class Material:
    """What a surface reflects, emits and lets through.

    The constructor makes matt surfaces and mirrors of formula (1): `color` is k_d (and k_a), `specular` k_s with the Phong exponent
    `shininess`. `Material.principled` is for everything that is described by metallic and roughness. Both have what follows.

    `emission` is the radiance that it emits. `texture` tints `color`, `emission_texture` tints `emission`, and `normal_texture` turns normals, by slopes
    times `normal_scale`. `opacity` is the share of the light that it stops, a `catcher` shows only the shadows on it, and `name` is what
    `Frame.material_ids` call it.
    """

    def __new__(
        cls,
        color: Color = 0.8,
        *,
        specular: Color = 0.0,
        shininess: float = 20.0,
        emission: Color = 0.0,
        texture: Texture | None = None,
        emission_texture: Texture | None = None,
        normal_texture: Texture | None = None,
        normal_scale: float = 1.0,
        opacity: float = 1.0,
        catcher: bool = False,
        name: str = "",
    ) -> Self: ...
    @staticmethod
    def principled(
        color: Color = 0.8,
        *,
        metallic: float = 0.0,
        roughness: float = 0.5,
        ior: float = 1.5,
        specular: float = 1.0,
        specular_tint: Color = 1.0,
        transmission: float = 0.0,
        thin: bool = False,
        emission: Color = 0.0,
        alpha: float = 1.0,
        alpha_mode: Literal["opaque", "mask", "blend"] = "opaque",
        alpha_cutoff: float = 0.5,
        texture: Texture | None = None,
        emission_texture: Texture | None = None,
        normal_texture: Texture | None = None,
        normal_scale: float = 1.0,
        metallic_roughness_texture: Texture | None = None,
        name: str = "",
    ) -> Material:
        """A material of glTF's metallic-roughness model, read as from a glTF file.

        `texture` tints `color`; its alpha counts with `alpha_mode` "mask" (what is below `alpha_cutoff` is not there) and "blend".
        `metallic_roughness_texture` has roughness in its green and metallic in its blue channel, which are multiplied by the factors.
        `transmission` is the share of what is not metal that goes through as through glass of index `ior`, straight on if `thin`. `metallic` is the share
        of metal, `roughness` that of its facets, `specular` and `specular_tint` are strength and colour of what is reflected by what is not metal, and
        `alpha` is the opacity.
        """
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    def __copy__(self) -> Material: ...
    def __deepcopy__(self, _memo: object) -> Material: ...

@final
class Geometry:
    """Triangles with materials, in one place or many."""

    @staticmethod
    def from_arrays(
        vertices: ArrayLike,
        triangles: ArrayLike,
        *,
        normals: ArrayLike | None = None,
        uvs: ArrayLike | None = None,
        colors: ArrayLike | None = None,
        material: Material | None = None,
        materials: Sequence[Material] | None = None,
        material_indices: ArrayLike | None = None,
        transforms: ArrayLike | None = None,
        name: str = "",
    ) -> Geometry:
        """An object.

        `vertices`: (V, 3) `float32` or `float64`, scene units. `triangles`: (T, 3) indices of vertices, counterclockwise seen from the front.
        `normals`: (V, 3), need not be of unit length; `None`: flat. `uvs`: (V, 2), origin in the upper left corner of the image, as in glTF.
        `colors`: (V, 3), linear, tint the material; those of `uint8` are shares of 255. `material` is that of all triangles; or `materials` is a list,
        and `material_indices`, (T,), says which each triangle has. `transforms`: (4, 4), or (N, 4, 4) for N places, in which the object
        is stored once; they are applied to column vectors, and end in the row 0, 0, 0, 1. `name` is that of the object.

        Raises `GeometryError` for indices out of range and lengths that do not match.
        """
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    @property
    def vertex_count(self) -> int:
        """In one place."""
    @property
    def triangle_count(self) -> int:
        """In all places together."""
    def placed(self, transforms: ArrayLike, *, name: str | None = None) -> Geometry:
        """The same object in other places, which `transforms` say, perhaps with another `name`; its arrays are shared."""
    def __copy__(self) -> Geometry: ...
    def __deepcopy__(self, _memo: object) -> Geometry: ...

@final
class Light:
    """A light. With `falloff` "none", 1 fully lights a white surface that faces it, at any distance; with "inverse-square",
    `intensity` is in candela (of a directional light in lux): a white surface that faces it at distance d shows I / (π d²), or I / π.
    `position` is its centre and `direction` the way that its light goes, in world coordinates; `name` is what files call it."""

    @staticmethod
    def point(position: Vector, *, spread: float = 0.0, intensity: Color = 1.0, falloff: Falloff = "none", name: str = "") -> Light:
        """Light from one point, or, where shadows are soft, from a ball of radius `spread`."""
    @staticmethod
    def directional(direction: Vector, *, angle: float = 0.0, intensity: Color = 1.0, falloff: Falloff = "none", name: str = "") -> Light:
        """Light that travels along `direction`, from a disk of the angular diameter `angle` in degrees; the sun's is 0.53."""
    @staticmethod
    def spot(
        position: Vector,
        direction: Vector,
        *,
        inner: float = 0.0,
        outer: float = 45.0,
        radius: float = 0.0,
        intensity: Color = 1.0,
        falloff: Falloff = "none",
        name: str = "",
    ) -> Light:
        """A cone of light around `direction`, from a ball of `radius`: of full strength up to the half-angle `inner`, none beyond `outer`,
        in degrees."""
    @staticmethod
    def sphere(position: Vector, radius: float, *, intensity: Color = 1.0, falloff: Falloff = "none", name: str = "") -> Light:
        """Light from a ball of this `radius`."""
    @staticmethod
    def disk(
        position: Vector,
        normal: Vector,
        radius: float,
        *,
        one_sided: bool = True,
        intensity: Color = 1.0,
        falloff: Falloff = "none",
        name: str = "",
    ) -> Light:
        """A flat round light of this `radius`. It shines like a surface: along `normal` with `intensity`, aside with the cosine. Not `one_sided`: evenly to all
        sides."""
    @staticmethod
    def rectangle(
        position: Vector,
        half_u: Vector,
        half_v: Vector,
        *,
        one_sided: bool = True,
        intensity: Color = 1.0,
        falloff: Falloff = "none",
        name: str = "",
    ) -> Light:
        """A flat rectangular light: `half_u` and `half_v`, at a right angle, point from its centre to the middles of two sides.
        It shines like a surface, towards half_u × half_v. Not `one_sided`: evenly to all sides."""
    @property
    def kind(self) -> str:
        """`point`, `directional`, `spot`, `sphere`, `disk` or `rectangle`."""
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    @property
    def intensity(self) -> tuple[float, float, float]:
        """Red, green and blue."""
    @property
    def falloff(self) -> Falloff:
        """`none` or `inverse-square`."""
    @property
    def position(self) -> tuple[float, float, float] | None:
        """World coordinates; `None` of a directional light."""
    @property
    def direction(self) -> tuple[float, float, float] | None:
        """The way that the light of a directional light or the axis of a spot goes, of unit length; `None` of others."""
    def replaced(
        self, *, position: Vector | None = None, direction: Vector | None = None, intensity: Color | None = None, name: str | None = None
    ) -> Light:
        """The same light elsewhere, or of other strength."""
    def __copy__(self) -> Light: ...
    def __deepcopy__(self, _memo: object) -> Light: ...

@final
class Camera:
    """A camera at `position` that looks at `target`, or along `direction`. `vfov` or `hfov` is the full vertical or horizontal field of view,
    degrees (45° vertical if none is given); `height` in their place makes it orthographic: the image is as high in scene units. `shift` moves
    the image, to the right and up, by shares of its height, as a shifted lens does: parallels stay parallel. `up` is what is up in the image, and
    `name` what `camera_name` calls it. Surfaces and lights are seen from the depth `near` up to the depth `far`, distances along the view
    direction in scene units; shadows, mirrors and the sky stay."""

    def __new__(
        cls,
        position: Vector,
        target: Vector | None = None,
        *,
        direction: Vector | None = None,
        up: Vector = (0.0, 1.0, 0.0),
        vfov: float | None = None,
        hfov: float | None = None,
        height: float | None = None,
        shift: tuple[float, float] = (0.0, 0.0),
        name: str = "",
        near: float = 0.0,
        far: float | None = None,
    ) -> Self: ...
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    @property
    def position(self) -> tuple[float, float, float]:
        """World coordinates."""
    @property
    def direction(self) -> tuple[float, float, float]:
        """Of unit length."""
    @property
    def up(self) -> tuple[float, float, float]:
        """What is up in the image."""
    def __copy__(self) -> Camera: ...
    def __deepcopy__(self, _memo: object) -> Camera: ...

@final
class Environment:
    """What surrounds a scene: `pixels` are an equirectangular panorama of linear radiance, (H, W, 3) `float32`, straight up in its first row, with
    the north in its middle: -Z if `up` is "y", +Y if it is "z". East, +X, is to its right. `rotation` turns it clockwise as seen from above,
    degrees; `strength` multiplies it. If it shows a sun, that becomes a light, and so do other regions that are much brighter than the rest,
    unless `find_sun` is off. `name` is for display."""

    def __new__(
        cls, pixels: ArrayLike, *, up: Literal["y", "z"] = "y", rotation: float = 0.0, strength: float = 1.0, find_sun: bool = True, name: str = ""
    ) -> Self: ...
    @staticmethod
    def open(path: Path, *, up: Literal["y", "z"] = "y", rotation: float = 0.0, strength: float = 1.0) -> Environment:
        """Reads an .hdr or .exr file, `path`."""
    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
    def __copy__(self) -> Environment: ...
    def __deepcopy__(self, _memo: object) -> Environment: ...

@final
class Scene:
    """Geometry, lights and cameras. Geometry is shared and never changes; lights, cameras and surroundings can be set at any time.

    Without `lights` (`None`), images show it in a studio, as the command line does, or with `no_studio=True` by a key and a fill light; an
    empty list is darkness. `instances`
    says whether objects in many places are stored once ("always"), copied ("never"), or stored once if they have many triangles in all
    ("auto"). Surfaces that emit get lights, `lamps`, as those of files have; in a frame they come after `lights`. What had to be
    corrected is a `SceneWarning`.

    `geometry` is one object or a sequence of them, `camera` the view of it, `environment` what surrounds it, `ambient` constant light from everywhere,
    `background` what is seen where nothing is, and `name` is for display.
    """

    def __new__(
        cls,
        geometry: Geometry | Sequence[Geometry],
        lights: Light | Sequence[Light] | None = None,
        camera: Camera | None = None,
        *,
        environment: Environment | None = None,
        ambient: Color | None = None,
        background: Color | None = None,
        instances: Instances = "auto",
        lamps: bool = True,
        name: str = "",
    ) -> Self: ...
    @staticmethod
    def open(path: Path, **settings: Unpack[OpenSettings]) -> Scene:
        """Reads `path`, a .toml, .obj, .gltf, .glb, .ply or .stl file. Raises `SceneError`, or `HostMemoryError` if it needs more memory than there is."""
    @staticmethod
    def builtin(name: str) -> Scene:
        """A built-in scene by `name`: "gazebo", "childpark", "garden", also with options, as in "garden?lights=3"."""
    @property
    def lights(self) -> list[Light]:
        """All lights; set a list, or one, to change them. The list is a copy, and cannot be changed itself."""
    @lights.setter
    def lights(self, lights: Light | Sequence[Light]) -> None: ...
    @property
    def cameras(self) -> list[Camera]:
        """All cameras; set a list to change them. The list is a copy, and cannot be changed itself."""
    @cameras.setter
    def cameras(self, cameras: Sequence[Camera]) -> None: ...
    @property
    def camera(self) -> Camera | None:
        """The one that is used unless settings say otherwise: the first."""
    @camera.setter
    def camera(self, camera: Camera | None) -> None: ...
    @property
    def ambient(self) -> tuple[float, float, float] | None:
        """Constant light from everywhere; `None`: gathered from surroundings, or chosen as on the command line."""
    @ambient.setter
    def ambient(self, color: Color | None) -> None: ...
    @property
    def background(self) -> tuple[float, float, float] | None:
        """What is seen where nothing is; `None`: the environment, or black."""
    @background.setter
    def background(self, color: Color | None) -> None: ...
    @property
    def environment(self) -> Environment | None:
        """What surrounds the scene."""
    @environment.setter
    def environment(self, environment: Environment | None) -> None: ...
    @property
    def name(self) -> str:
        """As it was given; may be empty."""
    @property
    def triangle_count(self) -> int:
        """As they are stored: of what is in many places, once if `instances` is "always"."""
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
        """Lowest and highest corner, world coordinates; `None` without triangles."""
    @property
    def origin(self) -> tuple[float, float, float]:
        """The place of vertices with the coordinates 0, 0, 0; world coordinates."""
    @property
    def vertices(self) -> NDArray[np.float32]:
        """(V, 3): the vertices, relative to `origin`. Like all arrays of a scene it is a view that cannot be written, and lives as long as it is
        used. Of objects that are stored once for many places, see `instances`, vertices are in coordinates of their own."""
    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(T, 3): the vertices of each triangle, counterclockwise seen from the front."""
    @property
    def normals(self) -> NDArray[np.float32] | None:
        """(V, 3): the shading normals of vertices, of unit length, or 0 where triangles are flat; `None` if all are."""
    @property
    def uvs(self) -> NDArray[np.float32] | None:
        """(V, 2): texture coordinates, origin in the upper left corner of the image; `None` if there are none."""
    @property
    def colors(self) -> NDArray[np.float32] | None:
        """(V, 3): linear colours that tint the materials; `None` if there are none."""
    @property
    def material_indices(self) -> NDArray[np.uint32]:
        """(T,): the material of each triangle, an index of `materials`."""
    @property
    def object_ranges(self) -> NDArray[np.uint32]:
        """(R, 3): which triangles belong to which object. A row is an index of `objects`, the first triangle, and the one after the last. An object
        can have several rows."""
    @property
    def objects(self) -> list[str]:
        """Names of the objects, in the order of `Frame.ids`; `object_ranges` has their triangles."""
    @property
    def materials(self) -> list[str]:
        """Names of the materials, in the order of `Frame.material_ids`."""
    @property
    def warnings(self) -> list[str]:
        """What the loader corrected, ignored or guessed."""
    @property
    def duration(self) -> float | None:
        """Seconds of its animation; `None` if nothing moves."""
    def at(self, time: float) -> Scene:
        """The scene at a moment of its animation: `time` is in seconds."""
    def with_geometry(self, geometry: Geometry | Sequence[Geometry], *, instances: Instances = "auto") -> Scene:
        """Other `geometry` with the same lights, cameras and surroundings; `instances` as in the constructor."""
    def info(self) -> SceneInfo:
        """What `lightmesh info` says of it."""
    def __copy__(self) -> Scene: ...
    def __deepcopy__(self, _memo: object) -> Scene: ...

@final
class PreparedScene:
    """A scene with its acceleration structure, ready to be rendered any number of times."""

    @property
    def scene(self) -> Scene:
        """The scene, with the camera and surroundings of the settings."""
    @property
    def memory(self) -> int:
        """Bytes that the structure takes."""
    def with_lights(self, lights: Light | Sequence[Light]) -> PreparedScene:
        """The same with other `lights`, one or a sequence; nothing is rebuilt."""
    def with_camera(self, camera: Camera) -> PreparedScene:
        """The same with another `camera`; nothing is rebuilt."""

@final
class MeshCache:
    """What light points see and surfaces gather, kept from image to image. Images are the same without it. A process that is forked begins with
    an empty one."""

    def __new__(cls) -> Self: ...
    @staticmethod
    def load(path: Path, prepared: PreparedScene) -> MeshCache:
        """Reads the file `path` of `save`, or of `--mesh-file`, for a `prepared` scene. Raises `MeshFileError`."""
    def save(self, path: Path, prepared: PreparedScene) -> int:
        """Writes light points and gathered light of a `prepared` scene to `path`, and returns the number of light points; if nothing is kept, no file is
        written."""
    def clear(self) -> None:
        """Forgets everything."""
    def __len__(self) -> int:
        """Light points times lights."""
    def __bool__(self) -> bool: ...
    @property
    def memory(self) -> int:
        """Bytes on the host and on devices."""

@final
class Progress:
    """How far a render, or the whole of a film, has come."""

    @property
    def done(self) -> float:
        """The share of all work that is done, from 0 to 1; it never falls, and is 1 in the end."""
    @property
    def seconds(self) -> float:
        """Since the beginning."""
    @property
    def left(self) -> float | None:
        """Seconds that remain, if that can be told."""
    @property
    def stage(self) -> str:
        """What is being done, by the names of `Frame.stats`."""

@final
class Cancel:
    """Stops renders from another thread: those it was given to raise `Cancelled`, or with `partial` return what is finished."""

    def __new__(cls) -> Self: ...
    def cancel(self) -> None:
        """From now on."""
    @property
    def cancelled(self) -> bool:
        """Whether `cancel` was called."""

@final
class Mattes:
    """Which things, objects or materials, pixels see. Things are numbered from 1; 0 is nothing."""

    @property
    def names(self) -> list[str]:
        """The name of thing n is number n - 1."""
    @property
    def nearest(self) -> NDArray[np.uint32]:
        """(H, W): what the nearest sample of each pixel sees."""
    @property
    def ranks(self) -> list[tuple[NDArray[np.uint32], NDArray[np.float32]]]:
        """From the largest share of a pixel to the smallest: thing and share, (H, W) each."""
    def cryptomatte(self) -> list[NDArray[np.float32]]:
        """(H, W, 4) each, as Cryptomatte 1.2 lays them out: hash and share of two things."""
    def manifest(self) -> str:
        """The hashes of the names, as Cryptomatte's JSON."""

@final
class Frame:
    """A rendered image. Its arrays are views into it that cannot be written; row 0 is the top. Those from `depth` on exist if it was
    rendered with `layers=True`."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
    @property
    def rgb(self) -> NDArray[np.float32]:
        """(H, W, 3): linear radiance, Rec. 709 primaries, premultiplied."""
    @property
    def alpha(self) -> NDArray[np.float32] | None:
        """(H, W): the covered share of each pixel, with `background="transparent"`."""
    @property
    def depth(self) -> NDArray[np.float32]:
        """(H, W): distance along the ray, scene units; infinite where nothing is seen."""
    @property
    def normal(self) -> NDArray[np.float32]:
        """(H, W, 3): unit geometric normal towards the viewer, world coordinates; 0 where nothing is seen."""
    @property
    def position(self) -> NDArray[np.float32]:
        """(H, W, 3): world coordinates."""
    @property
    def visibility(self) -> list[NDArray[np.float32]]:
        """(H, W) of each light, then of each lamp: the share of it that is seen, from 0 to 1."""
    @property
    def lights(self) -> list[NDArray[np.float32]]:
        """(H, W, 3) of each light, then of each lamp: what the pixel shows of it alone. Empty if that is not known."""
    @property
    def rest(self) -> NDArray[np.float32] | None:
        """(H, W, 3): what belongs to no light."""
    @property
    def used(self) -> NDArray[np.uint32]:
        """(H, W): number of light points that a pixel was interpolated from."""
    @property
    def ids(self) -> Mattes:
        """The objects that pixels see."""
    @property
    def material_ids(self) -> Mattes:
        """The materials that pixels see."""
    @property
    def stats(self) -> FrameStats:
        """Counts, seconds, memory and settings: what `--stats` writes."""
    @property
    def exposure(self) -> float:
        """Stops that image files are shown at, unless `save` says otherwise."""
    @property
    def number(self) -> int | None:
        """Its number in a film; `None` for a picture."""
    @property
    def when(self) -> str:
        """The time of day in a film of a sun study, as in "06:15"; else empty."""
    @property
    def finished_rows(self) -> int:
        """All, unless the render was stopped with `partial=True`."""
    @property
    def notes(self) -> list[str]:
        """What was chosen automatically."""
    def save(self, path: Path | IO[bytes], **settings: Unpack[SaveSettings]) -> None:
        """Writes a bmp, png, exr or jpg file; the same bytes as the command line. `path` may also be a file that is open for writing bytes: then `format` is
        needed. Raises `SaveError`; no partial file is left."""
    def save_layers(self, path: Path | IO[bytes], **settings: Unpack[SaveSettings]) -> None:
        """Writes all layers as a multilayer exr file. `path` may also be a file that is open for writing bytes."""
    def to_png(self, **settings: Unpack[SaveSettings]) -> bytes:
        """A png file, in memory."""
    def _repr_png_(self) -> bytes: ...
    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[np.float32]: ...

@final
class Film:
    """The frames of a film: iterate over it. With an output, each frame is written before it is returned. It goes on in the process that began it only."""

    def __iter__(self) -> Self: ...
    def __next__(self) -> Frame: ...
    @property
    def notes(self) -> list[str]:
        """What was chosen for all frames, as sentences."""
    def __len__(self) -> int:
        """How many frames are left."""

@final
class SunHours:
    """The hours of direct sun on what an image shows."""

    @property
    def hours(self) -> NDArray[np.float32]:
        """(H, W): hours of direct sun; 0 where there is none, and where no surface is seen: `mask` tells which."""
    @property
    def mask(self) -> NDArray[np.bool_]:
        """(H, W): whether a surface is seen. It is the alpha of exr files."""
    @property
    def table(self) -> str:
        """Hours by object, as the text of a csv file."""
    @property
    def notes(self) -> list[str]:
        """What was chosen and what counts, as sentences: how many materials let light through, and what `glass` makes of them."""
    @property
    def table_notes(self) -> list[str]:
        """What to know of the table, as sentences: how many objects no pixel sees, and how many rest on few points. Empty if there is nothing."""
    def save(self, path: Path | IO[bytes], *, format: Literal["exr", "png", "csv"] | None = None) -> None:
        """Writes an exr with the hours, a png with a legend, or a csv with a row for each object. `path` may also be a file that is open for writing
        bytes: then `format`, "exr", "png" or "csv", is needed. Raises `SaveError`."""

@final
class Renderer:
    """Renders scenes on a `device`: "auto", "cpu", "cuda" or "cuda:1", or on several: "cuda:all", "cuda:0,1" or "cuda:all,cpu", with so many `threads` of
    the CPU, or as many as `OMP_NUM_THREADS` says, or all. Can be used by several threads at once; the interpreter is free while it works. A process that is
    forked uses it with threads of its own, if the device is the CPU. Raises `DeviceError` if the device cannot be used."""

    def __new__(cls, device: str = "auto", *, threads: int | None = None) -> Self: ...
    @property
    def device(self) -> str:
        """The device in use: "cpu" or "cuda:0"."""
    @property
    def reason(self) -> str:
        """Which device that is, and why it was chosen."""
    @property
    def threads(self) -> int:
        """The threads of the CPU that were started: of more than 16, at most four for each logical CPU."""
    def prepare(
        self,
        scene: Scene,
        *,
        before: PreparedScene | None = None,
        lights: Light | Sequence[Light] | None = None,
        progress: ProgressCallback | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[ImageSettings],
    ) -> PreparedScene:
        """Builds the acceleration structure of `scene`. `before` is the same scene at another moment: what has not moved is kept. `lights`, one or a
        sequence, stand in for the scene's. `progress` is called now and then, and `cancel` stops it."""
    def render(
        self,
        scene: Scene | PreparedScene,
        *,
        cache: MeshCache | None = None,
        lights: Light | Sequence[Light] | None = None,
        progress: ProgressCallback | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[ImageSettings],
    ) -> Frame:
        """Renders an image of `scene`. The structure of the scene rendered last is kept: other lights and cameras cost no building. `lights`, one or a
        sequence, stand in for the scene's. `cache` keeps what light points see. `progress` is called now and then, and `cancel` stops it."""
    def film(
        self,
        scene: Scene | Path,
        output: Path | None = None,
        *,
        layers_file: Path | None = None,
        stats: Path | None = None,
        mesh_file: Path | None = None,
        lights: Light | Sequence[Light] | None = None,
        progress: ProgressCallback | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[FilmSettings],
    ) -> Film:
        """The frames of a film of `scene`: by `turntable`, `sun`, `frames` or `fps`. Iterate over it to render them one by one, or as many at the same
        time as there are GPUs; `len` says how many are left. With `output`, as in "film.####.png" or "film.mp4", and `layers_file`, `stats` and
        `mesh_file`, each is written before it is returned; `resume` goes on with a film of which some frames are there. `lights`, one or a sequence,
        stand in for the scene's. `progress` is called now and then with the share of the whole film, and `cancel` stops it."""
    def sun_hours(
        self,
        scene: Scene | Path,
        *,
        progress: ProgressCallback | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[FilmSettings],
    ) -> SunHours:
        """The hours of direct sun on what an image of `scene` shows, on a day at a place that `sun` says. `progress` is called now and then, and `cancel`
        stops it."""
    def visibility(
        self,
        points: ArrayLike,
        normals: ArrayLike,
        scene: Scene | PreparedScene,
        lights: Light | Sequence[Light] | None = None,
        *,
        progress: ProgressCallback | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[ImageSettings],
    ) -> NDArray[np.float32]:
        """The visible share of each light, (N, L), at surface `points` (N, 3) of `scene` with these `normals`, (N, 3) or one for all, world coordinates: to
        bake vertex colours and lightmaps. `lights`, one or a sequence, stand in for the scene's, of which a scene may have none: L is 0 then, with a
        `LightmeshWarning`, for no studio is added. What lies behind a surface is dark. `progress` is called now and then, and `cancel` stops it."""

def visibility(
    points: ArrayLike,
    normals: ArrayLike,
    scene: Scene | PreparedScene,
    lights: Light | Sequence[Light] | None = None,
    *,
    device: str = "auto",
    **settings: Unpack[ImageSettings],
) -> NDArray[np.float32]:
    """`Renderer.visibility` of `points` with `normals` in `scene`, lit by `lights`, on a renderer of its own on `device`."""

def devices() -> list[DeviceInfo]:
    """What `lightmesh info --devices` lists."""

def command(arguments: Sequence[str]) -> int:
    """Runs the command line program with these arguments, and returns its exit code."""

@final
class _FilmLog:
    """The log of a film that others render: the manifest of a film by one process. Raises what `Renderer.film` raises."""

    def __new__(cls, scene: Path, output: Path, settings: Mapping[str, object]) -> Self: ...
    @property
    def notes(self) -> list[str]:
        """What was chosen, corrected or guessed, as sentences."""
    @property
    def request(self) -> str:
        """The request of workers, as text."""
    @property
    def inputs(self) -> list[tuple[pathlib.Path, int, str]]:
        """The files that are needed: path, size and checksum."""
    @property
    def numbers(self) -> list[int]:
        """The numbers of the frames that were left when it began."""
    @property
    def kept(self) -> int:
        """How many frames were there and are kept."""
    @property
    def last(self) -> int:
        """The film's last frame."""
    @property
    def chosen(self) -> str | None:
        """What a worker chose for all frames, as text; `None` if that is to be asked."""
    def choose(self, chosen: str) -> None:
        """A worker has `chosen` for all frames."""
    def has_written(self, seal: str) -> bool:
        """Whether the manifest was lately written with this `seal`."""
    def publish(self, number: int, content: bytes, files: str) -> None:
        """Writes the file of frame `number`, its `content`, which a worker without this disk has sent with its `files`."""
    def finished(self, number: int, files: str) -> None:
        """Frame `number` is finished, its `files` are published."""
    def close(self) -> None:
        """Records what is not yet recorded."""

@final
class _BandedPicture:
    """A picture of which others render the rows."""

    def __new__(cls, scene: Path, output: Path | None, settings: Mapping[str, object]) -> Self: ...
    @property
    def notes(self) -> list[str]:
        """What was chosen, corrected or guessed, as sentences."""
    @property
    def request(self) -> str:
        """The request of workers, as text."""
    @property
    def inputs(self) -> list[tuple[pathlib.Path, int, str]]:
        """The files that are needed: path, size and checksum."""
    def render(
        self, render: Callable[[str], Sequence[tuple[int, NDArray[np.float32], NDArray[np.float32] | None, str]]]
    ) -> tuple[Frame, list[str]]:
        """Makes the image of the bands that `render` returns for each pass, which it gets as text; writes the file if there is an output, and returns
        the frame with what was said of it."""

@final
class _Worker:
    """A scene that is prepared on a device; its frames and rows are rendered as they are asked for."""

    def __new__(cls, scene: Path, output: Path | None, request: str) -> Self: ...
    @property
    def notes(self) -> list[str]:
        """What was chosen, corrected or guessed, as sentences."""
    @property
    def inputs(self) -> list[tuple[pathlib.Path, int, str]]:
        """The files that the scene was read from: path, size and checksum."""
    @property
    def threads(self) -> int:
        """The CPU threads that it renders with."""
    def choose(self) -> str:
        """What holds for all frames of a film, as text."""
    def frame(self, number: int, chosen: str) -> tuple[str, float, float, list[str]]:
        """Renders frame `number` with what was `chosen`, and publishes its file. Returns the record of its files as text, the seconds of the image, those of
        its file, and what was said of it."""
    def rows(
        self, render_pass: str, first: int, rows: int
    ) -> tuple[tuple[NDArray[np.float32], NDArray[np.float32] | None, str], float]:
        """Renders `rows` rows of a pass, which is given as text, from row `first` of the image on. Returns colours, alpha if there is one, statistics as
        text, and the seconds of the image."""

def _digest(path: Path) -> tuple[int, str]:
    """Size and checksum of a file, `path`."""

def _seal(output: Path) -> str | None:
    """The seal of the manifest beside `output`, if there is one."""

def _sweep(output: Path) -> None:
    """Removes the temporary files that dead processes of this system have left beside `output`."""

def _parse(arguments: Sequence[str]) -> tuple[pathlib.Path, pathlib.Path | None, str]:
    """The scene, the output and the request, as text, of the arguments of `lightmesh render`. What cannot be read is explained, and `SystemExit` raised."""

__version__: str
