"""What the five terms lack, step by step."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _document, _options
from ._axes import Axes
from ._model import Model
from ._page import Picture, html_table, paragraphs
from ._parts import Bin, Comb, Covariate, DetectionLimit, FilterShape, SpectralLine, Step
from ._source import Source

if TYPE_CHECKING:
    from . import _native


@dataclass(frozen=True)
class AxisDiagnosis:
    """The diagnosis of one axis.

    Attributes
    ----------
    axis : str
        The axis of the record.
    steps : tuple of Step
        From the five terms to the last model; the error falls from step to step.
    spectrum : tuple of Bin
        The spectrum of the record beside the last model.
    events : tuple of dict
        What happened during the record, such as steps of the rate or motion, with times in s.
    lines, combs : tuple
        The sinusoids of the last model, and those that are harmonics of one fundamental.
    covariates : tuple of Covariate
        The columns that were tried, such as temperatures.
    verdict : str
        ``adequate``, ``improved``, ``incomplete``, ``unexplained``, ``not_stationary``, ``invalid``, ``too_short`` …
    missing, ambiguous : tuple of str
        The effects that the five terms lack, and others that would explain the curve as well.
    detection_limits : tuple of DetectionLimit
        How large other effects would have to be to show.
    """

    axis: str
    steps: tuple[Step, ...]
    verdict: str
    missing: tuple[str, ...]
    ambiguous: tuple[str, ...]
    covariates: tuple[Covariate, ...]
    detection_limits: tuple[DetectionLimit, ...]
    notes: tuple[str, ...]
    events: tuple[dict[str, Any], ...] = ()
    spectrum: tuple[Bin, ...] = ()
    lines: tuple[SpectralLine, ...] = ()
    combs: tuple[Comb, ...] = ()
    filter: FilterShape | None = None
    _of: Diagnosis = field(default=None, repr=False, compare=False)  # type: ignore[assignment]

    @property
    def model(self) -> Model:
        """The last model beside the record, to which effects are added. What follows a covariate is subtracted before."""
        of = self._of
        last = json.loads(of._native_handle().models())[[one.axis for one in of].index(self.axis)]
        return Model._fit(of, self.axis, tuple(last["with"]), tuple(last["without"]), of._filter)

    def plot(self, *, step: int | None = None, what: Any = None, ax: Any = None) -> Any:
        """The picture of this axis: see :meth:`Diagnosis.plot`."""
        return self._of.plot(self.axis, step=step, what=what, ax=ax)


@dataclass(frozen=True)
class Diagnosis(Axes[AxisDiagnosis]):
    """The diagnosis of every axis of a record: ``diagnosis["gx"].missing``.

    ``steps``, ``missing``, ``verdict`` and ``model`` are those of the only axis, if the record has one; otherwise choose an axis first.

    Attributes
    ----------
    axes : tuple of AxisDiagnosis
        One for each axis of the record, in its order.
    record : Record
        The record.
    """

    axes: tuple[AxisDiagnosis, ...]
    record: Source = field(repr=False, compare=False)
    _search: _options.Options = field(default_factory=dict, repr=False, compare=False)
    _filter: str | None = field(default=None, repr=False, compare=False)
    _document: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)
    _text: str = field(default="", repr=False, compare=False)
    _conclusion: tuple[str, ...] = field(default=(), repr=False, compare=False)
    _kept: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def _of(
        cls,
        record: Source,
        search: _options.Options,
        filter: str | None,
        progress: Callable[[float], object] | None,
    ) -> Diagnosis:
        native = record._native_handle().diagnose(search, len(record.axes), progress)
        document = json.loads(native.json())
        axes = tuple(_document.build(AxisDiagnosis, axis) for axis in document["axes"])
        conclusion = tuple(native.conclusion())
        return cls(axes, record, search, filter, document, native.text(), conclusion, {"native": native})

    def __post_init__(self) -> None:
        for axis in self.axes:
            object.__setattr__(axis, "_of", self)

    def _native_handle(self) -> _native.Diagnosis:
        """The native diagnosis. After pickling it is made again, which gives the same bits."""
        native: _native.Diagnosis | None = self._kept.get("native")
        if native is None:
            record = self.record._native_handle()
            native = record.diagnose(self._search, len(self.record.axes), None)
            self._kept["native"] = native
        return native

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_kept": {}}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    @property
    def steps(self) -> tuple[Step, ...]:
        """The steps of the only axis."""
        return self[None].steps

    @property
    def missing(self) -> tuple[str, ...]:
        """What the five terms lack on the only axis."""
        return self[None].missing

    @property
    def verdict(self) -> str:
        """The verdict on the only axis."""
        return self[None].verdict

    @property
    def model(self) -> Model:
        """The last model of the only axis."""
        return self[None].model

    def plot(self, axis: str | None = None, *, step: int | None = None, what: Any = None, ax: Any = None) -> Any:
        """The record beside the model of a step, as a :class:`Picture`: what ``allanite plot`` draws.

        Parameters
        ----------
        axis : str, optional
            The axis; all of them, one below the other, unless one is given.
        step : int, optional
            The step whose model is drawn, 0 for the five terms; the last one unless given.
        what : str or sequence of str, optional
            ``deviation``, ``spectrum``, ``rate`` or several of them; all that the record has unless given.
        ax : matplotlib.axes.Axes, optional
            Draws the Allan deviation of one axis and its last model into these axes instead, and returns them.
        """
        if ax is not None:
            return self[axis].model.plot(ax)
        options = _options.given(axis=axis, step=step, what=what)
        return Picture(self._native_handle().svg(options))

    def to_dict(self) -> dict[str, Any]:
        """The document that ``allanite diagnose --json`` prints."""
        return self._document

    def table(self) -> Any:
        """The steps of all axes, a row each: a ``pandas.DataFrame`` if pandas is installed, or else a list of dictionaries."""
        return _document.table(self._rows())

    def _rows(self) -> list[dict[str, Any]]:
        rows = []
        for axis in self.axes:
            for number, step in enumerate(axis.steps):
                added = axis.steps[number - 1].added if number > 0 else None
                rows.append(
                    {
                        "axis": axis.axis,
                        "step": number,
                        "added": added,
                        "error": step.error,
                        "chi2": step.chi2,
                        "dof": step.dof,
                        "p_value": step.p_value,
                        "rms_percent": step.rms_percent,
                    }
                )
        return rows

    def coefficients(self) -> Any:
        """The coefficients of the last models, a row each, in the form of :meth:`table`."""
        rows = [row for axis in self.axes for row in _document.rows(axis.steps[-1].coefficients, axis=axis.axis)]
        return _document.table(rows)

    def __str__(self) -> str:
        return self._text.rstrip()

    def _repr_html_(self) -> str:
        columns = ("axis", "step", "added", "error", "dof", "p_value", "rms_percent")
        picture: Picture = self.plot()
        return paragraphs(self._conclusion) + html_table(self._rows(), columns) + picture.svg
