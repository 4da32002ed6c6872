"""Passes against Cycles' of the same scene, and Cryptomatte by its hashes."""

import json
import re

import bpy
import numpy as np
import pytest
from support import Picture, cycles, light, lightmesh, overlap, stage

NEW_NAMES = bpy.app.version >= (5, 0, 0)
OBJECT_INDEX = "Object Index" if NEW_NAMES else "IndexOB"
MATERIAL_INDEX = "Material Index" if NEW_NAMES else "IndexMA"


def layer() -> bpy.types.ViewLayer:
    return bpy.context.view_layer


def inner(mask: np.ndarray) -> np.ndarray:
    """The pixels of a mask whose neighbours are in it, too: no edges."""
    kept = mask.copy()
    for axis in (0, 1):
        for step in (1, -1):
            kept &= np.roll(mask, step, axis)
    return kept


def both(**passes: object) -> tuple[Picture, Picture]:
    stage()
    light("SUN", 3.0, angle=0.05)
    for name, value in passes.items():
        setattr(layer(), name, value)
    return lightmesh(), cycles(samples=1)


def test_depth() -> None:
    ours, theirs = both(use_pass_z=True)
    a, b = ours.channels["Depth.Z"], theirs.channels["Depth.Z"]
    assert overlap(a < 1e9, b < 1e9) > 0.99
    seen = inner((a < 1e9) & (b < 1e9))
    # Cycles' one sample lies anywhere in the pixel.
    assert np.median(np.abs(a[seen] - b[seen])) < 0.03
    assert np.abs(a[seen] - b[seen]).mean() < 0.05


def test_normal() -> None:
    ours, theirs = both(use_pass_normal=True)
    a, b = ours.pass_("Normal", "XYZ"), theirs.pass_("Normal", "XYZ")
    floor = inner((a[..., 2] > 0.999) & (b[..., 2] > 0.999))
    assert floor.mean() > 0.4
    length = np.linalg.norm(a, axis=2)
    assert np.all((np.abs(length - 1.0) < 1e-3) | (length == 0.0))
    seen = inner((length > 0.0) & (np.linalg.norm(b, axis=2) > 0.5))
    assert np.sum(a * b, axis=2)[seen].mean() > 0.98


def test_position() -> None:
    ours, theirs = both(use_pass_position=True)
    a, b = ours.pass_("Position", "XYZ"), theirs.pass_("Position", "XYZ")
    assert np.median(np.abs(a - b)) < 0.03


def test_indices() -> None:
    stage()
    light("SUN", 3.0)
    for number, name in enumerate(("Floor", "Box", "Ball"), 1):
        bpy.data.objects[name].pass_index = 10 * number
    bpy.data.materials["matt"].pass_index = 7
    layer().use_pass_object_index = layer().use_pass_material_index = True
    ours, theirs = lightmesh(), cycles(samples=1)
    for name, numbers in ((OBJECT_INDEX, (0, 10, 20, 30)), (MATERIAL_INDEX, (0, 7))):
        a, b = ours.channels[f"{name}.X"], theirs.channels[f"{name}.X"]
        assert set(np.unique(a)) == set(numbers)
        assert (a == b).mean() > 0.97


def test_visibility_of_each_light() -> None:
    """A pass for each light, named by it: its own shadow alone."""
    stage()
    light("POINT", 200.0, (3.0, -2.0, 3.0), shadow_soft_size=0.3).name = "Key"
    light("SUN", 1.0, (-4.0, -1.0, 3.0), angle=0.05).name = "Sun"
    layer().lightmesh.use_pass_visibility = True
    ours = lightmesh()
    for name, other in (("Key", "Sun"), ("Sun", "Key")):
        seen = ours.channels[f"Visibility {name}.X"]
        assert 0.0 <= seen.min() and seen.max() <= 1.0 and 0.02 < (seen < 0.5).mean() < 0.9
        bpy.data.objects[other].hide_render = True
        alone = lightmesh()
        bpy.data.objects[other].hide_render = False
        assert np.abs(alone.channels[f"Visibility {name}.X"] - seen).mean() < 0.01
        lit = alone.rgb.sum(2) > 0.02
        assert overlap(inner(lit), inner(lit & (seen > 0.0))) > 0.99


def test_cryptomatte() -> None:
    """The same hashes and shares as Cycles', in the same places."""
    stage()
    light("SUN", 3.0)
    layer().use_pass_cryptomatte_object = layer().use_pass_cryptomatte_material = True
    layer().pass_cryptomatte_depth = 4
    ours, theirs = lightmesh(), cycles(samples=64)
    for kind in ("CryptoObject", "CryptoMaterial"):
        assert f"{kind}01.a" in ours.channels and f"{kind}02.r" not in ours.channels
        first, second = (picture.channels[f"{kind}00.r"].view(np.uint32) for picture in (ours, theirs))
        assert (first == second).mean() > 0.97
        assert len(np.unique(first)) >= (4 if kind == "CryptoObject" else 2)
        shares = [picture.channels[f"{kind}00.g"] + picture.channels[f"{kind}00.a"] for picture in (ours, theirs)]
        assert np.abs(shares[0] - shares[1]).mean() < 0.01


def test_cryptomatte_metadata() -> None:
    """Readers find names by the header: the same as Cycles writes."""
    stage()
    light("SUN", 3.0)
    layer().use_pass_cryptomatte_object = True
    ours, theirs = lightmesh(), cycles(samples=1)
    texts = [picture.data[: 1 << 16].decode("latin-1") for picture in (ours, theirs)]
    keys = [set(re.findall(r"cryptomatte/[0-9a-f]{7}/\w+", text)) for text in texts]
    assert len(keys[0]) == 4 and keys[0] == keys[1]
    manifests = [json.loads(re.search(r'\{"[^}]*\}', text).group()) for text in texts]
    assert set(manifests[0]) == {"Floor", "Box", "Ball"}
    for name, text in manifests[0].items():
        # Cycles writes hashes before the bit is flipped that makes numbers of them.
        assert int(text, 16) & ~(1 << 23) == int(manifests[1][name], 16) & ~(1 << 23)


def test_passes_in_parts() -> None:
    """A border crops passes, too."""
    stage()
    light("SUN", 3.0)
    layer().use_pass_z = True
    whole = lightmesh().channels["Depth.Z"]
    render = bpy.context.scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.5, 1.0, 0.0, 0.5
    part = lightmesh().channels["Depth.Z"]
    np.testing.assert_array_equal(part, whole[whole.shape[0] // 2 :, whole.shape[1] // 2 :])


def test_unknown_passes_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    stage()
    light("SUN", 3.0)
    layer().use_pass_mist = True
    lightmesh()
    assert "Mist" in capfd.readouterr().out
