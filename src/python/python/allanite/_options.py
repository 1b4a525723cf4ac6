"""Arguments of Python as the options of the native part, by the names that they have on the command line."""

from __future__ import annotations

import numbers
import os
from collections.abc import Iterable
from typing import Any, Union

Options = dict[str, Union[bool, float, str, "list[str]"]]


def given(**arguments: Any) -> Options:
    """The options that these arguments stand for. ``None`` and ``False`` stand for none; numbers and texts stay what they are."""
    options: Options = {}
    for name, value in arguments.items():
        if value is None or value is False:
            continue
        option = name.rstrip("_").replace("_", "-")
        if isinstance(value, (bool, str)):
            options[option] = value
        elif isinstance(value, numbers.Real):
            options[option] = float(value)
        elif isinstance(value, dict):
            options[option] = [f"{key}={text(one)}" for key, one in value.items()]
        elif isinstance(value, Iterable) and not isinstance(value, os.PathLike):
            options[option] = [text(one) for one in value]
        else:
            options[option] = text(value)
    return options


def repeated(option: str, values: Any) -> Options:
    """An option that has a list of values, of which one may be given alone."""
    if values is None:
        return {}
    if isinstance(values, (str, os.PathLike)) or not isinstance(values, Iterable):
        values = [values]
    return {option: [text(value) for value in values]}


def text(value: Any) -> str:
    """A value as the command line writes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, dict):
        return ",".join(f"{key}={text(one)}" for key, one in value.items())
    if isinstance(value, Iterable):
        return ",".join(text(one) for one in value)
    return repr(float(value))
