#!/usr/bin/env python3
"""Does glass look as it does to a path tracer?

Two balls and a block of glass, one clear and two that absorb, stand on a chequered floor that shines, under an even sky. There is no other
light, so that a path tracer sees the same as rays that are reflected and bent. Prints how Lightmesh's image differs from Mitsuba's, for
several numbers of bounces.

    cargo build --release
    python3.11 -m venv target/peers
    target/peers/bin/pip install mitsuba numpy flip-evaluator
    target/peers/bin/python bench/glass/glass.py
"""

import argparse
import pathlib
import subprocess
import tempfile

import flip_evaluator
import mitsuba
import numpy as np

SKY = [0.4, 0.5, 0.7]
FLOOR = 0.7
SQUARES = 10
DARK, LIGHT = [70, 80, 100], [235, 235, 225]
IOR = 1.5
ABSORPTION = [2.5, 0.6, 1.8]
BALLS = [([-1.1, 0.61, 0.8], 0.6, False), ([0.2, 0.41, 1.5], 0.4, True)]
BLOCK = ([1.4, 0.61, 0.7], [1.0, 1.2, 1.0])
EYE, TARGET, ANGLE = [0, 1.5, 5], [0, 0.6, 0], 35


def main():
    options = arguments()
    mitsuba.set_variant(options.variant)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        reference = by_mitsuba(folder, options)
        print(f"Mitsuba {mitsuba.__version__}, {options.samples} samples: mean radiance {reference.mean():.4f}")
        print("bounces  mean radiance  mean difference   RMSE  mean FLIP")
        for bounces in options.bounces:
            image = by_lightmesh(folder, options, bounces)
            off = image - reference
            flip = flip_evaluator.evaluate(encoded(reference), encoded(image), "LDR")[1]
            print(
                f"{bounces:7}  {image.mean():13.4f}  {abs(off).mean():15.4f}  {np.sqrt((off**2).mean()):.4f}  {flip:9.4f}"
            )


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lightmesh", default="target/release/lightmesh", help="the program")
    parser.add_argument("--size", type=int, nargs=2, default=[320, 240], help="width and height")
    parser.add_argument("--samples", type=int, default=512, help="Mitsuba's samples of a pixel")
    parser.add_argument("--bounces", type=int, nargs="+", default=[0, 2, 6], help="Lightmesh's bounces")
    parser.add_argument("--variant", default="scalar_rgb", help="Mitsuba's variant")
    return parser.parse_args()


def chequers():
    """An image of two by two squares, as it is encoded."""
    half = np.repeat([DARK, LIGHT], 32, axis=0)
    return np.concatenate([np.tile(half, (32, 1, 1)), np.tile(half[::-1], (32, 1, 1))]).astype(np.uint8)


def linear(texels):
    share = texels / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4).astype(np.float32)


def encoded(image):
    """The image as it is shown."""
    share = np.clip(image, 0.0, 1.0)
    return np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1 / 2.4) - 0.055).astype(np.float32)


def by_lightmesh(folder, options, bounces):
    mitsuba.Bitmap(chequers()).write(str(folder / "chequers.png"))
    ball = '[[sphere]]\ncenter = {}\nradius = {}\nmaterial = "{}"\n'
    lines = [
        # Ambient light makes the floor shine; without a light there would be one.
        f"[ambient]\nintensity = 1\nbackground = {SKY}",
        f"[[camera]]\nposition = {EYE}\ntarget = {TARGET}\nvfov = {ANGLE}",
        '[[light]]\nkind = "point"\nposition = [0, 50, 0]\nintensity = 0',
        f'[[material]]\nname = "floor"\nkd = {FLOOR}\ntexture = "chequers.png"\ntexture_scale = {SQUARES}',
        f'[[material]]\nname = "clear"\nior = {IOR}',
        f'[[material]]\nname = "green"\nior = {IOR}\nabsorption = {ABSORPTION}',
        '[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [20, 20]\nmaterial = "floor"',
        *(ball.format(center, radius, "green" if absorbs else "clear") for center, radius, absorbs in BALLS),
        f'[[box]]\ncenter = {BLOCK[0]}\nsize = {BLOCK[1]}\nmaterial = "green"',
    ]
    scene, image = folder / "glass.toml", folder / "glass.exr"
    scene.write_text("\n".join(lines))
    width, height = options.size
    command = [options.lightmesh, "render", scene, "-o", image, "--size", f"{width}x{height}", "--bounces", str(bounces)]
    command += ["--aa", "64", "--filter", "box", "--exposure", "0", "--ambient-light", "constant"]
    subprocess.run(command, check=True, capture_output=True)
    color = mitsuba.Bitmap(str(image)).convert(mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False)
    return np.array(color)


def by_mitsuba(folder, options):
    place = mitsuba.ScalarTransform4f
    radiance = folder / "chequers.exr"
    mitsuba.Bitmap(FLOOR * linear(chequers())).write(str(radiance))
    # Its image begins in another corner: half a period apart.
    tiled = place().translate([0.5, 0, 0]).scale([SQUARES, SQUARES, 1])
    clear = {"bsdf": {"type": "dielectric", "int_ior": IOR, "ext_ior": 1.0}}
    most = max(ABSORPTION)
    medium = {"type": "homogeneous", "albedo": grey(0), "sigma_t": rgb([one / most for one in ABSORPTION]), "scale": most}
    green = {**clear, "interior": medium}
    width, height = options.size
    scene = {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": 64, "rr_depth": 64},
        "sensor": {
            "type": "perspective",
            "fov": ANGLE,
            "fov_axis": "y",
            "to_world": place().look_at(origin=EYE, target=TARGET, up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": options.samples},
        },
        "sky": {"type": "constant", "radiance": rgb(SKY)},
        "floor": {
            "type": "rectangle",
            "to_world": place().rotate([1, 0, 0], -90).scale(10),
            "bsdf": {"type": "diffuse", "reflectance": grey(0)},
            "emitter": {
                "type": "area",
                "radiance": {"type": "bitmap", "filename": str(radiance), "raw": True, "to_uv": tiled},
            },
        },
        "block": {
            "type": "cube",
            "to_world": place().translate(BLOCK[0]).scale([0.5 * edge for edge in BLOCK[1]]),
            **green,
        },
    }
    for number, (center, radius, absorbs) in enumerate(BALLS):
        scene[f"ball{number}"] = {"type": "sphere", "center": center, "radius": radius, **(green if absorbs else clear)}
    return np.array(mitsuba.render(mitsuba.load_dict(scene)))[..., :3]


def rgb(color):
    return {"type": "rgb", "value": color}


def grey(value):
    return {"type": "rgb", "value": value}


if __name__ == "__main__":
    main()
