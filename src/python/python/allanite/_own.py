"""Effects of one's own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import _native


class OwnEffect:
    """An effect that is not in the catalogue, as a function of the lag: ``model + OwnEffect("bench", covariance)``.

    Everything that a fit needs follows from one function, the generalised covariance G of the angle: half of the variance of the
    angle between two samples that are ``lag_s`` apart is G(0) - G(lag_s). The angle is the sum of the samples times their interval.
    For a rate with the autocovariances r(0), r(1), … at lags of whole samples τ₀, G(n) = -τ₀²/2 · [n r(0) + 2 Σ (n - l) r(l)], with
    the sum over l from 1 to n - 1. A constant and a multiple of the squared lag are free.

    Parameters
    ----------
    name : str
        In lower case with underscores; not one of the catalogue.
    covariance : callable
        G at a lag in s, a multiple of the sample interval, for a coefficient of one: a float, in s² times the rate unit squared.
        It is called once for every lag, some ten thousand times for a fit.
    symbol : str
        The symbol of the coefficient.
    half_seconds : int
        The power of √s in the unit of the coefficient, which is 0 for an rms in the rate unit.

    Notes
    -----
    The function is kept until the program ends. Where an effect of the catalogue has a closed form for the weights of the octaves,
    one's own is interpolated, so that coefficients agree within a standard error.
    """

    def __init__(
        self, name: str, covariance: Callable[[float], float], *, symbol: str = "c", half_seconds: int = 0
    ) -> None:
        self.NAME = name
        self._arguments = (name, covariance, symbol, half_seconds)
        self._native = _native.OwnEffect(name, symbol, half_seconds, covariance)

    def __repr__(self) -> str:
        return f"OwnEffect({self.NAME!r})"

    def __reduce__(self) -> Any:
        return (_again, self._arguments)


def _again(name: str, covariance: Callable[[float], float], symbol: str, half_seconds: int) -> OwnEffect:
    return OwnEffect(name, covariance, symbol=symbol, half_seconds=half_seconds)
