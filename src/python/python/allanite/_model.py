"""A model that is fitted to an axis of a record, and that effects are added to."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from typing import Any

from . import _document, _native, _options
from ._own import OwnEffect
from ._page import Picture, html_table, paragraphs
from ._parts import ComparedOctave, Coefficient, ModelEffect, Stretch, Worst
from ._source import Comparable
from .effects import Effect


@dataclass(frozen=True)
class Model:
    """The five terms and other effects, fitted to one axis of a record.

    ``model + Sinusoid(47)`` fits the model with one effect more, ``model - "rate_ramp"`` with one fewer. Both give another
    model, which knows the one before it, so that the error is seen to fall. An effect that is not in the catalogue is a formula,
    ``model + "density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30"``, or an :class:`OwnEffect`.

    Attributes
    ----------
    axis : str
        The axis of the record.
    rate_hz : float
        Samples per second.
    unit : str
        The rate unit: ``deg/s``, ``rad/s``, ``m/s^2`` or ``g``.
    effects, coefficients : tuple
        The effects with their fitted shapes, and their coefficients, in one order.
    octaves : tuple of ComparedOctave
        The record beside the model, octave by octave.
    chi2, dof, p_value
        χ² of octaves and bins, its degrees of freedom, and the probability of a larger one.
    rms_percent : float
        Root mean square of the misfit of the octaves, in percent of the variance.
    name : str
        The model in words: ``five terms + sinusoid``.
    before : Model or None
        The model that this one was made of.
    """

    axis: str
    rate_hz: float
    unit: str
    effects: tuple[ModelEffect, ...]
    coefficients: tuple[Coefficient, ...]
    octaves: tuple[ComparedOctave, ...]
    chi2: float | None
    dof: int
    p_value: float | None
    rms_percent: float | None
    worst: Worst | None
    stretches: tuple[Stretch, ...]
    words: str
    name: str = ""
    before: Model | None = field(default=None, repr=False, compare=False)
    _of: Any = field(default=None, repr=False, compare=False)
    _with: tuple[str, ...] = field(default=(), repr=False, compare=False)
    _without: tuple[str, ...] = field(default=(), repr=False, compare=False)
    _filter: str | None = field(default=None, repr=False, compare=False)
    _own: tuple[OwnEffect, ...] = field(default=(), repr=False, compare=False)
    _document: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def _fit(
        cls,
        of: Comparable,
        axis: str,
        with_: tuple[str, ...] = (),
        without: tuple[str, ...] = (),
        filter: str | None = None,
        own: tuple[OwnEffect, ...] = (),
        before: Model | None = None,
    ) -> Model:
        compared = _compared(of, axis, with_, without, filter, own)
        document = json.loads(compared.json())
        return _document.build(
            cls,
            document["axes"][0],
            name=compared.name(),
            before=before,
            _of=of,
            _with=with_,
            _without=without,
            _filter=filter,
            _own=own,
            _document=document,
        )

    @property
    def error(self) -> float | None:
        """χ², which falls when an effect is added that the record has."""
        return self.chi2

    def __add__(self, effect: Effect | OwnEffect | str) -> Model:
        """The model with one effect more, fitted to the same axis."""
        if isinstance(effect, OwnEffect):
            return self._changed(own=(*self._own, effect))
        if not isinstance(effect, (Effect, str)):
            return NotImplemented
        text = effect.written() if isinstance(effect, Effect) else effect
        name = _native.effect_name(text)
        if name in self._without:
            return self._changed(without=tuple(one for one in self._without if one != name))
        return self._changed(with_=(*self._with, text))

    def __sub__(self, effect: Effect | OwnEffect | str | type[Effect]) -> Model:
        """The model without an effect, which is given by its name, its class, or one like it."""
        name = effect if isinstance(effect, str) else effect.NAME
        own = tuple(one for one in self._own if one.NAME != name)
        if len(own) < len(self._own):
            return self._changed(own=own)
        added = [at for at, text in enumerate(self._with) if _native.effect_name(text) == name]
        if added:
            return self._changed(with_=self._with[: added[-1]] + self._with[added[-1] + 1 :])
        return self._changed(without=(*self._without, name))

    def _changed(
        self,
        with_: tuple[str, ...] | None = None,
        without: tuple[str, ...] | None = None,
        own: tuple[OwnEffect, ...] | None = None,
    ) -> Model:
        return self._fit(
            self._of,
            self.axis,
            self._with if with_ is None else with_,
            self._without if without is None else without,
            self._filter,
            self._own if own is None else own,
            self,
        )

    def __getitem__(self, symbol: str) -> Coefficient:
        """The coefficient of an effect, by its name or by its symbol."""
        for coefficient in self.coefficients:
            if symbol in (coefficient.effect, coefficient.symbol):
                return coefficient
        raise KeyError(symbol)

    def to_dict(self) -> dict[str, Any]:
        """The document that ``allanite compare --json`` prints."""
        return self._document

    def table(self) -> Any:
        """The coefficients, a row each: a ``pandas.DataFrame`` if pandas is installed, or else a list of dictionaries."""
        return _document.table(_document.rows(self.coefficients, axis=self.axis))

    def plot(self, ax: Any = None) -> Any:
        """The record beside the model: Allan deviation over the averaging time, and the spectrum, as a :class:`Picture`.

        With ``ax``, an ``Axes`` of matplotlib, the Allan deviation is drawn into that instead, and returned.
        """
        if ax is None:
            compared = _compared(self._of, self.axis, self._with, self._without, self._filter, self._own)
            return Picture(compared.svg())
        taus = [octave.tau_s for octave in self.octaves]
        ax.loglog(taus, [octave.measured for octave in self.octaves], "o", label=f"{self.axis}, measured")
        ax.loglog(taus, [octave.model for octave in self.octaves], "-", label=self.name)
        ax.set_xlabel("averaging time τ, s")
        ax.set_ylabel(f"Allan deviation σ, {self.unit}")
        ax.legend()
        return ax

    def __str__(self) -> str:
        fall = "" if self.before is None else f"{_shown(self.before.chi2)} → "
        return (
            f"{self.axis}: {self.name}: χ² {fall}{_shown(self.chi2)}, "
            f"{self.dof} degrees of freedom, p = {_probability(self.p_value)}"
        )

    def __repr__(self) -> str:
        return f"<Model of {self}>"

    def _repr_html_(self) -> str:
        rows = _document.rows(self.coefficients)
        columns = ("effect", "symbol", "value", "lower", "upper", "unit", "state")
        picture: Picture = self.plot()
        return paragraphs([str(self)]) + html_table(rows, columns) + picture.svg

    def __reduce__(self) -> Any:
        return (_again, (self._of, self.axis, self._with, self._without, self._filter, self._own, self.before))


def _again(of: Any, axis: str, with_: Any, without: Any, filter: Any, own: Any, before: Any) -> Model:
    """A model that was pickled. It is fitted again, which gives the same bits."""
    return Model._fit(of, axis, with_, without, filter, own, before)


def _compared(
    of: Comparable,
    axis: str,
    with_: tuple[str, ...],
    without: tuple[str, ...],
    filter: str | None,
    own: tuple[OwnEffect, ...],
) -> _native.Comparison:
    options = _model_options(with_, without, filter)
    return of._native_handle().compare(axis, options, [effect._native for effect in own])


def _model_options(with_: tuple[str, ...], without: tuple[str, ...], filter: str | None) -> _options.Options:
    return _options.repeated("with", with_) | _options.repeated("without", without) | _options.given(filter=filter)


def filter_text(filter: Effect | str | None) -> str | None:
    """A filter that is known, as the command line writes it."""
    if isinstance(filter, Effect):
        return replace(filter, fitted=False).written()
    return filter


def _shown(value: float | None) -> str:
    return "–" if value is None else f"{value:.1f}"


def _probability(value: float | None) -> str:
    if value is None:
        return "–"
    return "0 (below 1e-300)" if value == 0 else f"{value:.3g}"
