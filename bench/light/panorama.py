"""A panorama of three soft boxes in a dark studio, as a photographer lights a still life."""

import numpy as np

ROWS, COLUMNS = 128, 256
STUDIO = 0.05
"""The radiance of all else."""
BOXES = [
    # azimuth and elevation of the middle, half of the width and the height, degrees; radiance
    (-55, 40, 22, 16, (11, 10.5, 10)),
    (70, 25, 10, 26, (6, 6.5, 7)),
    (175, 60, 28, 10, (3, 3, 3)),
]


def soft_boxes():
    """Linear colours; row 0 is straight above, the middle column is -z, and x is to the right of it."""
    elevation = 90 - (np.arange(ROWS) + 0.5) * 180 / ROWS
    azimuth = (np.arange(COLUMNS) + 0.5) * 360 / COLUMNS - 180
    image = np.full((ROWS, COLUMNS, 3), STUDIO, np.float32)
    for around, up, width, height, radiance in BOXES:
        beside = abs((azimuth - around + 180) % 360 - 180) < width
        image[np.ix_(abs(elevation - up) < height, beside)] = radiance
    return image


def write(path):
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": soft_boxes()}).write(str(path))
