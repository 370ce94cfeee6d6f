"""The reference of the command ``lir``, written by typer from the app: docs/generated/cli.md.

docs/cli.md includes it.
"""

from __future__ import annotations

import re
import subprocess  # runs this interpreter on the app  # noqa: S404
import sys
from html import unescape
from pathlib import Path
from typing import TYPE_CHECKING

from typer.main import get_group

from frames.command.app import app as command

if TYPE_CHECKING:
    from sphinx.application import Sphinx

WRITTEN = Path("docs", "generated", "cli.md")


def reference() -> str:
    """Return the pages of all commands as Markdown, headings from the second order on."""
    call = [sys.executable, "-m", "typer", "frames.command.app", "utils", "docs", "--name", "lir"]
    told = subprocess.run(call, capture_output=True, text=True, check=True)  # noqa: S603
    text = unescape(told.stdout).partition("**Usage**")[2]
    text = re.sub(r"^Example: (.*)$", r"Example: `\1`", text, flags=re.M)
    for name, one in get_group(command).commands.items():  # typer cuts what it lists
        said = (one.help or "").partition("\n")[0]
        text = re.sub(rf"^\* `{name}`: .*$", f"* [`{name}`](#lir-{name}): {said}", text, flags=re.M)
    return f"**Usage**{text.rstrip()}\n"


def write(app: Sphinx) -> None:
    """Write the reference where it is not as it was."""
    path, text = Path(app.srcdir) / WRITTEN, reference()
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write it before pages are read."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
