"""Records of many devices on an engine for tables: SQL functions for DataFusion, and the same for Spark, Ray and others.

A state is what :class:`allanite.Pieces` keep of one axis, as bytes in a column. It does not depend on how the rows are
partitioned, and states merge in any order, so that an engine may cut, shuffle and repeat as it likes.

>>> from datafusion import SessionContext                                        # doctest: +SKIP
>>> context = allanite.fleet.register(SessionContext())                          # doctest: +SKIP
>>> context.register_parquet("logs", "logs/")                                    # doctest: +SKIP
>>> context.sql("SELECT device, axis, allan_fit(allan_state(start, counts, rate, scale), 'deg/s') AS fit "
...             "FROM logs GROUP BY device, axis")                               # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ._error import AllaniteError
from ._pieces import Pieces

if TYPE_CHECKING:
    import pyarrow as pa

#: The symbols of the coefficients, as the fields of ``allan_fit`` are named.
SYMBOLS = ("Q", "N", "B", "K", "R")


class _States:
    """The state of one axis while rows arrive: what DataFusion calls an accumulator."""

    def __init__(self) -> None:
        self._pieces: Pieces | None = None

    def _of(self, rate: float, scale: float) -> Pieces:
        """The pieces, which have this rate and scale."""
        if self._pieces is None:
            self._pieces = Pieces(rate=rate, scale=scale)
        elif (self._pieces.rate_hz, self._pieces.scale) != (rate, scale):
            # An empty piece of this rate and scale is refused with the right words.
            self._pieces.merge(Pieces(rate=rate, scale=scale))
        return self._pieces

    def update(self, *columns: pa.Array) -> None:
        """Adds rows: the number of a sample and its count, or the number of a first sample and a list of counts; and the rate
        in samples per second and the scale in rate units per count, which are the same in all rows."""
        numbers, samples, rates, scales = columns
        if len(numbers) == 0:
            return
        if numbers.null_count or rates.null_count or scales.null_count:
            raise AllaniteError("allan_state", None, "a row has no number, rate or scale", "leave such rows out")
        pieces = self._of(_only(rates, "rate"), _only(scales, "scale"))
        if hasattr(samples, "offsets"):
            for first, counts in zip(numbers.to_pylist(), samples, strict=True):
                if counts.values is not None:
                    _push_list(pieces, first, counts.values)
            return
        if samples.null_count:
            present = samples.is_valid()
            numbers, samples = numbers.filter(present), samples.filter(present)
        pieces.push_numbered(numbers.to_numpy(zero_copy_only=False), samples.to_numpy(zero_copy_only=False))

    def merge(self, states: Sequence[pa.Array]) -> None:
        """Adds states."""
        for state in states[0]:
            if state.is_valid:
                self.merge_bytes(state.as_py())

    def merge_bytes(self, state: bytes) -> None:
        pieces = Pieces.from_bytes(state)
        if self._pieces is None:
            self._pieces = pieces
        else:
            self._pieces.merge(pieces)

    def bytes(self) -> bytes | None:
        return None if self._pieces is None else bytes(self._pieces)


def _push_list(pieces: Pieces, first: int, counts: pa.Array) -> None:
    """A missing count is a lost sample."""
    if counts.null_count:
        import numpy as np

        present = counts.is_valid().to_numpy(zero_copy_only=False)
        numbers = np.flatnonzero(present) + first
        pieces.push_numbered(numbers, counts.drop_null().to_numpy(zero_copy_only=False))
    else:
        pieces.push(counts.to_numpy(zero_copy_only=False), first=first)


def _only(column: pa.Array, what: str) -> float:
    """The value that all rows have."""
    import pyarrow.compute as pc

    ends = pc.min_max(column).as_py()
    if ends["min"] != ends["max"]:
        raise AllaniteError(
            "allan_state", None, f"one axis of one device has the {what}s {ends['min']} and {ends['max']}",
            f"group by the {what} too",
        )
    return float(ends["min"])


def states(batches: Iterable[Any], keys: Sequence[str] = ("device", "axis")) -> Iterator[pa.RecordBatch]:
    """The states of the rows of Arrow batches: for ``mapInArrow`` of Spark, ``map_batches`` of Ray and others.

    Parameters
    ----------
    batches : iterable of pyarrow.RecordBatch
        With the columns ``keys``, ``start``, ``counts``, ``rate`` and ``scale``; ``counts`` are lists, or single counts.
    keys : sequence of str
        The columns that tell the axes apart.

    Yields
    ------
    pyarrow.RecordBatch
        One, with the columns ``keys`` and ``state``: a row for each axis.
    """
    found: dict[tuple[Any, ...], _States] = {}
    for batch in batches:
        for key, rows in _grouped(batch, keys):
            columns = [rows.column(name).combine_chunks() for name in ("start", "counts", "rate", "scale")]
            found.setdefault(key, _States()).update(*columns)
    yield _batch(found, keys)


def merged(batches: Iterable[Any], keys: Sequence[str] = ("device", "axis")) -> Iterator[pa.RecordBatch]:
    """The states of all rows with the same keys, of batches as :func:`states` yields them."""
    found: dict[tuple[Any, ...], _States] = {}
    for batch in batches:
        for key, rows in _grouped(batch, keys):
            found.setdefault(key, _States()).merge([rows.column("state").combine_chunks()])
    yield _batch(found, keys)


def _grouped(batch: Any, keys: Sequence[str]) -> Iterator[tuple[tuple[Any, ...], pa.Table]]:
    import pyarrow as pa

    table = pa.table(batch) if not isinstance(batch, pa.RecordBatch) else pa.Table.from_batches([batch])
    numbered = table.append_column("row number", pa.array(range(len(table)), pa.int64()))
    groups = numbered.group_by(list(keys)).aggregate([("row number", "list")])
    for group in groups.to_pylist():
        rows = pa.array(group["row number_list"], pa.int64())
        yield tuple(group[key] for key in keys), table.take(rows)


def _batch(found: dict[tuple[Any, ...], _States], keys: Sequence[str]) -> pa.RecordBatch:
    import pyarrow as pa

    columns = [pa.array([key[at] for key in found]) for at in range(len(keys))]
    states = pa.array([state.bytes() for state in found.values()], pa.binary())
    return pa.RecordBatch.from_arrays([*columns, states], names=[*keys, "state"])


def fit(state: bytes, unit: str = "deg/s") -> dict[str, Any]:
    """The five terms of a state: the row that ``allan_fit`` gives."""
    pieces = Pieces.from_bytes(state)
    row: dict[str, Any] = {"samples": pieces.samples, "stretches": len(pieces.stretches)}
    try:
        axis = pieces.record(unit=unit).fit().axes[0]
    except AllaniteError as error:
        return row | {"invalid": _of_axis(error)}
    row |= {"invalid": axis.invalid, "adequate": axis.adequate, "chi2": axis.chi2, "dof": axis.dof}
    for coefficient in axis.coefficients:
        observed = coefficient.state == "measured"
        row[coefficient.symbol] = coefficient.value if observed else None
        row[f"{coefficient.symbol}_lower"] = coefficient.lower if observed else None
        row[f"{coefficient.symbol}_upper"] = coefficient.upper
    return row


def diagnose(state: bytes, unit: str = "deg/s") -> dict[str, Any]:
    """The diagnosis of a state: the row that ``allan_diagnose`` gives."""
    try:
        diagnosis = Pieces.from_bytes(state).record(unit=unit).diagnose()
    except AllaniteError as error:
        return {"verdict": None, "missing": None, "conclusion": _of_axis(error)}
    axis = diagnosis.axes[0]
    return {"verdict": axis.verdict, "missing": list(axis.missing), "conclusion": " ".join(diagnosis._conclusion)}


def _of_axis(error: AllaniteError) -> str:
    """Why an axis cannot be fitted, which must not end the query over all others; a wrong unit or damaged bytes do."""
    if error.axis is None:
        raise error
    return f"{error.what}; {error.remedy}"


def register(context: Any) -> Any:
    """Gives a ``datafusion.SessionContext`` the functions, and returns it.

    ``allan_state(start, counts, rate, scale)``
        Aggregate: the state of one axis of one device. ``start`` is the number of the first sample of a row in the record,
        ``counts`` a list of whole numbers of 32 bits, ``rate`` in samples per second, ``scale`` in rate units per count.
    ``allan_state_of_samples(number, count, rate, scale)``
        Aggregate: the same with one sample a row.
    ``allan_merge(state)``
        Aggregate: the state of all parts.
    ``allan_samples(state)``
        The number of samples.
    ``allan_fit(state, unit)``
        A struct of the five coefficients with their 95 % intervals: ``N``, ``N_lower``, ``N_upper`` and so on, in the unit times
        the powers of s of IEEE Std 952, ``NULL`` where the record does not show one; ``adequate``, ``chi2``, ``dof``; ``invalid``
        says why the samples are not those of a gyro at rest.
    ``allan_diagnose(state, unit)``
        A struct of ``verdict``, ``missing`` (a list of effects) and ``conclusion`` in words.
    """
    import datafusion
    import pyarrow as pa

    class Accumulator(_States, datafusion.Accumulator):
        def state(self) -> list[Any]:
            return [pa.scalar(self.bytes(), pa.binary())]

        def evaluate(self) -> Any:
            return self.state()[0]

    class Merging(Accumulator):
        def update(self, *columns: Any) -> None:
            self.merge(columns)

    def aggregate(name: str, accumulator: Any, inputs: list[Any]) -> None:
        made = datafusion.udaf(accumulator, inputs, pa.binary(), [pa.binary()], "immutable", name)
        context.register_udaf(made)

    def scalar(name: str, function: Any, inputs: list[Any], output: Any) -> None:
        def rows(*columns: Any) -> Any:
            lists = [column.to_pylist() for column in columns]
            found = [None if row[0] is None else function(*row) for row in zip(*lists, strict=True)]
            return pa.array(found, output)

        context.register_udf(datafusion.udf(rows, inputs, output, "immutable", name))

    numbers, of_sensor = pa.int64(), [pa.float64(), pa.float64()]
    aggregate("allan_state", Accumulator, [numbers, pa.list_(pa.int32()), *of_sensor])
    aggregate("allan_state_of_samples", Accumulator, [numbers, pa.int32(), *of_sensor])
    aggregate("allan_merge", Merging, [pa.binary()])
    fields = [("samples", pa.int64()), ("stretches", pa.int64()), ("invalid", pa.string())]
    fields += [("adequate", pa.bool_()), ("chi2", pa.float64()), ("dof", pa.int64())]
    fields += [(f"{symbol}{end}", pa.float64()) for symbol in SYMBOLS for end in ("", "_lower", "_upper")]
    fitted = pa.struct(fields)
    diagnosed = pa.struct([("verdict", pa.string()), ("missing", pa.list_(pa.string())), ("conclusion", pa.string())])
    scalar("allan_samples", lambda state: Pieces.from_bytes(state).samples, [pa.binary()], pa.int64())
    scalar("allan_fit", fit, [pa.binary(), pa.string()], fitted)
    scalar("allan_diagnose", diagnose, [pa.binary(), pa.string()], diagnosed)
    return context
