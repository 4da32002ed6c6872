"""Films of gathered light: what changes from frame to frame that should not."""

import copy

import numpy as np

import seen

FPS, FRAMES = 8, 9
DARK = 1 / 50
"""Of the median of what is compared."""


def frames(program, path, size, words):
    """Linear colours of all frames."""
    import flip_evaluator

    width, height = size
    pattern = program.folder / f"{path.stem}.##.exr"
    words = ["--size", f"{width}x{height}", "--filter", "box", *words, "--fps", FPS, "--frames", f"1-{FRAMES}", "--overwrite", "--quiet"]
    program.run("render", path, "-o", pattern, *words, "--threads", program.options.threads, "--device", program.options.device)
    return [flip_evaluator.load(str(program.folder / f"{path.stem}.{number:02}.exr")) for number in range(1, FRAMES + 1)]


def of_wall(path, images):
    """The largest change of a pixel of the back wall, above half a metre, and the change that one in a thousand exceeds."""
    scene = seen.read(path)
    found = seen.look(scene, seen.view(scene, images[0].shape[1::-1]))
    x, y, z = np.moveaxis(found.point, -1, 0)
    wall = found.plain(2) & (abs(z + 3) < 1e-3) & (y > 0.5)
    light = [image.mean(axis=-1)[wall] for image in images]
    changes = np.concatenate([change(before, after) for before, after in zip(light, light[1:])])
    return float(changes.max()), float(np.quantile(changes, 0.999))


def change(before, after):
    """Relative; next to black, relative to a little light."""
    return abs(after - before) / np.maximum(before, max(DARK * np.median(before), 1e-9))


def of_dolly(path, images):
    """The change of points that stay in sight, which one pixel in a hundred exceeds; a later frame is interpolated between its pixels."""
    scene = seen.read(path)
    size, keys = images[0].shape[1::-1], scene["camera"]["motion"]["key"]
    eyes, views = [], []
    for number in range(len(images)):
        share = number / FPS / keys[-1]["time"]
        eye = copy.deepcopy(scene)
        for name in ("position", "target"):
            eye["camera"][name] = [(1 - share) * a + share * b for a, b in zip(keys[0][name], keys[-1][name])]
        eyes.append(seen.view(eye, size))
        views.append(seen.look(scene, eyes[-1]))
    changes = []
    for number in range(len(images) - 1):
        here = views[number].plain(2)
        x, y = eyes[number + 1].project(views[number].point[here])
        left, top = np.floor(x).astype(int), np.floor(y).astype(int)
        inside = (left >= 0) & (top >= 0) & (left < size[0] - 1) & (top < size[1] - 1)
        x, y, left, top = (values[inside] for values in (x, y, left, top))
        same = views[number + 1].plain(2)[top, left] & (views[number + 1].face[top, left] == views[number].face[here][inside])
        after, right, down = images[number + 1].mean(axis=-1), x - left, y - top
        row = lambda at: (1 - right) * after[at, left] + right * after[at, left + 1]
        later = (1 - down) * row(top) + down * row(top + 1)
        changes.append(change(images[number].mean(axis=-1)[here][inside], later)[same])
    return float(np.quantile(np.concatenate(changes), 0.99))
