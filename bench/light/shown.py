"""Images as they are shown."""

import flip_evaluator
import numpy as np


def shown(linear, exposure):
    """sRGB from 0 to 1."""
    share = np.clip(2.0**exposure * linear, 0, 1)
    return np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1 / 2.4) - 0.055).astype(np.float32)


def flip(reference, image, exposure):
    """The mean FLIP of both as they are shown."""
    return float(flip_evaluator.evaluate(shown(reference, exposure), shown(image, exposure), "LDR")[1])


def halved(image):
    """Averaged to half its size."""
    rows, columns = image.shape[0] // 2, image.shape[1] // 2
    return image[: 2 * rows, : 2 * columns].reshape(rows, 2, columns, 2, 3).mean(axis=(1, 3))


def keep(path, linear, exposure):
    from PIL import Image

    Image.fromarray(np.uint8(255 * shown(linear, exposure) + 0.5)).save(path)
