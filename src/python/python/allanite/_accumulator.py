"""Samples that arrive while Python runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _native, _options
from ._error import AllaniteError
from ._record import Record


class Accumulator:
    """Takes samples in pieces of any length, and keeps none of them: a few kilobytes for each axis, whatever the length.

    Parameters
    ----------
    rate : float
        Samples per second.
    scale : float
        Rate units per count. Floats are rounded to such counts, so that it should lie below the noise.
    unit : str
        ``deg/s``, ``rad/s``, ``m/s^2`` or ``g``.
    axes : sequence of str
        The names of the axes.

    Examples
    --------
    >>> accumulator = Accumulator(rate=100, scale=0.01, axes=["gx"])
    >>> accumulator.push([1, -2, 3])
    >>> accumulator.samples
    3
    """

    def __init__(
        self, *, rate: float, scale: float = 1.0, unit: str = "deg/s", axes: Sequence[str] = ("gyro",)
    ) -> None:
        self.axes = (axes,) if isinstance(axes, str) else tuple(axes)
        self.scale = float(scale)
        self._native = _native.Accumulator(_options.given(rate=rate, scale=scale, unit=unit, axes=self.axes))

    def push(self, samples: Any) -> None:
        """Adds samples: an array of shape (n,) for one axis, or (n, axes).

        Integers are counts. Floats are rates in the unit, and are rounded to counts of ``scale``.
        """
        array = np.asarray(samples)
        if array.ndim == 1 and len(self.axes) == 1:
            array = array[:, np.newaxis]
        if array.ndim != 2 or array.shape[1] != len(self.axes):
            raise AllaniteError(
                "accumulator", None, f"samples of shape {array.shape} do not have {len(self.axes)} axes",
                "push an array of shape (n, axes)",
            )
        if array.dtype.kind == "f":
            array = np.rint(array / self.scale)
            # A value that is not a number fails both comparisons.
            valid = (np.abs(array) < 2**31).all()
        elif array.dtype.kind in "iu":
            valid = array.size == 0 or (array.max() < 2**31 and array.min() >= -(2**31))
        else:
            valid = False
        if not valid:
            raise AllaniteError(
                "accumulator", None, "a sample is no count of 32 bits",
                "leave such samples out and call gap(), or give another scale=",
            )
        columns = [np.ascontiguousarray(array[:, axis], dtype=np.int32) for axis in range(len(self.axes))]
        self._native.push(columns)

    def gap(self) -> None:
        """Tells that samples were lost here. No difference spans the gap."""
        self._native.gap()

    @property
    def samples(self) -> int:
        """Samples of each axis so far."""
        return self._native.samples()

    def record(self) -> Record:
        """The record so far, to be fitted and diagnosed. The accumulator goes on."""
        return Record(self._native.record())
