"""How the command speaks: lines as they are, errors with their exit code, each warning once.

The commands import what they need when they run: `lir --help` starts without the rest.
"""

from __future__ import annotations

import warnings
from collections.abc import Generator
from contextlib import contextmanager

import typer
from rich.console import Console

from frames.command.toml_words import in_toml

FAILED_CHECKS, BAD_INPUT, FAILED_ANALYSIS, INTERRUPTED = 1, 2, 3, 130

out, err = Console(), Console(stderr=True)


@contextmanager
def told() -> Generator[None, None, None]:
    """Tell errors as lines and leave with their exit code; each warning is a line, once.

    Yields
    ------
    None
        While the command works.

    Raises
    ------
    typer.Exit
        With the code of the error.
    """
    from frames._errors import ModelError, MotionError, without_numbers
    from frames.design._errors import CheckError, ProjectError
    from frames.risk._errors import CampaignError
    from lir_element.errors import AnalysisError, AnalysisInterrupted

    with warnings.catch_warnings():
        before: set[str] = set()

        def once(message: Warning | str, *_: object, **__: object) -> None:
            text = in_toml(str(message))
            if without_numbers(text) not in before:
                before.add(without_numbers(text))
                err.print(f"warning: {text}", markup=False, highlight=False, soft_wrap=True)

        warnings.showwarning = once
        try:
            yield
        except (ProjectError, CheckError, ModelError, MotionError, CampaignError) as cause:
            text = in_toml(str(cause))
            err.print(f"error: {text}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(BAD_INPUT) from cause
        except AnalysisError as cause:
            err.print(f"error: {cause}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(FAILED_ANALYSIS) from cause
        except (AnalysisInterrupted, KeyboardInterrupt) as cause:
            # what was complete is on disk, not in an attribute
            err.print(str(cause).split(": ")[0] or "interrupted", markup=False, soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from cause


def say(text: str) -> None:
    """Print a text as it is, whatever is in it."""
    out.print(text, markup=False, highlight=False, soft_wrap=True)
