"""The site: ``make docs`` builds it from these pages and the docstrings of the public names.

The folder of sources is the repository itself, so that links between pages are the same for a
reader of the files and on the site.
"""

from importlib.metadata import version as version_of

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

project = "LIR-DCFP"
author = "The lir-dcfp developers"
project_copyright = f"2026, {author}"
version = release = version_of("lir-dcfp")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
root_doc = "docs/index"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/**"]
templates_path = ["_templates"]
myst_heading_anchors = 4
default_role = "code"

autodoc_typehints = "none"  # docstrings have types, shapes and units
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"  # drawn by the browser itself, without a network
html_title = f"LIR-DCFP {release}"
html_additional_pages = {"index": "to_start.html"}
html_copy_source = False
html_show_sourcelink = False

autodoc_default_options = {"members": True}


def write_formula(writer: HTML5Translator, node: nodes.math | nodes.math_block) -> None:
    """Write a formula as MathML."""
    writer.body.append(tex2mathml(node.astext(), as_block=isinstance(node, nodes.math_block)))
    raise nodes.SkipNode


def setup(app: Sphinx) -> None:
    """Make the renderer of formulas known."""
    app.add_html_math_renderer("mathml", (write_formula, None), (write_formula, None))
