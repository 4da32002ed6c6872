"""Runs notebooks, each in a kernel and an empty folder of its own. Fails if a cell fails or takes too long, if a picture is empty, or if
there is none at all. Needs matplotlib, nbclient and ipykernel.

    python notebooks/run.py [--limit SECONDS] [--save FOLDER] [NOTEBOOK or PAGE…]

The default is all notebooks of this folder. A page (`.md`) is run as a notebook of its blocks of Python. `--save` keeps what was shown: the
notebooks with their outputs, and all pictures.
"""

import argparse
import base64
import io
import re
import sys
import tempfile
import time
from pathlib import Path

import nbformat
import numpy as np
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from PIL import Image

# Of the pixels of a picture, the share that must differ from its most frequent colour.
LEAST = 0.01

# Run before the first cell and after the last one: axes without data are found where they are drawn, since frame and labels are no empty picture.
BEFORE = """
import functools as _functools
import matplotlib.backends.backend_agg as _agg
_axes_without_data, _print_png = [], _agg.FigureCanvasAgg.print_png
@_functools.wraps(_print_png)
def _checked(canvas, *arguments, **settings):
    _axes_without_data.extend(axes.get_title() or "untitled" for axes in canvas.figure.axes if not axes.has_data())
    return _print_png(canvas, *arguments, **settings)
_agg.FigureCanvasAgg.print_png = _checked
"""
AFTER = "if _axes_without_data: raise ValueError(f'axes without data: {sorted(set(_axes_without_data))}')"


def main() -> int:
    parser = argparse.ArgumentParser(description="Run notebooks, and check that they show pictures.")
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--limit", type=float, default=120, metavar="SECONDS", help="for all cells of a notebook [default: 120]")
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="keep notebooks with outputs, and pictures")
    arguments = parser.parse_args()
    files = arguments.files or sorted(Path(__file__).parent.glob("*.ipynb"))
    failed = 0
    for file in files:
        begin = time.perf_counter()
        notebook = read(file)
        problems = run(notebook, arguments.limit)
        pictures = list(pictures_of(notebook))
        if not problems:
            problems = check(pictures)
        if arguments.save:
            save(notebook, pictures, arguments.save, file.stem)
        seconds = time.perf_counter() - begin
        print(f"{'FAILED' if problems else 'ok'}  {file.name}: {len(pictures)} pictures, {seconds:.1f} s", flush=True)
        for problem in problems:
            print(f"    {problem}", file=sys.stderr)
        failed += bool(problems)
    print(f"{len(files) - failed} passed, {failed} failed")
    return 1 if failed or not files else 0


def read(file: Path) -> nbformat.NotebookNode:
    if file.suffix == ".ipynb":
        notebook = nbformat.read(file, as_version=4)
        nbformat.validate(notebook)
        return notebook
    blocks = re.findall(r"^```python\n(.*?)^```$", file.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(block.rstrip("\n")) for block in blocks])


def run(notebook: nbformat.NotebookNode, limit: float) -> list[str]:
    """Leaves outputs in the notebook, and returns what went wrong."""
    end = time.monotonic() + limit
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(
            notebook,
            kernel_name="python3",
            resources={"metadata": {"path": folder}},
            extra_arguments=["--log-level=ERROR"],
            # At least a second: 0 would be no limit.
            timeout_func=lambda cell: max(1, int(end - time.monotonic())),
        )
        notebook.cells = [nbformat.v4.new_code_cell(BEFORE), *notebook.cells, nbformat.v4.new_code_cell(AFTER)]
        try:
            client.execute()
        except CellTimeoutError:
            return [f"not done after {limit:.0f} s"]
        except (CellExecutionError, DeadKernelError) as error:
            return [re.sub(r"\x1b\[[0-9;]*m", "", str(error)).strip()]
        finally:
            notebook.cells = notebook.cells[1:-1]
    return []


def pictures_of(notebook: nbformat.NotebookNode):
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if "image/png" in output.get("data", {}):
                yield base64.b64decode(output["data"]["image/png"])


def check(pictures: list[bytes]) -> list[str]:
    if not pictures:
        return ["no picture is shown"]
    return [f"picture {number} is empty" for number, picture in enumerate(pictures, 1) if is_empty(picture)]


def is_empty(picture: bytes) -> bool:
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).reshape(-1, 3)
    most = np.unique(pixels, axis=0, return_counts=True)[1].max()
    return len(pixels) - most < LEAST * len(pixels)


def save(notebook: nbformat.NotebookNode, pictures: list[bytes], folder: Path, name: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, folder / f"{name}.ipynb")
    for number, picture in enumerate(pictures, 1):
        (folder / f"{name}-{number}.png").write_bytes(picture)


if __name__ == "__main__":
    sys.exit(main())
