"""The site: ``make docs`` builds it from these pages and the docstrings of the public names.

The folder of sources is the repository itself, so that links between pages are the same for a
reader of the files and on the site. Scripts of docs/gallery and docs/tutorials are run by the
build; with LIR_DOCS_RUN=0 in the environment they become pages without output and pictures, and
sources are not shown.
"""

import os
import sys
import warnings
from importlib.metadata import version as version_of
from pathlib import Path

import furo
from sphinx_gallery.sorting import ExplicitOrder, FileNameSortKey

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))
from figures import scraper  # of docs/_ext  # noqa: E402

RUN = os.environ.get("LIR_DOCS_RUN", "1") != "0"  # 0: as the tests build it

project = "LIR-DCFP"
author = "The lir-dcfp developers"
project_copyright = f"2026, {author}"
version = release = version_of("lir-dcfp")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    *(["sphinx.ext.viewcode"] if RUN else []),
    "sphinx_gallery.gen_gallery",
    "command",  # docs/_ext
    "formulas",
    "objects",
    "sample",
]
root_doc = "docs/index"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/**"]
exclude_patterns = ["docs/_templates/**", "docs/gallery/**", "docs/tutorials/**"]
exclude_patterns += ["docs/generated/cli.md", "docs/README.md"]  # part of cli.md; for GitHub
templates_path = [str(HERE / "_templates")]  # autosummary would look beside the repository
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4
smartquotes_action = "qe"  # "--verify" keeps its dashes
default_role = "code"

autosummary_generate = True
autodoc_typehints = "none"  # docstrings have types, shapes and units
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
napoleon_google_docstring = False
napoleon_use_ivar = True

SECTIONS = ("bearing", "building", "design", "research", "opensees")
sphinx_gallery_conf = {
    "examples_dirs": [str(HERE / "tutorials"), str(HERE / "gallery")],
    "gallery_dirs": ["docs/generated/tutorials", "docs/generated/gallery"],
    "filename_pattern": r"\.py$",
    "plot_gallery": RUN,
    "subsection_order": ExplicitOrder([f"docs/gallery/{name}" for name in SECTIONS]),
    "within_subsection_order": FileNameSortKey,
    "backreferences_dir": "docs/generated/backreferences",
    "doc_module": ("lir_element", "frames"),
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "thumbnail_size": (480, 336),
    "ignore_repr_types": r"matplotlib|frames\.plots",  # pictures are enough
    "image_scrapers": (scraper,),
    "reset_modules": ("matplotlib",),
}
suppress_warnings = ["config.cache"]  # functions and objects in sphinx_gallery_conf
warnings.filterwarnings("ignore", category=UserWarning, message=".*Agg.*")  # figures are not shown

html_theme = "furo"
if not RUN:  # the tree of all pages beside each page, made anew for each, is a third of the build
    furo._compute_navigation_tree = lambda _: ""
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["generated/sample"]  # the extension sample
html_math_renderer = "mathml"  # drawn by the browser itself, without a network
html_title = f"LIR-DCFP {release}"
html_additional_pages = {"index": "to_start.html"}
html_copy_source = False
html_show_sourcelink = False
