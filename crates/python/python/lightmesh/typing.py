"""Types for annotations of programs that use Lightmesh."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import Literal, Union

from numpy.typing import ArrayLike

from ._info import AnimationInfo as AnimationInfo
from ._info import BoundsInfo as BoundsInfo
from ._info import CameraInfo as CameraInfo
from ._info import CameraStats as CameraStats
from ._info import Counts as Counts
from ._info import DeviceInfo as DeviceInfo
from ._info import DeviceStats as DeviceStats
from ._info import FrameStats as FrameStats
from ._info import LatticeStats as LatticeStats
from ._info import LightInfo as LightInfo
from ._info import MemoryStats as MemoryStats
from ._info import SceneInfo as SceneInfo
from ._info import SceneStats as SceneStats
from ._info import Seconds as Seconds
from ._info import SettingsStats as SettingsStats
from ._info import UpInfo as UpInfo
from ._lightmesh import Progress
from ._progress import Bar as Bar
from ._settings import FilmSettings as FilmSettings
from ._settings import ImageSettings as ImageSettings
from ._settings import OpenSettings as OpenSettings
from ._settings import SaveSettings as SaveSettings

Path = Union[str, PathLike[str]]
#: Three numbers: a position or a way in scene units, world coordinates.
Vector = ArrayLike
#: Linear radiance or reflectance with Rec. 709 primaries: one number for grey, or red, green and blue. Those of an
#: array of `uint8` are shares of 255.
Color = Union[float, ArrayLike]
Quality = Literal["draft", "good", "final"]
Falloff = Literal["none", "inverse-square"]
Instances = Literal["auto", "always", "never"]
WrapMode = Literal["repeat", "mirror", "clamp"]

#: Called now and then by the thread that asked for the render. What it raises stops the render, and is raised there.
ProgressCallback = Callable[[Progress], object]
