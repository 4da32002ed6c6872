"""Types for annotations of programs that use Lightmesh."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import Literal, Union

from numpy.typing import ArrayLike

from ._lightmesh import Progress
from ._settings import FilmSettings as FilmSettings
from ._settings import ImageSettings as ImageSettings
from ._settings import OpenSettings as OpenSettings
from ._settings import SaveSettings as SaveSettings

Path = Union[str, PathLike[str]]
#: Three numbers: a position or a way in scene units, world coordinates.
Vector = ArrayLike
#: Linear radiance or reflectance with Rec. 709 primaries: one number for grey, or red, green and blue.
Color = Union[float, ArrayLike]
Quality = Literal["draft", "good", "final"]
Falloff = Literal["none", "inverse-square"]
Instances = Literal["auto", "always", "never"]
WrapMode = Literal["repeat", "mirror", "clamp"]

#: Called now and then by the thread that asked for the render. What it raises stops the render, and is raised there.
ProgressCallback = Callable[[Progress], object]
