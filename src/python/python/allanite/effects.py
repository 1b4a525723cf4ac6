"""The effects of the catalogue, which are added to a model: ``model + Sinusoid(47)``.

A shape parameter that is given is where the fit of the shape begins, or, with ``fitted=False``, the shape itself. Without any,
the shape is looked for in the whole range that the record can show. Whole numbers are never fitted: one that is not given is
the least, or looked for with the rest of the shape. The coefficient is always fitted.

This file is made from the catalogue of the library, ``src/theory/effect``, and not edited:
``ALLANITE_RENEW_PYTHON=1 cargo test --test library python_effects`` makes it anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ._effect import Effect

__all__ = [
    "CATALOGUE",
    "Effect",
    "Quantization",
    "AngleRandomWalk",
    "BiasInstability",
    "RateRandomWalk",
    "RateRamp",
    "GaussMarkov",
    "Sinusoid",
    "Resonance",
    "LowPass",
    "DecimationFilter",
    "RandomTelegraph",
    "PowerLaw",
    "Notch",
    "DigitalLowPass",
    "Cascade",
    "ModeSplit",
    "HighPass",
    "DriftingResonance",
    "DriftingSinusoid",
    "OutputLowPass",
    "MovingAverage",
]


@dataclass(frozen=True)
class Quantization(Effect):
    """Quantization noise: the angle is rounded, or its sampling instant jitters.

    Quantization noise: the angle carries an error that is independent from sample to sample. The coefficient is ``Q``,
    the rms of that error, in rate · s (an angle).
    """

    NAME: ClassVar[str] = "quantization"


@dataclass(frozen=True)
class AngleRandomWalk(Effect):
    """Angle random walk: white noise of the rate.

    Angle random walk, which is white noise of the rate. The coefficient is ``N`` in rate · √s; the two-sided spectral
    density of the rate is ``N²``.
    """

    NAME: ClassVar[str] = "angle_random_walk"


@dataclass(frozen=True)
class BiasInstability(Effect):
    """Bias instability: flicker noise of the rate.

    Bias instability, which is flicker noise of the rate, averaged over each sample interval. The coefficient is ``B``
    in rate units; the spectral density of the rate is ``B²/(2πf)``.
    """

    NAME: ClassVar[str] = "bias_instability"


@dataclass(frozen=True)
class RateRandomWalk(Effect):
    """Rate random walk: the rate wanders by independent random steps.

    Rate random walk: the rate takes a random step once a sample. The coefficient is ``K`` in rate / √s; a step has the
    variance ``K²τ₀``.
    """

    NAME: ClassVar[str] = "rate_random_walk"


@dataclass(frozen=True)
class RateRamp(Effect):
    """A rate ramp: the rate drifts steadily.

    Rate ramp: the rate drifts steadily, so that all differences are the same. The coefficient is ``R`` in rate / s.
    """

    NAME: ClassVar[str] = "rate_ramp"


@dataclass(frozen=True)
class GaussMarkov(Effect):
    """Exponentially correlated noise: a random rate that keeps its value for about its correlation time.

    Exponentially correlated noise, which is a Gauss–Markov process of first order. The coefficient is its rms ``s`` in
    rate units, the shape parameter its correlation time ``T_c`` in seconds, above zero.

    Attributes
    ----------
    correlation_time_s : float, optional
        In s, above 0.
    """

    NAME: ClassVar[str] = "gauss_markov"

    correlation_time_s: float | None = None


@dataclass(frozen=True)
class Sinusoid(Effect):
    """A sinusoid: a steady oscillation of one frequency.

    A sinusoidal rate. The coefficient is its amplitude ``Ω₀`` in rate units, the shape parameter its frequency ``f`` in
    Hz, above zero and not a multiple of the sample rate.

    Attributes
    ----------
    frequency_hz : float, optional
        In Hz, above 0.
    """

    NAME: ClassVar[str] = "sinusoid"

    frequency_hz: float | None = None


@dataclass(frozen=True)
class Resonance(Effect):
    """A resonance: an oscillation with a phase that wanders.

    Resonance: a lightly damped mode that noise drives. The coefficient is its rms ``s`` in rate units; the shape
    parameters are its frequency ``f`` in Hz and its quality factor, both above zero.

    Attributes
    ----------
    frequency_hz : float, optional
        In Hz, above 0.
    quality : float, optional
        A number above 0.
    """

    NAME: ClassVar[str] = "resonance"

    frequency_hz: float | None = None
    quality: float | None = None


@dataclass(frozen=True, kw_only=True)
class LowPass(Effect):
    """A low pass: white noise is cut off before it is sampled.

    Angle random walk that passed a Butterworth low pass of one to four poles. It takes the place of
    ``AngleRandomWalk``. The coefficient is ``N`` in rate · √s; the shape parameters are the time constant ``T`` of the
    filter in seconds, above zero, and the number of its poles. The density has fallen to a half at the cut-off
    frequency ``1/(2πT)``.

    Attributes
    ----------
    cutoff_hz : float, optional
        In Hz, above 0. It is 0.159155/``time_constant_s``, and one of the two is given.
    time_constant_s : float, optional
        In s, above 0.
    poles : int, optional
        A whole number, 1 to 4.
    """

    NAME: ClassVar[str] = "low_pass"
    WHOLE: ClassVar[tuple[str, ...]] = ("poles",)

    cutoff_hz: float | None = None
    time_constant_s: float | None = None
    poles: int | None = None


@dataclass(frozen=True)
class DecimationFilter(Effect):
    """A decimation filter: white noise is averaged over longer than a sample interval.

    Angle random walk that passed a decimation filter. It takes the place of ``AngleRandomWalk``. The coefficient is
    ``N`` in rate · √s; the shape parameters are the width of the filter in seconds, up to 64 samples, and the number of
    its stages. One stage is a moving average, two are a Bartlett (triangular) window.

    Attributes
    ----------
    width_s : float, optional
        In s, above 0.
    stages : int, optional
        A whole number, 1 to 2.
    """

    NAME: ClassVar[str] = "decimation_filter"
    WHOLE: ClassVar[tuple[str, ...]] = ("stages",)

    width_s: float | None = None
    stages: int | None = None


@dataclass(frozen=True)
class RandomTelegraph(Effect):
    """Random telegraph noise: the rate jumps between two levels.

    The coefficient is its rms in rate units, the shape parameter its correlation time ``T_c`` in seconds, above zero.

    Attributes
    ----------
    correlation_time_s : float, optional
        In s, above 0.
    """

    NAME: ClassVar[str] = "random_telegraph"

    correlation_time_s: float | None = None


@dataclass(frozen=True)
class PowerLaw(Effect):
    """Power-law noise: flicker noise of the rate whose slope is not that of 1/f.

    Power-law noise of the rate, averaged over each sample interval: flicker noise whose exponent is free. It takes the
    place of ``BiasInstability``, which is power-law noise of exponent 1. The coefficient is the Allan deviation ``P``
    at an averaging time of one second, in rate units; the shape parameter is the exponent ``α`` of the spectral density
    ``S(f) ∝ f^(−α)``, above 0 and below 3.

    Attributes
    ----------
    exponent : float, optional
        A number above 0.
    """

    NAME: ClassVar[str] = "power_law"

    exponent: float | None = None


@dataclass(frozen=True)
class Notch(Effect):
    """A notch filter: a band is missing from the white noise.

    Angle random walk that passed a notch filter. It takes the place of ``AngleRandomWalk``. The coefficient is ``N`` in
    rate · √s; the shape parameters are the frequency of the notch in Hz, below half the sample rate, and its quality,
    the ratio of the frequency to the width between the points at −3 dB.

    Attributes
    ----------
    frequency_hz : float, optional
        In Hz, above 0.
    quality : float, optional
        A number above 0.
    """

    NAME: ClassVar[str] = "notch"

    frequency_hz: float | None = None
    quality: float | None = None


@dataclass(frozen=True, kw_only=True)
class DigitalLowPass(Effect):
    """A digital low pass: white noise is filtered at the sample rate, and nothing is left of it at half that rate.

    Angle random walk that passed a digital Butterworth low pass of one to four poles, which runs at the sample rate. It
    takes the place of ``AngleRandomWalk``. The coefficient is ``N`` in rate · √s; the shape parameters are the time
    constant ``T`` of the filter in seconds and the number of its poles. The density has fallen to a half at the cut-off
    frequency ``1/(2πT)``, which lies below half the sample rate: one above 0.49 of the sample rate is taken as that.

    Attributes
    ----------
    cutoff_hz : float, optional
        In Hz, above 0. It is 0.159155/``time_constant_s``, and one of the two is given.
    time_constant_s : float, optional
        In s, above 0.
    poles : int, optional
        A whole number, 1 to 4.
    """

    NAME: ClassVar[str] = "digital_low_pass"
    WHOLE: ClassVar[tuple[str, ...]] = ("poles",)

    cutoff_hz: float | None = None
    time_constant_s: float | None = None
    poles: int | None = None


@dataclass(frozen=True, kw_only=True)
class Cascade(Effect):
    """A cascade: white noise passed several equal smoothing filters, one behind the other.

    Angle random walk that passed two to four equal digital filters of first order in series, ``y += α (x − y)``. It
    takes the place of ``AngleRandomWalk``. The coefficient is ``N`` in rate · √s; the shape parameters are the time
    constant ``T`` of one stage in seconds and the number of stages. Each stage has the pole ``z = e^(−τ₀/T) = 1 − α``,
    and its density has fallen to a half at the frequency ``1/(2πT)``, as long as that is far below half the sample
    rate. One stage alone is a ``LowPass`` of one pole.

    Attributes
    ----------
    cutoff_hz : float, optional
        In Hz, above 0. It is 0.159155/``time_constant_s``, and one of the two is given.
    time_constant_s : float, optional
        In s, above 0.
    stages : int, optional
        A whole number, 2 to 4.
    """

    NAME: ClassVar[str] = "cascade"
    WHOLE: ClassVar[tuple[str, ...]] = ("stages",)

    cutoff_hz: float | None = None
    time_constant_s: float | None = None
    stages: int | None = None


@dataclass(frozen=True)
class ModeSplit(Effect):
    """Rising white noise: the noise grows with frequency up to the sensor's bandwidth.

    Angle random walk that rises towards high frequency, and is then cut off. It takes the place of ``AngleRandomWalk``.
    The coefficient is ``N`` in rate · √s, that of the plateau at low frequency; the shape parameters are the frequency
    ``f_r`` in Hz at which the density has risen to twice the plateau, and the frequency ``f_c`` in Hz of the corner
    above it.

    Attributes
    ----------
    rise_hz : float, optional
        In Hz, above 0.
    corner_hz : float, optional
        In Hz, above 0.
    """

    NAME: ClassVar[str] = "mode_split"

    rise_hz: float | None = None
    corner_hz: float | None = None


@dataclass(frozen=True, kw_only=True)
class HighPass(Effect):
    """A high pass: white noise is missing at low frequency, so that the angle does not walk away.

    Angle random walk that passed a high pass of first order. It takes the place of ``AngleRandomWalk``. The coefficient
    is ``N`` in rate · √s, that of the noise in front of the filter; the shape parameter is the time constant ``T`` of
    the filter in seconds. The density is ``N² f²/(f² + f_c²)`` with the cut-off frequency ``f_c = 1/(2πT)``, for
    frequencies far below the sample rate.

    Attributes
    ----------
    cutoff_hz : float, optional
        In Hz, above 0. It is 0.159155/``time_constant_s``, and one of the two is given.
    time_constant_s : float, optional
        In s, above 0.
    """

    NAME: ClassVar[str] = "high_pass"

    cutoff_hz: float | None = None
    time_constant_s: float | None = None


@dataclass(frozen=True)
class DriftingResonance(Effect):
    """A drifting resonance: an oscillation with a phase that wanders, and a frequency that moved during the record.

    A ``Resonance`` whose frequency ran evenly over a range during the record. The coefficient is its rms ``s`` in rate
    units; the shape parameters are the frequency ``f`` in Hz in the middle of the range, the quality factor there, and
    the width of the range in Hz. The time constant ``T = quality/(πf)`` stays the same over the range. A range that is
    wider than half of its middle is taken as half of it.

    Attributes
    ----------
    frequency_hz : float, optional
        In Hz, above 0.
    quality : float, optional
        A number above 0.
    drift_hz : float, optional
        In Hz, above 0.
    """

    NAME: ClassVar[str] = "drifting_resonance"

    frequency_hz: float | None = None
    quality: float | None = None
    drift_hz: float | None = None


@dataclass(frozen=True)
class DriftingSinusoid(Effect):
    """A drifting sinusoid: an oscillation whose frequency moved during the record.

    A ``Sinusoid`` whose frequency ran evenly over a range during the record. The coefficient is its amplitude ``Ω₀`` in
    rate units; the shape parameters are the frequency ``f`` in Hz in the middle of the range, and the width of the
    range in Hz. A range that is wider than half of its middle is taken as half of it.

    Attributes
    ----------
    frequency_hz : float, optional
        In Hz, above 0.
    drift_hz : float, optional
        In Hz, above 0.
    """

    NAME: ClassVar[str] = "drifting_sinusoid"

    frequency_hz: float | None = None
    drift_hz: float | None = None


@dataclass(frozen=True, kw_only=True)
class OutputLowPass(Effect):
    """A low pass of the whole output: everything that the sensor gave was smoothed at the sample rate, its quantization too.

    A ``DigitalLowPass`` that the whole signal passed: quantization, flicker noise and random walks as well as the white
    noise. The coefficient is the ``N`` of the angle random walk in front of it; the shape parameters are the time
    constant ``T`` of the filter in seconds and the number of its poles.

    Attributes
    ----------
    cutoff_hz : float, optional
        In Hz, above 0. It is 0.159155/``time_constant_s``, and one of the two is given.
    time_constant_s : float, optional
        In s, above 0.
    poles : int, optional
        A whole number, 1 to 4.
    """

    NAME: ClassVar[str] = "output_low_pass"
    WHOLE: ClassVar[tuple[str, ...]] = ("poles",)

    cutoff_hz: float | None = None
    time_constant_s: float | None = None
    poles: int | None = None


@dataclass(frozen=True)
class MovingAverage(Effect):
    """A moving average of the whole output: every value is a mean over the last samples, quantization and all.

    A moving average of the whole output: quantization, flicker noise and random walks as well as the white noise are
    means over the last samples. The coefficient is the ``N`` of the angle random walk in front of it; the shape
    parameter is the number of samples of a mean, 2 to 32.

    Attributes
    ----------
    samples : int, optional
        A whole number, 2 to 32.
    """

    NAME: ClassVar[str] = "moving_average"
    WHOLE: ClassVar[tuple[str, ...]] = ("samples",)

    samples: int | None = None


CATALOGUE: tuple[type[Effect], ...] = (
    Quantization,
    AngleRandomWalk,
    BiasInstability,
    RateRandomWalk,
    RateRamp,
    GaussMarkov,
    Sinusoid,
    Resonance,
    LowPass,
    DecimationFilter,
    RandomTelegraph,
    PowerLaw,
    Notch,
    DigitalLowPass,
    Cascade,
    ModeSplit,
    HighPass,
    DriftingResonance,
    DriftingSinusoid,
    OutputLowPass,
    MovingAverage,
)
"""Every effect that the diagnosis knows, in its order."""
