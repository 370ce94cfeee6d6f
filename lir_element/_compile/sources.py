"""Sources that kernels depend on: their own, and all that define their types and constants.

The list is read from the imports, those for annotations included, so that a new file is in it with
the first kernel that names it. A text is searched rather than parsed: it is done at every start.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

COMPILERS = (
    "_jit.py",
    "_compile/front_end.py",
    "_compile/jit.py",
    "_compile/linking.py",
    "_compile/lowering.py",
)
"""Files that compile kernels, in a package."""

_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]*(\([^)]*\)|[^\n]*)|import[ \t]+([\w., \t]+))",
    re.MULTILINE,
)
_FOR_TYPING = re.compile(r"^if TYPE_CHECKING:\n(?:[ \t][^\n]*\n|\n)*", re.MULTILINE)
_COMMENT = re.compile(r"#[^\n]*")
_NAME = re.compile(r"(\w+)(?:\s+as\s+\w+)?")


def compiled_sources(*folders: Path) -> list[tuple[Path, Path]]:
    """Return the sources that compiled code depends on, sorted.

    These are the files in a folder ``kernels``, each module that they import from, if only for an
    annotation, and each module from which those import constants and classes at runtime. Constants
    and classes begin with a capital; Python functions that make the arguments of kernels are left
    out.
    """
    kernels = {path for folder in folders for path in folder.glob("**/kernels/**/*.py")}
    found = kernels | {path for f in folders for name in COMPILERS for path in f.glob(name)}
    new = set(kernels)
    modules = {folder.name: folder for folder in folders}
    while new:
        path = new.pop()
        more = set(_imported(path, path in kernels, modules)) - found
        found |= more
        new |= more
    return [
        (folder, path) for folder in folders for path in sorted(found) if folder in path.parents
    ]


def _imported(path: Path, kernels: bool, packages: dict[str, Path]) -> Iterator[Path]:
    # Files of the packages that a module imports anything from; or, of one that holds no kernels,
    # constants and classes at runtime.
    text = path.read_text(encoding="utf-8")
    for module, listed, whole in _IMPORT.findall(text if kernels else _FOR_TYPING.sub("", text)):
        for name in (part.split()[0] for part in whole.split(",") if part.strip()):
            yield from _file(_place(name, path, packages))
        place = _place(module, path, packages)
        names = _NAME.findall(_COMMENT.sub("", listed)) if place else []
        taken = [name for name in names if kernels or name.lstrip("_")[:1].isupper()]
        if place and place.is_dir():
            for name in names:
                yield from _file(place / name) or (_file(place) if name in taken else [])
        elif taken:
            yield from _file(place)


def _place(module: str, path: Path, packages: dict[str, Path]) -> Path | None:
    # Path of a module, without suffix; None if it is in none of the packages.
    top, *below = module.lstrip(".").split(".")
    if module.startswith("."):
        return path.parents[len(module) - len(module.lstrip(".")) - 1].joinpath(top, *below)
    return packages[top].joinpath(*below) if top in packages else None


def _file(place: Path | None) -> list[Path]:
    # The file of a module, or of a package; none of anything else.
    if place is None:
        return []
    files = (place.with_name(f"{place.name}.py"), place / "__init__.py")
    return [file for file in files if file.is_file()][:1]
