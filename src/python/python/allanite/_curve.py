"""The Allan curve of an axis."""

from __future__ import annotations

from dataclasses import dataclass

from ._parts import Octave


@dataclass(frozen=True)
class Curve:
    """The Allan curve of one axis of a record.

    Attributes
    ----------
    axis : str
        The name of the axis.
    rate_hz : float
        Samples per second.
    unit : str
        The rate unit.
    rate_per_count : float
        Rate units per count, or per quantum if the samples are floats.
    samples, gaps : int
        Samples of the axis, and gaps in it.
    octaves : tuple of Octave
        Shortest averaging time first.
    invalid : str or None
        Why the curve is not valid, if it is not.
    covariates : tuple of str
        The columns beside it that a diagnosis tries.
    """

    axis: str
    rate_hz: float
    unit: str
    rate_per_count: float
    samples: int
    gaps: int
    octaves: tuple[Octave, ...]
    invalid: str | None = None
    covariates: tuple[str, ...] = ()
