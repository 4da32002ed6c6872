"""What a camera sees in a scene of boxes, planes and balls, in numpy: which face, and where."""

import tomllib
from dataclasses import dataclass

import numpy as np


@dataclass
class View:
    """A camera of a scene file, at pixels' centres."""

    position: np.ndarray
    target: np.ndarray
    vfov: float
    size: tuple

    @property
    def axes(self):
        forward = (self.target - self.position) / np.linalg.norm(self.target - self.position)
        right = np.cross(forward, [0, 1, 0])
        right /= np.linalg.norm(right)
        return forward, right, np.cross(right, forward)

    @property
    def scale(self):
        """Pixels of a tangent of 1."""
        return self.size[1] / 2 / np.tan(np.radians(self.vfov) / 2)

    def rays(self):
        """Directions, (height, width, 3), as long as makes their share along the view 1."""
        (forward, right, up), (width, height) = self.axes, self.size
        x = (np.arange(width) + 0.5 - width / 2) / self.scale
        y = (height / 2 - np.arange(height) - 0.5) / self.scale
        return forward + x[None, :, None] * right + y[:, None, None] * up

    def project(self, points):
        """Columns and rows of points."""
        forward, right, up = self.axes
        way = points - self.position
        depth = way @ forward
        return self.size[0] / 2 + self.scale * (way @ right) / depth - 0.5, self.size[1] / 2 - self.scale * (way @ up) / depth - 0.5


@dataclass
class Seen:
    """Of each pixel's centre: a number of the face, -1 if nothing is there; the point on it; and its distance in lengths of rays."""

    face: np.ndarray
    point: np.ndarray
    distance: np.ndarray

    def plain(self, reach):
        """Whether all pixels within `reach` see the same face."""
        here = self.face >= 0
        rows, columns = self.face.shape
        wide = np.pad(self.face, reach, constant_values=-2)
        for y in range(2 * reach + 1):
            for x in range(2 * reach + 1):
                here = here & (wide[y : y + rows, x : x + columns] == self.face)
        return here


def view(scene, size, position=None):
    eye = scene["camera"]
    return View(np.array(position or eye["position"], float), np.array(eye["target"], float), eye["vfov"], tuple(size))


def read(path):
    return tomllib.loads(path.read_text())


def look(scene, eye):
    """What `eye` sees of a scene file that has been read."""
    rays = eye.rays()
    face = np.full(rays.shape[:2], -1)
    nearest = np.full(rays.shape[:2], np.inf)
    number = 0
    for hit, distance in surfaces(scene, eye.position, rays):
        closer = distance < nearest
        face[closer], nearest[closer] = number + hit[closer], distance[closer]
        number += 6
    with np.errstate(invalid="ignore"):
        return Seen(face, eye.position + nearest[..., None] * rays, nearest)


def surfaces(scene, origin, rays):
    """Of each shape: which of up to six faces is hit, and how far away; infinity where it is missed."""
    for shape in scene.get("box", []):
        yield boxed(shape, origin, rays)
    for shape in scene.get("plane", []):
        yield flat(shape, origin, rays)
    for shape in scene.get("sphere", []):
        middle = origin - np.array(shape["center"], float)
        along, length = rays @ middle, (rays**2).sum(axis=-1)
        inside = along**2 - length * (middle @ middle - shape["radius"] ** 2)
        distance = np.where(inside > 0, (-along - np.sqrt(np.maximum(inside, 0))) / length, np.inf)
        yield np.zeros(rays.shape[:2], int), np.where(distance > 0, distance, np.inf)


def boxed(shape, origin, rays):
    if "min" in shape:
        low, high = np.array(shape["min"], float), np.array(shape["max"], float)
    else:
        half, around = np.array(shape["size"], float) / 2, np.radians(shape.get("rotate", [0, 0, 0])[1])
        turn = np.array([[np.cos(around), 0, np.sin(around)], [0, 1, 0], [-np.sin(around), 0, np.cos(around)]])
        # Into the box's own axes; distances stay.
        origin, rays = (origin - np.array(shape["center"], float)) @ turn, rays @ turn
        low, high = -half, half
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(low - origin) / rays, (high - origin) / rays])
    first, last = ends.min(axis=0), ends.max(axis=0)
    axis, enter, leave = first.argmax(axis=-1), first.max(axis=-1), last.min(axis=-1)
    side = np.take_along_axis(rays, axis[..., None], -1)[..., 0] < 0
    return 2 * axis + side, np.where((enter < leave) & (enter > 0), enter, np.inf)


def flat(shape, origin, rays):
    point, normal = np.array(shape["point"], float), np.array(shape["normal"], float)
    across = np.argmax(abs(normal))
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (point[across] - origin[across]) / rays[..., across]
    spot = origin + distance[..., None] * rays
    others = [axis for axis in range(3) if axis != across]
    # Sizes of scenes here: along the two other axes, in their order.
    width = shape.get("size", [np.inf, np.inf])
    inside = (distance > 0) & np.logical_and(*(abs(spot[..., axis] - point[axis]) <= extent / 2 for axis, extent in zip(others, width)))
    return np.zeros(rays.shape[:2], int), np.where(inside, distance, np.inf)
