"""Variables of a Dataset that are formed when they are first looked at.

Most of what a time history could tell is never asked for: forming all of it would take as long as
the analysis. A deferred variable is formed once, when its values are needed, and is an array like
any other from then on; copies and pickles hold the values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from xarray.backends import BackendArray
from xarray.core import indexing as xarray_indexing

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element.layout import Floats


indexing: Any = xarray_indexing  # its types are those of another kind of arrays


def deferred(shape: tuple[int, ...], form: Callable[[], Floats]) -> Any:
    """Return an array for a variable that is formed when it is first needed.

    Parameters
    ----------
    shape : tuple of int
        Its shape.
    form : callable
        Returns it, an array of float64; what it is made from must stay as it is.

    Returns
    -------
    object
        What `xarray.Variable` takes as values.
    """
    lazy = indexing.LazilyIndexedArray(_Deferred(shape, form))
    return indexing.MemoryCachedArray(indexing.CopyOnWriteArray(lazy))


class _Deferred(BackendArray):
    # The array, as xarray asks for arrays that are elsewhere. Who asks for all of it gets it and
    # keeps it; where parts are asked for, it stays here, and they get copies.

    def __init__(self, shape: tuple[int, ...], form: Callable[[], Floats]) -> None:
        self.shape = shape
        self.dtype = np.dtype(np.float64)
        self._form = form
        self._values: Floats | None = None

    def __getitem__(self, key: Any) -> Any:
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.OUTER_1VECTOR, self._part
        )

    def _part(self, key: tuple[Any, ...]) -> Floats:
        values = self._form() if self._values is None else self._values
        part: Floats = values
        for axis, one in enumerate(key):
            if isinstance(one, np.ndarray):
                part = np.take(part, one, axis=axis)
                key = (*key[:axis], slice(None), *key[axis + 1 :])
        part = part[key]
        is_all = part.shape == values.shape and part.strides == values.strides
        if is_all and np.shares_memory(part, values):
            self._values = None
            return part
        self._values = values
        return part.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        whole = (slice(None),) * len(self.shape)
        return _Deferred, (self.shape, _Formed(self._part(whole).copy()))


class _Formed:
    # Stands for what forms the values where these are known.

    def __init__(self, values: Floats) -> None:
        self._values = values

    def __call__(self) -> Floats:
        return self._values.copy()
