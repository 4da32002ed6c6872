#!/usr/bin/env python3
"""Reads the EXR files that Lightmesh writes with OpenEXR's own library, and checks what it finds.

    python3 crates/cli/tests/openexr.py target/debug/lightmesh

It needs the wheels in .ci/openexr.txt; `.ci/run` installs them. A check that fails ends the script with its line.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

SCENE = """
[camera]
position = [1, 2, 4]
target = [0, 0.3, 0]
vfov = 50

[ambient]
intensity = [0.1, 0.1, 0.1]
background = [0.25, 0.5, 0.75]

[[light]]
kind = "sphere"
position = [2, 3, 1]
radius = 0.2
intensity = [0.6, 0.4, 0.2]

[[light]]
kind = "point"
position = [-2, 3, 1]
intensity = [0.1, 0.3, 0.5]

[[material]]
name = "mirror \\"grün\\""
kd = [0.4, 0.6, 0.4]
ks = [0.3, 0.3, 0.3]

[[material]]
name = "matt"
kd = [0.6, 0.6, 0.6]

[[sphere]]
name = "Kugel ß"
center = [0, 0.5, 0]
radius = 0.5
segments = 24
material = "mirror \\"grün\\""

[[box]]
min = [0.7, 0, -0.3]
max = [1.2, 0.5, 0.3]
material = "matt"

[[box]]
min = [-1.3, 0, -0.3]
max = [-0.8, 0.8, 0.3]
material = "matt"

[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
size = [4, 4]
material = "matt"
"""

SIZE = (48, 36)
OBJECTS = ["Kugel ß", "box 1", "box 2", "plane 1"]
MATERIALS = ['mirror "grün"', "matt"]
PARTS = ["rgba", "depth", "normal", "position", "visibility", "lights", "ids", "CryptoObject", "CryptoMaterial"]


class Layers:
    """The channels of all parts of a file, and their headers."""

    def __init__(self, path):
        self.parts = OpenEXR.File(str(path), separate_channels=True).parts
        self.planes = {name: channel.pixels for part in self.parts for name, channel in part.channels.items()}
        self.header = {name: value for part in self.parts for name, value in part.header.items()}

    def vector(self, prefix, names="RGB"):
        return np.stack([self.planes[prefix + name].astype(np.float64) for name in names], -1)

    def manifest(self, layer):
        """The names of a matte with the identifiers that stand for them."""
        prefix = {name.rsplit("/", 1)[0] for name, value in self.header.items() if name.endswith("/name") and value == layer}
        (prefix,) = prefix
        assert prefix == "cryptomatte/" + f"{murmur3(layer.encode()):08x}"[:7], prefix
        assert self.header[prefix + "/hash"] == "MurmurHash3_32"
        assert self.header[prefix + "/conversion"] == "uint32_to_float32"
        return {name: int(value, 16) for name, value in json.loads(self.header[prefix + "/manifest"]).items()}

    def mattes(self, layer):
        """The coverage of each thing that the manifest names."""
        mattes = {}
        for name, bits in self.manifest(layer).items():
            assert bits == identifier(name), name
            coverage = np.zeros(self.planes[layer + "00.R"].shape)
            for number in range(3):
                for identifiers, shares in ["RG", "BA"]:
                    found = self.planes[f"{layer}{number:02}.{identifiers}"].view(np.uint32) == bits
                    coverage += np.where(found, self.planes[f"{layer}{number:02}.{shares}"], 0.0)
            mattes[name] = coverage
        return mattes

    def ranks(self, layer):
        return [self.planes[f"{layer}{number:02}.{shares}"] for number in range(3) for shares in "GA"]


def murmur3(data):
    """MurmurHash3_x86_32 with seed 0."""

    def mixed(word):
        word = word * 0xCC9E2D51 & 0xFFFFFFFF
        word = (word << 15 | word >> 17) & 0xFFFFFFFF
        return word * 0x1B873593 & 0xFFFFFFFF

    value, whole = 0, len(data) // 4 * 4
    for start in range(0, whole, 4):
        value ^= mixed(int.from_bytes(data[start : start + 4], "little"))
        value = (value << 13 | value >> 19) & 0xFFFFFFFF
        value = value * 5 + 0xE6546B64 & 0xFFFFFFFF
    value ^= mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    value = (value ^ value >> 16) * 0x85EBCA6B & 0xFFFFFFFF
    value = (value ^ value >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    return value ^ value >> 16


def identifier(name):
    value = murmur3(name.encode())
    return value ^ 1 << 23 if value >> 23 & 255 in (0, 255) else value


def check_light_groups(layers, lights):
    beauty, rest = layers.vector(""), layers.vector("L.rest.")
    groups = [layers.vector(f"L.{light}.") for light in range(lights)]
    assert f"L.{lights}.R" not in layers.planes and all(group.max() > 0 for group in groups)
    apart = np.abs(sum(groups) + rest - beauty)
    assert (apart <= 1e-6 + 1e-5 * beauty).all(), apart.max()


def check_mattes(layers, samples, alpha):
    for layer, names, ids in [("CryptoObject", OBJECTS, "id.object"), ("CryptoMaterial", MATERIALS, "id.material")]:
        mattes, ids = layers.mattes(layer), layers.planes[ids]
        assert list(mattes) == names, list(mattes)
        assert ids.dtype == np.uint32 and ids.max() == len(names)
        ranks = layers.ranks(layer)
        assert all((a >= b).all() for a, b in zip(ranks, ranks[1:])), "large shares come first"
        # A pixel has a number if any sample sees something: one of what its matte has.
        assert ((ids > 0) == (sum(mattes.values()) > 0)).all()
        for number, (name, coverage) in enumerate(mattes.items(), 1):
            assert coverage.max() == 1.0, f"{name} fills some pixels"
            counts = coverage * samples
            assert np.abs(counts - counts.round()).max() < 1e-4, f"{name}: whole numbers of samples"
            assert (coverage[ids == number] > 0).all(), name
            if samples == 1:
                assert (coverage == (ids == number)).all(), name
        assert np.abs(sum(mattes.values()) - alpha).max() < 1e-5, layer


def check_single(render):
    for samples in [1, 6, 40]:
        layers = render(f"single{samples}", "--aa", str(samples), "--bounces", "2")
        assert len(layers.parts) == 1
        depth = layers.planes["Z"]
        assert depth.dtype == np.float32 and depth.shape == SIZE[::-1] and np.isinf(depth).any()
        check_light_groups(layers, 2)
        seen = sum(layers.ranks("CryptoObject"))
        assert ((seen > 0) == np.isfinite(depth)).all()
        check_mattes(layers, samples, seen)


def check_alpha(render):
    for samples in [1, 6]:
        layers = render(f"alpha{samples}", "--aa", str(samples), "--background", "transparent")
        alpha = layers.planes["A"].astype(np.float64)
        assert alpha.min() == 0.0 and alpha.max() == 1.0
        assert (layers.vector("")[alpha == 0.0] == 0.0).all()
        check_light_groups(layers, 2)
        check_mattes(layers, samples, alpha)


def check_shadow_catcher(render):
    layers = render("ground", "--aa", "6", "--background", "transparent", "--ground")
    check_light_groups(layers, 2)
    mattes = layers.mattes("CryptoObject")
    assert list(mattes) == [*OBJECTS, "ground"]
    assert np.abs(sum(mattes.values()) - layers.planes["A"]).max() < 1e-5


def check_halves(render):
    layers = render("half", "--aa", "6", "--exr-type", "half")
    exact = ("Z", "P.", "M", "Crypto")
    for name, plane in layers.planes.items():
        expected = np.uint32 if name.startswith("id.") else np.float32 if name.startswith(exact) else np.float16
        assert plane.dtype == expected, (name, plane.dtype)
    check_mattes(layers, 6, sum(layers.ranks("CryptoObject")))


def check_crop(render, whole):
    layers = render("crop", "--aa", "6", "--bounces", "2", "--crop", "5,7,20,11")
    header = layers.parts[0].header
    data, display = [[tuple(int(value) for value in corner) for corner in header[name]] for name in ["dataWindow", "displayWindow"]]
    assert (data, display) == ([(5, 7), (24, 17)], [(0, 0), (SIZE[0] - 1, SIZE[1] - 1)]), (data, display)
    for name, plane in layers.planes.items():
        assert (plane.view(np.uint32) == np.ascontiguousarray(whole.planes[name][7:18, 5:25]).view(np.uint32)).all(), name


def check_overscan(render, whole):
    layers = render("overscan", "--aa", "6", "--bounces", "2", "--crop", f"-3,-2,{SIZE[0] + 8},{SIZE[1] + 4}")
    header = layers.parts[0].header
    data, display = [[tuple(int(value) for value in corner) for corner in header[name]] for name in ["dataWindow", "displayWindow"]]
    assert (data, display) == ([(-3, -2), (SIZE[0] + 4, SIZE[1] + 1)], [(0, 0), (SIZE[0] - 1, SIZE[1] - 1)]), (data, display)
    for name, plane in layers.planes.items():
        own = np.ascontiguousarray(plane[2 : 2 + SIZE[1], 3 : 3 + SIZE[0]])
        assert (own.view(np.uint32) == np.ascontiguousarray(whole.planes[name]).view(np.uint32)).all(), name


def check_parts(render, single):
    parts = render("multi", "--aa", "6", "--bounces", "2", "--exr-parts", "multi")
    assert [part.name() for part in parts.parts] == PARTS, [part.name() for part in parts.parts]
    assert parts.planes.keys() == single.planes.keys()
    for name, plane in parts.planes.items():
        assert plane.tobytes() == single.planes[name].tobytes(), name
    for part in parts.parts:
        described = [name for name in part.header if name.startswith("cryptomatte/")]
        assert len(described) == (4 if part.name().startswith("Crypto") else 0), part.name()
    check_mattes(parts, 6, sum(parts.ranks("CryptoObject")))


def check_attributes(layers):
    header = layers.header
    assert header["software"].startswith("Lightmesh ") and header["lightmesh:scene"] == "scene"
    assert json.loads(header["comments"])["aa"] == 6
    assert np.array(header["worldToCamera"]).shape == (4, 4) and "chromaticities" in header


def main():
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(SCENE)

        def render(name, *flags):
            command = [program, "render", "scene.toml", "-o", "a.png", "--layers", f"{name}.exr", "--device", "cpu", "--quiet"]
            command += ["--size", f"{SIZE[0]}x{SIZE[1]}", "--quality", "draft", *flags]
            subprocess.run(command, cwd=folder, check=True)
            return Layers(folder / f"{name}.exr")

        check_single(render)
        check_alpha(render)
        check_shadow_catcher(render)
        check_halves(render)
        single = Layers(folder / "single6.exr")
        check_crop(render, single)
        check_overscan(render, single)
        check_parts(render, single)
        check_attributes(single)
        render("again", "--aa", "6", "--bounces", "2")
        assert (folder / "again.exr").read_bytes() == (folder / "single6.exr").read_bytes(), "the same file twice"
    print("OpenEXR reads what was written")


main()
