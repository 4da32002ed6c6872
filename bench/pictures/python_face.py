"""Writes the pictures of a scene by the Python package, for `pictures.py --face python`: python_face.py CASE SCENE FOLDER DEVICE

Frames are saved as PNG and EXR, with layers and statistics. Warnings and notes go to standard error; exit code 2 if the scene cannot be rendered.
"""

import json
import sys
import warnings
from pathlib import Path

import lightmesh
import numpy as np

SETTINGS = {
    "default": {},
    "ground": {"ground": True},
    "sky": {"sky": "clear", "quality": "draft"},
    "turntable": {},
}
FRAMES = 3


def main(case, path, folder, device):
    scene = lightmesh.Scene.builtin(path) if path.startswith("builtin:") else lightmesh.Scene.open(path)
    renderer = lightmesh.Renderer(device=device, threads=1)
    cameras = turned(scene) if case == "turntable" else [None]
    for number, camera in enumerate(cameras, 1):
        frame = renderer.render(scene, size=(48, 36), layers=True, camera=camera, **SETTINGS[case])
        frame.save(folder / f"p.{number}.png")
        frame.save(folder / f"e.{number}.exr")
        frame.save_layers(folder / f"l.{number}.exr")
        (folder / f"p.{number}.json").write_text(json.dumps(frame.stats))
        for note in frame.notes:
            print(note, file=sys.stderr)


def turned(scene):
    """Cameras around a scene, which look at its middle. What is above is by the axis Y: one rule serves all models."""
    low, high = np.array(scene.bounds)
    middle, arm = (low + high) / 2, np.linalg.norm(high - low)
    for angle in np.arange(FRAMES) * 2 * np.pi / FRAMES:
        yield lightmesh.Camera(middle + arm * np.array([np.sin(angle), 0.4, np.cos(angle)]), middle)


if __name__ == "__main__":
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    case, path, folder, device = sys.argv[1:]
    try:
        main(case, path, Path(folder), device)
    except lightmesh.LightmeshError as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        sys.exit(2)
