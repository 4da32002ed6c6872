"""Films and large pictures on a Ray cluster.

    import lightmesh.ray

    report = lightmesh.ray.film("garden.toml", "film.####.png", frames="1-120", turntable=120, size=(1920, 1080))
    print(report)

One process leads: it reads the scene, hands out units of work, and keeps the film's manifest, which is that of `lightmesh render`. Actors, as
many as the cluster holds, have the scene prepared on a device and render. Whoever dies, the film goes on; if the leader does, `resume=True`
goes on with what is finished. Files are the same, to the byte, as those of one process on the same kind of device.
"""

try:
    import ray as _ray  # noqa: F401
except ImportError as _error:
    raise ImportError("lightmesh.ray needs Ray: pip install lightmesh[ray]") from _error

from ._errors import ClusterError, FilesError, NodeError
from ._films import film
from ._pictures import picture
from ._report import Failure, NodeReport, Progress, Report
from ._settings import FilmRequest, PictureRequest

__all__ = [
    "ClusterError",
    "Failure",
    "FilesError",
    "FilmRequest",
    "NodeError",
    "NodeReport",
    "PictureRequest",
    "Progress",
    "Report",
    "film",
    "picture",
]
