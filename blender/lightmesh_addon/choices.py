"""The items of menus. Made by `cargo xtask settings`."""

QUALITIES = [
    ("DRAFT", "Draft", "16 samples of a light in a pixel, 4 of the pixel: for a quick look"),
    ("GOOD", "Good", "64, and 8 of the pixel: hardly any noise"),
    ("FINAL", "Final", "256, and 16 of the pixel: no visible noise"),
]

TECHNIQUES = [
    ("LISTS", "Occluder Lists", "Exact area shadows, by triangles found once for neighbouring surface points"),
    ("ADAPTIVE", "Adaptive Rays", "One shadow ray per light and pixel, all samples where 5x5 pixels disagree"),
    ("HALF_BALL", "Half-Ball", "Formula (3), the thesis: the mean over the light points of a half-ball"),
    ("RAY_TRACE", "Hard Shadows", "One hard shadow ray per light and pixel"),
    ("AREA", "Area Shadows", "Many shadow rays per light and pixel: the reference"),
]

AMBIENT = [
    ("AUTO", "Automatic", "Mesh with sky, environment or only lamps; constant otherwise, or by ambient"),
    ("CONSTANT", "Unshadowed", "The ambient intensity; under a sky by direction, without shadows"),
    ("MESH", "Gathered", "Gathered from the sky and other surfaces, in place of ambient"),
    ("RAYS", "Gathered by Rays", "Gathered by thousands of rays at each surface point: slow, the reference"),
]

GLASS = [
    ("OPEN", "Open", "It hides no sun; what is at least half opaque does"),
    ("CLOSED", "Closed", "It hides the sun as a wall does"),
    ("TINTED", "Tinted", "Behind it counts the share of the light that it lets through"),
]

#: What each technique is in settings of a render.
SETTINGS = {
    "LISTS": {"mode": "light-mesh", "lookup": "lists"},
    "ADAPTIVE": {"mode": "light-mesh", "lookup": "adaptive"},
    "HALF_BALL": {"mode": "light-mesh", "lookup": "half-ball"},
    "RAY_TRACE": {"mode": "ray-trace"},
    "AREA": {"mode": "area"},
}
