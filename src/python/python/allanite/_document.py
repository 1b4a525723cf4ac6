"""Documents of JSON as frozen dataclasses."""

from __future__ import annotations

import dataclasses
import functools
import types
import typing
from typing import Any, TypeVar

T = TypeVar("T")


@functools.cache
def _hints(kind: Any) -> dict[str, Any]:
    return typing.get_type_hints(kind)


def build(kind: type[T], document: dict[str, Any], **more: Any) -> T:
    """The dataclass that has these numbers. What a document leaves out is the default of its field."""
    hints = _hints(kind)  # type: ignore[arg-type]
    fields = {}
    for field in dataclasses.fields(kind):  # type: ignore[arg-type]
        if field.name in more:
            fields[field.name] = more[field.name]
        elif field.name in document:
            fields[field.name] = _value(hints[field.name], document[field.name])
    return kind(**fields)


def _value(hint: Any, value: Any) -> Any:
    if value is None:
        return None
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (typing.Union, types.UnionType):
        inner = [one for one in arguments if one is not type(None)]
        return _value(inner[0], value)
    if origin is tuple:
        return tuple(_value(arguments[0], one) for one in value)
    if dataclasses.is_dataclass(hint):
        return build(hint, value)  # type: ignore[arg-type]
    return value


def rows(parts: Any, **first: Any) -> list[dict[str, Any]]:
    """Dataclasses as rows, with these columns in front."""
    return [{**first, **_flat(part)} for part in parts]


def _flat(part: Any) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        if isinstance(value, dict):
            row.update(value)
        elif not isinstance(value, tuple) and not dataclasses.is_dataclass(value):
            row[field.name] = value
    return row


def table(rows: list[dict[str, Any]]) -> Any:
    """The rows as a ``pandas.DataFrame`` if pandas is installed, or else as they are."""
    try:
        import pandas
    except ImportError:
        return rows
    return pandas.DataFrame(rows)
