"""Short digests of values by their content: whether it is the same model or motion again."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
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
    _tell(value, found.update)
    return found.hexdigest()[:16]


def _tell(value: Any, told: Callable[[bytes], object]) -> None:
    # Hands over the content of a value piece by piece.
    told(f"<{type(value).__name__}>".encode())
    if value is None or isinstance(value, (str, bytes, bool, int, float, np.generic)):
        told(repr(value).encode())
    elif isinstance(value, (tuple, list)):
        for each in value:
            _tell(each, told)
    elif isinstance(value, np.ndarray):
        told(f"{value.dtype.str}{value.shape}".encode())
        told(np.ascontiguousarray(value).tobytes())
    elif issparse(value):
        given: Any = value
        whole = given.tocsr(copy=True)
        whole.sum_duplicates()
        _tell((whole.shape, whole.data, whole.indices, whole.indptr), told)
    elif isinstance(value, Mapping):
        for key, each in value.items():
            _tell(key, told)
            _tell(each, told)
    elif isinstance(value, AbstractSet):
        for piece in sorted(map(_whole, value)):
            told(piece)
    elif is_dataclass(value):
        _tell({field.name: getattr(value, field.name) for field in fields(value)}, told)
        _tell_table(value, told)
    else:
        _tell(vars(value), told)
    told(b"</>")


def _whole(value: object) -> bytes:
    pieces: list[bytes] = []
    _tell(value, pieces.append)
    return b"".join(pieces)


def _tell_table(value: object, told: Callable[[bytes], object]) -> None:
    # Of a friction law from a table: what its class says its fields do not tell.
    values = value.kernel_values() if isinstance(value, FrictionLaw) else None
    if values and values.table:
        _tell(values, told)


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
