#!/usr/bin/env python3
"""Do shadows and gathered light stay where they are in a film?

Two films of Childpark: a slow dolly, each frame of which is compared with the next one after that has been moved to where its surfaces were
seen before; and a camera that stands still while a ball moves far away. README.md says what is compared, and what makes it fair.

    cargo build --release
    python3 -m venv target/films
    target/films/bin/pip install -r bench/films/requirements.txt
    target/films/bin/python bench/films/dolly.py -o docs/results/film-dolly.json
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

from films import Film, Films
from moved import beside, changed, flicker, moved
from stages import BALLS, ball_scene, dolly_scene

DIRECT = {
    "half-ball": ["--lookup", "half-ball"],
    "lists": ["--lookup", "lists"],
    "area 64": ["--mode", "area", "--samples", "64"],
    "reference": ["--mode", "area", "--samples", "1024"],
}
"""Shadows of the scene's two round lights. Lists have 64 samples, too."""

SKY = {"gathered": ["--ambient-light", "mesh"], "rays": ["--ambient-light", "rays"]}
"""Light of a sky and of other surfaces, with shadows of its sun by lists."""

RADIUS = 2.1
"""Interpolation radius of the half-ball, in steps."""

ROUNDING = 0.002
"""Below this, changes of the reference under a sky are rounding: one of its 1024 samples of the sun."""

DIGITS = 12
"""Digits of numbers: as many as every reader of JSON gets right."""


def main():
    start, started, plan = time.perf_counter(), now(), arguments()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        films = Films(plan, plan.pictures or Path(folder))
        for measure in [measure for part in plan.only for measure in PARTS[part]]:
            for one in measure(plan, films):
                rows.append(one)
                print(one["id"], json.dumps(one["values"]), flush=True)
    kept = []
    if plan.output and plan.output.exists():
        # Parts that are not measured this time stay as they are.
        made = {one["experiment"] for one in rows}
        kept = [one for one in json.loads(plan.output.read_text())["rows"] if one["experiment"] not in made]
    if plan.output:
        notes = [f"{films.reused} films were there and have been used again."] if films.reused else []
        plan.output.write_text(written(results(plan, started, time.perf_counter() - start, kept + rows, notes)))
    failed = [one["id"] for one in rows if one["values"].get("holds") == 0.0]
    if failed:
        sys.exit("does not hold: " + "; ".join(failed))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("-o", "--output", type=Path, help="a JSON file with the rows; those of other parts in it are kept")
    add("--pictures", type=Path, help="a folder for the films and maps of FLIP; films that are there are used again")
    add("--only", nargs="+", default=["dolly", "sky", "ball"], choices=["dolly", "sky", "ball"], help="parts, default: all")
    add("--lightmesh", default="target/release/lightmesh", help="the program, default: %(default)s")
    add("--size", type=int, nargs=2, default=[480, 270], help="width and height, default: 480 270")
    add("--frames", type=int, default=12, help="of the dolly, default %(default)s")
    add("--ball-frames", type=int, default=6, help="with the ball, default %(default)s")
    add("--aa", type=int, nargs="+", default=[1, 8], help="samples of a pixel in the dolly, default: 1 8")
    add("--pairs", type=int, nargs="*", default=[3, 9], help="first frames of pairs that are rendered by rays, default: 3 9")
    add("--crop", type=int, nargs=4, default=[230, 120, 190, 110], help="column, row, width and height of what rays render")
    add("--device", choices=["cpu", "cuda"], default="cpu")
    plan = parser.parse_args()
    plan.threads = os.cpu_count()
    return plan


def dolly(plan, films):
    """Rows of shadows: each technique with one sample of a pixel and with several."""
    scene = films.scene("dolly", dolly_scene(films.park, plan.frames, sky=False))
    geometry = films.render("dolly geometry", scene, ["--mode", "ray-trace", "--aa", "1"], f"1-{plan.frames}")
    pairs = [(number, number + 1) for number in range(1, plan.frames)]
    for aa in plan.aa:
        found = {}
        for name, flags in DIRECT.items():
            film = films.render(f"dolly {name} aa {aa}", scene, [*flags, "--aa", str(aa)], f"1-{plan.frames}")
            found[name] = flickers(films, film, geometry, pairs, aa)
        for name, values in found.items():
            if name in ("half-ball", "lists"):
                values["by_area"] = values["flicker"] / found["area 64"]["flicker"]
                values["holds"] = float(values["flicker"] <= found["area 64"]["flicker"])
            yield row("dolly", {**keys(plan), "technique": name, "aa": aa, "frames": plan.frames}, values)


def sky(plan, films):
    """Rows of gathered light: the whole film, and some pairs beside rays, a part of the image."""
    scene = films.scene("sky", dolly_scene(films.park, plan.frames, sky=True))
    plain = films.scene("dolly", dolly_scene(films.park, plan.frames, sky=False))
    geometry = films.render("dolly geometry", plain, ["--mode", "ray-trace", "--aa", "1"], f"1-{plan.frames}")
    pairs = [(number, number + 1) for number in range(1, plan.frames)]
    gathered = {}
    for aa in plan.aa:
        film = gathered[aa] = films.render(f"sky gathered aa {aa}", scene, [*SKY["gathered"], "--aa", str(aa)], f"1-{plan.frames}")
        values = flickers(films, film, geometry, pairs, aa)
        yield row("sky dolly", {**keys(plan), "technique": "gathered", "aa": aa, "frames": plan.frames}, values)
    if plan.pairs and 1 in gathered:
        some, (column, line, width, height) = [(first, first + 1) for first in plan.pairs], plan.crop
        part, crop = [line, line + height, column, column + width], ",".join(map(str, plan.crop))
        parts = {"gathered": Film("sky gathered part", gathered[1].frames, part, whole=True)}
        for name, flags in {"rays": SKY["rays"], "reference": [*SKY["rays"], "--quality", "final"]}.items():
            film = parts[name] = Film(f"sky {name} part", [], part)
            # The reference takes minutes for a frame: one pair.
            for first, last in some if name == "rays" else some[:1]:
                film.join(films.render(f"sky {name} aa 1 {first}", scene, [*flags, "--aa", "1", "--crop", crop], f"{first}-{last}", part))
        found = {name: flickers(films, film, geometry, some if name != "reference" else some[:1], 1) for name, film in parts.items()}
        for kind, by in {"flicker": "by_rays", "rest_flicker": "rest_by_rays"}.items():
            found["gathered"][by] = found["gathered"][kind] / found["rays"][kind]
        found["gathered"]["holds"] = float(max(found["gathered"]["by_rays"], found["gathered"]["rest_by_rays"]) <= 1.0)
        for name, values in found.items():
            yield row(
                "sky dolly", {**keys(plan), "technique": name, "aa": 1, "frames": 2 * int(values["pairs"]), "crop": place_of(plan.crop)}, values
            )


def flickers(films, film, geometry, pairs, aa):
    """What changes between frames that show the same surfaces."""
    found = []
    for number, (first, last) in enumerate(pairs):
        way = moved(geometry[first], geometry[last], margin=1 if aa == 1 else 2)
        one = flicker(film[first], film[last], way, film.part)
        if number == len(pairs) // 2:
            films.map(film.name, one.pop("map"))
        one.pop("map", None)
        found.append(one)
    values = {name: statistics.fmean(one[name] for one in found) for name in found[0]}
    largest = {name: max(one[of] for one in found) for name, of in LARGEST.items()}
    return {**values, **largest, "pairs": len(pairs)}


LARGEST = {"largest_flicker": "flicker", "rest_largest_codes": "rest_largest_codes"}
"""Of all pairs."""


def ball(plan, films):
    """Rows of a camera that stands still: how many pixels change that the ball does not influence."""
    frames = f"1-{plan.ball_frames}"
    for place in BALLS:
        for lights in ("lamps", "sky"):
            scene = films.scene(f"ball {place} {lights}", ball_scene(films.park, plan.ball_frames, place, sky=lights == "sky"))
            film = lambda name, flags: films.render(f"ball {place} {lights} {name}", scene, flags, frames)  # noqa: B023, E731
            plain = [] if lights == "lamps" else ["--ambient-light", "constant"]
            # Converged, with many samples of a pixel: what it shows to change is influenced.
            truth = film("reference", [*DIRECT["reference"], *plain, "--aa", "8"])
            found = {name: film(name, [*DIRECT[name], *plain]) for name in ("half-ball", "lists", "area 64")}
            if lights == "sky":
                found["gathered"] = film("gathered", SKY["gathered"])
            for name, one in found.items():
                radius = RADIUS * (one[1].step or 0.0)
                values = changed(one, truth, range(2, plan.ball_frames + 1), radius, ROUNDING if lights == "sky" else 0.0)
                if name != "gathered":
                    values["holds"] = float(values["differing_pixels"] == 0)
                films.map(one.name, values.pop("map"))
                yield row("ball", {**keys(plan), "technique": name, "ball": place, "lights": lights, "frames": plan.ball_frames}, values)


def ball_by_rays(plan, films):
    """Rows of how much gathered light changes from the first frame to the last, a part of the image, beside rays."""
    if not plan.pairs:
        return
    scene = films.scene("ball in sight sky", ball_scene(films.park, plan.ball_frames, "in sight", sky=True))
    column, line, width, height = plan.crop
    part, crop = [line, line + height, column, column + width], ",".join(map(str, plan.crop))
    light = {}
    for name, flags in SKY.items():
        film = Film(name, [], part)
        for number in (1, plan.ball_frames):
            of = [*flags, "--aa", "1", "--crop", crop]
            film.join(films.render(f"ball in sight {name} part {number}", scene, of, f"{number}-{number}", part))
        light[name] = film[1], film[plan.ball_frames]
    for name, values in beside(light["gathered"], light["rays"]).items():
        settings = {**keys(plan), "aa": 1, "ball": "in sight", "crop": place_of(plan.crop), "frames": 2}
        yield row("ball by rays", {**settings, "technique": name}, values)


def place_of(crop):
    column, line, width, height = crop
    return f"{width}x{height}+{column}+{line}"


def keys(plan):
    place = {"device": "cuda"} if plan.device == "cuda" else {"device": "cpu", "threads": plan.threads}
    return {"scene": "childpark", "size": plan.size[0], **place}


def row(experiment, keys, values):
    keys = dict(sorted(keys.items()))
    words = " ".join(f"{name}={key}" for name, key in keys.items())
    keys = {name: float(key) if isinstance(key, int) else key for name, key in keys.items()}
    values = {name: float(f"{value:.{DIGITS}g}") for name, value in sorted(values.items())}
    return {"id": f"{experiment}: {words}", "experiment": experiment, "keys": keys, "seconds": {}, "values": values}


def written(results):
    """Results as `lightmesh bench --json` writes them: a line for each member and row."""
    members = []
    for name, value in results.items():
        if isinstance(value, dict):
            lines = ",\n".join(f"    {json.dumps(inner)}: {compact(of)}" for inner, of in value.items())
            members.append(f'  "{name}": {{\n{lines}\n  }}')
        elif isinstance(value, list) and value:
            members.append(f'  "{name}": [\n' + ",\n".join(f"    {compact(one)}" for one in value) + "\n  ]")
        else:
            members.append(f'  "{name}": {compact(value)}')
    return "{\n" + ",\n".join(members) + "\n}\n"


def compact(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(name)}: {compact(of)}" for name, of in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(compact, value)) + "]"
    if isinstance(value, float):
        # Rust writes numbers from 1e-5 on without an exponent, and others as 1.5e-7.
        text = repr(value)
        mantissa, _, exponent = text.partition("e")
        if not exponent:
            return text
        return f"{value:.{len(mantissa.replace('.', '').lstrip('-')) + 4}f}" if int(exponent) == -5 else f"{mantissa}e{int(exponent)}"
    return json.dumps(value, ensure_ascii=False)


def results(plan, started, seconds, rows, notes):
    version = subprocess.run([plan.lightmesh, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()[1]
    command = "python bench/films/dolly.py -o docs/results/film-dolly.json"
    if (plan.size, plan.frames, plan.device) != ([480, 270], 12, "cpu"):
        command = shlex.join(["python", *sys.argv])
    return {
        "version": 1,
        "suite": "films",
        "quick": False,
        "program": {"name": "lightmesh", "version": version, "commit": None, "command": command},
        "machine": {"cpu": processor(), "threads": plan.threads, "memory_bytes": memory(), "os": platform.system().lower(), "gpus": []},
        "started": started,
        "seconds": round(seconds, 3),
        "rows": rows,
        "pictures": [],
        "notes": notes,
    }


def processor():
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.processor())


def memory():
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def now():
    return datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


PARTS = {"dolly": [dolly], "sky": [sky], "ball": [ball, ball_by_rays]}
"""What `--only` names."""


if __name__ == "__main__":
    main()
