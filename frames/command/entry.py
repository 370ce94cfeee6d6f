"""Entry of the command ``lir``: its packages may not be installed."""

from __future__ import annotations

import atexit
import os
import signal
import sys
from importlib.util import find_spec

NEEDED = ("typer", "rich", "pydantic", "pint", "jinja2")


def main() -> None:
    """Run the command, or name the missing package."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        text = f"lir needs {', '.join(missing)}: pip install 'lir-dcfp[cli]'\n"
        sys.stderr.write(text)
        sys.exit(2)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # which ends it as Ctrl-C does
    from frames.command.app import app

    atexit.register(_end_quietly)
    app()


def _end_quietly() -> None:
    # OpenSees prints "Process 0 Terminating" when the process ends, after all that matters.
    if "openseespy.opensees" in sys.modules:
        sys.stderr.flush()
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 2)
        os.close(nothing)
