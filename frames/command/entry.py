"""Where the command ``lir`` begins: what it needs may not be installed."""

from __future__ import annotations

import sys
from importlib.util import find_spec

NEEDED = ("typer", "rich", "pydantic", "pint", "jinja2")


def main() -> None:
    """Run the command, or say what is missing."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        text = f"lir needs {', '.join(missing)}: pip install 'lir-dcfp[cli]'\n"
        sys.stderr.write(text)
        sys.exit(2)
    from frames.command.app import app

    app()
