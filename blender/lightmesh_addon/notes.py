"""What a render shows otherwise than the scene asks for: collected while it is exported, reported once."""

from __future__ import annotations

from collections.abc import Iterator


class Notes:
    """Warnings in the order in which they came up, each once."""

    def __init__(self) -> None:
        self._texts = {}

    def add(self, text: str) -> None:
        self._texts.setdefault(text)

    def __iter__(self) -> Iterator[str]:
        return iter(self._texts)

    def __len__(self) -> int:
        return len(self._texts)

    def text(self) -> str:
        """All of them as one message, with their number if there are several."""
        texts = list(self)
        if len(texts) < 2:
            return "".join(texts)
        return f"{len(texts)} warnings:\n" + "\n".join(texts)


def fault(error: Exception) -> str:
    """What is told of an error that is nobody's but the add-on's own."""
    return f"Lightmesh failed ({type(error).__name__}: {error}): please report it with the text in the console"
