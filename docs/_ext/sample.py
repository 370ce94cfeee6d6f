"""A sample project: ``lir new`` with its report and view, in the folder docs/sample of the site.

The build runs it if the sources of numbers changed. With LIR_DOCS_RUN=0 its pages are empty; so is
the PDF without Chromium.
"""

from __future__ import annotations

import os
import shutil
import subprocess  # runs this interpreter on the command  # noqa: S404
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from frames._provenance import sources_hash

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGES = ("report.html", "view.html", "report.pdf")
CALLS = (("new", "."), ("run",), ("report", "--pdf"), ("view",))  # a report removes earlier views
COMMAND = (sys.executable, "-c", "from frames.command.entry import main; main()")


def write(app: Sphinx, _: object) -> None:
    """Write the pages into a folder whose files the build copies (`html_extra_path`)."""
    folder = Path(app.confdir, "generated", "sample")
    target, stamp = folder / "docs" / "sample", folder / "docs" / "sample" / "sources.txt"
    target.mkdir(parents=True, exist_ok=True)
    if os.environ.get("LIR_DOCS_RUN", "1") == "0":
        for name in PAGES:
            (target / name).touch()
    elif not stamp.exists() or stamp.read_text(encoding="utf-8") != sources_hash():
        with tempfile.TemporaryDirectory() as place:
            for words in CALLS:
                subprocess.run([*COMMAND, *words], cwd=place, check="--pdf" not in words)  # noqa: S603
            Path(place, "results", "report.pdf").touch()
            for name in PAGES:
                shutil.copy(Path(place, "results", name), target)
        stamp.write_text(sources_hash(), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write it before the folder is looked for."""
    app.connect("config-inited", write, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
