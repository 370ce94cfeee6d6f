"""Python files that a project names: codes, checks and friction laws of its own, and models."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import traceback
from collections.abc import Callable
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames.design._errors import ProjectError
from lir_element.argument_checks import shown

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType

_LOADED: dict[Path, str] = {}
"""SHA-256 of the files that were run, as it was then: each is run once in a process."""

ANYWHERE: ContextVar[bool] = ContextVar("ANYWHERE", default=False)
"""Whether files outside of the project's folder may run."""

TOLD: ContextVar[Callable[[Path], None] | None] = ContextVar("TOLD", default=None)
"""Called with each file before it runs."""


class RunningScript:
    """A script that runs in its own folder, where it may read files; its failure names the line.

    Parameters
    ----------
    script : Path
        The script.
    key : str
        Of the project's file, which names it.
    folder : Path
        That of the project's file, in which it must be.

    Raises
    ------
    ProjectError
        If it is elsewhere and `ANYWHERE` is not set, or if it fails.
    """

    def __init__(self, script: Path, key: str, folder: Path) -> None:
        whole = script.resolve()
        if not ANYWHERE.get() and not whole.is_relative_to(folder.resolve()):
            msg = (
                f"{key} = {whole} lies outside of the project's folder: copy it there; or, if you "
                "trust it, write `lir --scripts-from-anywhere` and then the command"
            )
            raise ProjectError(msg)
        self._script, self._key, self._before = script, key, Path.cwd()
        tell = TOLD.get()
        if tell is not None:
            tell(whole)

    def __enter__(self) -> None:
        os.chdir(self._script.parent)

    def __exit__(
        self, kind: object, cause: BaseException | None, trace: TracebackType | None
    ) -> bool:
        os.chdir(self._before)
        if cause is None or isinstance(cause, KeyboardInterrupt):
            return False
        if isinstance(cause, SystemExit) and not cause.code:
            return True
        name = self._script.name
        lines = [s.lineno for s in traceback.extract_tb(trace) if Path(s.filename).name == name]
        where = f", line {lines[-1]}" if lines else ""
        msg = f"{self._key} = {name}{where}: {type(cause).__name__}: {cause}"
        raise ProjectError(msg) from cause


def load_extensions(data: Mapping[str, Any], folder: Path, section: str = "project") -> None:
    """Run the Python files that a file names: their codes, checks and friction laws are known then."""
    about = data.get(section)
    named = about.get("extensions", ()) if isinstance(about, dict) else ()
    for name in named if isinstance(named, list) else ():
        _load(_extension(folder, str(name), section), section, folder)


def loaded_digest(script: Path) -> str:
    """Return the SHA-256 of an extension as it was run; empty if it was not."""
    return _LOADED.get(script, "")


def _extension(folder: Path, name: str, section: str) -> Path:
    # A file of a name, or a ProjectError.
    script = folder / name
    try:
        whole = script.resolve()
        there = whole.is_file()
    except (OSError, ValueError) as cause:  # a name that no file can have
        why = getattr(cause, "strerror", None) or cause
        msg = f"[{section}] extensions: {shown(name)}: {why}: name a Python file"
        raise ProjectError(msg) from cause
    if not there:
        msg = (
            f"[{section}] extensions: {whole} is no file: name a Python file beside the {section}'s"
        )
        raise ProjectError(msg)
    return whole


def _load(script: Path, section: str, folder: Path) -> None:
    if script in _LOADED:
        return
    name = f"lir_extension_{len(_LOADED)}_{script.stem}"
    found = importlib.util.spec_from_file_location(name, script)
    if found is None or found.loader is None:
        msg = f"[{section}] extensions: {script.name} is no Python file: its name must end in .py"
        raise ProjectError(msg)
    module = importlib.util.module_from_spec(found)
    content = script.read_bytes()
    with RunningScript(script, "extensions", folder):
        sys.modules[name] = module  # as dataclasses of it need
        exec(compile(content, str(script), "exec"), module.__dict__)  # noqa: S102  # was told
    _LOADED[script] = hashlib.sha256(content).hexdigest()
