"""Pages of single objects: reached from the page of their area, and not listed beside every page.

`autosummary` hangs the page of each object into the tree of contents; with 250 of them the list at
the left is of no use, and writing it takes most of a build. Each page of an object begins with a
link to its area instead.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from docutils import nodes
from sphinx.ext.autosummary import autosummary_toc

if TYPE_CHECKING:
    from sphinx.application import Sphinx

AREAS, PAGES = "docs/api/", "docs/api/generated/"


def unlist(app: Sphinx, tree: nodes.document) -> None:
    """Take the objects of an area out of the tree of contents, and keep which area they are of."""
    page = app.env.docname
    if not page.startswith(AREAS) or page.startswith(PAGES):
        return
    areas: dict[str, str] = app.env.__dict__.setdefault("lir_areas", {})
    for listed in list(tree.findall(autosummary_toc)):
        for toctree in listed.children:
            areas |= {name: page for _, name in toctree["entries"]}
        listed.parent.remove(listed)


def link_area(app: Sphinx, tree: nodes.document, page: str) -> None:
    """Begin the page of an object with a link to its area."""
    area = getattr(app.env, "lir_areas", {}).get(page)
    if area is None:
        return
    title = app.env.titles[area].astext()
    target = app.builder.get_relative_uri(page, area)
    link = nodes.reference("", title, refuri=target, internal=True)
    where = nodes.paragraph("", "API / ", link, classes=["where"])
    section = tree.next_node(nodes.section)
    if section is not None:
        section.insert(1, where)


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect both."""
    app.connect("doctree-read", unlist, priority=100)  # before the tree of contents is collected
    app.connect("doctree-resolved", link_area)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
