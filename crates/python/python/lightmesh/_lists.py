"""Lists that scenes hand out."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NoReturn, TypeVar

from ._errors import ArgumentError

T = TypeVar("T")


class FixedList(list[T]):
    """A copy of what a scene has, which says so when it is changed: that would be lost. Sums, slices and copies of it are lists."""

    remedy: str

    @classmethod
    def of(cls, items: list[T], remedy: str) -> FixedList[T]:
        made = cls(items)
        made.remedy = remedy
        return made

    def _refuse(self, *_arguments: object, **_keywords: object) -> NoReturn:
        raise ArgumentError(f"this list is a copy, and a change of it would be lost: {self.remedy}")

    append = extend = insert = remove = pop = clear = sort = reverse = _refuse
    __setitem__ = __delitem__ = __imul__ = _refuse

    def __iadd__(self, other: Iterable[T]) -> list[T]:  # type: ignore[override,misc]
        # `scene.lights += [light]` sets the sum, which is another list: so it is not what lists do.
        return [*self, *other]

    def __reduce__(self) -> tuple[type[list[T]], tuple[list[T]]]:
        return list, (list(self),)
