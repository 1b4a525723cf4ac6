"""Results of several axes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic, TypeVar

from ._error import AllaniteError

T = TypeVar("T")


class Axes(Generic[T]):
    """One result for each axis of a record, by the name of the axis or in their order."""

    axes: tuple[T, ...]

    def __getitem__(self, axis: str | int | None) -> T:
        """The result of an axis. ``None`` stands for the only one."""
        names = [one.axis for one in self.axes]  # type: ignore[attr-defined]
        if axis is None:
            if len(names) != 1:
                raise AllaniteError(None, None, f"there are {len(names)} axes", f"choose from {', '.join(names)}")
            return self.axes[0]
        if isinstance(axis, int):
            return self.axes[axis]
        if axis not in names:
            raise AllaniteError(None, None, f'there is no axis "{axis}"', f"choose from {', '.join(names)}")
        return self.axes[names.index(axis)]

    def __iter__(self) -> Iterator[T]:
        return iter(self.axes)

    def __len__(self) -> int:
        return len(self.axes)
