"""Results as HTML, for notebooks."""

from __future__ import annotations

import os
from collections.abc import Sequence
from html import escape
from typing import Any


class Picture:
    """A picture as SVG. A notebook shows it; ``save`` writes it to a file.

    Attributes
    ----------
    svg : str
        The text of the SVG file.
    """

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture to a file that ends in ``.svg``."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.svg)

    def __repr__(self) -> str:
        return f"<Picture, {len(self.svg)} bytes of SVG>"


def number(value: Any) -> str:
    """A value for a table: a float with four digits."""
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value)


def html_table(rows: Sequence[dict[str, Any]], columns: Sequence[str]) -> str:
    """Some columns of some rows."""
    head = "".join(f"<th>{escape(column.replace('_', ' '))}</th>" for column in columns)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(number(row.get(column)))}</td>" for column in columns) + "</tr>"
        for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def paragraphs(lines: Sequence[str]) -> str:
    """Lines of text."""
    return "".join(f"<p>{escape(line)}</p>" for line in lines)
