"""Arguments of Python as the options of the command line, which one parser reads for both."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any


def written(**arguments: Any) -> list[str]:
    """The options that these arguments stand for. ``None`` and ``False`` stand for none, and ``True`` for one without a value.

    Numbers are written with as many digits as tell them apart from all others, so that none changes on the way.
    """
    options = []
    for name, value in arguments.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            options.append(option)
        else:
            options.append(f"{option}={text(value)}")
    return options


def repeated(option: str, values: Any) -> list[str]:
    """An option that is given once for each value."""
    if values is None:
        return []
    if isinstance(values, (str, os.PathLike)) or not isinstance(values, Iterable):
        values = [values]
    return [f"--{option}={text(value)}" for value in values]


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
