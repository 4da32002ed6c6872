#!/usr/bin/env python3
"""Shows that the tests notice errors: breaks the program in many places, one after the other, and runs tests until one fails.

    python3 fuzz/mutants/mutants.py             # all of mutants.toml, with the tests that `cargo test` runs by default
    python3 fuzz/mutants/mutants.py --check     # only whether every entry still fits the sources
    python3 fuzz/mutants/mutants.py --only grid-walk-cpu,scan-second-block

A copy of the tree gets all errors at once, each behind a switch: `LIGHTMESH_MUTANT=7` turns on the seventh alone. So there is one build. CUDA
kernels are broken as the emulator compiles them; no GPU is used.

An entry of mutants.toml has
    id, place, broken   a name, the part of the program, and what is wrong there;
    file, find          a stretch of the source that occurs in it exactly once;
    part, replace       what is replaced, which occurs in that stretch once (without `part` all of it), and by what: an expression;
    kind = "statement"  if both are statements instead; an empty one leaves the step out;
    tests               where to look first: "FOLDER/TARGET FILTER", where FOLDER is one of `crates`, and TARGET `lib`, `bin`, or a test.

An error that the tests named there miss meets all others. A test that fails is run once more without any error, and must pass. Results are
written to the table in README.md, and kept in the folder of the build, so that a run that was stopped goes on.
Exit code: 0 if tests notice every error, 1 if they miss one, 2 if the list does not fit the tree, or tests fail without any error.
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PACKAGES = ["memory", "files", "scene-tests", "image", "layout", "render-tests", "emulator", "lightmesh", "request", "cli"]
"""Packages whose tests are run, if not told otherwise: those that make images."""
VARIABLE = "LIGHTMESH_MUTANT"
FAILED = re.compile(r"^test (.+?)(?: - should panic)? \.\.\. FAILED")
PASSED = re.compile(r"^test result: .*? (\d+) passed")
MARKERS = ("<!-- mutants -->", "<!-- /mutants -->")

RUST = """
#[allow(dead_code, missing_docs)]
fn lightmesh_mutant(number: u32) -> bool {
    static CHOSEN: std::sync::LazyLock<u32> =
        std::sync::LazyLock::new(|| std::env::var("%s").ok().and_then(|it| it.parse().ok()).unwrap_or(0));
    *CHOSEN == number
}
""" % VARIABLE
CUDA = """#ifndef lightmesh_mutant
extern "C" const unsigned lightmesh_mutant_chosen;
#define lightmesh_mutant(number) (lightmesh_mutant_chosen == (number))
#endif
"""
SHIM = """
#include <cstdlib>
extern "C" {
extern const unsigned lightmesh_mutant_chosen;
const unsigned lightmesh_mutant_chosen = std::getenv("%s") != nullptr ? (unsigned)std::atoi(std::getenv("%s")) : 0u;
}
""" % (VARIABLE, VARIABLE)
SHIM_FILE = "crates/emulator/shim/failures.cpp"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", type=Path, default=HERE / "mutants.toml")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/mutants", help="of the copy and the results")
    parser.add_argument("--target-dir", type=Path, help="of the build; in the folder by default")
    parser.add_argument("--packages", default=",".join(PACKAGES), help="those whose tests are run, without `lightmesh-`")
    parser.add_argument("--only", help="these errors alone, separated by commas")
    parser.add_argument("--jobs", type=int, default=2, help="errors at once")
    parser.add_argument("--check", action="store_true", help="only compare the list with the sources")
    parser.add_argument("--build", action="store_true", help="only build")
    parser.add_argument("--hints", action="store_true", help="only the tests that entries name")
    parser.add_argument("--full", action="store_true", help="what is missed meets the full extent of tests, too (LIGHTMESH_TESTS=all)")
    parser.add_argument("--patience", type=float, default=1200, help="seconds after which a test program hangs")
    parser.add_argument("--fresh", action="store_true", help="forget results of earlier runs")
    plan = parser.parse_args()
    mutants = read_list(plan.list)
    problems = [problem for mutant in mutants for problem in mutant.problems()]
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 2
    print(f"{len(mutants)} errors in {len({mutant.file for mutant in mutants})} files", flush=True)
    if plan.check:
        return 0
    folder, tree = plan.folder.resolve(), plan.folder.resolve() / "tree"
    write_tree(tree, mutants)
    binaries = build(tree, (plan.target_dir or folder / "build").resolve(), plan.packages.split(","))
    if plan.build:
        return 0
    return Trials(folder / "results.json", mutants, binaries, plan).run()


# ---- The list and the tree ----


class Mutant:
    def __init__(self, number, entry):
        self.number, self.id, self.place, self.broken = number, entry["id"], entry["place"], entry["broken"]
        self.file, self.find, self.replace = entry["file"], entry["find"], entry["replace"]
        self.part = entry.get("part", self.find)
        self.is_statement = entry.get("kind") == "statement"
        self.tests = [tuple((hint + " ").split(" ", 1)) for hint in entry.get("tests", [])]
        self.tests = [(binary, rest.strip()) for binary, rest in self.tests]

    def text(self):
        """The file without errors."""
        return (ROOT / self.file).read_text(encoding="utf-8")

    def problems(self):
        """Why it does not fit the sources."""
        if not (ROOT / self.file).is_file():
            yield f"{self.id}: there is no {self.file}; adapt mutants.toml"
            return
        for what, where, text in [("find", self.file, self.text()), ("part", "`find`", self.find)]:
            wanted = self.find if what == "find" else self.part
            if (count := text.count(wanted)) != 1:
                yield f"{self.id}: `{what}` occurs {count} times in {where}, not once; adapt mutants.toml: {wanted.strip()!r}"

    def switched(self):
        """The stretch of the source with the error behind its switch."""
        chosen = f"lightmesh_mutant({self.number})"
        if self.file.endswith(".rs"):
            switch = f"if {chosen} {{ {self.replace} }} else {{ {self.part} }}"
            switch = switch if self.is_statement else f"({switch})"
        elif self.is_statement:
            switch = f"if ({chosen}) {{ {self.replace} }} else {{ {self.part} }}"
        else:
            switch = f"({chosen} ? ({self.replace}) : ({self.part}))"
        return self.find.replace(self.part, switch)

    def package(self):
        """Whose tests are most likely to notice it: kernels are run by the emulator's."""
        return "emulator" if self.file.endswith((".cu", ".cuh")) else Path(self.file).parts[1]


def read_list(path):
    entries = tomllib.loads(path.read_text(encoding="utf-8"))["mutant"]
    mutants = [Mutant(number, entry) for number, entry in enumerate(entries, start=1)]
    names = [mutant.id for mutant in mutants]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        sys.exit(f"{path}: these names occur twice: {', '.join(twice)}")
    return mutants


def write_tree(tree, mutants):
    """Copies the files of the repository to `tree`, with all errors behind switches. Files that stay the same are not touched."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True)
    names = {name for name in listed.stdout.decode().split("\0") if name and (ROOT / name).is_file()}
    texts = {}
    for mutant in mutants:
        texts.setdefault(mutant.file, mutant.text())
        if texts[mutant.file].count(mutant.find) != 1:
            sys.exit(f"{mutant.id}: it overlaps with another error in {mutant.file}; change `find` in mutants.toml")
        texts[mutant.file] = texts[mutant.file].replace(mutant.find, mutant.switched())
    for name, text in texts.items():
        texts[name] = text + RUST if name.endswith(".rs") else CUDA + text
    texts[SHIM_FILE] = (ROOT / SHIM_FILE).read_text(encoding="utf-8") + SHIM
    for name in sorted(names):
        new = texts[name].encode() if name in texts else (ROOT / name).read_bytes()
        path = tree / name
        if not path.is_file() or path.read_bytes() != new:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(new)
            shutil.copymode(ROOT / name, path)
    for path in [path for path in tree.rglob("*") if path.is_file() and path.relative_to(tree).as_posix() not in names]:
        path.unlink()
    # Tests find shared scenes beside the tree.
    shared, beside = ROOT.parent / "shared", tree.parent / "shared"
    if shared.is_dir() and not beside.exists():
        beside.symlink_to(shared.resolve(), target_is_directory=True)


def build(tree, target, packages):
    """Builds all tests. Returns programs by FOLDER/TARGET, with the folder in which each runs."""
    names = [word for package in packages for word in ("-p", package if package == "lightmesh" else f"lightmesh-{package}")]
    command = ["cargo", "test", "--no-run", "--lib", "--bins", "--tests", "--message-format=json", *names]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(target), "CARGO_INCREMENTAL": "0"}
    begin, binaries = time.monotonic(), {}
    process = subprocess.Popen(command, cwd=tree, env=environment, stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        artifact = json.loads(line)
        # Of diagnostics only errors: switches have parentheses that are not needed everywhere.
        if artifact["reason"] == "compiler-message" and artifact["message"]["level"] == "error":
            print(artifact["message"]["rendered"], file=sys.stderr)
        if artifact["reason"] == "compiler-artifact" and artifact["profile"]["test"] and artifact["executable"]:
            folder = Path(artifact["manifest_path"]).parent
            kinds, name = artifact["target"]["kind"], artifact["target"]["name"]
            name = name if "test" in kinds else "bin" if "bin" in kinds else "lib"
            # Tests that are a package of their own are in the folder of what they test.
            package = folder.parent.name if folder.name == "tests" else folder.name
            binaries[f"{package}/{name}"] = (artifact["executable"], folder)
    if process.wait() != 0:
        sys.exit("the tree with all errors, none of which is turned on, does not compile")
    print(f"built {len(binaries)} test programs in {time.monotonic() - begin:.0f} s", flush=True)
    return binaries


# ---- Trials ----


class Outcome:
    """What tests say: which one failed, if any; how many passed."""

    def __init__(self, failed, is_named, passed):
        self.failed, self.is_named, self.passed = failed, is_named, passed


class Trials:
    def __init__(self, path, mutants, binaries, plan):
        self.path, self.mutants, self.binaries, self.plan = path, mutants, binaries, plan
        self.lock, self.known, self.locks, self.problems, self.ignored = threading.Lock(), {}, {}, set(), set()
        self.results = {} if plan.fresh or not path.is_file() else json.loads(path.read_text(encoding="utf-8"))

    def run(self):
        chosen = self.plan.only.split(",") if self.plan.only else None
        if chosen and (unknown := set(chosen) - {mutant.id for mutant in self.mutants}):
            sys.exit(f"there is no error of the name {', '.join(sorted(unknown))}")
        asked = [mutant for mutant in self.mutants if (mutant.id in chosen if chosen else mutant.id not in self.results)]
        with ThreadPoolExecutor(self.plan.jobs) as pool:
            list(pool.map(self.try_mutant, asked))
        write_table(self.mutants, self.results)
        missed = [mutant.id for mutant in self.mutants if self.results.get(mutant.id, {}).get("test") == ""]
        found = sum(1 for mutant in self.mutants if self.results.get(mutant.id, {}).get("test"))
        print(f"tests notice {found} of {len(self.mutants)} errors" + (f"; they miss {', '.join(missed)}" if missed else ""))
        return 1 if missed else 2 if self.problems else 0

    def try_mutant(self, mutant):
        begin = time.monotonic()
        others = [] if self.plan.hints else [(binary, "") for binary in self.in_order(mutant)]
        test = self.first_failure(mutant, mutant.tests + [other for other in others if other not in mutant.tests])
        result = {"test": test, "seconds": round(time.monotonic() - begin, 1)}
        if not test and self.plan.full:
            result["full"] = self.first_failure(mutant, [(binary, "") for binary in self.in_order(mutant)], full=True)
        with self.lock:
            self.results[mutant.id] = result
            self.path.write_text(json.dumps(self.results, indent=1), encoding="utf-8")
            full = f"; of the full extent: {result['full'] or 'missed'}" if "full" in result else ""
            print(f"{mutant.id}: {test or 'MISSED'} ({result['seconds']} s){full}", flush=True)

    def in_order(self, mutant):
        """All programs, those of the package with the error first."""
        return sorted(self.binaries, key=lambda binary: (not binary.startswith(mutant.package() + "/"), binary))

    def first_failure(self, mutant, commands, full=False):
        """The first test that fails with an error, and does not without it; empty if all pass."""
        for binary, filter_ in commands:
            if binary not in self.binaries:
                self.note(f"there is no {binary}: adapt `tests` in mutants.toml, or `--packages`")
                continue
            while (outcome := self.run_tests(mutant.number, binary, filter_.split(), full)).failed:
                if self.passes(binary, [outcome.failed, "--exact"] if outcome.is_named else filter_.split(), full):
                    return f"{binary} {outcome.failed}"
                self.note(f"{binary}: {outcome.failed} fails without any error, too")
                self.ignored.add((binary, outcome.failed))
                if not outcome.is_named:
                    break
            if filter_ and not outcome.failed and not outcome.passed:
                self.note(f"{binary} has no test of the name {filter_}: adapt `tests` in mutants.toml")
        return ""

    def note(self, problem):
        with self.lock:
            if problem not in self.problems:
                print(problem, file=sys.stderr, flush=True)
            self.problems.add(problem)

    def passes(self, binary, words, full):
        """Whether tests pass without any error. Each is asked once."""
        key = (binary, *words, full)
        with self.lock:
            lock = self.locks.setdefault(key, threading.Lock())
        with lock:
            if key not in self.known:
                outcome = self.run_tests(0, binary, words, full)
                self.known[key] = not outcome.failed and outcome.passed > 0
            return self.known[key]

    def run_tests(self, number, binary, words, full):
        """Runs tests until one fails."""
        program, folder = self.binaries[binary]
        environment = {**os.environ, VARIABLE: str(number), "CUDA_VISIBLE_DEVICES": "", "CARGO_MANIFEST_DIR": str(folder)}
        environment.pop("LIGHTMESH_TESTS", None)
        if full:
            environment["LIGHTMESH_TESTS"] = "all"
        failed, passed, has_ignored = "", 0, False
        process = subprocess.Popen([program, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace", process_group=0)
        hangs = threading.Event()
        watch = threading.Timer(self.plan.patience, lambda: hangs.set() or stop(process))
        watch.start()
        for line in process.stdout:
            if found := FAILED.match(line):
                name = found.group(1).strip()
                if (binary, name) in self.ignored and "--exact" not in words:
                    has_ignored = True
                    continue
                failed = name
                break
            if found := PASSED.match(line):
                passed += int(found.group(1))
        if failed:
            stop(process)
        code = process.wait()
        watch.cancel()
        is_named = bool(failed)
        if not failed and hangs.is_set():
            failed = "(it hangs)"
        elif not failed and code != 0 and not has_ignored:
            failed = f"(it ends with {code})"
        return Outcome(failed, is_named, passed)


def stop(process):
    """Ends a test program and what it has started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


# ---- The table ----


def write_table(mutants, results):
    path = HERE / "README.md"
    text = path.read_text(encoding="utf-8")
    before, rest = text.split(MARKERS[0])
    after = rest.split(MARKERS[1])[1]
    rows = ["| place | what is broken | noticed by | s |", "|---|---|---|---:|"]
    for mutant in mutants:
        result = results.get(mutant.id)
        noticed = "not tried" if result is None else f"`{result['test']}`" if result["test"] else "**missed**"
        seconds = "" if result is None else f"{result['seconds']:.0f}"
        rows.append(f"| {mutant.place} | {mutant.broken} | {noticed} | {seconds} |".replace("||", "\\|\\|"))
    found = sum(1 for mutant in mutants if results.get(mutant.id, {}).get("test"))
    summary = f"Tests notice {found} of {len(mutants)} errors."
    path.write_text(f"{before}{MARKERS[0]}\n{summary}\n\n" + "\n".join(rows) + f"\n{MARKERS[1]}{after}", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
