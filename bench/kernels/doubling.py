"""What kernels without tests of cut-outs gain on opaque scenes: the times of two builds of the program, stage by stage.

    python bench/kernels/doubling.py measure PROGRAM SCENE… -o FOLDER          once for each build, in turns on one machine
    python bench/kernels/doubling.py compare WITHOUT FOLDER… WITH FOLDER… -o FILE.json

`measure` runs the suites stages, shadows, antialiasing and light. `compare` takes the folders of the builds without and with the tests, after the
words `without` and `with`; it prints a table and saves the medians of all rows. See README.md.
"""

import argparse
import json
import math
import statistics
import subprocess
import sys
from pathlib import Path

SUITES = {"stages": 28, "shadows": 38, "antialiasing": 14, "light": 14}
"""Seconds for each."""

KERNELS = [
    ("primary rays", lambda s, st, k: st == "primary_rays" and s in ("stages", "shadows") and k["accel"] == "bvh"),
    ("samples of pixels", lambda s, st, k: st == "pixel_samples" and s == "antialiasing" and k["aa"] > 1),
    ("occluder lists", lambda s, st, k: st == "occluder_lists" and s == "shadows"),
    ("short tests by cell", lambda s, st, k: st == "short_tests" and s == "stages" and k["short_tests"] == "cells" and k["accel"] == "bvh"),
    ("short tests, plain", lambda s, st, k: st == "short_tests" and s == "stages" and k["short_tests"] == "plain" and k["accel"] == "bvh"),
    ("long tests", lambda s, st, k: st == "long_tests" and s == "stages" and k["mode"] == "light-mesh" and k["accel"] == "bvh"),
    ("long tests of whole frames", lambda s, st, k: st == "long_tests" and s == "shadows" and k.get("method") == "half-ball"),
    ("hard shadow rays", lambda s, st, k: st == "shadow_rays" and s == "stages" and k["accel"] == "bvh"),
    ("rays to samples", lambda s, st, k: st == "shadow_rays" and s == "shadows"),
    ("adaptive rays", lambda s, st, k: st == "adaptive_shadows" and s == "shadows"),
    ("samples in rows", lambda s, st, k: st == "area_shadows" and s == "shadows"),
    ("interpolation", lambda s, st, k: st == "interpolate" and k["accel"] == "bvh"),
    ("gathered light", lambda s, st, k: st == "gather"),
    ("no difference: grids", lambda s, st, k: s == "stages" and st in ("primary_rays", "short_tests", "long_tests", "shadow_rays") and k["accel"] == "grid"),
    ("no difference: shading", lambda s, st, k: st == "shade" and s == "shadows"),
]
"""Kernels, and which stages of which suites run them."""

LEAST = 50e-6
"""Shorter stages are left out: the clock of a device has steps of half a microsecond."""


def measure(program, scenes, folder):
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [word for scene in scenes for word in ("--scene", scene)]
    for suite, seconds in SUITES.items():
        size = ["--size", "1024"] if suite == "shadows" else []
        command = [program, "bench", suite, *chosen, *size, "--device", "cuda", "--repeat", "9", "--budget", f"{seconds}s", "-q"]
        subprocess.run([*command, "--json", str(folder / f"{suite}.json")], check=True, stdout=subprocess.DEVNULL)


def medians(folders):
    """By suite, row and stage: keys, and the median of each folder."""
    found = {}
    for folder in folders:
        for suite in SUITES:
            for row in json.loads((Path(folder) / f"{suite}.json").read_text())["rows"]:
                if row["keys"].get("cost") == "cut-outs":
                    continue
                for stage, seconds in row["seconds"].items():
                    if seconds:
                        _, all_medians = found.setdefault((suite, row["id"], stage), (row["keys"], []))
                        all_medians.append(statistics.median(seconds))
    return found


def compare(without, with_tests, output):
    a, b = medians(without), medians(with_tests)
    rows = []
    for (suite, name, stage), (keys, before) in a.items():
        after = b.get((suite, name, stage), (None, []))[1]
        kernel = next((kernel for kernel, takes in KERNELS if takes(suite, stage, keys)), None)
        # The last turn: in the first one, the driver compiles.
        if kernel and len(before) == len(without) and len(after) == len(with_tests) and before[-1] >= LEAST:
            before, after = ([float(f"{seconds:.5g}") for seconds in times] for times in (before, after))
            rows.append({"kernel": kernel, "row": name, "stage": stage, "without": before, "with": after})
    print("| kernels | rows | ms without | with / without | least | most | turns differ |\n|---|--:|--:|--:|--:|--:|--:|")
    for kernel, _ in KERNELS:
        own = [row for row in rows if row["kernel"] == kernel]
        ratios = [row["with"][-1] / row["without"][-1] for row in own]
        spread = [abs(times[0] / times[-1] - 1) for row in own for times in (row["without"], row["with"])]
        mean = math.exp(statistics.mean(map(math.log, ratios)))
        milliseconds = 1e3 * statistics.mean(row["without"][-1] for row in own)
        print(f"| {kernel} | {len(own)} | {milliseconds:.2f} | {mean:.3f} | {min(ratios):.3f} | {max(ratios):.3f} | {statistics.median(spread):.3f} |")
    if output:
        lines = ",\n".join(json.dumps(row) for row in rows)
        Path(output).write_text(f"[\n{lines}\n]\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["measure", "compare"])
    parser.add_argument("words", nargs="+")
    parser.add_argument("-o", "--output")
    given = parser.parse_args()
    if given.task == "measure":
        measure(given.words[0], given.words[1:], Path(given.output or "."))
        return
    if given.words[0] != "without" or "with" not in given.words:
        sys.exit("write: compare without FOLDER… with FOLDER…")
    middle = given.words.index("with")
    compare(given.words[1:middle], given.words[middle + 1 :], given.output)


if __name__ == "__main__":
    main()
