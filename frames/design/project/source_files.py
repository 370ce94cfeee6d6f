"""The files of a project, as they were when it was read."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import traceback
import warnings
from collections.abc import Callable
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames._errors import ModelWarning, MotionError
from frames.design._errors import ProjectError
from frames.design.hazard.motion_folder import files_of, table_rows
from frames.design.project.schema_structure import ImportedModel, IrregularFrame, OpenSeesModel
from lir_element.argument_checks import shown
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from types import TracebackType

    from frames.design.project.derived import WholeFile

_LOADED: dict[Path, str] = {}
"""SHA-256 of the executed files at that time: each is executed once in a process."""

ANYWHERE: ContextVar[bool] = ContextVar("ANYWHERE", default=False)
"""True if files outside of the project's folder may run."""

TOLD: ContextVar[Callable[[str], None] | None] = ContextVar("TOLD", default=None)
"""Called with a text before a file runs, and before a model that another program wrote is read."""


def tell(text: str) -> None:
    """Report the start of a step to the listener, if there is one."""
    listener = TOLD.get()
    if listener is not None:
        listener(text)


class RunningScript:
    """A script that runs in its own folder and may read files there; its failure names the line.

    `key` of the project's file names it. It must be in the project's folder, or `ANYWHERE` is set.
    """

    def __init__(self, script: Path, key: str, folder: Path) -> None:
        whole = script.resolve()
        if not ANYWHERE.get() and not whole.is_relative_to(folder.resolve()):
            msg = (
                f"{key} = {whole} is outside of the project's folder: copy it there, or, if you "
                "trust it, write `lir --scripts-from-anywhere` before the command"
            )
            raise ProjectError(msg)
        self._script, self._key, self._before = script, key, Path.cwd()
        tell(f"running {whole}, a Python file that the project names")

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
    """Run the Python files that a file names, which register codes, checks and friction laws."""
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
            f"[{section}] extensions: {whole} is not a file: name a Python file beside the "
            f"{section}'s"
        )
        raise ProjectError(msg)
    return whole


def _load(script: Path, section: str, folder: Path) -> None:
    if script in _LOADED:
        return
    name = f"lir_extension_{len(_LOADED)}_{script.stem}"
    found = importlib.util.spec_from_file_location(name, script)
    if found is None or found.loader is None:
        msg = (
            f"[{section}] extensions: {script.name} is not a Python file: its name must end in .py"
        )
        raise ProjectError(msg)
    module = importlib.util.module_from_spec(found)
    content = script.read_bytes()
    with RunningScript(script, "extensions", folder):
        sys.modules[name] = module  # for dataclasses in it
        exec(compile(content, str(script), "exec"), module.__dict__)  # noqa: S102  # was told
    _LOADED[script] = hashlib.sha256(content).hexdigest()


class SourceFiles:
    """Digests of the files of a project or a campaign, for their results."""

    def __init__(self, file: WholeFile, folder: Path) -> None:
        given: Any = file  # either has a structure and motions
        about = given.project if hasattr(file, "project") else given.campaign
        self.text = file.source.decode("utf-8", "replace")
        self._digests = {path: _hash(content) for path, content in file.sources.items()}
        for path in _named(given, folder):
            self._digests[path] = _digest_of(path)
        scripts = [(folder / name).resolve() for name in about.extensions]
        self.extensions = {each.name: loaded_digest(each) for each in scripts}
        self._digests |= {each: loaded_digest(each) for each in scripts if loaded_digest(each)}
        self.tables: dict[str, bytes] = {}
        if isinstance(given.structure, IrregularFrame):
            for name in (given.structure.columns_table, given.structure.beams_table):
                self.tables[name.name] = _content_of(folder / name)
                self._digests[folder / name] = _hash(self.tables[name.name])

    def digest(self, path: Path) -> str:
        """Return the SHA-256 that a file of the project had when it was read."""
        return self._digests[path]

    def changed(self) -> tuple[str, ...]:
        """Return the files that changed on disk since they were read, as sentences."""
        return tuple(
            worded(
                "{file} was changed or removed after it was read: the results, the input "
                "shown and its SHA-256 belong to the earlier file",
                file=path,
            )
            for path, digest in self._digests.items()
            if _digest_of(path) != digest
        )

    def warn_of_changes(self) -> tuple[str, ...]:
        """Warn of each file that has changed, and return the sentences."""
        found = self.changed()
        for each in found:
            warnings.warn(each, ModelWarning, stacklevel=2)
        return found

    def require_unchanged(self) -> None:
        """Raise a ProjectError if files have changed since they were read."""
        if found := self.changed():
            msg = f"{found[0].split(': ')[0]}, before any run: run the command again"
            raise ProjectError(msg)


def _named(file: Any, folder: Path) -> list[Path]:
    # A model or its script, libraries of sections, points of a spectrum, tables of losses, records.
    names: list[Path] = []
    structure, motions = file.structure, file.motions
    if isinstance(structure, OpenSeesModel):
        names = [structure.script]
    elif isinstance(structure, ImportedModel):
        names = [structure.file, *structure.library]
    points = getattr(getattr(file, "spectrum", None), "points", None)
    loss = getattr(file, "loss", None)
    tables = [points]
    if loss is not None:
        tables += [loss.components, loss.hazard, *loss.hazards.values()]
    names += [each for each in tables if isinstance(each, Path)]
    if motions.folder is not None:
        names.append(motions.folder / motions.table)
        records = _records_in(folder / motions.folder, motions.table)
        names += [motions.folder / name for name in records]
    return [folder / name for name in names]


def _records_in(folder: Path, table: str) -> Iterable[str]:
    # Names of records in a table of motions.
    try:
        rows = table_rows(folder, table)
    except (MotionError, OSError):  # the message comes from the reading of motions
        return ()
    return dict.fromkeys(name for row in rows for name in files_of(row))


def _content_of(path: Path) -> bytes:
    # Nothing of an unreadable file: its reader gives the reason.
    try:
        return path.read_bytes()
    except (OSError, ValueError):
        return b""


def _digest_of(path: Path) -> str:
    return _hash(_content_of(path))


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
