"""The scenes of the films, as files."""

import re

FPS = 24

POSITION, TARGET = (13.0, 68.0, 114.0), (5.0, 33.0, 44.0)
"""Childpark's camera."""

STEP = (0.25, -0.12, -0.28)
"""How far the dolly goes from frame to frame: less than a pixel in the middle of the scene, at 480×270."""

SKY = '\n[sky]\nkind = "clear"\nsun = [40, 225]\n'

BALLS = {
    "in sight": [(28.0, 1.5, -18.0), (46.0, 1.5, -16.0)],
    "hidden": [(-60.0, 1.5, -70.0), (-35.0, 1.5, -70.0)],
    "outside": [(400.0, 1.5, -200.0), (400.0, 1.5, 100.0)],
}
"""From where to where a ball moves: behind the swings; behind the trees; beyond the park, so that the scene's bounds change from frame to frame."""

RADIUS = 1.5
"""The ball's."""


def dolly_scene(park, frames, sky):
    def camera(number):
        position, target = ([a + number * b for a, b in zip(point, STEP, strict=True)] for point in (POSITION, TARGET))
        return f"position = {position}, target = {target}"

    keys = f"{{ time = 0, {camera(0)} }}, {{ time = {(frames - 1) / FPS}, {camera(frames - 1)} }}"
    return park_with(park, f'motion = {{ interpolation = "linear", key = [{keys}] }}\n', sky)


def ball_scene(park, frames, place, sky):
    begin, end = BALLS[place]
    way = [b - a for a, b in zip(begin, end, strict=True)]
    keys = f"{{ time = 0, translate = [0, 0, 0] }}, {{ time = {(frames - 1) / FPS}, translate = {way} }}"
    motion = f'motion = {{ interpolation = "linear", key = [{keys}] }}'
    material = '\n[[material]]\nname = "ball"\nkd = [0.7, 0.1, 0.1]\n'
    return park_with(park, "", sky) + f'{material}\n[[sphere]]\ncenter = {list(begin)}\nradius = {RADIUS}\nmaterial = "ball"\n{motion}\n'


def park_with(park, motion, sky):
    """The exported Childpark with a camera that moves, and its own lights or a sky alone."""
    left_out = ("[[camera]]", "[[light]]", "[ambient]") if sky else ("[[camera]]",)
    text = "\n".join(block for block in re.split(r"\n(?=\[)", park) if not block.startswith(left_out))
    return f"[camera]\nposition = {list(POSITION)}\ntarget = {list(TARGET)}\nvfov = 50\n{motion}\n{text}{SKY if sky else ''}"
