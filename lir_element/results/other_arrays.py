"""Kinds of arrays that xarray knows, dask's and pint's, stay unimported while nobody uses them.

Before it says that an array is none of theirs, xarray imports both: a fifth of the time of a start.
Where a package is not imported, there are no arrays of it, so the answer is known without.
"""

from __future__ import annotations

import sys
from typing import Any

from xarray.namedarray import pycompat, utils

PACKAGES = {"dask": "dask.array", "pint": "pint"}
"""Those with an array, and the module without which there is none."""


class _NotImported:
    # Stands for xarray's record of a package until its arrays can exist; then for the real one.

    def __init__(self, package: str) -> None:
        self._package = package

    def _known(self) -> Any:
        kinds: Any = pycompat._cached_duck_array_modules
        if kinds.get(self._package) is self:
            kinds[self._package] = pycompat.DuckArrayModule(self._package)
        return kinds[self._package]

    @property
    def type(self) -> tuple[type, ...]:
        if PACKAGES[self._package] not in sys.modules:
            return ()
        known: tuple[type, ...] = self._known().type
        return known

    def __getattr__(self, name: str) -> Any:
        return getattr(self._known(), name)


def spare() -> None:
    """Have xarray ask first whether a package is imported, where it keeps its record as known."""
    kinds: Any = getattr(pycompat, "_cached_duck_array_modules", None)
    if isinstance(kinds, dict) and hasattr(pycompat, "DuckArrayModule"):
        for package in PACKAGES:
            kinds.setdefault(package, _NotImported(package))
    checks: Any = utils
    asked = getattr(checks, "is_dask_collection", None)
    if asked is not None:
        checks.is_dask_collection = lambda x: "dask.base" in sys.modules and asked(x)
