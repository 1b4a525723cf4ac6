"""Records that are read in pieces: on several machines, from several files, in any order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from . import _native, _options
from ._error import AllaniteError
from ._record import Record


class Pieces:
    """What is kept of one axis of a record, as far as it was read. It is the same, byte by byte, however the record is cut and
    in whatever order its pieces come.

    Samples are known by their numbers in the record, counted from 0, and never by the order in which they arrive. Where
    numbers are missing is a gap. Samples that come twice are refused, and so are pieces of another rate or scale. It takes some
    10 kB for each contiguous stretch, whatever its length.

    Parameters
    ----------
    rate : float
        Samples per second.
    scale : float
        Rate units per count.

    Examples
    --------
    >>> morning, evening = Pieces(rate=100), Pieces(rate=100)
    >>> evening.push([4, 5, 6], first=3)
    >>> morning.push([1, 2, 3])
    >>> morning.merge(evening)
    >>> morning.stretches
    ((0, 6),)
    """

    def __init__(self, *, rate: float, scale: float = 1.0) -> None:
        self._native = _native.Pieces(rate, scale)

    @classmethod
    def _of(cls, native: _native.Pieces) -> Pieces:
        pieces = cls.__new__(cls)
        pieces._native = native
        return pieces

    def push(self, counts: Any, *, first: int = 0) -> None:
        """Adds neighbouring samples: an array of shape (n,) of whole numbers of 32 bits, which begins with sample ``first``."""
        self._native.push(int(first), _counts(counts))

    def push_numbered(self, numbers: Any, counts: Any) -> None:
        """Adds samples with their numbers in the record, both of shape (n,), in any order."""
        numbers = np.asarray(numbers)
        if numbers.ndim != 1 or numbers.dtype.kind not in "iu" or (numbers.size > 0 and numbers.min() < 0):
            raise AllaniteError(
                "pieces", None, "the numbers of samples are no whole numbers from 0 on", "count the samples of the record",
            )
        contiguous = np.ascontiguousarray(numbers)
        unsigned = contiguous.view(np.uint64) if contiguous.dtype == np.int64 else contiguous.astype(np.uint64, copy=False)
        self._native.push_numbered(unsigned, _counts(counts))

    def merge(self, *others: Pieces) -> None:
        """Adds the pieces of other parts of the record. Neighbours are joined as if they had never been apart."""
        for other in others:
            self._native.merge(other._native)

    @property
    def rate_hz(self) -> float:
        """Samples per second."""
        return self._native.rate_hz()

    @property
    def scale(self) -> float:
        """Rate units per count."""
        return self._native.rate_per_count()

    @property
    def stretches(self) -> tuple[tuple[int, int], ...]:
        """For each contiguous stretch the number of its first sample, and the number behind its last one."""
        return tuple(self._native.stretches())

    @property
    def samples(self) -> int:
        """Samples so far."""
        return sum(end - start for start, end in self.stretches)

    def record(self, *, axis: str = "gyro", unit: str = "deg/s") -> Record:
        """The record of this axis, to be fitted, diagnosed and saved. :meth:`record_of` takes several axes."""
        return self.record_of({axis: self}, unit=unit)

    @staticmethod
    def record_of(axes: Mapping[str, Pieces] | Iterable[tuple[str, Pieces]], *, unit: str = "deg/s") -> Record:
        """The record of the axes of one sensor: ``Pieces.record_of({"gx": gx, "gy": gy})``."""
        items = axes.items() if isinstance(axes, Mapping) else axes
        native = [(name, pieces._native) for name, pieces in items]
        return Record(_native.Pieces.record(native, _options.given(unit=unit)))

    def __bytes__(self) -> bytes:
        return self._native.to_bytes()

    @classmethod
    def from_bytes(cls, data: bytes) -> Pieces:
        """The pieces whose ``bytes(pieces)`` these are."""
        return cls._of(_native.Pieces.from_bytes(data))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Pieces) and bytes(self) == bytes(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<Pieces: {self.samples} samples at {self.rate_hz:g} Hz in {len(self.stretches)} stretches>"

    def __reduce__(self) -> Any:
        return (Pieces.from_bytes, (bytes(self),))


def _counts(counts: Any) -> np.ndarray[Any, np.dtype[np.int32]]:
    array = np.asarray(counts)
    if array.ndim == 1 and array.size == 0:
        array = array.astype(np.int32)
    fits = array.ndim == 1 and array.dtype.kind in "iu"
    if fits and array.size > 0 and not np.can_cast(array.dtype, np.int32):
        fits = array.min() >= -(2**31) and array.max() < 2**31
    if not fits:
        raise AllaniteError(
            "pieces", None, "the samples are no whole numbers of 32 bits", "round them to counts, which an integer holds",
        )
    return np.ascontiguousarray(array, dtype=np.int32)
