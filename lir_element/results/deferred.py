"""Variables of a Dataset that are formed on first use; arrays of other kinds.

Most variables of a time history are never used, and forming all would take as long as the analysis.
A deferred variable is formed once, when its values are needed. From then on it is an array like any
other: earlier parts of it are views of it if those of an array are, and written values stay; copies
and pickles hold the values.

xarray imports dask and pint before it recognises an array of another kind: a fifth of the time of a
start. If a package is not imported, there are no arrays of it, so the answer is clear without the
import.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from xarray.core import indexing as xarray_indexing
from xarray.namedarray import pycompat, utils

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element.layout import Floats


indexing: Any = xarray_indexing  # its types are those of another kind of arrays


def deferred(shape: tuple[int, ...], form: Callable[[], Floats]) -> Any:
    """Return an array for a variable that is formed when it is first needed."""
    return indexing.MemoryCachedArray(_Deferred(shape, form))


class _Deferred(indexing.ExplicitlyIndexedNDArrayMixin):  # type: ignore[misc]  # see `indexing`
    # The array, or a part of one, as xarray expects arrays that are elsewhere. A part is formed
    # with the whole, by numpy's indexing: a view of it, or a copy.

    def __init__(self, shape: tuple[int, ...], form: Callable[[], Floats]) -> None:
        self._shape, self._form = shape, form
        self._values: Floats | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        return self._shape

    @property
    def dtype(self) -> np.dtype[np.float64]:
        return np.dtype(np.float64)

    def get_duck_array(self) -> Floats:
        if self._values is None:
            self._values = self._form()
        return self._values

    def _part(self, choice: Callable[[Any], Any]) -> _Deferred:
        # Its shape is that of the same part of an array without memory.
        empty = np.broadcast_to(np.zeros((), dtype=np.bool_), self.shape)
        shape = choice(indexing.NumpyIndexingAdapter(empty)).shape
        return _Deferred(shape, lambda: np.asarray(choice(self._adapter())))

    def _adapter(self) -> Any:
        return indexing.NumpyIndexingAdapter(self.get_duck_array())

    def __getitem__(self, key: Any) -> Any:
        return self._part(lambda array: array[key])

    def _oindex_get(self, indexer: Any) -> Any:
        return self._part(lambda array: array.oindex[indexer])

    def _vindex_get(self, indexer: Any) -> Any:
        return self._part(lambda array: array.vindex[indexer])

    def transpose(self, order: Any) -> Any:
        return self._part(lambda array: array.transpose(order))

    def __setitem__(self, key: Any, value: Any) -> None:
        self._adapter()[key] = value

    def _oindex_set(self, indexer: Any, value: Any) -> None:
        self._adapter().oindex[indexer] = value

    def _vindex_set(self, indexer: Any, value: Any) -> None:
        self._adapter().vindex[indexer] = value

    def __reduce__(self) -> tuple[Any, ...]:
        return indexing.NumpyIndexingAdapter, (np.array(self.get_duck_array()),)


PACKAGES = {"dask": "dask.array", "pint": "pint"}
"""Packages with an array type, and the module without which there is none."""


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
    """Make xarray check first if a package is imported, if its record is laid out as expected."""
    kinds: Any = getattr(pycompat, "_cached_duck_array_modules", None)
    if isinstance(kinds, dict) and hasattr(pycompat, "DuckArrayModule"):
        for package in PACKAGES:
            kinds.setdefault(package, _NotImported(package))
    checks: Any = utils
    asked = getattr(checks, "is_dask_collection", None)
    if asked is not None:
        checks.is_dask_collection = lambda x: "dask.base" in sys.modules and asked(x)
