"""Soft shadows by the light mesh.

    import lightmesh

    scene = lightmesh.Scene.open("garden.toml")
    renderer = lightmesh.Renderer()
    frame = renderer.render(scene, size=(640, 480))
    frame.save("garden.png")
"""

from ._errors import (
    ArgumentError,
    Cancelled,
    DeviceError,
    DeviceMemoryError,
    GeometryError,
    HostMemoryError,
    LayersError,
    LightmeshError,
    LightmeshWarning,
    MeshFileError,
    MeshFileWarning,
    SaveError,
    SceneError,
    SceneWarning,
    SettingError,
)
from ._lightmesh import (
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
    __version__,
    devices,
    visibility,
)
from ._progress import follow

__all__ = [
    "ArgumentError",
    "Camera",
    "Cancel",
    "Cancelled",
    "DeviceError",
    "DeviceMemoryError",
    "Environment",
    "Film",
    "Frame",
    "Geometry",
    "GeometryError",
    "HostMemoryError",
    "LayersError",
    "Light",
    "LightmeshError",
    "LightmeshWarning",
    "Material",
    "Mattes",
    "MeshCache",
    "MeshFileError",
    "MeshFileWarning",
    "PreparedScene",
    "Progress",
    "Renderer",
    "SaveError",
    "Scene",
    "SceneError",
    "SceneWarning",
    "SettingError",
    "SunHours",
    "Texture",
    "__version__",
    "devices",
    "follow",
    "visibility",
]
