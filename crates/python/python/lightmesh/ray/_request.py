"""What films and pictures have in common: arguments that are checked before anything starts."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from .._errors import SettingError
from .._lightmesh import Camera, Environment, Light
from ._team import Share

if TYPE_CHECKING:
    from ..typing import Path as AnyPath

#: What is built in, and no file.
BUILTIN = "builtin:"


def share(cpus: float, gpus: float, device: object) -> Share:
    """What each actor gets."""
    if not cpus > 0:
        raise SettingError(f"cpus_per_actor cannot be {cpus}: an actor needs a CPU, or a part of one")
    if not gpus >= 0:
        raise SettingError(f"gpus_per_actor cannot be {gpus}: give 0, a part of one, or a whole number")
    if str(device or "auto").startswith("cuda") and not gpus:
        raise SettingError(f"device={str(device)!r} needs gpus_per_actor: without it, Ray gives the same GPUs to others, too")
    return Share(float(cpus), float(gpus))


def settings(request: Mapping[str, object]) -> dict[str, object]:
    """The settings that are given, which must be values: objects stay on one machine."""
    for name, value in request.items():
        values = value if isinstance(value, (list, tuple)) else [value]
        if any(isinstance(item, (Camera, Light, Environment)) for item in values):
            raise SettingError(f"{name}: objects stay on this machine; give it as text, as for `lightmesh render`, or put it into the scene's file")
    given = {name: value for name, value in request.items() if value is not None}
    device = str(given.get("device", "auto"))
    if device.startswith("cuda:"):
        raise SettingError(f"device={device!r}: Ray chooses the GPU of each actor; give device='cuda'")
    return given


def scene_path(scene: AnyPath) -> str:
    """The scene as every process finds it."""
    text = os.fspath(scene)
    return text if text.startswith(BUILTIN) else str(Path(text).absolute())
