"""Common style of all figures: size, palette, text and units."""

from __future__ import annotations

import math
import textwrap
from io import BytesIO
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import Formatter, NullFormatter

from lir_element.texts import Text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from frames._types import FloatArray

PAGE_WIDTH = 6.9
"""Width of a figure, that of the text on an A4 page [in]."""

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Colours that stay apart for the colour-blind (Okabe and Ito); systems take them in order."""

LINES: tuple[Literal["-", "--", "-.", ":"], ...] = ("-", "--", "-.", ":", "-", "--")
WIDTHS = (1.7, 1.1, 0.9, 1.0, 0.8, 0.8)  # pt; falling, so that equal curves show both

GREY = "#666666"
PLANE = ("x", "y")
TITLE, LABEL, SMALL = 9.0, 8.5, 7.5  # pt
COLUMNS = (0, 1, 2, 3, 2, 3, 3)  # of panels, by their number
LETTER = 0.56  # width of a letter over the size of its font, about
SCREEN_DPI = 110

_PREFIXES = {
    "N": ((1e6, "MN"), (1e3, "kN"), (1.0, "N")),
    "N m": ((1e6, "MN m"), (1e3, "kN m"), (1.0, "N m")),
    "J": ((1e6, "MJ"), (1e3, "kJ"), (1.0, "J")),
    "m": ((1.0, "m"), (1e-3, "mm")),
    "m/s2": ((1.0, "m/s²"),),
    "m/s": ((1.0, "m/s"),),
    "s": ((1.0, "s"),),
    "1": ((1.0, ""),),
}


class PageFigure(Figure):
    """A figure that a notebook shows as a picture, with or without pyplot's inline backend."""

    def _repr_png_(self) -> bytes:
        return png_of(self, SCREEN_DPI)


def png_of(figure: Figure, dpi: float, *, tight: bool = False) -> bytes:
    """Return a figure as a PNG file of a resolution [1/in], with or without its margins."""
    file = BytesIO()
    figure.savefig(file, format="png", dpi=dpi, bbox_inches="tight" if tight else None)
    return file.getvalue()


def new_figure(height: float, width: float = PAGE_WIDTH) -> PageFigure:
    """Return an empty figure of `width` x `height` [in] that arranges its parts by itself."""
    layout = ConstrainedLayoutEngine(w_pad=0.05, h_pad=0.05, wspace=0.04, hspace=0.05)
    return PageFigure(figsize=(width, height), layout=layout)


def grid_of(
    figure: Figure, rows: int, columns: int, *, share_x: bool = False, share_y: bool = False
) -> list[list[Axes]]:
    """Return styled axes of `figure`, by row and column."""
    panels = figure.subplots(
        rows,
        columns,
        squeeze=False,
        sharex="all" if share_x else False,
        sharey="all" if share_y else False,
    )
    table: list[list[Axes]] = [list(row) for row in panels]
    for ax in (ax for row in table for ax in row):
        style(ax)
    return table


def panels_of(
    count: int, columns: int, height: float, *, share: bool = True
) -> tuple[PageFigure, list[Axes]]:
    """Return a figure of `count` panels, row after row of a height [in]; common axes or not."""
    rows = math.ceil(count / columns)
    figure = new_figure(0.6 + height * rows)
    table = grid_of(figure, rows, columns, share_x=share, share_y=share)
    panels = [panel for row in table for panel in row]
    for panel in panels[count:]:
        panel.remove()
    return figure, panels[:count]


def close_column(panel: Axes, text: str, *, is_last: bool) -> None:
    """Label the horizontal axis of the last panel of a column."""
    if is_last:
        caption(panel, x=text)
        panel.tick_params(labelbottom=True)


def style(ax: Axes) -> None:
    """Set fonts, grid and frame of a panel."""
    ax.tick_params(labelsize=SMALL, width=0.6, length=3.0)
    ax.grid(visible=True, color="#DDDDDD", linewidth=0.5)
    ax.set_axisbelow(True)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        ax.spines[side].set_linewidth(0.6)


def caption(ax: Axes, *, x: str | None = None, y: str | None = None, title: str = "") -> None:
    """Write the labels of the axes and the title of a panel."""
    if x is not None:
        ax.set_xlabel(x, fontsize=LABEL)
    if y is not None:
        ax.set_ylabel(y, fontsize=LABEL)
    if title:
        ax.set_title(title, fontsize=TITLE, loc="left")


def add_legend(
    figure: Figure,
    handles: Iterable[Artist],
    *,
    columns: int = 3,
    title: str = "",
    size: float = LABEL,
) -> None:
    """Add a legend, under its title, above all panels; of `columns`, or as many as fit."""
    entries = list(handles)
    longest = max((len(str(entry.get_label())) for entry in entries), default=0)
    entry_width = (LETTER * longest + 4.5) * size / 72.0
    columns = max(1, min(columns, int(figure.get_figwidth() / entry_width)))
    figure.legend(
        handles=entries,
        title=wrapped(title, figure.get_figwidth(), TITLE + 1.0) or None,
        title_fontsize=TITLE + 1.0,
        loc="outside upper center",
        ncols=columns,
        frameon=False,
        fontsize=size,
    )


def line_of(place: int, widen: float = 0.0) -> dict[str, Any]:
    """Return colour, style and width [pt] of the line of a system, by its place in the order."""
    return {
        "color": PALETTE[place],
        "linestyle": LINES[place],
        "linewidth": WIDTHS[place] + widen,
    }


def wrapped(text: str, width: float, size: float = TITLE) -> str:
    """Return `text` in lines that fit `width` [in] at a font of `size` [pt]."""
    letters = max(12, int(width / (LETTER * size / 72.0)))
    lines = "\n".join(
        part for line in text.split("\n") for part in textwrap.wrap(line, letters) or [""]
    )
    return text.laid_out(lines) if isinstance(text, Text) else lines


def engineering(units: str, peak: float) -> tuple[float, str]:
    """Return the factor and the unit that show values up to `peak` with sensible digits.

    Examples
    --------
    >>> engineering("N", 2.5e6)
    (0.001, 'kN')
    >>> engineering("m", 0.25)
    (1000.0, 'mm')
    """
    choices = _PREFIXES.get(units)
    if choices is None:
        return 1.0, units
    for size, text in choices:
        if peak >= (10.0 if len(choices) > 2 else 1.0) * size:
            return 1.0 / size, text
    return 1.0 / choices[-1][0], choices[-1][1]


def text_of(long_name: str, unit: str) -> str:
    """Return the label of an axis: its quantity, and its unit in brackets."""
    return f"{long_name} [{unit}]" if unit else f"{long_name} [-]"


def peak_of(values: Iterable[FloatArray]) -> float:
    """Return the largest absolute value of several arrays, 0 without any."""
    return max((float(np.abs(v).max()) for v in values if np.size(v)), default=0.0)


def say_ticks(figure: Figure, say: Callable[[str], str]) -> None:
    """Translate the tick labels of all axes of a figure by `say`."""
    for axes in figure.axes:
        third = getattr(axes, "zaxis", None)
        for axis in (axes.xaxis, axes.yaxis, *([third] if third else [])):
            axis.set_major_formatter(_said(axis.get_major_formatter(), say))
            axis.set_minor_formatter(_said(axis.get_minor_formatter(), say))


def _said(inner: Formatter, say: Callable[[str], str]) -> Formatter:
    return inner if isinstance(inner, NullFormatter) else _Said(inner, say)


class _Said(Formatter):
    """Labels of an axis in the words of `say`."""

    def __init__(self, inner: Formatter, say: Callable[[str], str]) -> None:
        super().__init__()
        self._inner, self._say = inner, say

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self._inner.set_axis(axis)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._say(str(self._inner(x, pos)))

    def format_ticks(self, values: Any) -> list[str]:
        return [self._say(text) for text in self._inner.format_ticks(values)]

    def set_locs(self, locs: Any) -> None:
        self._inner.set_locs(locs)

    def get_offset(self) -> str:
        return self._say(str(self._inner.get_offset()))
