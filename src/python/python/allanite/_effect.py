"""What all effects of the catalogue share."""

from __future__ import annotations

import dataclasses
import math
import numbers
from dataclasses import dataclass
from typing import Any, ClassVar

from . import _native
from ._error import AllaniteError


@dataclass(frozen=True)
class Effect:
    """What every class of an effect has, such as ``Sinusoid``.

    Attributes
    ----------
    fitted : bool
        Whether the shape is fitted, from the given parameters on. With ``False``, the parameters are the shape itself.

    Raises
    ------
    AllaniteError
        If the command line would refuse a parameter, in its words.
    """

    NAME: ClassVar[str] = ""
    WHOLE: ClassVar[tuple[str, ...]] = ()

    fitted: bool = dataclasses.field(default=True, kw_only=True)

    def __post_init__(self) -> None:
        for name, value in self._given():
            # A bool is an integer to Python.
            if isinstance(value, bool) or not isinstance(value, numbers.Real):
                kind = type(value).__name__
                raise AllaniteError(None, None, f"effect {self.NAME}: {name} is a {kind}", "give a number, such as 0.3")
        if not isinstance(self.fitted, bool):
            kind = type(self.fitted).__name__
            raise AllaniteError(None, None, f"effect {self.NAME}: fitted is a {kind}", "give True or False")
        try:
            _native.check_effect(self.written(), self.fitted)
        except AllaniteError as refused:
            remedy = refused.remedy.replace(f"write {self.NAME}:", "give ")
            raise AllaniteError(None, None, refused.what, remedy) from None

    def _given(self) -> list[tuple[str, Any]]:
        """The shape parameters that are given."""
        names = [field.name for field in dataclasses.fields(self) if field.name != "fitted"]
        values = [(name, getattr(self, name)) for name in names]
        return [(name, value) for name, value in values if value is not None]

    def written(self) -> str:
        """The effect as the command line writes it: ``sinusoid:frequency_hz~47.0``."""
        pairs = []
        for name, value in self._given():
            is_whole = name in self.WHOLE
            sign = "~" if self.fitted and not is_whole else "="
            pairs.append(f"{name}{sign}{_number(value, is_whole)}")
        return self.NAME + (":" + ",".join(pairs) if pairs else "")


def _number(value: Any, is_whole: bool) -> str:
    """A number with as many digits as tell it apart from all others."""
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    return str(int(number)) if is_whole and number.is_integer() else repr(number)
