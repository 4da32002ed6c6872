"""How dark it is under low tables."""

import numpy as np

import seen

HEIGHTS = (0.05, 0.09, 0.17, 0.4)
"""Of the tables of `scenes/tables.toml`, from the left."""
LEFT, APART, SIDE = -1.2, 0.8, 0.6


def ratios(path, truth, image):
    """By height: the mean under the table, where the camera sees it, relative to the truth."""
    scene = seen.read(path)
    eye = seen.view(scene, (image.shape[1], image.shape[0]))
    found = seen.look(scene, eye)
    on_floor = found.plain(1) & (abs(found.point[..., 1]) < 1e-4)
    for number, height in enumerate(HEIGHTS):
        middle = LEFT + APART * number
        under = on_floor & (abs(found.point[..., 0] - middle) < SIDE / 2) & (abs(found.point[..., 2]) < SIDE / 2)
        yield height, float(image[under].mean() / truth[under].mean()), int(under.sum())


def spread(image, kd):
    """The smallest and the largest pixel of an open floor under a sky of radiance 1, relative to what it shows."""
    light = np.asarray(image, np.float64)
    return float(light.min() / kd), float(light.max() / kd)
