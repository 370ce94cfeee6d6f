"""What all pages share: their templates and styles, tables as text, figures inside the file."""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING, NamedTuple

import jinja2
import numpy as np
from pandas.api.types import is_string_dtype

from frames.design.report.tables import rows_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from matplotlib.figure import Figure

_DOTS = 110  # per inch
_NAME = 18  # letters of a name that stays on one line


class Table(NamedTuple):
    """A table of a page: cells as text, the first column and those named to the left."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: frozenset[int] = frozenset()

    @property
    def short(self) -> bool:
        """Whether the first column has names alone, which are not broken into lines."""
        return all(len(row[0]) <= _NAME for row in self.rows)


class Picture(NamedTuple):
    """A figure of a page.

    Attributes
    ----------
    title : str
        What it shows.
    source : str
        A data URI of a PNG file.
    """

    title: str
    source: str


def page_template(name: str, package: str = "frames.design.report") -> jinja2.Template:
    """Return the template of a page.

    Parameters
    ----------
    name : str
        Its file. ``page.css`` and ``macros.html.j2`` of this room are found beside it.
    package : str
        Where it is.

    Returns
    -------
    jinja2.Template
        What it is given is escaped; a name that it lacks is an error.
    """
    rooms = dict.fromkeys((package, "frames.design.report"))
    return jinja2.Environment(
        loader=jinja2.ChoiceLoader([jinja2.PackageLoader(room, ".") for room in rooms]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    ).get_template(name)


def page_table(frame: pd.DataFrame, index: str) -> Table:
    """Return a table with its numbers as `rows_of` writes them; columns of words to the left."""
    words = [k for k, kind in enumerate(frame.dtypes, start=1) if is_string_dtype(kind)]
    return Table((index, *map(str, frame.columns)), rows_of(frame, _word), frozenset(words))


def picture(title: str, figure: Figure) -> Picture:
    """Return a figure with its title, drawn; the figure is closed."""
    import matplotlib.pyplot as plt

    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=_DOTS, bbox_inches="tight")
    plt.close(figure)
    drawn = base64.b64encode(file.getvalue()).decode("ascii")
    return Picture(title, f"data:image/png;base64,{drawn}")


def _word(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return "" if value is None else str(value)
