"""The five terms fitted to the axes of a record."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _document, _native, _options
from ._axes import Axes
from ._model import Model
from ._page import html_table, paragraphs
from ._parts import Coefficient, Covariate, FilterShape, Limit, Octave
from ._source import Source
from .effects import Effect

if TYPE_CHECKING:
    from ._diagnosis import Diagnosis


@dataclass(frozen=True)
class AxisFit:
    """The five terms fitted to one axis.

    Attributes
    ----------
    axis : str
        The axis of the record.
    rate_hz : float
        Samples per second.
    unit : str
        The rate unit: ``deg/s``, ``rad/s``, ``m/s^2`` or ``g``.
    octaves : tuple of Octave
        The Allan curve, shortest averaging time first.
    coefficients : tuple of Coefficient
        Q, N, B, K and R with their 95 % intervals.
    chi2, dof, p_value
        χ² of octaves and bins, its degrees of freedom, and the probability of a larger one; ``None`` if the method has none.
    adequate : bool or None
        Whether the five terms explain a valid curve and a diagnosis finds nothing else; ``None`` if the record does not tell.
    verdict : str or None
        The verdict of the diagnosis, as :class:`AxisDiagnosis` has it.
    missing : tuple of str
        The effects and the covariate that the five terms lack.
    birge_ratio : float
        The factor by which the intervals are widened: √(χ²/degrees of freedom) of a model that is not adequate.
    invalid : str or None
        Why the curve is not valid, if it is not.
    """

    axis: str
    rate_hz: float
    unit: str
    octaves: tuple[Octave, ...]
    method: str
    coefficients: tuple[Coefficient, ...]
    chi2: float | None
    dof: int | None
    p_value: float | None
    adequate: bool | None
    verdict: str | None
    missing: tuple[str, ...]
    birge_ratio: float | None
    invalid: str | None
    covariates: tuple[Covariate, ...]
    notes: tuple[str, ...]
    filter: FilterShape | None = None
    limits: tuple[Limit, ...] = ()
    _of: Fit = field(default=None, repr=False, compare=False)  # type: ignore[assignment]

    @property
    def model(self) -> Model:
        """The five terms beside the record, to which effects are added: ``fit["gx"].model + Sinusoid(47)``."""
        return Model._fit(self._of.record, self.axis, filter=self._of._filter)

    def __getitem__(self, symbol: str) -> Coefficient:
        """The coefficient of a term, by its symbol or its name: ``fit["gx"]["N"]``."""
        for coefficient in self.coefficients:
            if symbol in (coefficient.symbol, coefficient.effect):
                return coefficient
        raise KeyError(symbol)


@dataclass(frozen=True)
class Fit(Axes[AxisFit]):
    """The five terms fitted to every axis of a record: ``fit["gx"]["N"].value``.

    Attributes
    ----------
    axes : tuple of AxisFit
        One for each axis of the record, in its order.
    record : Record
        The record.
    """

    axes: tuple[AxisFit, ...]
    record: Source = field(repr=False, compare=False)
    _filter: str | None = field(default=None, repr=False, compare=False)
    _document: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)
    _text: str = field(default="", repr=False, compare=False)

    @classmethod
    def _of(cls, record: Source, options: _options.Options, filter: str | None) -> Fit:
        text, printed = record._native_handle().fit(options)
        document = json.loads(text)
        axes = tuple(_document.build(AxisFit, axis) for axis in document["axes"])
        return cls(axes, record, filter, document, printed)

    def __post_init__(self) -> None:
        for axis in self.axes:
            object.__setattr__(axis, "_of", self)

    @property
    def model(self) -> Model:
        """The five terms beside the only axis."""
        return self[None].model

    def diagnose(
        self,
        *,
        max_effects: int | None = None,
        filter: Effect | str | None = None,
        own: str | Iterable[str] = (),
        progress: Callable[[float], object] | None = None,
    ) -> Diagnosis:
        """Finds the effects that the five terms lack: see :meth:`Record.diagnose`."""
        found: Diagnosis = self.record.diagnose(
            max_effects=max_effects,
            filter=filter if filter is not None else self._filter,
            own=own,
            progress=progress,
        )
        return found

    def to_dict(self) -> dict[str, Any]:
        """The document that ``allanite fit --json`` prints."""
        return self._document

    def table(self) -> Any:
        """The coefficients of all axes, a row each: a ``pandas.DataFrame`` if pandas is installed, or else a list of dictionaries."""
        return _document.table(self._rows())

    def _rows(self) -> list[dict[str, Any]]:
        return [row for axis in self.axes for row in _document.rows(axis.coefficients, axis=axis.axis)]

    def curves(self) -> Any:
        """The Allan curves of all axes, an octave a row, in the form of :meth:`table`."""
        rows = [row for axis in self.axes for row in _document.rows(axis.octaves, axis=axis.axis)]
        return _document.table(rows)

    def __str__(self) -> str:
        return self._text.rstrip()

    def _repr_html_(self) -> str:
        columns = ("axis", "effect", "symbol", "value", "lower", "upper", "unit", "state")
        lines = [_judged(axis) for axis in self.axes]
        pictures = "".join(axis.model.plot().svg for axis in self.axes)
        return paragraphs(lines) + html_table(self._rows(), columns) + pictures


def _judged(axis: AxisFit) -> str:
    said = _native.explained(axis.adequate)
    if axis.adequate is False:
        said += ": diagnose() finds what is missing"
    chi2 = "" if axis.chi2 is None else f" (χ² {axis.chi2:.1f}, {axis.dof} degrees of freedom)"
    return f"{axis.axis}: {axis.invalid or said}{chi2}"
