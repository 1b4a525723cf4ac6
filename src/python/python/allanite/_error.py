"""The exception of the package."""

from __future__ import annotations

import re

_OPTION = re.compile(r"--([a-z][a-z-]*)(?: <[^>]*>| (?=[A-Z_]+\b|-?\d))?")

_ARGUMENTS = {"from": "from_", "with": "effect", "limit": "limits", "no-covariates": "covariates"}


def _in_python(text: str) -> str:
    """The words of the command line in those of Python: ``--time-unit`` is the argument ``time_unit=``."""
    return _OPTION.sub(lambda found: _ARGUMENTS.get(found[1], found[1].replace("-", "_")) + "=", text)


class AllaniteError(ValueError):
    """Something that cannot be used, in one line: the place, what is wrong, and the remedy.

    Attributes
    ----------
    path : str or None
        The file, or what stands for it, such as ``array``.
    row : int or None
        The row of the file, counted from 1.
    what : str
        What is wrong.
    remedy : str
        What to do about it.
    axis : str or None
        The axis that cannot be measured or fitted, whereas others of the record may; ``None`` for any other failure.
    """

    def __init__(self, path: str | None, row: int | None, what: str, remedy: str, axis: str | None = None) -> None:
        super().__init__(path, row, what, remedy, axis)
        self.path = path
        self.row = row
        self.what = _in_python(what)
        self.remedy = _in_python(remedy)
        self.axis = axis

    def __str__(self) -> str:
        place = "" if self.path is None else f"{self.path}:"
        if self.row is not None:
            place += f"{self.row}:"
        axis = "" if self.axis is None else f"axis {self.axis}: "
        return f"{place}{' ' if place else ''}{axis}{self.what}; {self.remedy}"
