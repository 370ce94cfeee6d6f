"""What runs, curves and rates show of themselves: a line as text, a small table in notebooks."""

from __future__ import annotations

from abc import ABC, abstractmethod

from lir_element.tables import html_table


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
