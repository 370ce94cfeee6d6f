"""The page: its parts from the folder of assets and its data, as one file."""

from __future__ import annotations

import html
import json
import math
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from frames.results.storage import write_whole
from frames.viewer.payload import payload_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray as xr

    from frames.frame import Frame
    from frames.viewer.payload import ShownCheck

SCRIPTS = (
    "three.min.js",
    "payload.js",
    "clock.js",
    "figure.js",
    "model.js",
    "section_geometry.js",
    "section.js",
    "plots.js",
    "timeline.js",
    "tables.js",
    "main.js",
)
"""Scripts of the page, in the order in which they build on each other."""


def write_view(
    data: xr.Dataset,
    model: Frame,
    path: str | Path,
    *,
    checks: Iterable[ShownCheck] = (),
    size: float = 3.0,
) -> str:
    """Write a page that shows a model on bearings in motion.

    The page is one file that needs no network: the model in space, one bearing in vertical
    section, its loop and orbit, the floors' response, at a common time.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `frames.time_history` with all nodes and all variables of bearings.
    model : Frame
        Model of the time history.
    path : str or path
        The file, "view.html"; one that is there is replaced.
    checks : iterable of Check
        Checks beside the picture, for example `frames.design.Checks`.
    size : float
        Largest size of the histories [MB], > 0. If all recorded steps would exceed it, steps are
        chosen so that linear interpolation between them reproduces the curves best; the page gives
        the error.

    Returns
    -------
    str
        Summary of the written file: name, size and number of steps, in words.

    Raises
    ------
    ModelError
        If the result is not one of this model.
    ValueError
        If variables were not recorded, a value is not finite, or `size` is not positive.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.viewer import write_view
    >>> frame, pulse = example()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     said = write_view(time_history(frame, pulse), frame, f"{folder}/view.html")
    >>> "view.html" in said, "401 of 401 steps" in said
    (True, True)
    """
    if not 0.0 < size < math.inf:
        msg = f"size = {size:g} MB must be positive: use 3 for about 1,000 steps of 12 bearings"
        raise ValueError(msg)
    held = payload_of(data, model, checks, size)
    text = page_of(held.content).encode("utf-8")
    write_whole(path, text)
    return f"{path}: {len(text) / 1e6:.1f} MB, {held.kept} of {held.recorded} steps"


def page_of(content: dict[str, object]) -> str:
    """Return the page that shows a payload."""
    folder = files("frames.viewer") / "assets"
    held = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    scripts = [
        f"<script>\n{(folder / name).read_text(encoding='utf-8')}</script>" for name in SCRIPTS
    ]
    parts = {
        "title": html.escape(str(content["title"])),
        "style": f"<style>\n{(folder / 'view.css').read_text(encoding='utf-8')}</style>",
        "payload": f'<script type="application/json" id="payload">{held}</script>',
        "scripts": "\n".join(scripts),
    }
    page = (folder / "view.html").read_text(encoding="utf-8")
    for name, text in parts.items():
        page = page.replace(f"<!-- {name} -->", text)
    return page
