"""Compiled kernels kept on disk: never a stale one, and no failure of the disk ends a run.

numba's own cache does not notice an edit in a *callee* of another file. If its folder cannot be
written it uses another one, and the hash of the sources does not name that. Here a kernel is kept
under the hash of all sources that it may depend on (`_sources`), by its types with the names of
their fields, behind a checksum. If anything fails (no folder, no space, a damaged file, sources
edited since), the kernel is compiled in memory, with one warning. Kernels that are not kept there
may have come with the wheel (`shipped`).

Kernels are pickles, and loading a pickle runs code of its writer. A file is opened only if it and
its folder belong to this user or to root, and nobody else may write to them; new ones belong to the
user alone.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle  # noqa: S403  # what this program has written, behind a checksum
import stat
import sys
import uuid
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import llvmlite
import numba
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps
from numba.core.types.containers import BaseNamedTuple, BaseTuple

from lir_element._compile import shipped
from lir_element._compile.sources import compiled_sources

if TYPE_CHECKING:
    from collections.abc import Iterator

VERSIONS = (sys.implementation.cache_tag, numba.__version__, llvmlite.__version__)
"""Versions that the code depends on, besides the processor."""

_DIGEST = hashlib.sha256().digest_size
_UNREADABLE = (
    pickle.PickleError,
    AttributeError,
    EOFError,
    ImportError,
    LookupError,
    TypeError,
    ValueError,
)
_said: set[str] = set()

taken: set[Path] = set()
"""Files that this process took kernels from."""

_parts: dict[Path, Any] = {}  # that this process took from files, so that each is there once


def cache_folder() -> Path | None:
    """Return the folder of all caches: LIR_CACHE_DIR, or one at home; None without a home."""
    try:
        chosen = os.environ.get("LIR_CACHE_DIR")
        base = Path(chosen).expanduser() if chosen else Path.home() / ".cache" / "lir-dcfp"
        return base.absolute()
    except (OSError, RuntimeError):  # no home, or a working directory that is gone
        return None


def fields_of(signature: Any) -> tuple[tuple[str, ...], ...]:
    """Return the names of the fields of all bundles in a signature, in the order of their places.

    numba distinguishes bundles by the name of their class and the types in it. A kernel contains
    the places of the fields, and so is stale once two of one type change places. (For a record
    numba names fields and places itself.)
    """
    found: list[tuple[str, ...]] = []
    new = list(getattr(signature, "args", signature))[::-1]
    while new:
        kind = new.pop()
        if isinstance(kind, BaseNamedTuple):
            found.append((kind.instance_class.__qualname__, *kind.instance_class._fields))
        if isinstance(kind, BaseTuple):
            new += list(kind)[::-1]
    return tuple(found)


class Sources:
    """Sources that the kernels of some packages depend on, as first read by this process.

    Parameters
    ----------
    *folders : Path
        The packages.
    """

    def __init__(self, *folders: Path) -> None:
        self.paths = compiled_sources(*folders)
        self._stamps = self._look()
        self.hash = self._digest()
        self._same = True

    def _look(self) -> list[tuple[int, int]]:
        stats = [path.stat() for _, path in self.paths]
        return [(stat.st_mtime_ns, stat.st_size) for stat in stats]

    def _digest(self) -> str:
        digest = hashlib.sha256()
        for folder, path in self.paths:
            digest.update(path.relative_to(folder).as_posix().encode())
            digest.update(path.read_bytes())
        return digest.hexdigest()[:16]

    def unchanged(self) -> bool:
        """Return whether the files on disk are still those of the hash."""
        try:
            stamps = self._look()
            if stamps != self._stamps:
                self._stamps, self._same = stamps, self._digest() == self.hash
        except OSError:
            self._same = False
        return self._same

    def folder(self) -> Path | None:
        """Return the folder of the files that belong to these sources; None without a home."""
        base = cache_folder()
        return None if base is None else base / self.hash


def keep(path: Path | None, content: bytes) -> bool:
    """Write a file of the cache completely, or not at all."""
    if path is None:
        _warn("cannot be kept: this user has no home folder", again=True)
        return False
    partial = path.with_name(f"{path.name}.{uuid.uuid4().hex[:12]}")
    try:
        base = path.parent.parent if path.parent.parent == cache_folder() else path.parent
        base.mkdir(mode=_OWN_FOLDER, parents=True, exist_ok=True)
        path.parent.mkdir(mode=_OWN_FOLDER, exist_ok=True)
        if why := _doubt_of_folder(path.parent):
            _distrust(path.parent, why)
            return False
        partial.touch(mode=_OWN_FILE, exist_ok=False)
        partial.write_bytes(content)
        partial.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            partial.unlink()
        _warn(f"cannot be kept in {path.parent} ({error.strerror or error})", again=True)
        return False
    return True


def is_kept() -> bool:
    """Return whether another process finds the kernels that this one has compiled."""
    return "again" not in _said


def content_of(path: Path) -> bytes | None:
    """Return the content of a file of the cache."""
    try:
        with path.open("rb") as file:
            why = _doubt_of_folder(path.parent) or _doubt(os.fstat(file.fileno()), path.parent)
            if not why:
                return file.read()
        _distrust(path.parent, why)
        return None
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        _warn(f"cannot be read from {path.parent} ({error.strerror or error})", again=True)
        return None


_OWN_FOLDER, _OWN_FILE = 0o700, 0o600
_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def _doubt_of_folder(folder: Path) -> str:
    # Reason not to open the files of a folder; empty if they may be opened. If the folder is a
    # link, its owner chose the folder that is opened.
    found = _doubt(folder.lstat(), folder) or _doubt(folder.stat(), folder)
    base = folder.parent
    if not found and base in {cache_folder(), shipped.FOLDER}:
        about = base.stat()
        sticky = about.st_mode & stat.S_ISVTX  # others may add, and take away nothing
        found = _doubt(about, base) if not sticky else ""
    return found


def _doubt(about: os.stat_result, folder: Path) -> str:
    # The same by the owner and the rights of one file or folder. Windows has neither: there the
    # folder of a user is closed to others by its own list of rights.
    if os.name == "nt":
        return ""
    owners = {0, os.geteuid()}
    if shipped.FOLDER in (folder, *folder.parents):
        owners.add(Path(__file__).stat().st_uid)  # whose sources run here anyway
    if about.st_uid not in owners:
        return f"are of another user (uid {about.st_uid})"
    if about.st_mode & _OTHERS and not stat.S_ISLNK(about.st_mode):
        return "may be written by others"
    return ""


def _distrust(folder: Path, why: str) -> None:
    place = cache_folder() if folder.parent == cache_folder() else folder
    _warn(
        f"in {folder} were not opened, because files there {why}. If you made them, run "
        f"`chmod -R go-w {place}`; otherwise remove them",
        again=True,
    )


def _warn(what: str, again: bool) -> None:
    # Once a process and kind of trouble: a run may compile a hundred kernels.
    kind = "again" if again else what
    if kind in _said:
        return
    _said.add(kind)
    cost = ", so every start compiles them again" if again else ""
    warnings.warn(
        f"compiled kernels {what}{cost}. Set LIR_CACHE_DIR to a writable folder with "
        "about 200 MB free.",
        RuntimeWarning,
        stacklevel=2,
    )


def _opened(key: tuple[Any, ...] | None, content: bytes) -> Any:
    # Content of the file, or None if it is damaged or another kernel's (`key` None: any kernel's).
    if hashlib.sha256(content[_DIGEST:]).digest() != content[:_DIGEST]:
        return None
    try:
        known, reduced = pickle.loads(content[_DIGEST:])  # noqa: S301  # written here
    except _UNREADABLE:
        return None
    return reduced if key in {None, known} else None


def _part_in(
    path: Path, context: Any, rebuilt: Any, key: tuple[Any, ...] | None = None, digest: Any = None
) -> Any:
    # The part in a file, and all parts below it; None if there is none. The digest shows that its
    # caller was compiled with it: names in the code differ between processes.
    part = _parts.get(path)
    if part is None:
        content = content_of(path)
        if content is None or digest not in {None, content[:_DIGEST]}:
            return None
        reduced = _opened(key, content)
        if reduced is None:
            _warn(f"in {path.parent}: damaged files, compiled anew", again=False)
            return None

        def below(name: str, of: bytes) -> Any:
            return _part_in(path.parent.parent / name, context, rebuilt, None, of)

        part = rebuilt(context, reduced, below)
        if part is None:
            return None
        part.library.kept = (f"{path.parent.name}/{path.name}", content[:_DIGEST])
        _parts[path] = part
    return part if digest in {None, part.library.kept[1]} else None


class KernelCache(NullCache):  # type: ignore[misc]  # numba has no types
    """Cache of one kernel: searched before it is compiled, written afterwards.

    Parameters
    ----------
    function : callable
        The kernel as Python.
    sources : Sources
        Sources that the kernel may depend on.
    rebuilt : callable, optional
        Function that makes a part (`_parts`) of the kept content.
    """

    def __init__(self, function: Any, sources: Sources, rebuilt: Any = None) -> None:
        self._name = f"{function.__module__}.{function.__qualname__}"
        self._sources = sources
        self._rebuilt = rebuilt
        self.as_part = False  # whether it is the part that is looked for

    @property
    def cache_path(self) -> str | None:
        """The folder of the kernel's file; None without a home."""
        folder = self._sources.folder()
        return None if folder is None else str(folder)

    def _key(self, signature: Any, processor: Any) -> tuple[Any, ...]:
        key = (self._name, signature, fields_of(signature), processor, VERSIONS)
        return (*key, "part") if self.as_part else key

    def _path(self, key: tuple[Any, ...], folder: Path | None) -> Path | None:
        code = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
        return None if folder is None else folder / f"{self._name}-{code}.kernel"

    def _places(self, signature: Any, codegen: Any) -> Iterator[tuple[tuple[Any, ...], Path]]:
        # Keys and files that may hold the kernel, the best first.
        processor = codegen.magic_tuple()
        for target, folder in (
            (processor, self._sources.folder()),
            (shipped.shipped_for(processor), shipped.FOLDER / self._sources.hash),
        ):
            key = self._key(signature, target)
            path = None if target is None else self._path(key, folder)
            if path is not None:
                yield key, path

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled kernel for a signature, or None if it has to be compiled."""
        target_context.refresh()  # 0.2 s, once: C's calling convention needs it
        if not self._sources.unchanged():
            return None
        if self.as_part:
            return self._load_part(sig, target_context)
        for key, path in self._places(sig, target_context.codegen()):
            content = content_of(path)
            if content is None:
                continue
            reduced = _opened(key, content)
            if reduced is not None:
                taken.add(path)
                return CompileResult._rebuild(target_context, *reduced)
            _warn(f"in {path.parent}: damaged files, compiled anew", again=False)
        return None

    def _load_part(self, sig: Any, context: Any) -> Any:
        key = self._key(sig, context.codegen().magic_tuple())
        path = self._path(key, self._sources.folder())
        return None if path is None else _part_in(path, context, self._rebuilt, key=key)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel, if it may be kept and there is room for it."""
        lasting = not data.library.has_dynamic_globals and not data.lifted
        if "again" in _said or not lasting or not self._sources.unchanged():
            return
        reduced = data.library.reduced(data) if self.as_part else data._reduce()
        if reduced is None:
            return
        key = self._key(sig, data.codegen.magic_tuple())
        path = self._path(key, self._sources.folder())
        content = dumps((key, reduced))
        digest = hashlib.sha256(content).digest()
        if keep(path, digest + content) and path and self.as_part:
            data.library.kept = (f"{path.parent.name}/{path.name}", digest)
