"""Whether what the program wrote is whole, and has no NaN: the formats are decoded with Python's standard library alone."""

from __future__ import annotations

import json
import math
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path


class NotWholeError(Exception):
    """What is wrong with a file."""


def check(name: str, data: bytes) -> None:
    """Raises if a file with this name has not all of its contents, or a NaN."""
    try:
        CHECKS.get(Path(name).suffix, something)(data)
    except (ValueError, IndexError, KeyError, UnicodeDecodeError, struct.error, zlib.error) as error:
        raise NotWholeError(f"{type(error).__name__}: {error}") from error


def need(condition: bool, what: str) -> None:
    if not condition:
        raise NotWholeError(what)


def something(data: bytes) -> None:
    need(bool(data), "empty")


def anything(_data: bytes) -> None:
    """An empty scene is an empty text."""


def whole_png(data: bytes) -> None:
    need(data.startswith(b"\x89PNG\r\n\x1a\n"), "no PNG")
    at, pixels, kind = 8, b"", b""
    while kind != b"IEND":
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        need(zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + length)[0], f"checksum of {kind!r}")
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
        if kind == b"IDAT":
            pixels += body
        at += 12 + length
    need(at == len(data), "more after the end")
    row = 1 + (width * {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour] * depth + 7) // 8
    need(len(zlib.decompress(pixels)) == row * height, "too few pixels")


def whole_bmp(data: bytes) -> None:
    need(data.startswith(b"BM") and struct.unpack_from("<I", data, 2)[0] == len(data), "not of the size that it says")


def whole_jpg(data: bytes) -> None:
    need(data.startswith(b"\xff\xd8") and data.endswith(b"\xff\xd9"), "no end of a JPEG file")


def whole_glb(data: bytes) -> None:
    need(data.startswith(b"glTF") and int.from_bytes(data[8:12], "little") == len(data), "not of the size that it says")


def whole_json(data: bytes) -> None:
    def refuse(word: str) -> None:
        raise NotWholeError(f"{word} in it")

    json.loads(data, parse_constant=refuse)


def whole_csv(data: bytes) -> None:
    text = data.decode()
    need(text.endswith("\n"), "the last line has no end")
    need("nan" not in text.lower().replace('"', ",").split(","), "NaN in it")


# ---- OpenEXR ----


def whole_exr(data: bytes) -> None:
    """Reads all parts of scan lines without compression, by run lengths or deflated; PIZ only up to its compressed blocks."""
    magic, version = struct.unpack_from("<II", data)
    need(magic == 20000630, "no OpenEXR file")
    multiple, at, parts = bool(version & 0x1000), 8, []
    while True:
        part, at = exr_header(data, at)
        if part:
            parts.append(part)
        if not multiple or not part:
            break
    for part in parts:
        x0, y0, x1, y1 = struct.unpack("<4i", part["dataWindow"])
        compression = part["compression"][0]
        rows = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32}[compression]
        blocks = math.ceil((y1 - y0 + 1) / rows)
        for place in struct.unpack_from(f"<{blocks}Q", data, at):
            need(place != 0, "a block is missing")
            begin = place + 4 * multiple
            y, size = struct.unpack_from("<iI", data, begin)
            packed = data[begin + 8 : begin + 8 + size]
            need(len(packed) == size, "a block is cut off")
            if compression != 4:
                read_block(packed, compression, list(channels(part["channels"])), x1 - x0 + 1, min(rows, y1 - y + 1))
        at += 8 * blocks


def exr_header(data: bytes, at: int) -> tuple[dict[str, bytes], int]:
    found = {}
    while data[at]:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size = struct.unpack_from("<I", data, at)[0]
        found[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return found, at + 1


def text_at(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def channels(data: bytes) -> Iterator[tuple[str, str]]:
    """Names and types of channels, in the order of the file."""
    at = 0
    while data[at]:
        name, at = text_at(data, at)
        yield name, "Ief"[struct.unpack_from("<I", data, at)[0]]
        at += 16


def read_block(packed: bytes, compression: int, kinds: list[tuple[str, str]], width: int, rows: int) -> None:
    size = rows * width * sum(struct.calcsize(kind) for _, kind in kinds)
    raw = packed
    if compression and len(packed) < size:
        raw = unpredicted(run_lengths(packed) if compression == 1 else zlib.decompress(packed))
    need(len(raw) == size, f"a block has {len(raw)} of {size} bytes")
    at = 0
    for _ in range(rows):
        for name, kind in kinds:
            values = struct.unpack_from(f"<{width}{kind}", raw, at)
            need(kind == "I" or not any(map(math.isnan, values)), f"NaN in {name}")
            at += width * struct.calcsize(kind)


def run_lengths(packed: bytes) -> bytes:
    found, at = bytearray(), 0
    while at < len(packed):
        count = struct.unpack_from("b", packed, at)[0]
        if count < 0:
            found += packed[at + 1 : at + 1 - count]
            at += 1 - count
        else:
            found += packed[at + 1 : at + 2] * (count + 1)
            at += 2
    return bytes(found)


def unpredicted(data: bytes) -> bytes:
    """Undoes the differences of bytes, and their order by even and odd places."""
    last, sums = 0, bytearray(len(data))
    for i, byte in enumerate(data):
        last = (last + byte - 128) & 255 if i else byte
        sums[i] = last
    half = (len(data) + 1) // 2
    found = bytearray(len(data))
    found[0::2], found[1::2] = sums[:half], sums[half:]
    return bytes(found)


CHECKS = {
    ".png": whole_png,
    ".bmp": whole_bmp,
    ".jpg": whole_jpg,
    ".exr": whole_exr,
    ".glb": whole_glb,
    ".json": whole_json,
    ".csv": whole_csv,
    ".toml": anything,
}
