"""Formulas as MathML, numbered as the kernels cite them, and links from "(2.1)" to equation 2.1.

A block ``$$ ... $$ (2.1)`` of a page is shown with the number that stands behind it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.domains.math import MathDomain

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

GREEK = re.compile(r"\\boldsymbol\{\\([A-Za-z]+)\}")
BOLD = {
    "delta": "𝜹",
    "eta": "𝜼",
    "theta": "𝜽",
    "tau": "𝝉",
    "phi": "𝝓",
    "varphi": "𝝋",
    "psi": "𝝍",
    "omega": "𝝎",
    "Phi": "𝜱",
    "Psi": "𝜳",
}
"""Bold Greek letters: docutils would set all that follows one in bold."""

BAR = re.compile(r"(?<!\\left)(?<!\\right)\|")
CITED = re.compile(r"\((\d+\.\d+)\)")
PAGES = "docs/theory"


def mathml(text: str, *, block: bool) -> str:
    """Return a formula as MathML."""
    text = GREEK.sub(lambda found: BOLD[found[1]], text)
    first, *others = BAR.split(text)  # bars open and close in turn, without space around them
    for k, other in enumerate(others):
        first += (r"\right|" if k % 2 else r"\left|") + other
    return str(tex2mathml(first, as_block=block)).strip()


def write_inline(writer: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    formula = mathml(node.astext(), block=False)
    writer.body.append(f'<span class="inline-formula">{formula}</span>')
    raise nodes.SkipNode


def write_block(writer: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on a line of its own, its number at the right."""
    name = node.get("label") or ""
    number = f'<span class="eqno">({name})</span>' if CITED.fullmatch(f"({name})") else ""
    identity = "".join(f' id="{name}"' for name in node["ids"][:1])
    formula = mathml(node.astext(), block=True)
    writer.body.append(f'<div class="formula"{identity}><div>{formula}</div>{number}</div>\n')
    raise nodes.SkipNode


def link_numbers(app: Sphinx, tree: nodes.document, page: str) -> None:
    """Make each number of an equation in the text of a page on theory a link to the equation."""
    if not page.startswith(PAGES):
        return
    domain = app.env.domains["math"]
    assert isinstance(domain, MathDomain)  # noqa: S101
    for text in list(tree.findall(nodes.Text)):
        if isinstance(text.parent, (nodes.math, nodes.math_block, nodes.literal, nodes.reference)):
            continue
        parts = CITED.split(text)
        new: list[nodes.Node] = []
        for k, part in enumerate(parts):
            place = domain.equations.get(part) if k % 2 else None
            if place is None:
                new.append(nodes.Text(f"({part})" if k % 2 else part))
                continue
            base = "" if place[0] == page else app.builder.get_relative_uri(page, place[0])
            target = f"{base}#{nodes.make_id(f'equation-{part}')}"
            new.append(nodes.reference("", f"({part})", refuri=target, internal=True))
        if len(parts) > 1:
            text.parent.replace(text, new)


def setup(app: Sphinx) -> dict[str, bool]:
    """Make the renderer of formulas and the links known."""
    app.add_html_math_renderer("mathml", (write_inline, None), (write_block, None))
    app.connect("doctree-resolved", link_numbers)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
