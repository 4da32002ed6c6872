"""Exceptions and warnings, by class."""


class LightmeshError(Exception):
    """Everything that goes wrong in Lightmesh."""


class SettingError(LightmeshError, ValueError):
    """A setting, or an argument of a light, camera or material, cannot be used."""


class SceneError(LightmeshError):
    """A file of a scene cannot be read."""


class GeometryError(LightmeshError, ValueError):
    """Arrays do not make geometry: indices out of range, lengths that do not match."""


class DeviceError(LightmeshError):
    """A device does not exist, cannot be used, or has failed."""


class DeviceMemoryError(DeviceError, MemoryError):
    """A device does not have enough memory."""


class HostMemoryError(LightmeshError, MemoryError):
    """The host does not have enough memory, or the limit is too low."""


class MeshFileError(LightmeshError):
    """A file of light points cannot be used."""


class SaveError(LightmeshError, OSError):
    """A file cannot be written."""


class Cancelled(LightmeshError):
    """The render was cancelled."""


class SceneWarning(UserWarning):
    """What a loader corrected, ignored or guessed."""


class MeshFileWarning(UserWarning):
    """Why nothing of a file of light points was used."""
