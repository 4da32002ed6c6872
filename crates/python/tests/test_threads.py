"""How many threads are started where nobody says so in the program: as many as OpenMP's, which Ray and other schedulers set to the share of a job."""

import os
import subprocess
import sys

import pytest

PROGRAM = "import lightmesh; print(lightmesh.Renderer('cpu'{threads}).threads)"
#: What is the same as nothing.
EVERY = os.cpu_count() or 1


@pytest.mark.parametrize(
    ("omp", "rayon", "argument", "threads"),
    [
        ("1", None, None, 1),
        ("3", None, None, 3),
        ("2,1", None, None, 2),
        (" 3 ", None, None, 3),
        (None, None, None, EVERY),
        ("0", None, None, EVERY),
        ("many", None, None, EVERY),
        ("1", "3", None, 3),
        ("3", "0", None, 3),
        ("1", None, 2, 2),
        ("1", "1", 3, 3),
    ],
)
def test_threads(omp, rayon, argument, threads):
    given = {name: value for name, value in (("OMP_NUM_THREADS", omp), ("RAYON_NUM_THREADS", rayon)) if value is not None}
    inherited = {name: value for name, value in os.environ.items() if name not in ("OMP_NUM_THREADS", "RAYON_NUM_THREADS")}
    program = PROGRAM.format(threads="" if argument is None else f", threads={argument}")
    done = subprocess.run([sys.executable, "-c", program], env={**inherited, **given}, capture_output=True, text=True, timeout=60, check=True)
    assert int(done.stdout) == threads


def test_a_forked_process_keeps_to_it():
    program = (
        "import multiprocessing as m, os, lightmesh\n"
        "def count(queue): queue.put(lightmesh.Renderer('cpu').threads)\n"
        "lightmesh.Scene.builtin('gazebo')\n"
        "queue = m.get_context('fork').Queue()\n"
        "process = m.get_context('fork').Process(target=count, args=(queue,)); process.start(); print(queue.get(timeout=30)); process.join()\n"
    )
    done = subprocess.run([sys.executable, "-c", program], env={**os.environ, "OMP_NUM_THREADS": "3"}, capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "3", done.stderr
