#!/usr/bin/env python3
"""Writes pictures as JPEG files of at most 60 KB, with the highest quality that fits. Needs pillow.

    book/shrink.py FOLDER PICTURE.png…
"""

import io
import sys
from pathlib import Path

from PIL import Image

LARGEST = 60_000


def main(folder, *pictures):
    for picture in map(Path, pictures):
        image = Image.open(picture).convert("RGB")
        for quality in range(92, 20, -2):
            data = io.BytesIO()
            image.save(data, "JPEG", quality=quality, optimize=True, progressive=True)
            if data.tell() <= LARGEST:
                break
        path = Path(folder) / f"{picture.stem}.jpg"
        path.write_bytes(data.getvalue())
        print(f"{path}: {data.tell()} bytes, quality {quality}")


if __name__ == "__main__":
    main(*sys.argv[1:])
