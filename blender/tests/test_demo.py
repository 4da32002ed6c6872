"""The demo file renders as it is opened, without a setting touched."""

import subprocess
import sys
from pathlib import Path

import bpy
import build
import numpy as np
from support import agreement, cycles, lightmesh


def test_demo(tmp_path: Path) -> None:
    path = tmp_path / "courtyard.blend"
    subprocess.run([sys.executable, str(build.ADDON.parent / "demo.py"), str(path)], check=True, timeout=60, capture_output=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    assert scene.render.engine == "LIGHTMESH"
    settings = scene.lightmesh
    assert not any(settings.is_property_set(name) for name in ("quality", "mode", "device", "samples", "pixel_samples", "bounces", "ambient_light"))
    # The sky lights the courtyard, so that reflected light is in both pictures.
    ours, theirs = lightmesh(), cycles(bounces=14, mirrors=2)
    agreement("demo", ours, theirs).check(shadows=0.85)
    assert np.isfinite(ours.rgb).all()
