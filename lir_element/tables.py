"""Small tables for people: as text, and as HTML for notebooks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from html import escape

Rows = Sequence[Sequence[str]]


def text_table(rows: Rows, head: Sequence[str] = (), left: int = 1) -> str:
    """Return rows of cells as lines of text."""
    lines = [tuple(head), *map(tuple, rows)] if head else [tuple(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            f"{cell:<{wide}}" if k < left else f"{cell:>{wide}}"
            for k, (cell, wide) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


def html_table(title: str, rows: Rows, head: Sequence[str] = (), notes: Sequence[str] = ()) -> str:
    """Return a table as HTML, everything escaped."""

    def line(tag: str, cells: Sequence[str]) -> str:
        return (
            "<tr>"
            + "".join(f'<{tag} style="text-align: left">{escape(c)}</{tag}>' for c in cells)
            + "</tr>"
        )

    body = "".join(line("td", row) for row in rows)
    top = line("th", head) if head else ""
    below = "".join(f"<li>{escape(note)}</li>" for note in notes)
    listed = f"<ul>{below}</ul>" if notes else ""
    return f"<div><b>{escape(title)}</b><table>{top}{body}</table>{listed}</div>"


class Shown(ABC):
    """What has a few rows to show."""

    @abstractmethod
    def _rows(self) -> list[tuple[str, str]]:
        """Return what is shown: what it is, and its value."""

    def __repr__(self) -> str:
        """Return it on one line."""
        return f"{type(self).__name__}({', '.join(f'{k}: {v}' for k, v in self._rows() if v)})"

    def _repr_html_(self) -> str:
        """Return a table for notebooks."""
        return html_table(type(self).__name__, [row for row in self._rows() if row[1]])
