"""Writes a forest: one tree, in many places of one scene file.

    python bench/instances/forest.py FOLDER [--trees 10000] [--leaves 24000]
    lightmesh render FOLDER/forest.toml -o forest.png --stats forest.json

A tree is a trunk, boughs and leaves of two triangles each, about 50 000 in all, from a fixed seed; trees are turned and scaled, and stand on a jittered
grid. The sun is low, so that shadows cross many trees.
"""

import argparse
from pathlib import Path

import numpy as np

#: Metres between trees.
SPACING = 6.0


def cone(base: np.ndarray, tip: np.ndarray, radius: float, sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of a cone without its base."""
    axis = (tip - base) / np.linalg.norm(tip - base)
    side = np.cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 0.0, 1.0))
    side /= np.linalg.norm(side)
    angles = np.arange(sides) * (2.0 * np.pi / sides)
    ring = base + radius * (np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * np.cross(axis, side))
    first = np.arange(sides)
    return np.vstack([ring, tip]), np.stack([first, (first + 1) % sides, np.full(sides, sides)], axis=1)


def tree(leaves: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners (N, 3), metres, and triangles (M, 3) of a tree, which stands at the origin, 7 high."""
    random = np.random.default_rng(7)
    boughs = leaves // 200
    parts = [cone(np.zeros(3), np.array((0.0, 6.0, 0.0)), 0.25, 16)]
    tips = []
    for bough in range(boughs):
        height = 1.5 + 4.5 * bough / boughs
        angle, reach = 2.4 * bough, 2.2 * (1.0 - 0.7 * bough / boughs)
        tip = np.array((reach * np.cos(angle), height + 0.5, reach * np.sin(angle)))
        parts.append(cone(np.array((0.0, height, 0.0)), tip, 0.05, 6))
        tips.append((np.array((0.0, height, 0.0)), tip))
    along = random.uniform(0.25, 1.0, leaves)[:, None]
    starts, ends = (np.array([pair[i] for pair in tips])[np.arange(leaves) % boughs] for i in (0, 1))
    centres = starts + along * (ends - starts) + random.normal(0.0, 0.14, (leaves, 3))
    u = random.normal(size=(leaves, 3))
    u /= np.linalg.norm(u, axis=1)[:, None]
    v = np.cross(u, random.normal(size=(leaves, 3)))
    v /= np.linalg.norm(v, axis=1)[:, None]
    corners = np.stack([centres + 0.05 * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1).reshape(-1, 3)
    first = 4 * np.arange(leaves)[:, None]
    parts.append((corners, np.concatenate([first + (0, 1, 2), first + (0, 2, 3)])))
    offsets = np.cumsum([0] + [len(points) for points, _ in parts])
    return np.vstack([points for points, _ in parts]), np.vstack([faces + offset for (_, faces), offset in zip(parts, offsets, strict=False)])


def write_ply(path: Path, points: np.ndarray, faces: np.ndarray) -> None:
    """A binary file."""
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    path.write_bytes(header.encode() + points.astype("<f4").tobytes() + rows.tobytes())


def write_scene(path: Path, trees: int) -> None:
    """Camera, sun, ground and trees."""
    random = np.random.default_rng(1)
    side = int(np.ceil(np.sqrt(trees)))
    half = 0.5 * side * SPACING
    lines = [
        "[[camera]]",
        f"position = [0.0, 14.0, {half + 12.0}]",
        "target = [0.0, 4.0, 0.0]",
        "vfov = 40.0",
        "[[light]]",
        'kind = "directional"',
        "direction = [-0.6, -0.55, -0.35]",
        "angle = 0.53",
        "[[material]]",
        'name = "leaf"',
        "kd = [0.25, 0.45, 0.15]",
        "[[material]]",
        'name = "ground"',
        "kd = [0.35, 0.3, 0.2]",
        "[[plane]]",
        f"point = [0.0, 0.0, 0.0]\nnormal = [0.0, 1.0, 0.0]\nsize = [{2.5 * half}, {2.5 * half}]",
        'material = "ground"',
    ]
    for tree in range(trees):
        x, z = (np.array((tree % side, tree // side)) + 0.5 + random.uniform(-0.3, 0.3, 2)) * SPACING - half
        lines += [
            "[[mesh]]",
            'file = "tree.ply"',
            'material = "leaf"',
            f"rotate = [0.0, {random.uniform(0.0, 360.0):.2f}, 0.0]",
            f"scale = {random.uniform(0.7, 1.3):.3f}",
            f"translate = [{x:.3f}, 0.0, {z:.3f}]",
        ]
    path.write_text("\n".join(lines) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--trees", type=int, default=10_000)
    parser.add_argument("--leaves", type=int, default=24_000)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    points, faces = tree(options.leaves)
    write_ply(options.folder / "tree.ply", points, faces)
    write_scene(options.folder / "forest.toml", options.trees)
    print(f"{options.trees} trees of {len(faces)} triangles")


if __name__ == "__main__":
    main()
