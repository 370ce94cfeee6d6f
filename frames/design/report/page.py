"""What all pages share: their templates and styles, tables as text, figures inside the file."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, NamedTuple

import jinja2
import numpy as np
from pandas.api.types import is_string_dtype

from frames.design.report.tables import Table as Table
from frames.design.report.tables import rows_of
from frames.design.report.words import Words

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

_DOTS = 110  # per inch


class Picture(NamedTuple):
    """A figure of a page."""

    title: str  # what it shows
    source: str  # a data URI of a PNG file


def page_template(
    name: str, package: str = "frames.design.report", words: Words | None = None
) -> jinja2.Template:
    """Return the template of a page."""
    rooms = dict.fromkeys((package, "frames.design.report"))
    room = jinja2.Environment(
        loader=jinja2.ChoiceLoader([jinja2.PackageLoader(room, ".") for room in rooms]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        extensions=["jinja2.ext.i18n"],
    )
    room.policies["ext.i18n.trimmed"] = True
    said = words or Words()
    room.install_gettext_callables(said.gettext, said.ngettext, newstyle=True)  # type: ignore[attr-defined]  # of the extension
    room.filters |= {"said": said.say, "cited": said.cited}
    room.filters |= {"number": said.number, "formula": said.formula}
    return room.get_template(name)


def page_table(frame: pd.DataFrame, index: str) -> Table:
    """Return a table with its numbers as `rows_of` writes them; columns of words to the left."""
    words = [k for k, kind in enumerate(frame.dtypes, start=1) if is_string_dtype(kind)]
    return Table((index, *map(str, frame.columns)), rows_of(frame, _word), frozenset(words))


def picture(title: str, figure: Figure, words: Words | None = None) -> Picture:
    """Return a figure with its title, drawn, in a language; the figure is closed."""
    import matplotlib.pyplot as plt

    from frames.plots.plot_style import png_of

    if words is not None:
        title, figure = words.say(title), words.figure(figure)
    drawn = base64.b64encode(png_of(figure, _DOTS, tight=True)).decode("ascii")
    plt.close(figure)
    return Picture(title, f"data:image/png;base64,{drawn}")


def _word(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return "" if value is None else str(value)
