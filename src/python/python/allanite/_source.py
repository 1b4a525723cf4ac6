"""Records and diagnoses, as the results that are made of them see them.

The results know these protocols, and records and diagnoses know the results, so that no two files import each other.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Protocol

from ._curve import Curve
from .effects import Effect

if TYPE_CHECKING:
    from . import _native


class Comparable(Protocol):
    """A record or a diagnosis, which models are fitted to."""

    def _native_handle(self) -> _native.Record | _native.Diagnosis: ...


class Source(Protocol):
    """A record: see :class:`Record`."""

    @property
    def axes(self) -> tuple[Curve, ...]:
        """The Allan curve of every axis."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader decided without being asked."""
        ...

    @property
    def path(self) -> str:
        """Where the record comes from."""
        ...

    @property
    def rate_hz(self) -> float:
        """Samples per second."""
        ...

    @property
    def unit(self) -> str:
        """The rate unit."""
        ...

    @property
    def samples(self) -> int:
        """Samples of each axis."""
        ...

    def diagnose(
        self,
        *,
        max_effects: int | None = None,
        filter: Effect | str | None = None,
        own: str | Iterable[str] = (),
        progress: Callable[[float], object] | None = None,
    ) -> Any:
        """See :meth:`Record.diagnose`."""
        ...

    def save(self, path: str | os.PathLike[str]) -> None:
        """See :meth:`Record.save`."""
        ...

    def to_dict(self) -> dict[str, Any]:
        """See :meth:`Record.to_dict`."""
        ...

    def table(self) -> Any:
        """See :meth:`Record.table`."""
        ...

    def _native_handle(self) -> _native.Record: ...
