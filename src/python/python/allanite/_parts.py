"""The parts of results: frozen dataclasses whose fields are named as in the documents of the command line.

Times are in seconds, frequencies in hertz, rates in the unit of the record. A number that is not finite, such as the upper end of
an interval that the record does not bound, is ``None``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Octave:
    """One octave of an Allan curve.

    Attributes
    ----------
    m : int
        Averaging factor, a power of two, in samples.
    tau_s : float
        Averaging time, in s.
    differences : int
        Number of quarter-overlapping differences of adjacent cluster means.
    variance : float
        Allan variance, in the rate unit squared.
    """

    m: int
    tau_s: float
    differences: int
    variance: float

    @property
    def deviation(self) -> float:
        """Allan deviation, in the rate unit."""
        return math.sqrt(self.variance)


@dataclass(frozen=True)
class Coefficient:
    """A coefficient with its 95 % interval.

    Attributes
    ----------
    effect, symbol : str
        The effect, such as ``angle_random_walk``, and its customary symbol, ``N``.
    value, lower, upper : float or None
        In ``unit``; an end that the record does not tell is ``None``.
    state : str
        ``measured``, ``upper_bound`` or ``not_observable``.
    unit : str
        Such as ``deg/s/√Hz``.
    """

    effect: str
    symbol: str
    value: float | None
    lower: float | None
    upper: float | None
    state: str
    unit: str


@dataclass(frozen=True)
class FilterShape:
    """A filter that was given, by its shape parameters."""

    effect: str
    parameters: dict[str, float | None]
    fits: bool | None = None
    better: FilterShape | None = None


@dataclass(frozen=True)
class Covariate:
    """A column beside the axis that was tried: whether the rate follows it, and its slope in rate unit per unit of the column,
    with its 95 % interval; the lag in s if there is one; and the largest slope that is not excluded, if none shows."""

    channel: str
    acts: bool
    slope: float | None = None
    slope_lower: float | None = None
    slope_upper: float | None = None
    z: float | None = None
    lag_s: float | None = None
    lag_lower_s: float | None = None
    lag_upper_s: float | None = None
    most: float | None = None


@dataclass(frozen=True)
class Limit:
    """A coefficient beside its limit ``most``, in ``unit``; the verdict is ``pass``, ``guard_band``, ``misfit``,
    ``not_stationary``, ``invalid`` or ``fail``. ``beside`` names the effects in whose presence it was compared."""

    effect: str
    symbol: str
    most: float
    unit: str
    verdict: str
    beside: tuple[str, ...] = ()


@dataclass(frozen=True)
class ModelEffect:
    """An effect of a model: its shape parameters, and its coefficient unless it is one of the five terms."""

    name: str
    parameters: dict[str, float | None]
    channel: str | None = None


@dataclass(frozen=True)
class Worst:
    """The octave that disagrees most: τ in s, the disagreement in standard errors, and in percent of the variance."""

    tau_s: float
    z: float
    percent: float


@dataclass(frozen=True)
class Candidate:
    """An effect that was tried in a step: its shape, and the χ² with it. ``improvement`` is the logarithm of a likelihood ratio."""

    effect: str
    parameters: dict[str, float | None]
    chi2: float | None
    improvement: float | None


@dataclass(frozen=True)
class Step:
    """A model on the way of a diagnosis.

    Attributes
    ----------
    error : float
        χ² and what the rate follows of a covariate. It falls from step to step.
    chi2, dof, p_value
        χ² of the octaves and the bins, its degrees of freedom, and the probability of a larger one.
    birge_ratio : float
        The factor by which the intervals are widened.
    rms_percent : float
        Root mean square of the misfit of the octaves, in percent of the variance.
    candidates : tuple of Candidate
        What was tried, best first.
    added : str or None
        The effect or ``covariate`` that leads to the next step.
    """

    effects: tuple[ModelEffect, ...]
    coefficients: tuple[Coefficient, ...]
    chi2: float | None
    error: float | None
    dof: int
    p_value: float | None
    birge_ratio: float | None
    rms_percent: float | None
    worst: Worst | None
    candidates: tuple[Candidate, ...]
    added: str | None


@dataclass(frozen=True)
class Bin:
    """A bin of the spectrum beside the last model: its frequency in Hz, the one-sided densities of the record and of the model in
    rate unit²/Hz, and the difference in standard errors. ``block`` is the number of samples in a block."""

    frequency_hz: float
    block: int
    density: float
    expected: float
    z: float


@dataclass(frozen=True)
class SpectralLine:
    """A sinusoid of the last model: its frequency in Hz with a 95 % interval, and its amplitude in the rate unit."""

    frequency_hz: float
    lower_hz: float
    upper_hz: float
    amplitude: float
    narrower_than_hz: float | None = None


@dataclass(frozen=True)
class Comb:
    """Sinusoids that are harmonics of one fundamental, by their places in ``lines``."""

    fundamental_hz: float
    mains_hz: float | None
    lines: tuple[int, ...]
    orders: tuple[int, ...]
    words: str


@dataclass(frozen=True)
class DetectionLimit:
    """How large an effect would have to be for the record to show it with a probability of 95 %, in ``unit``."""

    effect: str
    limited: str
    limit: float | None
    unit: str
    shapes: tuple[dict[str, float | None], ...] = ()


@dataclass(frozen=True)
class ComparedOctave:
    """An octave of the record beside a model: deviations in the rate unit, the difference of the variances in percent and in
    standard errors, and the share of each effect in the model's variance."""

    m: int
    tau_s: float
    measured: float
    model: float
    percent: float
    z: float | None
    shares: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Stretch:
    """Octaves, from a τ to a τ in s, in which the record lies ``above`` or ``below`` the model."""

    side: str
    from_s: float
    to_s: float
