"""Tables that are wider than a page, in parts that are not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.report.page import Table

if TYPE_CHECKING:
    from collections.abc import Sequence

PAGE = 118  # letters that a line of a printed table holds
_GAP = 3  # letters between two columns
_WRAPPED = 26  # letters: words that are longer are broken into lines


def in_parts(table: Table, width: int = PAGE, *, keep: int = 1) -> list[Table]:
    """Return a table in parts that fit a page, each with the first columns."""
    sizes = [_size(table, k) for k in range(len(table.head))]
    keep = min(keep, len(table.head))
    kept, count = tuple(range(keep)), 1
    while (groups := _grouped(sizes, keep, count)) and any(
        sum(sizes[:keep]) + sum(sizes[k] for k in group) > width and len(group) > 1
        for group in groups
    ):
        count += 1
    return [_part(table, (*kept, *group)) for group in groups]


def _size(table: Table, column: int) -> int:
    # Letters of a column: heads are broken at blanks, long words of cells as well.
    cells = [row[column] for row in table.rows]
    words = [*table.head[column].split(), *(w for cell in cells for w in cell.split()), ""]
    whole = max((min(len(cell), _WRAPPED) for cell in cells), default=0)
    return max(whole, *(len(word) for word in words)) + _GAP


def _grouped(sizes: Sequence[int], keep: int, count: int) -> list[list[int]]:
    # Columns but the first `keep` in `count` groups of about the same width, in order.
    share = sum(sizes[keep:]) / count
    groups: list[list[int]] = [[] for _ in range(count)]
    before = 0.0
    for k, size in enumerate(sizes[keep:], start=keep):
        groups[min(int((before + 0.5 * size) / share), count - 1)].append(k)
        before += size
    return [group for group in groups if group] or [[]]


def _part(table: Table, columns: Sequence[int]) -> Table:
    return Table(
        [table.head[k] for k in columns],
        [[row[k] for k in columns] for row in table.rows],
        frozenset(place for place, k in enumerate(columns) if k in table.left),
    )
