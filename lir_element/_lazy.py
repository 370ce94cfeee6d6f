"""Names of a package that are imported when they are first asked for: it starts without the rest.

They stand in its ``__init__.py`` as imports under ``if TYPE_CHECKING:``, where checkers of types
and readers find them; nothing names them twice.
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


def lazily(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return what a package takes as its `__getattr__` and `__dir__`."""
    homes = _listed(Path(file).read_text(encoding="utf-8"))
    module = sys.modules[package]

    def look_up(name: str) -> Any:
        if name in homes:
            found = getattr(import_module(homes[name]), name)
            setattr(module, name, found)  # asked for once
            return found
        if not name.startswith("_") and find_spec(f"{package}.{name}") is not None:
            return import_module(f"{package}.{name}")
        msg = f"module {package!r} has no attribute {name!r}"
        raise AttributeError(msg)

    return look_up, lambda: sorted({*vars(module), *homes})


def _listed(source: str) -> dict[str, str]:
    # Modules by the names imported from them under `if TYPE_CHECKING:`.
    blocks = [
        node
        for node in ast.parse(source).body
        if isinstance(node, ast.If)
        and isinstance(node.test, ast.Name)
        and node.test.id == "TYPE_CHECKING"
    ]
    imports = [each for block in blocks for each in block.body if isinstance(each, ast.ImportFrom)]
    return {alias.name: str(each.module) for each in imports for alias in each.names}
