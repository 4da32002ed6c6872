"""How far an image is from the truth."""

import numpy as np

from shown import flip, halved

SIDE = 8
"""Of a block, pixels."""
EVEN = 1.5
"""The largest over the smallest pixel of a block in which the truth is even."""
DARK = 1 / 50
"""Of white: darker blocks don't count."""
CUT = 2
"""Times white: what is brighter counts as that, since lamps that are seen would outweigh the rest."""
SKY = 1.1
"""Times what surfaces can show: the truth is brighter where it shows the sky."""
EXCESS = 1.001
"""Times what energy allows."""


def all_of(room, truth, image):
    """A dictionary of numbers."""
    height, width = image.shape[:2]
    white = 2.0**-room.exposure
    cut = lambda linear: np.minimum(linear, CUT * white)
    row = {
        "flip": above_floor(truth.first, truth.second, image, room.exposure),
        "flip, half size": above_floor(*map(halved, (truth.first, truth.second, image)), room.exposure),
        "flip to both": flip(truth.mean, image, room.exposure),
        "noise": flip(truth.first, truth.second, room.exposure),
        "mean": float(cut(image).mean() / cut(truth.mean).mean()) if truth.mean.any() else None,
    }
    row["block"], row["block at"] = worst_block(truth.mean, image, white)
    row["rms"] = blocks_rms(truth.mean, image, white)
    row["too bright"] = too_bright(room, truth.mean, image)
    return row


def above_floor(first, second, image, exposure):
    """The mean FLIP to either seed's image, less that of both."""
    return (flip(first, image, exposure) + flip(second, image, exposure)) / 2 - flip(first, second, exposure)


def blocks(image, side):
    """Luminances, as (rows, columns, pixels of a block)."""
    light = image @ np.array([0.2126, 0.7152, 0.0722])
    rows, columns = light.shape[0] // side, light.shape[1] // side
    light = light[: side * rows, : side * columns].reshape(rows, side, columns, side)
    return light.transpose(0, 2, 1, 3).reshape(rows, columns, side * side)


def ratios(truth, image, white):
    """Of the means of blocks in which the truth is even and neither dark nor brighter than white; else 1. And where they are."""
    # Of pairs of pixels both ways, in which the noise of the truth is half as strong.
    true, seen = blocks(halved(truth), SIDE // 2), blocks(image, SIDE)
    level = true.mean(axis=2)
    counts = (true.max(axis=2) < EVEN * true.min(axis=2)) & (level > DARK * white) & (level < white)
    return np.where(counts, seen.mean(axis=2) / np.maximum(level, 1e-9), 1), counts


def worst_block(truth, image, white):
    """The ratio that is farthest from 1, and the middle of its block in pixels, from the left and the top."""
    ratio, _ = ratios(truth, image, white)
    row, column = np.unravel_index(np.argmax(abs(ratio - 1)), ratio.shape)
    return float(ratio[row, column]), [int(SIDE * column + SIDE // 2), int(SIDE * row + SIDE // 2)]


def blocks_rms(truth, image, white):
    ratio, counts = ratios(truth, image, white)
    return float(np.sqrt(((ratio[counts] - 1) ** 2).mean())) if counts.any() else 0.0


def too_bright(room, truth, image):
    """The share of pixels that show more than their surfaces can of a sky of radiance 1; None where there is other light."""
    if room.reflectance is None:
        return None
    # A pixel in which a surface ends shows some of the sky, too.
    sky = near(near(truth.max(axis=2) > SKY * room.reflectance))
    return float(((image.max(axis=2) > EXCESS * room.reflectance) & ~sky).mean())


def near(mask):
    """Also the pixels beside those of the mask."""
    wide = np.pad(mask, 1)
    return np.any([wide[1 + y : mask.shape[0] + 1 + y, 1 + x : mask.shape[1] + 1 + x] for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)
