"""Pages of single objects: reached from the page of their area, and not listed beside every page.

`autosummary` hangs the page of each object into the tree of contents; with 250 of them the list at
the left is of no use, and writing it takes most of a build. Each page of an object begins with a
link to its area instead. Links between pages have titles in place of files' names.
"""

from __future__ import annotations

import posixpath
import re
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


def name_pages(app: Sphinx, tree: nodes.document, page: str) -> None:
    """Give links whose text is a file's name, "guide.md", the title of that page."""
    for link in tree.findall(nodes.reference):
        path, _, _ = link.get("refuri", "").partition("#")
        target = posixpath.normpath(posixpath.join(posixpath.dirname(page), path))
        title = app.env.titles.get(target.removesuffix(".html"))
        if title is not None and re.fullmatch(r"[\w/.]+\.md", link.astext()):
            link.children = [nodes.inline("", title.astext())]


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect all."""
    app.connect("doctree-read", unlist, priority=100)  # before the tree of contents is collected
    app.connect("doctree-resolved", link_area)
    app.connect("doctree-resolved", name_pages)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
