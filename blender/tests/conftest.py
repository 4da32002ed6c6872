"""Registers the add-on once in the process, limits the time of each test file, and starts each test with an empty scene."""

import faulthandler
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bpy
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import lightmesh_addon  # noqa: E402

#: Seconds that the tests of one file may take; beyond, the process ends with the stacks of all threads.
LIMIT = 600.0


def pytest_configure(config: pytest.Config) -> None:
    # Blender 5 has it for old scripts, Blender 4 needs it.
    config.addinivalue_line("filterwarnings", "ignore:.*use_nodes.*:DeprecationWarning")


@pytest.fixture(scope="session", autouse=True)
def addon() -> Iterator[None]:
    """The add-on, registered. Blender 4.5 hangs at its exit if an engine is left."""
    lightmesh_addon.register()
    yield
    lightmesh_addon.unregister()


@pytest.fixture(scope="module")
def deadline() -> float:
    return time.monotonic() + LIMIT


@pytest.fixture(autouse=True)
def time_limit(deadline: float) -> Iterator[None]:
    # Set for each test, since pytest takes it back where one fails.
    faulthandler.dump_traceback_later(max(deadline - time.monotonic(), 1.0), exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture(autouse=True)
def empty_file(addon: None) -> Iterator[None]:
    """A file without objects, for each test."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    yield
