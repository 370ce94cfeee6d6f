"""The codes of this package: each module of this folder that has a ``CODE`` is one."""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path

from frames.design.codes.registry import DesignCode, known_codes, register_code

for _found in sorted(pkgutil.iter_modules([str(Path(__file__).parent)])):
    _code = getattr(importlib.import_module(f"{__package__}.{_found.name}"), "CODE", None)
    if isinstance(_code, DesignCode):
        register_code(_code)

BUILT_IN = known_codes()
"""The codes of this package."""
