"""Output of the command: lines as they are, errors with their exit code, each warning once.

The commands import their modules when they run: `lir --help` starts without the rest.
"""

from __future__ import annotations

import errno
import re
import warnings
from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console

if TYPE_CHECKING:
    from frames.design.project.inputs import ProjectInputs

FAILED_CHECKS, BAD_INPUT, FAILED_ANALYSIS, FAILED_FILE, INTERRUPTED = 1, 2, 3, 4, 130

out, err = Console(), Console(stderr=True)


@contextmanager
def exit_codes() -> Generator[None, None, None]:
    """Print errors as lines and exit with their code; print each warning once."""
    from frames._errors import ModelError, MotionError, without_numbers
    from frames.design._errors import CheckError, ProjectError
    from frames.design.project.source_files import ANYWHERE, TOLD
    from frames.risk._errors import CampaignError
    from lir_element.errors import AnalysisError, AnalysisInterrupted

    with warnings.catch_warnings():
        before: set[str] = set()

        def once(message: Warning | str, *_: object, **__: object) -> None:
            text = in_toml(str(message))
            if without_numbers(text) not in before:
                before.add(without_numbers(text))
                err.print(f"warning: {text}", markup=False, highlight=False, soft_wrap=True)

        def begins(text: str) -> None:
            if text not in before:
                before.add(text)
                err.print(text, markup=False, highlight=False, soft_wrap=True)

        warnings.showwarning = once
        tokens = TOLD.set(begins), ANYWHERE.set(_TRUST.get())
        try:
            yield
        except (ProjectError, CheckError, ModelError, MotionError, CampaignError) as cause:
            text = in_toml(str(cause))
            err.print(f"error: {text}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(BAD_INPUT) from cause
        except (AnalysisError, MemoryError) as cause:
            why = cause if isinstance(cause, AnalysisError) else f"{_MEMORY} ({cause})"
            err.print(f"error: {why}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(FAILED_ANALYSIS) from cause
        except BrokenPipeError:  # the reader of the output has left
            raise
        except OSError as cause:
            err.print(f"error: {_of_a_file(cause)}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(FAILED_FILE) from cause
        except (AnalysisInterrupted, KeyboardInterrupt) as cause:
            # the complete part is on disk, not in an attribute
            err.print(str(cause).split(": ")[0] or "interrupted", markup=False, soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from cause
        finally:
            TOLD.reset(tokens[0])
            ANYWHERE.reset(tokens[1])


def say(text: str) -> None:
    """Print a text unchanged."""
    out.print(text, markup=False, highlight=False, soft_wrap=True)


_MEMORY = "there is not enough memory: use fewer workers, motions or recorded variables"


def _of_a_file(cause: OSError) -> str:
    # Without the number of the error, with the file and a remedy.
    if cause.filename is None:
        return cause.strerror or str(cause)
    name = str(cause.filename)
    short = name if len(name) <= _LONGEST else f"{name[:60]}...{name[-60:]}"
    return f"{short}: {cause.strerror}: {_REMEDIES.get(cause.errno or 0, 'check this path')}"


_LONGEST = 300  # characters of a path in a message

_REMEDIES = {
    errno.ENOSPC: "make room, or name another place",
    errno.EDQUOT: "make room, or name another place",
    errno.EFBIG: "allow larger files (ulimit -f), or name another place",
    errno.EROFS: "name a place that can be written to",
    errno.EACCES: "name a place that this user may read and write",
    errno.EPERM: "name a place that this user may read and write",
    errno.ENOENT: "it does not exist: check the path, and repeat the command",
    errno.ENAMETOOLONG: "choose a shorter name",
    errno.EISDIR: "it is a folder: remove it, or name another place",
    errno.ENOTDIR: "a part of the path is a file: name another place",
    errno.EEXIST: "name another place",
}


def trust(anywhere: bool) -> None:
    """Allow Python files of a project outside of its folder, or only inside."""
    _TRUST.set(anywhere)


_TRUST: ContextVar[bool] = ContextVar("_TRUST", default=False)


def project_in(file: Path) -> ProjectInputs:
    """Return the project of a file; its Python files are listed before they run."""
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.reading import read_project

    return ProjectInputs(read_project(file), file.resolve().parent)


_WORDS = tuple(
    (re.compile(pattern), said)
    for pattern, said in (
        (r"\. See the variables? [a-z ]+$", ""),
        (r"\bmath\.inf\b", "inf"),
        (r"\bSection\.rolled_i\b", "i_shape"),
        (r"\bSection\.elastic_modulus\b", "E"),
        (r"\bSection\.(\w+)", r"\1"),
        (r"\b(?:pass|use|give|set|take) (\w+)=None\b", r"leave \1 out"),
        (r"\b([A-Za-z_]\w*)=True\b", r"\1 = true"),
        (r"\b([A-Za-z_]\w*)=False\b", r"\1 = false"),
        (r"\b([A-Za-z_]\w*)=\(([^()]*)\)", r"\1 = [\2]"),
        (r'\b([A-Za-z_]\w*)=("[^"]*"|-?\d[\w.+-]*)', r"\1 = \2"),
        (r"\b([A-Za-z_]\w*)=(?=[\s,;:.)]|$)", r"\1"),
        (r"\bpass (?=\w+ = )", "write "),
        (r"choose one of \(([^()]*?),?\)", r"choose one of \1"),
    )
)


def in_toml(text: str) -> str:
    """Return a message with the remedies of Python as TOML has them.

    Examples
    --------
    >>> in_toml("raise it, or pass allow_weak_interface=True to study such a bearing")
    'raise it, or write allow_weak_interface = true to study such a bearing'
    >>> in_toml("must be below 1, or math.inf; or rims=(bottom, top)")
    'must be below 1, or inf; or rims = [bottom, top]'
    """
    if ".py" in text:
        return text
    for pattern, said in _WORDS:
        text = pattern.sub(said, text)
    return text
