"""The files that a project is made of, as they were when it was read."""

from __future__ import annotations

import hashlib
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames._errors import ModelWarning, MotionError
from frames.design._errors import ProjectError
from frames.design.hazard.motion_folder import files_of, table_rows
from frames.design.project.extensions import loaded_digest
from frames.design.project.schema import ImportedModel, IrregularFrame, OpenSeesModel

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.project.derived import WholeFile


class SourceFiles:
    """Digests of the files of a project or a campaign, and what results keep of them."""

    def __init__(self, file: WholeFile, folder: Path) -> None:
        given: Any = file  # either has a structure and motions
        about = given.project if hasattr(file, "project") else given.campaign
        self.text = file.source.decode("utf-8", "replace")
        self._digests: dict[Path, str] = {}
        if file.source_path is not None:
            self._digests[file.source_path] = _hash(file.source)
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
        """Return the files that are on disk no longer what was read, as sentences."""
        return tuple(
            f"{path} was changed or removed after it was read: the numbers, the "
            "input that is shown and its SHA-256 are of the file before"
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
        """Refuse to go on with files that are no longer what was read, by a ProjectError."""
        if found := self.changed():
            msg = f"{found[0].split(': ')[0]}, before anything was run: give the command again"
            raise ProjectError(msg)


def _named(file: Any, folder: Path) -> list[Path]:
    # A model or its script, libraries of sections, points of a spectrum, records with their table.
    names: list[Path] = []
    structure, motions = file.structure, file.motions
    if isinstance(structure, OpenSeesModel):
        names = [structure.script]
    elif isinstance(structure, ImportedModel):
        names = [structure.file, *structure.library]
    points = getattr(getattr(file, "spectrum", None), "points", None)
    names += [points] if isinstance(points, Path) else []
    if motions.folder is not None:
        names.append(motions.folder / motions.table)
        records = _records_in(folder / motions.folder, motions.table)
        names += [motions.folder / name for name in records]
    return [folder / name for name in names]


def _records_in(folder: Path, table: str) -> Iterable[str]:
    # Names of records in a table of motions.
    try:
        rows = table_rows(folder, table)
    except (MotionError, OSError):  # said where the motions are read
        return ()
    return dict.fromkeys(name for row in rows for name in files_of(row))


def _content_of(path: Path) -> bytes:
    # Nothing of a file that cannot be read: what reads it says why.
    try:
        return path.read_bytes()
    except (OSError, ValueError):
        return b""


def _digest_of(path: Path) -> str:
    return _hash(_content_of(path))


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
