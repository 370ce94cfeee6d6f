"""Lazily imported names of a package: each is one import "from m import a as a".

Under ``if TYPE_CHECKING:``, where checkers of types and readers find them, they are imported when
they are first used: the package starts without the rest.
"""

from __future__ import annotations

import ast
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


def lazily(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return the `__getattr__`, `__dir__` and `__all__` of a package whose names load lazily."""
    homes = _homes(file)
    module = sys.modules[package]

    def look_up(name: str) -> Any:
        if name in homes:
            found = getattr(import_module(homes[name]), name)
            setattr(module, name, found)  # each name is imported once
            return found
        if not name.startswith("_") and find_spec(f"{package}.{name}") is not None:
            return import_module(f"{package}.{name}")
        msg = f"module {package!r} has no attribute {name!r}"
        raise AttributeError(msg)

    return look_up, lambda: sorted({*vars(module), *homes}), sorted(homes)


def listed(file: str) -> list[str]:
    """Return the names that a module exports, as its `__all__`."""
    return sorted(_homes(file))


def _homes(file: str) -> dict[str, str]:
    # Modules by the names that a file imports as themselves, "from m import a as a".
    source = ast.parse(Path(file).read_text(encoding="utf-8"))
    imports = [each for each in ast.walk(source) if isinstance(each, ast.ImportFrom)]
    return {a.name: str(i.module) for i in imports for a in i.names if a.asname == a.name}
