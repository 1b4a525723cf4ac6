"""Records: what is kept of a log or of arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from . import _columns, _document, _native, _options
from ._axes import Axes
from ._diagnosis import Diagnosis
from ._error import AllaniteError
from ._fit import Fit
from ._model import filter_text
from ._page import html_table, paragraphs
from ._curve import Curve
from .effects import Effect

Progress = Callable[[float], object]


class Record(Axes[Curve]):
    """The axes of a log, as everything that a fit and a diagnosis need: a few kilobytes for each axis, and no samples.

    Make one with :func:`read`, :meth:`from_numpy`, :meth:`from_pandas` or :meth:`from_arrow`. Records can be pickled.

    Attributes
    ----------
    axes : tuple of Curve
        The Allan curve of every axis: ``record["gx"].octaves``.
    rate_hz : float
        Samples per second.
    unit : str
        The rate unit: ``deg/s``, ``rad/s``, ``m/s^2`` or ``g``.
    samples : int
        Samples of each axis.
    notes : tuple of str
        What the reader decided without being asked.
    path : str
        Where the record comes from.
    """

    def __init__(self, native: _native.Record) -> None:
        self._native = native
        self._document: dict[str, Any] = json.loads(native.describe())
        self.axes = tuple(_document.build(Curve, axis) for axis in self._document["axes"])
        self.notes: tuple[str, ...] = tuple(self._document["notes"])
        self.path: str = self._document["path"]

    @property
    def rate_hz(self) -> float:
        """Samples per second."""
        return self.axes[0].rate_hz

    @property
    def unit(self) -> str:
        """The rate unit."""
        return self.axes[0].unit

    @property
    def samples(self) -> int:
        """Samples of each axis."""
        return self.axes[0].samples

    @classmethod
    def from_numpy(
        cls,
        samples: Any,
        *,
        rate: float | None = None,
        scale: float | None = None,
        unit: str | None = None,
        names: Sequence[str] | None = None,
        time: Any = None,
        time_unit: str | None = None,
        columns: Any = None,
        covariates: Any = None,
        name: str = "array",
        progress: Progress | None = None,
        **options: Any,
    ) -> Record:
        """A record of an array, which is not copied.

        Parameters
        ----------
        samples : array of shape (n,) or (n, axes), structured array, or mapping from names to arrays of shape (n,)
            Counts, or rates in ``unit``: integers of 1 to 8 bytes or floats of 4 or 8 bytes, in any memory order. A row with a
            value that is not finite is a lost sample.
        rate : float, optional
            Samples per second. Without it, ``time`` is needed.
        scale : float, optional
            Rate units per count. 1 unless given.
        unit : str, optional
            ``deg/s`` (the default), ``rad/s``, ``m/s^2`` or ``g``.
        names : sequence of str, optional
            The names of the columns of a two-dimensional array, such as ``["gx", "gy", "gz"]``.
        time : array of shape (n,), optional
            Time stamps, from which the rate and the gaps follow: ``datetime64``, or numbers in ``time_unit``.
        time_unit : str, optional
            ``s``, ``ms``, ``us`` or ``ns``.
        columns, covariates, **options
            As of :func:`read`.
        name : str
            What stands for the file in messages.
        progress : callable, optional
            Called with the share of the rows that are read, 0 to 1. What it raises ends the reading.

        Raises
        ------
        AllaniteError
            With the place, what is wrong, and the remedy.
        """
        lent = _columns.of_arrays(samples, names, time)
        time_name = None if time is None else _columns.TIME
        return cls._of_columns(
            lent, name, progress, rate=rate, scale=scale, unit=unit, time=time_name,
            time_unit=time_unit, columns=columns, covariates=covariates, **options,
        )

    @classmethod
    def from_pandas(
        cls,
        frame: Any,
        *,
        rate: float | None = None,
        scale: float | None = None,
        unit: str | None = None,
        time: str | None = None,
        time_unit: str | None = None,
        columns: Any = None,
        covariates: Any = None,
        name: str = "frame",
        progress: Progress | None = None,
        **options: Any,
    ) -> Record:
        """A record of a ``pandas.DataFrame`` or ``Series``, whose columns are not copied if they are of NumPy's types.

        The columns are chosen as those of a log: by ``columns``, or by their names. An index of dates, times or time differences
        is the time unless ``rate`` is given. The other parameters are those of :meth:`from_numpy`; ``time`` is the name of a
        column.
        """
        lent, index = _columns.of_frame(frame)
        if time is None and rate is None and index is not None:
            time = index
        return cls._of_columns(
            lent, name, progress, rate=rate, scale=scale, unit=unit, time=time,
            time_unit=time_unit, columns=columns, covariates=covariates, **options,
        )

    @classmethod
    def from_arrow(
        cls,
        table: Any,
        *,
        rate: float | None = None,
        scale: float | None = None,
        unit: str | None = None,
        time: str | None = None,
        time_unit: str | None = None,
        columns: Any = None,
        covariates: Any = None,
        name: str = "table",
        progress: Progress | None = None,
        **options: Any,
    ) -> Record:
        """A record of any table with ``__arrow_c_stream__`` (Arrow's PyCapsule): of pyarrow, polars, pandas, DuckDB and others.

        The buffers are not copied. Columns of numbers and of time stamps are seen, others are not. A row with a value that is
        missing is a lost sample. The parameters are those of :meth:`from_pandas`.
        """
        if not hasattr(table, "__arrow_c_stream__"):
            raise AllaniteError(
                None, None, f"a {type(table).__name__} has no __arrow_c_stream__",
                "give a table of pyarrow, polars, pandas or DuckDB",
            )
        written = _read_options(
            rate=rate, scale=scale, unit=unit, time=time, time_unit=time_unit, columns=columns,
            covariates=covariates, **options,
        )
        return cls(_native.Record.of_arrow(name, table, written, progress))

    @classmethod
    def _of_columns(
        cls, lent: list[tuple[str, Any]], name: str, progress: Progress | None, **options: Any
    ) -> Record:
        return cls(_native.Record.of_arrays(name, lent, _read_options(**options), progress))

    def fit(
        self,
        *,
        method: str | None = None,
        filter: Effect | str | None = None,
        limits: Mapping[str, Any] | Sequence[str] | None = None,
    ) -> Fit:
        """Fits the five coefficients of IEEE Std 952 to every axis, as ``allanite fit`` does, to the bit.

        Parameters
        ----------
        method : str, optional
            ``covariance`` unless given; ``ordinary`` and others are baselines.
        filter : Effect or str, optional
            A filter on the white noise that is known: ``LowPass(cutoff_hz=42, poles=2)``.
        limits : mapping, optional
            The largest value that a coefficient may have: ``{"N": 0.005}``, in the unit of the record, or ``{"N": "0.3°/√h"}``.
        """
        if isinstance(limits, Mapping):
            limits = [f"{effect}={_options.text(value)}" for effect, value in limits.items()]
        text = filter_text(filter)
        options = _options.given(method=method, filter=text) | _options.repeated("limit", limits)
        return Fit._of(self, options, text)

    def diagnose(
        self,
        *,
        max_effects: int | None = None,
        filter: Effect | str | None = None,
        own: str | Iterable[str] = (),
        progress: Progress | None = None,
    ) -> Diagnosis:
        """Finds, one by one, the effects that the five terms lack, as ``allanite diagnose`` does, to the bit.

        Parameters
        ----------
        max_effects : int, optional
            The largest number of effects to add; 4 unless given.
        filter : Effect or str, optional
            A filter on the white noise that is known.
        own : str or iterable of str, optional
            Effects that are tried beside the catalogue, as formulas: ``"density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30"``.
        progress : callable, optional
            Called with the share of the axes that are done, 0 to 1.
        """
        text = filter_text(filter)
        options = _options.given(max_effects=max_effects, filter=text) | _options.repeated("try", own)
        return Diagnosis._of(self, options, text, progress)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the curves to a curve file, as ``allanite measure`` does. Its name has to end in ``.json``."""
        if not os.fspath(path).endswith(".json"):
            raise AllaniteError(os.fspath(path), None, "a curve file ends in .json", "rename it")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self._native.curve_file())

    def to_dict(self) -> dict[str, Any]:
        """The curves of all axes as a document, with the exact sums of squares in counts²."""
        return self._document

    def table(self) -> Any:
        """The Allan curves of all axes, an octave a row: a ``pandas.DataFrame`` if pandas is installed, or else a list of
        dictionaries."""
        return _document.table([row for axis in self.axes for row in _document.rows(axis.octaves, axis=axis.axis)])

    def _native_handle(self) -> _native.Record:
        return self._native

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._document == other._document

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        names = ", ".join(axis.axis for axis in self.axes)
        return f"{names}: {self.samples} samples at {self.rate_hz:g} Hz, in {self.unit}"

    def __repr__(self) -> str:
        return f"<Record of {self.path}: {self}>"

    def _repr_html_(self) -> str:
        rows = [
            {"axis": axis.axis, "samples": axis.samples, "rate_hz": axis.rate_hz, "unit": axis.unit,
             "octaves": len(axis.octaves), "not valid because": axis.invalid}
            for axis in self.axes
        ]
        return html_table(rows, list(rows[0])) + paragraphs(self.notes)

    def __reduce__(self) -> Any:
        return (_from_bytes, (self._native.to_bytes(),))


def _from_bytes(data: bytes) -> Record:
    return Record(_native.Record.from_bytes(data))


def _read_options(*, drop: Any = None, from_: Any = None, covariates: Any = None, **options: Any) -> _options.Options:
    """The options of a reader."""
    known = {"rate", "scale", "unit", "columns", "sensor", "time", "time_unit", "topic", "rows", "repeats", "to"}
    for name in options:
        if name not in known:
            raise TypeError(f"unexpected argument {name!r}; choose from {', '.join(sorted(known | {'drop', 'from_', 'covariates'}))}")
    given = _options.given(**options) | _options.given(**{"from": from_}) | _options.repeated("drop", drop)
    if covariates is False or (not isinstance(covariates, str) and covariates is not None and len(covariates) == 0):
        return given | {"no-covariates": True}
    return given | _options.given(covariates=covariates)


def read(
    path: str | os.PathLike[str],
    *,
    rate: float | None = None,
    scale: float | None = None,
    unit: str | None = None,
    columns: str | Sequence[str] | Mapping[str, Any] | None = None,
    sensor: str | None = None,
    time: str | None = None,
    time_unit: str | None = None,
    topic: str | None = None,
    rows: str | None = None,
    repeats: str | None = None,
    from_: str | None = None,
    to: str | None = None,
    drop: str | Sequence[str] | None = None,
    covariates: str | Sequence[str] | bool | None = None,
    progress: Progress | None = None,
) -> Record:
    """Reads a log in any of the formats of the command line: text, ``.npy``, ``.ulg``, bags of ROS, Parquet, Arrow, workbooks,
    MATLAB, HDF5, ArduPilot, Betaflight; or a curve file (``.json``).

    Parameters
    ----------
    path : str or path
        The file, or the folder of a bag.
    rate : float, optional
        Samples per second; from the log unless given.
    scale : float, optional
        Rate units per count; from the log unless given, or else 1.
    unit : str, optional
        Unit of the scaled values: ``deg/s``, ``rad/s``, ``m/s^2`` or ``g``.
    columns : sequence of str, or mapping from axes to columns, optional
        The columns to take as axes, by name or by number from 1: ``["gyro_x", "gyro_y"]``, ``{"gx": 2}``.
    sensor : str, optional
        ``gyro`` or ``accel``.
    time : str, optional
        The column of time stamps.
    time_unit : str, optional
        ``s``, ``ms``, ``us`` or ``ns``.
    topic : str, optional
        The topic of a bag or a ULog, or the table of a file with several.
    rows : str, optional
        The rows to read, in a log with the rows of several sensors: ``rows="SensorId=1"``.
    repeats : str, optional
        ``drop`` (the default) or ``keep`` samples that a logger repeated.
    from_, to, drop : str, optional
        What is left out: ``from_="10s"``, ``to="-12s"``, ``drop="311s..313s"``.
    covariates : sequence of str, or False, optional
        Columns that the rate may follow: ``["temp_C", "rate(temp_C)"]``. Temperatures are found by their names; ``False`` tries none.
    progress : callable, optional
        Called with the share of the file that is read, 0 to 1, in each of the two or three passes that a log of decimals takes.
        What it raises ends the reading. So does Ctrl-C.

    Returns
    -------
    Record

    Raises
    ------
    AllaniteError
        With the file, the row, what is wrong, and the remedy.
    """
    options = _read_options(
        rate=rate, scale=scale, unit=unit, columns=columns, sensor=sensor, time=time, time_unit=time_unit,
        topic=topic, rows=rows, repeats=repeats, from_=from_, to=to, drop=drop, covariates=covariates,
    )
    return Record(_native.Record.read(os.fspath(path), options, progress))
