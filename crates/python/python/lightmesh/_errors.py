"""Exceptions and warnings, by class."""

import re


class LightmeshError(Exception):
    """Everything that goes wrong in Lightmesh. Errors of arguments are also a `TypeError` or a `ValueError`."""

    def add_note(self, note: str) -> None:
        """Notes which argument it is about, in the message itself: not all that shows messages shows notes, and Python 3.10 has none."""
        argument = re.fullmatch(r"while processing '(\w+)'", note)
        if argument and self.args:
            self.args = (f"{argument[1]}: {self.args[0]}", *self.args[1:])
        elif hasattr(super(), "add_note"):
            super().add_note(note)


class SettingError(LightmeshError, ValueError):
    """A setting, or an argument of a light, camera or material, cannot be used."""


class ArgumentError(LightmeshError, TypeError):
    """An argument is of a type that cannot be used, or has a name that is not known."""


class SceneError(LightmeshError):
    """A file of a scene cannot be read."""


class GeometryError(LightmeshError, ValueError):
    """Arrays do not make geometry: indices out of range, lengths that do not match."""


class LayersError(LightmeshError, AttributeError):
    """A frame does not have what only layers have."""


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


class LightmeshWarning(UserWarning):
    """Everything that may not be as it should be: settings that do nothing, files whose names say another format."""


class SceneWarning(LightmeshWarning):
    """What a loader corrected, ignored or guessed."""


class MeshFileWarning(LightmeshWarning):
    """Why nothing of a file of light points was used."""
