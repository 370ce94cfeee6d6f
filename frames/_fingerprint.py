"""Short digests of values by their content: whether it is the same model or motion again."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import issparse

from lir_element.device.friction import FrictionLaw

if TYPE_CHECKING:
    from frames.motion.ground_motion import GroundMotion


def fingerprint(value: object) -> str:
    """Return a digest of a value by its content, the same in every process.

    Examples
    --------
    >>> fingerprint({"a": {"x", "y"}}) == fingerprint({"a": {"y", "x"}})
    True
    """
    found = hashlib.sha256()
    for piece in _pieces(value):
        found.update(piece)
    return found.hexdigest()[:16]


def _pieces(value: Any) -> Iterator[bytes]:
    yield f"<{type(value).__name__}>".encode()
    if isinstance(value, np.ndarray):
        yield f"{value.dtype.str}{value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif issparse(value):
        given: Any = value
        whole = given.tocsr(copy=True)
        whole.sum_duplicates()
        yield from _pieces((whole.shape, whole.data, whole.indices, whole.indptr))
    elif isinstance(value, Mapping):
        for key, each in value.items():
            yield from _pieces(key)
            yield from _pieces(each)
    elif isinstance(value, AbstractSet):
        yield from sorted(b"".join(_pieces(each)) for each in value)
    elif isinstance(value, (tuple, list)):
        for each in value:
            yield from _pieces(each)
    elif value is None or isinstance(value, (str, bytes, bool, int, float, np.generic)):
        yield repr(value).encode()
    elif is_dataclass(value):
        yield from _pieces({field.name: getattr(value, field.name) for field in fields(value)})
        yield from _table(value)
    else:
        yield from _pieces(vars(value))
    yield b"</>"


def _table(value: object) -> Iterator[bytes]:
    # Of a friction law from a table: what its class says its fields do not tell.
    values = value.kernel_values() if isinstance(value, FrictionLaw) else None
    if values and values.table:
        yield from _pieces(values)


def motion_digest(motion: GroundMotion) -> str:
    """Return a digest of the samples of a motion and of its step; its name is not in it.

    Examples
    --------
    >>> from frames import GroundMotion
    >>> motion = GroundMotion(x=[0.0, 1.0, 0.0], dt=0.01, name="a")
    >>> motion_digest(motion) == motion_digest(motion.scaled(2.0))
    False
    """
    return fingerprint([motion.x, motion.y, motion.z, motion.dt])
