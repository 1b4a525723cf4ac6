"""Arrays and frames as columns of plain numbers, without copying what is plain already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._error import AllaniteError

TIME = "time"
"""The name of the column of time stamps that are given beside an array."""

_KINDS = "iuf"


def of_arrays(samples: Any, names: Sequence[str] | None, time: Any) -> list[tuple[str, Any]]:
    """The columns of an array, or of a mapping from names to arrays."""
    fields = getattr(getattr(samples, "dtype", None), "names", None)
    if fields:
        # A structured array is a table of its fields.
        samples = {name: samples[name] for name in fields}
    if isinstance(samples, Mapping):
        columns = [_plain(name, _array(array)) for name, array in samples.items()]
    else:
        array = _array(samples)
        if array.ndim not in (1, 2):
            raise AllaniteError(
                "array", None, f"the array has {array.ndim} dimensions",
                "give one or two, with samples as rows and axes as columns",
            )
        if array.ndim == 2 and array.shape[1] > 64:
            raise AllaniteError(
                "array", None, f"the array has {array.shape[0]} rows and {array.shape[1]} columns",
                "give its transpose, because rows are samples",
            )
        parts = [array] if array.ndim == 1 else [array[:, column] for column in range(array.shape[1])]
        if names is None:
            names = [""] * len(parts)
        elif isinstance(names, str):
            names = [names]
        if len(names) != len(parts):
            raise AllaniteError(
                "array", None, f"{len(names)} names for {len(parts)} columns", "give a name for each column"
            )
        columns = [_plain(name, part) for name, part in zip(names, parts)]
    if time is not None:
        # Without names, the columns have to be told from the time.
        columns = [(name or f"c{at}", array) for at, (name, array) in enumerate(columns, 1)]
        columns.insert(0, _plain(TIME, _array(time)))
    lengths = {len(array) for _, array in columns}
    if len(lengths) > 1:
        raise AllaniteError("array", None, f"the columns have {sorted(lengths)} rows", "give columns of one length")
    return columns


def _array(samples: Any) -> Any:
    """An array. Values that are masked are missing."""
    if isinstance(samples, np.ma.MaskedArray) and np.ma.is_masked(samples):
        return np.ma.filled(samples.astype("f8"), np.nan)
    return np.asarray(samples)


def of_frame(frame: Any) -> tuple[list[tuple[str, Any]], str | None]:
    """The columns of a frame of pandas that hold numbers or times, and the name of the time if the index is one."""
    if hasattr(frame, "to_frame") and not hasattr(frame, "columns"):
        frame = frame.to_frame()
    columns = []
    for place, label in enumerate(frame.columns):
        array = _numbers(frame.iloc[:, place])
        if array is not None:
            columns.append(_plain(str(label), array))
    index = frame.index
    # Only an index of dates and times has a time zone, and only one of time differences has their seconds.
    if hasattr(index, "tz") or hasattr(index, "total_seconds"):
        if getattr(index, "tz", None) is not None:
            index = index.tz_convert("UTC").tz_localize(None)
        name, array = _plain(str(index.name or TIME), index.to_numpy())
        columns.insert(0, (name, array))
        return columns, name
    return columns, None


def _numbers(series: Any) -> Any:
    """The values of a column, or ``None`` if they are no numbers. Missing values of pandas' own types become NaN."""
    kind = series.dtype
    if isinstance(kind, np.dtype):
        return series.to_numpy() if kind.kind in _KINDS + "Mm" else None
    if hasattr(kind, "tz"):
        return series.dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()
    if getattr(kind, "kind", None) in tuple(_KINDS):
        return series.to_numpy(dtype="f8", na_value=np.nan) if series.isna().any() else series.to_numpy(dtype=kind.numpy_dtype)
    return None


def _plain(name: str, array: Any) -> tuple[str, Any]:
    """A column of native numbers. Times become nanoseconds, which the name of the column says."""
    if array.ndim != 1:
        raise AllaniteError("array", None, f"column {name} has {array.ndim} dimensions", "give one dimension")
    kind = array.dtype
    if kind.kind in "Mm":
        nanoseconds = array.astype(f"{kind.kind}8[ns]", copy=False).view("i8")
        return f"{name} [ns]", nanoseconds
    if kind.kind == "b":
        array = array.view("u1")
    elif kind.kind not in _KINDS or kind.itemsize > 8:
        raise AllaniteError(
            "array", None, f"elements of type {kind} are not plain numbers", 'convert them: samples.astype("f8")'
        )
    elif kind.itemsize == 2 and kind.kind == "f":
        array = array.astype("f4")
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return name, array if array.flags.aligned else array.copy()
