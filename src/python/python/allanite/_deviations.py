"""Allan deviations of arrays, and nothing else."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from . import _columns, _document, _native, _options


@dataclass(frozen=True)
class Deviation:
    """The Allan deviation at one averaging time.

    Attributes
    ----------
    m : int
        Averaging factor, a power of two, in samples.
    tau_s : float
        Averaging time, in s.
    differences : int
        Number of quarter-overlapping differences of adjacent cluster means.
    deviation : float
        In the unit of the samples times ``scale``.
    """

    m: int
    tau_s: float
    differences: int
    deviation: float


def deviations(
    samples: Any,
    *,
    rate: float,
    scale: float = 1.0,
    names: Sequence[str] | None = None,
    progress: Callable[[float], object] | None = None,
) -> dict[str, tuple[Deviation, ...]]:
    """Allan deviations at octaves of the averaging time, for each column of an array that is not copied.

    The starts of differences advance by a quarter of a cluster: at m = 1, 2 and 4 they overlap fully. Use
    :meth:`Record.from_numpy` for coefficients.

    Parameters
    ----------
    samples : array of shape (n,) or (n, axes), or mapping from names to arrays of shape (n,)
        Integers of 1 to 8 bytes, or floats of 4 or 8 bytes, which are rounded to 2^-30 of their range.
    rate : float
        Samples per second.
    scale : float
        By what the samples are multiplied.
    names : sequence of str, optional
        The names of the columns; ``column 1`` and so on unless given.
    progress : callable, optional
        Called with the share that is done, 0 to 1, in each of up to three passes.
    """
    lent = _columns.of_arrays(samples, names, None)
    text = _native.deviations(lent, _options.given(rate=rate, scale=scale), progress)
    return {
        column["axis"]: tuple(_document.build(Deviation, octave) for octave in column["octaves"])
        for column in json.loads(text)
    }
