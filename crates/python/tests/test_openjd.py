"""Jobs of `lightmesh farm`, as the engine of Open Job Description checks and runs them."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import CUBE, CUBE_TRIANGLES

pytest.importorskip("openjd")

#: The programs beside this Python.
PROGRAMS = Path(sys.executable).parent
#: A film of seven small frames.
FILM = ("--turntable", "7", "--size", "48x32", "--device", "cpu")
#: What one process and a job alike take.
LIMIT = 300


def run(program: str, *arguments: str | Path, cwd: Path) -> str:
    """Runs a program that must succeed; returns what it says."""
    done = subprocess.run([PROGRAMS / program, *arguments], cwd=cwd, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def farm(folder: Path, *flags: str | Path, output: str = "job.yaml") -> str:
    """Writes the job of a film, of which all frames go to the folder `frames`; returns what the program says."""
    (folder / "frames").mkdir(exist_ok=True)
    program = ("--program", PROGRAMS / "lightmesh")
    said = run("lightmesh", "farm", "scene.obj", *FILM, "--frames-to", "frames/f.##.png", *program, "-o", output, *flags, cwd=folder)
    assert "passes validation" in run("openjd", "check", output, cwd=folder)
    return said


def frames(folder: Path) -> dict[str, bytes]:
    """The frames in a folder, by their names."""
    return {path.name: path.read_bytes() for path in sorted(folder.glob("f.*.png"))}


def servers(folder: Path) -> list[str]:
    """Command lines of servers, whose sockets are in folders that sessions make below this one."""
    running = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    return [line for line in running.splitlines() if "serve --socket" in line and str(folder) in line]


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    """A folder with the scene, and the frames of one process."""
    folder = tmp_path_factory.mktemp("whole")
    corners = [f"v {x} {y} {z}" for x, y, z in CUBE]
    triangles = [f"f {a} {b} {c}" for a, b, c in CUBE_TRIANGLES + 1]
    (folder / "scene.obj").write_text("\n".join([*corners, *triangles]))
    run("lightmesh", "render", "scene.obj", *FILM, "-o", "f.##.png", cwd=folder)
    return folder


@pytest.fixture
def folder(whole, tmp_path, monkeypatch) -> Path:
    """A folder with the scene. Sessions have theirs in it, too."""
    (tmp_path / "scene.obj").write_bytes((whole / "scene.obj").read_bytes())
    (tmp_path / "sessions").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "sessions"))
    return tmp_path


def left_over(folder: Path) -> list[Path]:
    """What sessions have left."""
    return [path for path in (folder / "sessions").rglob("*") if not path.is_dir()]


def test_the_frames_of_a_job_are_those_of_one_process(folder, whole):
    farm(folder, "--frames-per-task", "3")
    said = run("openjd", "run", "job.yaml", cwd=folder)
    assert frames(folder / "frames") == frames(whole) and len(frames(whole)) == 7
    assert "Chunks run: 3" in said and "openjd_status: frame 7 of 7" in said
    films = [json.loads((folder / "manifest.json").read_text())["films"]["f.##.png"] for folder in (folder / "frames", whole)]
    assert films[0] == films[1]
    assert not servers(folder) and not left_over(folder)
    # What is finished is kept.
    assert run("openjd", "run", "job.yaml", cwd=folder).count("no frame is missing") == 3


@pytest.mark.parametrize(("chunks", "count"), [("noncontiguous", 2), ("contiguous", 4)])
def test_tasks_without_a_server_and_with_steps(folder, whole, chunks, count):
    farm(folder, "--no-server", "--chunks", chunks, "--frames", "1-7x2", "--frames-per-task", "2", output="job.json")
    said = run("openjd", "run", "job.json", cwd=folder)
    assert "Server" not in said and f"Chunks run: {count}" in said
    assert frames(folder / "frames") == {name: bytes for name, bytes in frames(whole).items() if int(name[2:4]) % 2}


def test_parameters_are_chosen_when_the_job_is_submitted(folder, whole):
    farm(folder)
    said = run("openjd", "run", "job.yaml", "-p", "Frames=6,2", "-p", "Size=32x24", "-p", "Quality=draft", cwd=folder)
    assert list(frames(folder / "frames")) == ["f.02.png", "f.06.png"], said
    smaller = subprocess.run(
        [PROGRAMS / "openjd", "run", "job.yaml", "-p", "Quality=superb"], cwd=folder, capture_output=True, text=True, timeout=LIMIT
    )
    assert smaller.returncode != 0 and "Quality" in smaller.stdout + smaller.stderr


def test_paths_are_those_of_the_machine_that_renders(folder, whole):
    (folder / "jobs").mkdir()
    said = farm(folder, output="jobs/job.yaml")
    assert f" -p Scene={folder / 'scene.obj'} -p OutputFolder={folder / 'frames'}" in said
    rule = {"source_path_format": "POSIX", "source_path": "/studio", "destination_path": str(folder)}
    rules = folder / "rules.json"
    rules.write_text(json.dumps({"version": "pathmapping-1.0", "path_mapping_rules": [rule]}))
    given = ("-p", "Scene=/studio/scene.obj", "-p", "OutputFolder=/studio/frames", "-p", "Frames=3")
    run("openjd", "run", "jobs/job.yaml", *given, "--path-mapping-rules", rules.as_uri(), cwd=folder)
    assert frames(folder / "frames") == {"f.03.png": frames(whole)["f.03.png"]}


def test_a_task_that_fails_says_why(folder):
    farm(folder)
    (folder / "scene.obj").write_text("v 1 2 three")
    done = subprocess.run([PROGRAMS / "openjd", "run", "job.yaml"], cwd=folder, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode != 0
    assert "openjd_fail: " in done.stdout and "scene.obj" in done.stdout, done.stdout
    assert not frames(folder / "frames") and not servers(folder) and not left_over(folder)


def test_a_job_that_is_cancelled_leaves_whole_frames_and_no_server(folder, whole):
    farm(folder)
    large = ("-p", "Quality=final", "-p", "Size=1600x1200")
    running = subprocess.Popen(
        [PROGRAMS / "openjd", "run", "job.yaml", *large], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert running.stdout is not None
    said = ""
    for line in running.stdout:
        said += line
        if "openjd_progress" in line:
            running.send_signal(signal.SIGINT)
            break
    said += running.communicate(timeout=LIMIT)[0]
    assert running.returncode != 0 and "interrupted: " in said, said
    deadline = time.monotonic() + 30
    while servers(folder) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not servers(folder) and not left_over(folder)
