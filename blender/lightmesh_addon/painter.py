"""Draws a picture into a viewport, through Blender's colour management."""

from __future__ import annotations

import bpy
import numpy as np


class Painter:
    """Keeps the picture on the graphics card until another one comes."""

    def __init__(self) -> None:
        self._texture, self._shown = None, None

    def draw(self, engine: bpy.types.RenderEngine, scene: bpy.types.Scene, pixels: np.ndarray, size: tuple[int, int]) -> None:
        """`pixels`: (H, W, 4) `float32`, rows upwards, premultiplied; stretched to `size`."""
        import gpu
        from gpu_extras.presets import draw_texture_2d

        if self._shown is not pixels:
            height, width = pixels.shape[:2]
            data = gpu.types.Buffer("FLOAT", width * height * 4, pixels.reshape(-1))
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=data)
            self._shown = pixels
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (0, 0), *size)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
