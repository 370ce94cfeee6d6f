"""What all figures share: size, palette, text, units, and several systems side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from frames._types import FloatArray

Systems: TypeAlias = xr.Dataset | Mapping[str, xr.Dataset]
"""One result, or several by name for comparison."""

PAGE_WIDTH = 6.9
"""Width of a figure, that of the text on an A4 page [in]."""

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Colours that stay apart for the colour-blind (Okabe and Ito); systems take them in order."""

LINES: tuple[Literal["-", "--", "-.", ":"], ...] = ("-", "--", "-.", ":", "-", "--")
WIDTHS = (1.7, 1.1, 0.9, 1.0, 0.8, 0.8)  # pt; falling, so that equal curves show both

GREY = "#666666"
PLANE = ("x", "y")
TITLE, LABEL, SMALL = 9.0, 8.5, 7.5  # pt

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


def as_systems(systems: Systems) -> dict[str, xr.Dataset]:
    """Return systems by name; a single Dataset goes by its title.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results of `frames.time_history`.

    Returns
    -------
    dict of str to Dataset
        In the order given, at least one and at most six.

    Raises
    ------
    ValueError
        If there are none, or more than the palette has colours for.
    """
    if isinstance(systems, xr.Dataset):
        return {str(systems.attrs.get("title", "result")): systems}
    found = dict(systems)
    if not 1 <= len(found) <= len(PALETTE):
        msg = f"{len(found)} systems: give 1 to {len(PALETTE)} Datasets to compare"
        raise ValueError(msg)
    return found


def label_of(name: str, data: xr.Dataset, space: str = " ") -> str:
    """Return the name of a system; after `space`, a run that stopped early says so."""
    if data.attrs.get("status", "ok") == "ok":
        return name
    return f"{name}{space}(stopped at {data.attrs.get('failed_at', float(data['time'][-1])):.2f} s)"


def new_figure(height: float, width: float = PAGE_WIDTH) -> Figure:
    """Return an empty figure of `width` x `height` [in] that arranges its parts by itself."""
    layout = ConstrainedLayoutEngine(w_pad=0.05, h_pad=0.05, wspace=0.04, hspace=0.05)
    return Figure(figsize=(width, height), layout=layout)


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
    """Put one legend, under its title, above all panels: outside of the data."""
    figure.legend(
        handles=list(handles),
        title=title or None,
        title_fontsize=TITLE + 1.0,
        loc="outside upper center",
        ncols=columns,
        frameon=False,
        fontsize=size,
    )


def system_handles(systems: Mapping[str, xr.Dataset]) -> list[Artist]:
    """Return the entries of a legend for the systems, in their colours and line styles."""
    return [
        Line2D(
            [], [], color=PALETTE[k], linestyle=LINES[k], linewidth=WIDTHS[k], label=label_of(*item)
        )
        for k, item in enumerate(systems.items())
    ]


def engineering(units: str, peak: float) -> tuple[float, str]:
    """Return the factor and the unit that show values up to `peak` with sensible digits.

    Parameters
    ----------
    units : str
        SI unit, as the Dataset's attributes name it.
    peak : float
        Largest absolute value, in that unit.

    Returns
    -------
    (float, str)
        What to multiply with, and the unit for the label; empty for pure numbers.

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
    """Return the label of an axis: what it shows, and its unit in brackets."""
    return f"{long_name} [{unit}]" if unit else f"{long_name} [-]"


def peak_of(values: Iterable[FloatArray]) -> float:
    """Return the largest absolute value of several arrays, 0 without any."""
    return max((float(np.abs(v).max()) for v in values if np.size(v)), default=0.0)


def worst_bearing(data: xr.Dataset, variable: str = "interface_slip_size") -> str:
    """Return the name of the bearing with the largest absolute value of a variable.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`.
    variable : str
        A variable over time and bearing.

    Returns
    -------
    str
        Its name, in the dimension "bearing".
    """
    values = np.abs(data[variable].transpose("bearing", ...).to_numpy())
    peaks = values.reshape(len(values), -1).max(axis=1)
    return str(data["bearing"].to_numpy()[int(np.argmax(peaks))])
