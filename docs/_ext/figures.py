"""What a script of the gallery shows: figures of pyplot, and those that functions hand back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper

if TYPE_CHECKING:
    from collections.abc import Mapping

LAST = "___"  # where sphinx-gallery keeps the value of the last expression of a block
SHOWN = "___shown"  # and what was shown of them: later blocks may have none


def scraper(
    block: tuple[str, ...], block_vars: Mapping[str, Any], gallery_conf: Mapping[str, Any]
) -> str:
    """Save the figures of a block, and return the text that shows them."""
    shown = matplotlib_scraper(block, block_vars, gallery_conf, dpi=110)
    names = block_vars["example_globals"]
    last = names.get(LAST)
    if isinstance(last, Figure) and last is not names.get(SHOWN):
        names[SHOWN] = last
        path = next(block_vars["image_path_iterator"])
        last.savefig(path, dpi=110)
        shown += figure_rst([path], gallery_conf["src_dir"])
    return str(shown)
