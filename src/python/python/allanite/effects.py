"""Effects that are added to a model: ``model + Sinusoid(47)``.

A shape parameter that is given is where the fit of the shape begins, or, with ``fitted=False``, the shape itself. Without any,
the shape is looked for in the whole range that the record can show. The coefficient is always fitted.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import ClassVar

__all__ = [
    "CATALOGUE",
    "Effect",
    "Quantization",
    "AngleRandomWalk",
    "BiasInstability",
    "RateRandomWalk",
    "RateRamp",
    "Sinusoid",
    "DriftingSinusoid",
    "GaussMarkov",
    "RandomTelegraph",
    "Resonance",
    "DriftingResonance",
    "PowerLaw",
    "LowPass",
    "DigitalLowPass",
    "OutputLowPass",
    "HighPass",
    "Cascade",
    "DecimationFilter",
    "MovingAverage",
    "Notch",
    "ModeSplit",
]


@dataclass(frozen=True)
class Effect:
    """An effect of the catalogue. Use one of the classes below."""

    NAME: ClassVar[str] = ""
    WHOLE: ClassVar[tuple[str, ...]] = ()

    fitted: bool = dataclasses.field(default=True, kw_only=True)

    def written(self) -> str:
        """The effect as the command line writes it: ``sinusoid:frequency_hz~47.0``."""
        pairs = []
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.name == "fitted" or value is None:
                continue
            is_whole = field.name in self.WHOLE
            sign = "~" if self.fitted and not is_whole else "="
            pairs.append(f"{field.name}{sign}{int(value) if is_whole else float(value)!r}")
        return self.NAME + (":" + ",".join(pairs) if pairs else "")


@dataclass(frozen=True)
class Quantization(Effect):
    """Rounding to counts: the coefficient Q, in the unit of the angle."""

    NAME: ClassVar[str] = "quantization"


@dataclass(frozen=True)
class AngleRandomWalk(Effect):
    """White noise of the rate: the coefficient N, in rate unit/√Hz."""

    NAME: ClassVar[str] = "angle_random_walk"


@dataclass(frozen=True)
class BiasInstability(Effect):
    """Flicker noise of the rate: the coefficient B, in the rate unit."""

    NAME: ClassVar[str] = "bias_instability"


@dataclass(frozen=True)
class RateRandomWalk(Effect):
    """A random walk of the rate: the coefficient K, in rate unit/√s."""

    NAME: ClassVar[str] = "rate_random_walk"


@dataclass(frozen=True)
class RateRamp(Effect):
    """A steady drift of the rate: the coefficient R, in rate unit/s."""

    NAME: ClassVar[str] = "rate_ramp"


@dataclass(frozen=True)
class Sinusoid(Effect):
    """A steady oscillation of one frequency, in Hz; the coefficient is its amplitude, in the rate unit."""

    NAME: ClassVar[str] = "sinusoid"
    frequency_hz: float | None = None


@dataclass(frozen=True)
class DriftingSinusoid(Effect):
    """A sinusoid whose frequency, in Hz, drifts over a range of ``drift_hz``; the coefficient is its amplitude."""

    NAME: ClassVar[str] = "drifting_sinusoid"
    frequency_hz: float | None = None
    drift_hz: float | None = None


@dataclass(frozen=True)
class GaussMarkov(Effect):
    """Exponentially correlated noise with a correlation time in s; the coefficient is its rms, in the rate unit."""

    NAME: ClassVar[str] = "gauss_markov"
    correlation_time_s: float | None = None


@dataclass(frozen=True)
class RandomTelegraph(Effect):
    """Jumps between two levels with a correlation time in s; the coefficient is the rms, in the rate unit."""

    NAME: ClassVar[str] = "random_telegraph"
    correlation_time_s: float | None = None


@dataclass(frozen=True)
class Resonance(Effect):
    """A lightly damped mode: its frequency in Hz and its quality; the coefficient is the rms, in the rate unit."""

    NAME: ClassVar[str] = "resonance"
    frequency_hz: float | None = None
    quality: float | None = None


@dataclass(frozen=True)
class DriftingResonance(Effect):
    """A resonance whose frequency, in Hz, drifts over a range of ``drift_hz``; the coefficient is the rms."""

    NAME: ClassVar[str] = "drifting_resonance"
    frequency_hz: float | None = None
    quality: float | None = None
    drift_hz: float | None = None


@dataclass(frozen=True)
class PowerLaw(Effect):
    """Noise whose Allan deviation is a power of τ; the coefficient is the deviation at 1 s."""

    NAME: ClassVar[str] = "power_law"
    exponent: float | None = None


@dataclass(frozen=True)
class LowPass(Effect):
    """White noise behind a low pass with a cut-off in Hz or a time constant in s, and 1 or more poles; replaces N."""

    NAME: ClassVar[str] = "low_pass"
    WHOLE: ClassVar[tuple[str, ...]] = ("poles",)
    cutoff_hz: float | None = None
    poles: int | None = None
    time_constant_s: float | None = None


@dataclass(frozen=True)
class DigitalLowPass(Effect):
    """White noise behind a digital low pass of first order, with a time constant in s; replaces N."""

    NAME: ClassVar[str] = "digital_low_pass"
    time_constant_s: float | None = None


@dataclass(frozen=True)
class OutputLowPass(Effect):
    """The whole output behind a low pass of first order, with a time constant in s; replaces N."""

    NAME: ClassVar[str] = "output_low_pass"
    time_constant_s: float | None = None


@dataclass(frozen=True)
class HighPass(Effect):
    """The whole output behind a high pass, with a time constant in s; replaces N."""

    NAME: ClassVar[str] = "high_pass"
    time_constant_s: float | None = None


@dataclass(frozen=True)
class Cascade(Effect):
    """White noise behind a cascade of equal stages, with a time constant in s; replaces N."""

    NAME: ClassVar[str] = "cascade"
    WHOLE: ClassVar[tuple[str, ...]] = ("stages",)
    time_constant_s: float | None = None
    stages: int | None = None


@dataclass(frozen=True)
class DecimationFilter(Effect):
    """White noise behind 1 or 2 moving averages of a width in s; replaces N."""

    NAME: ClassVar[str] = "decimation_filter"
    WHOLE: ClassVar[tuple[str, ...]] = ("stages",)
    width_s: float | None = None
    stages: int | None = None


@dataclass(frozen=True)
class MovingAverage(Effect):
    """The whole output behind a moving average of so many samples; replaces N."""

    NAME: ClassVar[str] = "moving_average"
    WHOLE: ClassVar[tuple[str, ...]] = ("samples",)
    samples: int | None = None


@dataclass(frozen=True)
class Notch(Effect):
    """White noise behind a notch of a frequency in Hz and a quality; replaces N."""

    NAME: ClassVar[str] = "notch"
    frequency_hz: float | None = None
    quality: float | None = None


@dataclass(frozen=True)
class ModeSplit(Effect):
    """White noise that rises behind a mode split: from a frequency in Hz to a corner in Hz; replaces N."""

    NAME: ClassVar[str] = "mode_split"
    rise_hz: float | None = None
    corner_hz: float | None = None


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
