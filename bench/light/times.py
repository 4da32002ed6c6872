"""Times of one program beside another's, or of one scene beside another."""

import statistics

TURNS = 3
ROOMS = ["room-window", "room-door", "glowing-ceiling", "screen"]
OTHERS = {
    "sponza": ("models:sponza/sponza.obj", ["--sky", "clear;sun=60,120", "--camera", "-13,3,0;10,5,0;60"]),
    "garden": ("builtin:garden", ["--sky", "clear"]),
}


def ratio(first, second, turns=TURNS):
    """Of the medians of what both calls return, which take turns."""
    pairs = [(first(), second()) for _ in range(turns)]
    one, other = (statistics.median(values) for values in zip(*pairs))
    return one / other, one, other
