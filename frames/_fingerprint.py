"""Short digests of values by their content: whether it is the same model or motion again."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import fields, is_dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from scipy.sparse import issparse

from lir_element.device.friction import FrictionLaw

if TYPE_CHECKING:
    from frames.motion.ground_motion import GroundMotion

Key = TypeVar("Key")

_MOST_KNOWN = 5000  # dataclasses whose content is kept: some megabytes


def fingerprint(value: object) -> str:
    """Return a digest of a value by its content, the same in every process.

    Examples
    --------
    >>> fingerprint({"a": {"x", "y"}}) == fingerprint({"a": {"y", "x"}})
    True
    """
    return fingerprints({None: value})[None]


def fingerprints(values: Mapping[Key, object]) -> dict[Key, str]:
    """Return the digest of each value; parts that several share are read once."""
    known: dict[int, tuple[object, bytes]] = {}
    found = {}
    for key, value in values.items():
        digest = hashlib.sha256()
        _tell(value, digest.update, known)
        found[key] = digest.hexdigest()[:16]
        if len(known) > _MOST_KNOWN:
            known.clear()
    return found


def _tell(
    value: Any, told: Callable[[bytes], object], known: dict[int, tuple[object, bytes]]
) -> None:
    # Yields the content of a value piece by piece; `known` are dataclasses with their content.
    name = type(value).__name__
    if value is None or isinstance(value, (str, bytes, bool, int, float, np.generic)):
        told(f"<{name}>{value!r}</>".encode())
        return
    if is_dataclass(value):
        if id(value) not in known:
            known[id(value)] = value, _content(value, known)
        told(known[id(value)][1])
        return
    told(f"<{name}>".encode())
    if isinstance(value, (tuple, list)):
        for each in value:
            _tell(each, told, known)
    elif isinstance(value, np.ndarray):
        told(f"{value.dtype.str}{value.shape}".encode())
        told(np.ascontiguousarray(value).tobytes())
    elif issparse(value):
        given: Any = value
        whole = given.tocsr(copy=True)
        whole.sum_duplicates()
        _tell((whole.shape, whole.data, whole.indices, whole.indptr), told, known)
    elif isinstance(value, Mapping):
        for key, each in value.items():
            _tell(key, told, known)
            _tell(each, told, known)
    elif isinstance(value, AbstractSet):
        pieces: list[list[bytes]] = [[] for _ in value]
        for each, own in zip(value, pieces, strict=True):
            _tell(each, own.append, known)
        for piece in sorted(map(b"".join, pieces)):
            told(piece)
    else:
        _tell(vars(value), told, known)
    told(b"</>")


@cache
def _fields(kind: type) -> tuple[tuple[str, bytes], ...]:
    # Names of a dataclass's fields, and their bytes for `_tell`.
    return tuple((each.name, f"<str>{each.name!r}</>".encode()) for each in fields(kind))


def _content(value: Any, known: dict[int, tuple[object, bytes]]) -> bytes:
    # Fields of a dataclass; of a friction law from a table also the statement of its class.
    kind = value if isinstance(value, type) else type(value)
    pieces = [f"<{type(value).__name__}><dict>".encode()]
    for name, told in _fields(kind):
        pieces.append(told)
        _tell(getattr(value, name), pieces.append, known)
    pieces.append(b"</>")
    values = value.kernel_values() if isinstance(value, FrictionLaw) else None
    if values and values.table:
        _tell(values, pieces.append, known)
    return b"".join((*pieces, b"</>"))


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
