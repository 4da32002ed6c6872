"""Lightmesh in this process: the C interface of `crates/lightmesh/examples/c_interface.rs`, through ctypes."""

import ctypes
from ctypes import POINTER, c_bool, c_char_p, c_double, c_uint32, c_uint64, c_void_p

import numpy as np


class Request(ctypes.Structure):
    _fields_ = [
        ("method", c_char_p),
        ("side", c_uint32),
        ("samples", c_uint32),
        ("seed", c_uint64),
        ("color", c_void_p),
        ("visibility", c_void_p),
    ]


class Report(ctypes.Structure):
    _fields_ = [
        ("seconds", c_double),
        ("primary_seconds", c_double),
        ("shadow_seconds", c_double),
        ("rays", c_uint64),
        ("hits", c_uint64),
        ("shadow_rays", c_uint64),
    ]


class Opened:
    """A scene that is prepared, and on a GPU uploaded, once."""

    def __init__(self, plan, scene, threads):
        library = ctypes.CDLL(str(plan.library.resolve()))
        library.lightmesh_open.restype = c_void_p
        library.lightmesh_open.argtypes = [c_char_p, c_char_p, c_uint32]
        library.lightmesh_render.restype = c_bool
        library.lightmesh_render.argtypes = [c_void_p, POINTER(Request), POINTER(Report)]
        self.render_with, self.lights = library.lightmesh_render, len(scene.lights)
        self.opened = library.lightmesh_open(str(scene.file).encode(), plan.device.encode(), threads)
        if not self.opened:
            raise RuntimeError(f"{scene.file} was not opened")

    def render(self, method, size, samples=1, seed=0, with_visibility=False):
        """What an image took, its linear colours, row 0 at the top, and the visibility of each light, which is zero unless asked for."""
        color, report = np.empty((size, size, 3), np.float32), Report()
        visibility = np.zeros((self.lights, size, size), np.float32)
        wanted = visibility.ctypes.data if with_visibility else None
        request = Request(method.encode(), size, samples, seed, color.ctypes.data, wanted)
        if not self.render_with(self.opened, request, report):
            raise RuntimeError(f"no image by {method}")
        return report, color, visibility
