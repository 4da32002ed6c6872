#!/usr/bin/env python3
"""How much faster are several GPUs than one, with the same bytes?

    target/python/bin/python bench/gpus/gpus.py

Renders each picture on one GPU, on two, and so on up to all, in turns, warm, and prints a row for each: the seconds of rendering (the median), and how
many times as fast that is as one GPU. A row for a film says the same of its frames. Exit code 1 if a picture has other bytes than that of one GPU.
Needs a Python that has the wheel installed.
"""

import argparse
import statistics
import sys
import time

import lightmesh
import numpy


def seconds_of(renderer, scene, settings):
    """Seconds of rendering one picture, and its colours."""
    frame = renderer.render(scene, **settings)
    return frame.stats["seconds"]["render"], frame.rgb


def film(renderer, scene, settings, count):
    """Seconds between the first and the last frame of a film, and the colours of the last one."""
    start, colors = None, None
    for frame in renderer.film(scene, turntable=count, **settings):
        start = start or time.perf_counter()
        colors = frame.rgb
    return time.perf_counter() - start, colors


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=4096)
    parser.add_argument("--quality", default="final")
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--frames", type=int, default=64, help="frames of the film; 0: none")
    parser.add_argument("--film-size", type=int, default=1024)
    parser.add_argument("--devices", help="device strings to compare, separated by blanks; the first is what others are compared with")
    parser.add_argument("scenes", nargs="*", default=["builtin:garden", "builtin:childpark"])
    arguments = parser.parse_args()
    count = sum(device["device"].startswith("cuda:") and device["usable"] for device in lightmesh.devices())
    devices = arguments.devices.split() if arguments.devices else [",".join(["cuda:0", *map(str, range(1, n))]) for n in range(1, count + 1)]
    start = time.perf_counter()
    renderers = {}
    for device in devices:
        renderers[device] = lightmesh.Renderer(device)
        print(f"{device}: ready after {time.perf_counter() - start:.2f} s", file=sys.stderr)
    differ = False
    print("| scene | devices | s | times |\n|---|---|--:|--:|")
    for name in arguments.scenes:
        scene = lightmesh.Scene.open(name)
        work = {name: lambda renderer: seconds_of(renderer, scene, {"size": (arguments.size,) * 2, "quality": arguments.quality})}
        if arguments.frames:
            size = (arguments.film_size,) * 2
            work[f"{name}, {arguments.frames} frames"] = lambda renderer: film(renderer, scene, {"size": size, "quality": arguments.quality}, arguments.frames)
        for what, run in work.items():
            turns = arguments.turns if what == name else 1
            pictures = {device: run(renderer)[1] for device, renderer in renderers.items()}
            differ |= any(not numpy.array_equal(pictures[devices[0]], picture) for picture in pictures.values())
            times = {device: [] for device in devices}
            for _ in range(turns):
                for device, renderer in renderers.items():
                    times[device].append(run(renderer)[0])
            medians = {device: statistics.median(seconds) for device, seconds in times.items()}
            for device in devices:
                print(f"| {what} | {device} | {medians[device]:.4f} | {medians[devices[0]] / medians[device]:.2f} |", flush=True)
    if differ:
        print("pictures differ", file=sys.stderr)
    return int(differ)


if __name__ == "__main__":
    sys.exit(main())
