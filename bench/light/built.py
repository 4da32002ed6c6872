"""Scenes that are one of a kind by a number: a thickness, a turn, a height, an angle."""

import math


def camera(position, target, vfov):
    return f"[camera]\nposition = {list(position)}\ntarget = {list(target)}\nvfov = {vfov}\n"


def material(name, kd, emission=None):
    shines = "" if emission is None else f"emission = {emission}\n"
    return f'[[material]]\nname = "{name}"\nkd = {kd}\n{shines}'


def box(low, high, of):
    return f'[[box]]\nmin = {list(low)}\nmax = {list(high)}\nmaterial = "{of}"\n'


def plane(point, normal, size, of):
    return f'[[plane]]\npoint = {list(point)}\nnormal = {list(normal)}\nsize = {list(size)}\nmaterial = "{of}"\n'


def sealed(thickness, turn):
    """A room of six boxes that abut, turned about the upright axis, the camera in it."""
    width, height, depth, around = 4.2, 2.7, 6.6, math.radians(turn)
    cosine, sine = math.cos(around), math.sin(around)
    turned = lambda x, y, z: [x * cosine + z * sine, y, z * cosine - x * sine]
    t, w, h, d = thickness, width / 2, height / 2, depth / 2
    boxes = [
        ((0, -t / 2, 0), (width + 2 * t, t, depth + 2 * t)),
        ((0, height + t / 2, 0), (width + 2 * t, t, depth + 2 * t)),
        ((-w - t / 2, h, 0), (t, height, depth + 2 * t)),
        ((w + t / 2, h, 0), (t, height, depth + 2 * t)),
        ((0, h, -d - t / 2), (width, height, t)),
        ((0, h, d + t / 2), (width, height, t)),
    ]
    text = [camera(turned(1.6, 1.5, 2.8), turned(-1, 1.2, -2), 75), material("plaster", 0.7)]
    for center, size in boxes:
        text.append(f'[[box]]\ncenter = {turned(*center)}\nsize = {list(size)}\nrotate = [0, {turn}, 0]\nmaterial = "plaster"\n')
    return "\n".join(text)


def floor(thickness):
    """Nothing but an open floor: a sheet, or the top of a slab. It fills the image."""
    text = [camera((0, 1.7, 2.5), (0, 0, -0.6), 45), material("white", 0.75)]
    if thickness:
        return "\n".join([*text, box((-15, -thickness, -15), (15, 0, 15), "white")])
    return "\n".join([*text, plane((0, 0, 0), (0, 1, 0), (30, 30), "white")])


def sun(angle):
    """A sun of this diameter, degrees, straight above a white floor, which shows 1."""
    light = f'[[light]]\nkind = "directional"\ndirection = [0, -1, 0]\nangle = {angle}\nintensity = [1, 1, 1]\n'
    dark = "[ambient]\nintensity = [0, 0, 0]\n"
    return "\n".join([camera((0, 5, 0.01), (0, 0, 0), 20), dark, light, material("w", 1), plane((0, 0, 0), (0, 1, 0), (10, 10), "w")])


def pile(count, key):
    """Panes or veils, one behind the other, in front of an open floor."""
    light = '[[light]]\nkind = "sphere"\nposition = [6, 9, 4]\nradius = 0.7\nintensity = [0.9, 0.85, 0.8]\n'
    panel = '[[light]]\nkind = "rectangle"\nposition = [-3, 4, 2]\nu = [1, 0, 0]\nv = [0, 0, 1]\nintensity = 0.4\n'
    text = [camera((4, 3, 6), (0, 0.8, 0), 40), light, panel, material("g", 0.5), f'[[material]]\nname = "x"\n{key}\n']
    text.append(plane((0, 0, 0), (0, 1, 0), (20, 20), "g"))
    return "\n".join([*text, *(plane((0, 1, round(0.01 * number, 4)), (0, 0, 1), (3, 2), "x") for number in range(count))])


PANE, VEIL = "kd = 0\nior = 1.5\nthin = true", "opacity = 0.05"
