"""A frame moved to where the one before it sees its surfaces, and what has changed."""

import flip_evaluator
import numpy as np

SAME_NORMAL = 0.95
"""Normals of one surface, from pixel to pixel, by cosine."""

SAME_PLANE = 0.1
"""How far pixels of one surface are from its plane, in distances between the surface points of two pixels."""


class Way:
    """For each pixel of a frame, where the next one sees its surface: four pixels with weights, and whether they are of that surface."""

    def __init__(self, taps, weights, same, error):
        self.taps, self.weights, self.same, self.error = taps, weights, same, error

    def bring(self, plane, part):
        """A plane of the next frame, at the pixels of the one before; and which of them are known."""
        shape, (top, left) = plane.shape[:2], (part[0], part[2]) if part else (0, 0)
        lines, columns = self.taps[..., 0] - top, self.taps[..., 1] - left
        inside = (lines >= 0) & (columns >= 0) & (lines < shape[0]) & (columns < shape[1])
        values = plane[np.clip(lines, 0, shape[0] - 1), np.clip(columns, 0, shape[1] - 1)]
        brought, known = (values * self.weights[..., None]).sum(axis=2), self.same & inside.all(axis=2)
        if part:
            brought, known = (whole[part[0] : part[1], part[2] : part[3]] for whole in (brought, known))
        return brought, known


def rays(camera, shape):
    """Unit directions through the pixels' centres, and the axes right, up and ahead."""
    ahead, up = (np.array(camera[name], dtype=np.float64) for name in ("direction", "up"))
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(right, ahead), ahead])
    scale = np.tan(0.5 * np.radians(camera["vfov"])) * 2.0 / shape[0]
    lines, columns = np.mgrid[0 : shape[0], 0 : shape[1]]
    x, y = (columns + 0.5 - 0.5 * shape[1]) * scale, (0.5 * shape[0] - lines - 0.5) * scale
    directions = np.stack([x, y, np.ones_like(x)], axis=-1) @ axes
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True), axes, scale


def moved(before, after, margin):
    """From geometry with one sample of a pixel. Depth is the distance along the ray. Pixels closer than `margin` to others are left out."""
    shape, eye = before.depth.shape, np.array(before.camera["position"])
    directions, _, scale = rays(before.camera, shape)
    hit = np.isfinite(before.depth)
    distance = np.where(hit, before.depth, 1.0)
    position = eye + distance[..., None] * directions
    # That this is the place which the renderer itself reports says that depth and camera are understood.
    error = np.abs(position - before.position)[hit].max() / distance[hit].max()
    _, axes, _ = rays(after.camera, shape)
    place = (position - np.array(after.camera["position"])) @ axes.T
    ahead = np.where(place[..., 2] > 0.0, place[..., 2], np.inf)
    x, y = (place[..., 0] / ahead / scale + 0.5 * shape[1] - 0.5, 0.5 * shape[0] - 0.5 - place[..., 1] / ahead / scale)
    column, line = np.floor(x).astype(int), np.floor(y).astype(int)
    right, down = x - column, y - line
    inside = (column >= 0) & (line >= 0) & (column + 1 < shape[1]) & (line + 1 < shape[0])
    taps = np.stack([np.stack([line + j, column + i], axis=-1) for j in (0, 1) for i in (0, 1)], axis=2)
    weights = np.stack([(right if i else 1 - right) * (down if j else 1 - down) for j in (0, 1) for i in (0, 1)], axis=-1)
    lines, columns = np.clip(taps[..., 0], 0, shape[0] - 1), np.clip(taps[..., 1], 0, shape[1] - 1)
    thick = SAME_PLANE * scale * distance
    others = (after.position[lines, columns] - position[..., None, :], after.normal[lines, columns], after.ids[lines, columns])
    same = hit & inside & one_surface(others, before, thick).all(axis=2)
    if margin:
        # Samples of a pixel are of pixels around it, too: all of these must be of one surface, in both frames.
        flat = [flat_around(frame, scale, margin) for frame in (before, after)]
        same &= flat[0] & flat[1][lines, columns].all(axis=2)
    return Way(taps, weights, same, error)


def one_surface(others, frame, thick):
    """Whether points, with their normals and ids, continue the surfaces of a frame's pixels."""
    ways, normals, ids = others
    with np.errstate(invalid="ignore"):
        near = np.abs((ways * frame.normal[..., None, :]).sum(axis=-1)) < thick[..., None]
        return near & ((normals * frame.normal[..., None, :]).sum(axis=-1) > SAME_NORMAL) & (ids == frame.ids[..., None, :]).all(axis=-1)


def flat_around(frame, scale, margin):
    """Pixels around which all others are of their surface."""
    hit = np.isfinite(frame.depth)
    thick = SAME_PLANE * scale * margin * np.where(hit, frame.depth, 1.0)
    flat = hit.copy()
    for down in range(-margin, margin + 1):
        for right in range(-margin, margin + 1):
            around = [np.roll(plane, (down, right), axis=(0, 1))[:, :, None] for plane in (frame.position, frame.normal, frame.ids)]
            flat &= one_surface((around[0] - frame.position[..., None, :], *around[1:]), frame, thick)[..., 0]
    flat[:margin] = flat[-margin:] = False
    flat[:, :margin] = flat[:, -margin:] = False
    return flat


def shown(linear):
    """Colours as a screen shows them, not rounded."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(linear, 1.0 / 2.4) - 0.055).astype(np.float32)


def flip(one, other):
    values, _, _ = flip_evaluator.evaluate(np.ascontiguousarray(one), np.ascontiguousarray(other), "LDR", applyMagma=False)
    return values[..., 0] if values.ndim == 3 else values


def flicker(before, after, way, part):
    """Changes from a frame to the next one where both show the same surface."""
    errors, codes, known = change(before.color, after.color, way, part)
    rest, rest_codes, _ = change(before.rest, after.rest, way, part)
    shadows, _ = way.bring(after.visibility, part)
    first = shown(before.color)
    still = flip(first, np.where(known[..., None], shown(after.color), first))
    return {
        "flicker": float(errors[known].mean()),
        "worst_percent": float(np.sort(errors[known])[-max(known.sum() // 100, 1) :].mean()),
        "codes": float(codes[known].mean()),
        "visibility_rmse": float(np.sqrt(((shadows - before.visibility)[known] ** 2).mean())),
        "rest_flicker": float(rest[known].mean()),
        "rest_codes": float(rest_codes[known].mean()),
        "rest_largest_codes": float(rest_codes[known].max()),
        "rest_worst_material": max((float(rest[some].mean()) for some in materials(before, known)), default=0.0),
        "not_moved": float(still[known].mean()),
        "compared_share": float(known.mean()),
        "position_error": float(way.error),
        "map": errors,
    }


MANY = 200
"""Pixels of a material from which on it counts by itself."""


def materials(frame, known):
    """For each material that is much seen, its pixels among those that are compared."""
    alone = [known & (frame.ids[..., 1] == material) for material in np.unique(frame.ids[..., 1][known])]
    return [pixels for pixels in alone if pixels.sum() >= MANY]


def change(before, after, way, part):
    """FLIP and the change in codes of 8 bits by pixel. Frames are made equal where they do not show the same, so that FLIP is 0 there."""
    brought, known = way.bring(after, part)
    first = shown(before)
    last = np.where(known[..., None], shown(brought), first)
    return flip(first, last), 255.0 * np.abs(first - last), known


def grown(mask, pixels):
    """A mask and all within so many pixels of it, as a square."""
    for axis in (0, 1):
        wide = mask.copy()
        for step in range(1, pixels + 1):
            for way in (-step, step):
                shifted = np.roll(mask, way, axis=axis)
                edge = [slice(None)] * 2
                edge[axis] = slice(0, way) if way > 0 else slice(way, None)
                shifted[tuple(edge)] = False
                wide |= shifted
        mask = wide
    return mask


MARGIN = 2
"""Pixels around what the reference shows to change."""


def changed(film, truth, numbers, radius, rounding):
    """Compares frames with the first one: pixels that change although the reference, around them, does not.

    Light points of a half-ball see for surface points within its radius: influence is that much wider there.
    """
    first, first_truth = film[1], truth[1]
    total = inside = influenced = of_codes = 0
    largest, places = 0.0, np.zeros(first.depth.shape)
    nearest = first_truth.depth.min()
    scale = rays(first_truth.camera, first.depth.shape)[2]
    for number in numbers:
        now, now_truth = film[number], truth[number]
        influence = (np.abs(now_truth.color - first_truth.color) > rounding).any(axis=-1) | (now_truth.ids != first_truth.ids).any(axis=-1)
        at = min(now_truth.depth[influence].min(), first_truth.depth[influence].min()) if influence.any() else nearest
        influence = grown(influence, MARGIN + (int(np.ceil(radius / (at * scale))) if radius else 0))
        differs = (now.color != first.color).any(axis=-1)
        outside = differs & ~influence
        total, inside, influenced = total + outside.sum(), inside + (differs & influence).sum(), influenced + influence.sum()
        of_codes += ((np.round(255.0 * shown(now.color)) != np.round(255.0 * shown(first.color))).any(axis=-1) & ~influence).sum()
        codes = 255.0 * np.abs(shown(now.color) - shown(first.color)).max(axis=-1)
        largest = max(largest, codes[outside].max(initial=0.0))
        places = np.maximum(places, 0.25 * outside + 0.1 * influence)
    count = len(numbers) * first.depth.size
    return {
        "differing_pixels": float(total),
        "differing_share": total / count,
        "differing_codes": float(of_codes),
        "largest_codes": float(largest),
        "differing_inside": float(inside),
        "influenced_share": influenced / count,
        "map": places,
    }


def beside(gathered, rays):
    """How much the ambient and gathered light of two frames differs, by two means, where no ball is: in codes of 8 bits."""
    same = np.ones(gathered[0].depth.shape, dtype=bool)
    for one, other in (gathered, rays):
        same &= (one.ids == other.ids).all(axis=-1)
    one, other = (255.0 * np.abs(shown(last.color) - shown(first.color)).max(axis=-1) for first, last in (gathered, rays))
    lit = same & ~grown((gathered[0].visibility != gathered[1].visibility).any(axis=-1), MARGIN)
    found = {}
    for name, codes in {"gathered": one, "rays": other}.items():
        found[name] = {"codes": float(codes[lit].mean()), "largest_codes": float(codes[lit].max()), "beyond_a_code": float((codes[lit] > 1.0).mean())}
    more = (one - other)[lit]
    found["gathered"] |= {"more_than_rays": float(more.max()), "half_a_code_more": float((more > 0.5).mean())}
    return found
