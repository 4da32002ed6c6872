"""Runs lightmesh and its peers on the same scenes, alternately, and saves the results in the format of `lightmesh bench --json`.

    python bench/peers/peers.py builtin:childpark bunny.ply -o peers.json

See README.md next to this file.
"""

import argparse
import datetime
import json
import os
import platform
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import flip_evaluator
import numpy as np

import agreement
import equal_error
import lightmesh
import native
import rays
import renderers
from results import rounded, row
from scene import Scene

LIBRARY = Path("target/release/libc_interface.so")
REFERENCE_SEED = 1000
"""Different from the seeds of the measured images, which are their rounds."""


def main():
    start, started, plan = time.perf_counter(), now(), arguments()
    rows, notes = [], []
    for source in plan.scenes:
        with tempfile.TemporaryDirectory() as folder:
            scene = Scene.open(plan.lightmesh, source, Path(folder))
            print(f"{scene.name}: {len(scene.triangles)} triangles, {len(scene.lights)} lights", file=sys.stderr)
            if plan.only != "images":
                rows += ray_rows(plan, scene, Path(folder), notes)
            if plan.only != "rays":
                rows += image_rows(plan, scene, Path(folder), notes)
    version = subprocess.run([plan.lightmesh, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()[1]
    results = {
        "version": 1,
        "suite": "peers",
        "quick": False,
        "program": {"name": "lightmesh and peers", "version": version, "commit": None, "command": shlex.join(["python", *sys.argv])},
        "machine": machine(plan),
        "started": started,
        "seconds": rounded(time.perf_counter() - start),
        "rows": rows,
        "pictures": [],
        "notes": list(dict.fromkeys(notes)),
    }
    plan.output.write_text(json.dumps(results, indent=2) + "\n")


def arguments():
    parser = argparse.ArgumentParser(description="Compares lightmesh with other renderers.")
    parser.add_argument("scenes", nargs="+", metavar="SCENE", help="a scene that lightmesh can open")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="output file for the results, as JSON")
    parser.add_argument("--lightmesh", default="target/release/lightmesh", metavar="PROGRAM", help="default: %(default)s")
    parser.add_argument("--library", type=Path, default=LIBRARY, metavar="FILE", help="its C interface, default: %(default)s")
    parser.add_argument("--size", type=int, default=256, help="pixels per side, default %(default)s")
    parser.add_argument("--samples", type=int, nargs="+", default=[1, 4, 16, 64, 256], help="default: 1 4 16 64 256")
    parser.add_argument("--reference", type=int, default=1024, metavar="N", help="samples of the references, default %(default)s")
    parser.add_argument("--repetitions", type=int, default=5, metavar="N", help="counted rounds, default %(default)s")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="for images, default: all")
    parser.add_argument("--only", choices=["rays", "images"], help="rays per second, or soft shadows; default: both")
    parser.add_argument("--ray-size", type=int, metavar="N", help="pixels per side for rays, default: the same")
    parser.add_argument("--ray-threads", type=int, nargs="+", default=[1], metavar="N", help="threads for rays, default: 1")
    parser.add_argument("--embree", type=Path, metavar="LIBRARY", help="libembree4.so, default: that of the wheel embreex")
    parser.add_argument("--embree-config", metavar="CONFIG", help="Embree's own, such as isa=avx2")
    parser.add_argument("--device", choices=["cpu", "cuda"], default="cpu", help="cuda: lightmesh and Mitsuba on a GPU, OptiX for rays")
    parser.add_argument("--without", nargs="+", default=[], choices=["embree", "optix", "mitsuba", "cycles"], help="peers to skip")
    plan = parser.parse_args()
    plan.ray_size = plan.ray_size or plan.size
    return plan


def peer(plan, notes, name, make):
    """The peer as a list, which is empty if it is excluded or its wheel is missing."""
    if name in plan.without:
        notes.append(f"{name} is skipped: excluded by --without.")
        return []
    try:
        made = make()
    except ImportError as error:
        notes.append(f"{name} is skipped: {error}.")
        return []
    notes.append(f"{made.name} is version {made.version}.")
    return [made]


def ray_rows(plan, scene, folder, notes):
    """Million rays per second of each program and kind of rays."""
    if plan.device == "cuda":
        embree, casters = [], [rays.Lightmesh(lightmesh.Opened(plan, scene, 1), plan.ray_size, 1)]
        casters += peer(plan, notes, "optix", lambda: rays.Optix(scene, plan))
    else:
        embree = peer(plan, notes, "embree", lambda: native.Embree(scene, plan, rays.SOFT_SAMPLES, folder))
        casters = []
        for threads in plan.ray_threads:
            own = rays.Lightmesh(lightmesh.Opened(plan, scene, threads), plan.ray_size, threads)
            casters += [own, *(native.Packets(one, width, threads) for one in embree for width in native.WIDTHS)]
        for one in embree:
            agreement.check(scene, own, one, notes)
    tasks = {(kind, caster): (lambda caster=caster, kind=kind: caster.cast(kind)) for kind in rays.KINDS for caster in casters}
    results = in_turn(plan, lambda _, task: task(), tasks)
    rows = [ray_row(plan, scene, kind, caster, runs) for (kind, caster), runs in results.items()]
    for one in embree:
        one.close()
    packets = [row("packets", one["keys"], one["seconds"], one["values"]) for one in rows if "width" in one["keys"]]
    best = fastest(rows)
    add_ratios(best)
    return best + packets


def ray_row(plan, scene, kind, caster, runs):
    keys = {"scene": scene.name, "program": caster.name, "rays": kind, "size": plan.ray_size, **place(plan, caster.threads)}
    seconds = [seconds for _, seconds in runs]
    count, median = runs[0][0], statistics.median(seconds)
    values = {"rays": count, "million_per_second": count / median / 1e6}
    if isinstance(caster, native.Packets):
        keys["width"] = caster.width
        values |= caster.values(kind, count, median)
    return row("rays", keys, {"render": seconds}, values)


def fastest(rows):
    """Of rows that differ in the width of packets, the fastest one."""
    best = {}
    for one in rows:
        keys = {name: key for name, key in one["keys"].items() if name != "width"}
        one = row("rays", keys, one["seconds"], one["values"])
        best[one["id"]] = max(best.get(one["id"], one), one, key=lambda row: row["values"]["million_per_second"])
    return list(best.values())


def add_ratios(rows):
    """Adds lightmesh's rate relative to that of each peer, the median over rounds, and shows it."""
    key = lambda row: (row["keys"]["rays"], row["keys"].get("threads"))
    own = {key(one): one for one in rows if one["keys"]["program"] == rays.Lightmesh.name}
    for one in rows:
        mine, values = own[key(one)], one["values"]
        if one is mine:
            continue
        rounds = zip(one["seconds"]["render"], mine["seconds"]["render"])
        ratio = statistics.median(peer / values["rays"] * mine["values"]["rays"] / seconds for peer, seconds in rounds)
        values["lightmesh_ratio"] = ratio
        rates = [f"{each['keys']['program']} {each['values']['million_per_second']:.3g}" for each in (mine, one)]
        where = f"{one['keys']['scene']}, {one['keys']['rays']} rays, {one['keys'].get('threads', 'all')} threads"
        print(f"  {where}: {' : '.join(rates)} million per second, ratio {ratio:.2f}", file=sys.stderr)


def image_rows(plan, scene, folder, notes):
    """Seconds and errors of each program and number of samples, and seconds at equal error."""
    opened = lightmesh.Opened(plan, scene, plan.threads)
    own = [renderers.Lightmesh(opened, method, plan.size) for method in ("lists", "area", "adaptive", "half-ball")]
    others = peer(plan, notes, "mitsuba", lambda: renderers.Mitsuba(scene, plan))
    others += peer(plan, notes, "cycles", lambda: renderers.Cycles(scene, plan, folder))
    # Each is compared with its own reference; what Lightmesh's methods approximate is the same.
    references, rows = {}, []
    denoised = [renderers.Denoised(one) for one in others if one.denoiser]
    notes += [f"{one.name}'s denoiser is skipped: there is none for this device." for one in others if not one.denoiser]
    for group in [own, *([one] for one in [*others, *denoised])]:
        picture, again = (group[0].reference(plan.reference, seed)[1] for seed in (REFERENCE_SEED, REFERENCE_SEED + 1))
        # The difference between two references indicates their remaining error.
        left = rmse_of(picture, again)
        references |= {renderer: (picture, left) for renderer in group}
    tasks = {(renderer, n): (lambda seed, r=renderer, n=n: r.render(n, seed)) for n in plan.samples for renderer in references}
    for (renderer, samples), runs in in_turn(plan, lambda seed, task: task(seed), tasks).items():
        picture, left = references[renderer]
        keys = {"scene": scene.name, "program": renderer.name, "samples": samples, "size": plan.size, **place(plan, plan.threads)}
        rmse, mean_flip = np.mean([rmse_of(picture, other) for _, other in runs]), flip_of(picture, runs[0][1])
        values = {"rmse": rmse, "mean_flip": mean_flip, "reference_rmse": left}
        rows.append(row("soft shadows", keys, {"render": [seconds for seconds, _ in runs]}, values))
    return rows + equal_error.rows(rows)


def place(plan, threads):
    """The device, as keys of a row."""
    return {"device": "cuda"} if plan.device == "cuda" else {"device": "cpu", "threads": threads}


def in_turn(plan, run, tasks):
    """Results of each task in each round. Round 0 is an uncounted warm-up."""
    results = {key: [] for key in tasks}
    for round_ in range(plan.repetitions + 1):
        for key, task in tasks.items():
            result = run(round_, task)
            if round_ > 0:
                results[key].append(result)
    return results


def rmse_of(reference, picture):
    """RMSE of linear values, clamped to the range of a screen."""
    return float(np.sqrt(np.mean((shown(reference) - shown(picture)) ** 2)))


def flip_of(reference, picture):
    """Mean FLIP. It takes longer than the image."""
    curved = [np.where(image <= 0.0031308, 12.92 * image, 1.055 * image ** (1 / 2.4) - 0.055) for image in map(shown, (reference, picture))]
    return float(flip_evaluator.evaluate(*curved, "LDR", applyMagma=False)[1])


def shown(image):
    return np.clip(image, 0, 1).astype(np.float32)


def machine(plan):
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        cpu = next(line.split(": ", 1)[1] for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        cpu = platform.processor()
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") if hasattr(os, "sysconf") else 0
    return {"cpu": cpu, "threads": os.cpu_count(), "memory_bytes": memory, "os": platform.system().lower(), "gpus": gpus(plan)}


def gpus(plan):
    """The first GPU and its driver, as named by lightmesh, if one is used."""
    if plan.device == "cpu":
        return []
    info = subprocess.run([plan.lightmesh, "info", "--devices", "--json"], check=True, stdout=subprocess.PIPE).stdout
    gpu = next(device for device in json.loads(info)["devices"] if device["device"] == "cuda:0")
    return [{"name": gpu["name"], "memory_bytes": gpu["memory_bytes"], "driver": f"CUDA {gpu['driver_cuda_version']}"}]


def now():
    return datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


if __name__ == "__main__":
    main()
