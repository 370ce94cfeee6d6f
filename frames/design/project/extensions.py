"""Python files that a project names: codes, checks and friction laws of its own, and models."""

from __future__ import annotations

import importlib.util
import os
import sys
import tomllib
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from frames.design._errors import ProjectError

if TYPE_CHECKING:
    from types import TracebackType

_LOADED: set[Path] = set()
"""Files that were run: each once in a process."""


class RunningScript:
    """A script that runs in its own folder, where it may read files; its failure names the line.

    Parameters
    ----------
    script : Path
        The script.
    key : str
        Of the project's file, which names it.

    Raises
    ------
    ProjectError
        If it fails.
    """

    def __init__(self, script: Path, key: str) -> None:
        self._script, self._key, self._before = script, key, Path.cwd()

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


def load_extensions(path: Path, section: str = "project") -> None:
    """Run the Python files that a file names: their codes, checks and friction laws are known then.

    Parameters
    ----------
    path : Path
        The project's file, or a campaign's; what is wrong with it is left to its reading.
    section : str
        The one that names them.

    Raises
    ------
    ProjectError
        If a file is not there, or fails.
    """
    try:
        about = tomllib.loads(path.read_text(encoding="utf-8")).get(section)
    except (OSError, ValueError):
        return
    named = about.get("extensions", ()) if isinstance(about, dict) else ()
    for name in named if isinstance(named, list) else ():
        _load((path.parent / str(name)).resolve(), section)


def _load(script: Path, section: str) -> None:
    if script in _LOADED:
        return
    if not script.is_file():
        msg = (
            f"[{section}] extensions: {script} is no file: name a Python file beside the "
            f"{section}'s"
        )
        raise ProjectError(msg)
    name = f"lir_extension_{len(_LOADED)}_{script.stem}"
    found = importlib.util.spec_from_file_location(name, script)
    if found is None or found.loader is None:
        msg = f"[{section}] extensions: {script.name} is no Python file: its name must end in .py"
        raise ProjectError(msg)
    module = importlib.util.module_from_spec(found)
    sys.modules[name] = module  # as dataclasses of it need
    with RunningScript(script, "extensions"):
        found.loader.exec_module(module)
    _LOADED.add(script)
