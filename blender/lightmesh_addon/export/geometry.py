"""Meshes as arrays. Vertices are split only where corners of faces differ in normal, texture coordinates or colour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    from hashlib import _Hash as Hash

    from ..notes import Notes
    from .materials import Made


@dataclass
class Arrays:
    """What `lightmesh.Geometry.from_arrays` takes of a mesh."""

    vertices: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None
    uvs: np.ndarray | None
    colors: np.ndarray | None
    material_indices: np.ndarray

    def corners(self) -> list[np.ndarray]:
        """The eight corners of the box around the vertices."""
        sides = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return [np.array([sides[x][0], sides[y][1], sides[z][2]], float) for x in (0, 1) for y in (0, 1) for z in (0, 1)]

    def digest_into(self, digest: Hash) -> None:
        """Adds all of it to a `hashlib` digest."""
        for array in (self.vertices, self.triangles, self.normals, self.uvs, self.colors, self.material_indices):
            digest.update(b"-" if array is None else repr(array.shape).encode())
            if array is not None:
                digest.update(np.ascontiguousarray(array))


def read(mesh: bpy.types.Mesh, made: list[Made], notes: Notes) -> Arrays | None:
    """The arrays of a mesh with these materials (`materials.Made`), or `None` without faces."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    vertices = _get(mesh.vertices, "co", (len(mesh.vertices), 3), np.float32)
    corners = _get(mesh.loop_triangles, "loops", (count, 3), np.int32)
    materials = np.minimum(_get(mesh.loop_triangles, "material_index", (count,), np.int32), len(made) - 1)
    vertex_of = _get(mesh.loops, "vertex_index", (len(mesh.loops),), np.int32)

    # 1. What corners have. Normals of vertices need no split, and those of faces are the default.
    of_corner = np.zeros(len(mesh.loops), np.int32)
    of_corner[corners] = materials[:, None]
    domain = mesh.normals_domain
    columns = {}
    if domain == "CORNER":
        columns["normals"] = _get(mesh.corner_normals, "vector", (len(mesh.loops), 3), np.float32)
    layers = {}  # Read once, however many materials have them.
    columns["uvs"] = _chosen(of_corner, [_uvs(mesh, material, layers, notes) for material in made], 0.0)
    columns["colors"] = _chosen(of_corner, [_colors(mesh, material, layers, vertex_of) for material in made], 1.0)
    columns = {name: column for name, column in columns.items() if column is not None}

    # 2. Corners of a vertex that agree in all of it are one.
    normals = _get(mesh.vertex_normals, "vector", vertices.shape, np.float32) if domain == "POINT" else None
    triangles = vertex_of[corners]
    if columns:
        first, number = merged(np.column_stack([vertex_of, *(column.view(np.int32) for column in columns.values())]))
        vertices = vertices[vertex_of[first]]
        normals = normals[vertex_of[first]] if normals is not None else None
        columns = {name: column[first] for name, column in columns.items()}
        triangles = number[corners]
    normals = columns.get("normals", normals)
    return Arrays(vertices, triangles.astype(np.uint32), normals, columns.get("uvs"), columns.get("colors"), materials)


def merged(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The first of each kind of equal rows, and the number of the kind of each row. Rows are compared by a hash, which is checked."""
    rows = np.ascontiguousarray(rows, np.int32)
    hashes = np.zeros(len(rows), np.uint64)
    for column in rows.T:
        hashes = (hashes ^ column.astype(np.uint32)) * np.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> np.uint64(29)
    _, first, number = np.unique(hashes, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    if not np.array_equal(rows[first[number]], rows):
        _, first, number = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return first, number.reshape(-1)


def _get(items: bpy.types.bpy_prop_collection, name: str, shape: tuple[int, ...], kind: type) -> np.ndarray:
    flat = np.empty(int(np.prod(shape)), kind)
    items.foreach_get(name, flat)
    return flat.reshape(shape)


def _chosen(of_corner: np.ndarray, columns: list[np.ndarray | None], default: float) -> np.ndarray | None:
    """For each corner the column of its material; `default` where that is `None`. `None` if all are."""
    found = [column for column in columns if column is not None]
    if not found:
        return None
    if all(column is found[0] for column in columns):
        return found[0]
    result = np.full(found[0].shape, default, np.float32)
    for index, column in enumerate(columns):
        if column is not None:
            where = of_corner == index
            result[where] = column[where]
    return result


def _uvs(mesh: bpy.types.Mesh, made: Made, read: dict[tuple[str, str | None], np.ndarray], notes: Notes) -> np.ndarray | None:
    """The UV map of a material at each corner, with the upper left origin."""
    if made.uv_map is None:
        return None
    layers = mesh.uv_layers
    layer = layers.get(made.uv_map) if made.uv_map else next((layer for layer in layers if layer.active_render), layers.active)
    if layer is None:
        name = f"the UV map “{made.uv_map}”" if made.uv_map else "a UV map"
        notes.add(f"Mesh “{mesh.name}” lacks {name}, which material “{made.material.name}” needs: its images are one colour there")
        return np.zeros((len(mesh.loops), 2), np.float32)
    key = ("uv", layer.name)
    if key not in read:
        read[key] = _get(layer.uv, "vector", (len(mesh.loops), 2), np.float32)
        read[key][:, 1] = 1.0 - read[key][:, 1]
    return read[key]


def _colors(mesh: bpy.types.Mesh, made: Made, read: dict[tuple[str, str | None], np.ndarray], vertex_of: np.ndarray) -> np.ndarray | None:
    """The colour attribute of a material at each corner; where it is missing, black, as in Cycles."""
    if made.attribute is None:
        return None
    attribute = _attribute(mesh, made.attribute)
    key = ("color", attribute.name if attribute else None)
    if key not in read:
        values = _values(mesh, attribute, vertex_of) if attribute else None
        read[key] = np.zeros((len(mesh.loops), 3), np.float32) if values is None else np.ascontiguousarray(np.maximum(values, 0.0))
    return read[key]


def _values(mesh: bpy.types.Mesh, attribute: bpy.types.Attribute, vertex_of: np.ndarray) -> np.ndarray | None:
    """An attribute as linear colours of corners; `None` if it has none."""
    size = len(attribute.data)
    if attribute.data_type in ("FLOAT_COLOR", "BYTE_COLOR"):
        values = _get(attribute.data, "color", (size, 4), np.float32)[:, :3]
    elif attribute.data_type == "FLOAT_VECTOR":
        values = _get(attribute.data, "vector", (size, 3), np.float32)
    elif attribute.data_type == "FLOAT":
        values = np.repeat(_get(attribute.data, "value", (size, 1), np.float32), 3, axis=1)
    else:
        return None
    if attribute.domain == "POINT":
        return values[vertex_of]
    if attribute.domain == "FACE":
        return np.repeat(values, _get(mesh.polygons, "loop_total", (len(mesh.polygons),), np.int32), axis=0)
    return values if attribute.domain == "CORNER" else None


def _attribute(mesh: bpy.types.Mesh, name: str) -> bpy.types.Attribute | None:
    if name:
        return mesh.attributes.get(name)
    colors = mesh.color_attributes
    index = colors.render_color_index
    return colors[index] if 0 <= index < len(colors) else None
