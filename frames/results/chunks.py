"""Runs in chunks: a file of numpy's format each, whole or not there, read on use."""

from __future__ import annotations

import hashlib
import io
import json
import zlib
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing as xarray_indexing

from frames.results.storage import write_whole

if TYPE_CHECKING:
    from pathlib import Path

indexing: Any = xarray_indexing  # its types are those of another kind of arrays

ENDING = ".npz"
_NAME, _HEAD, _OF = "name", "head", "of "
_NOT_REACHED = {"seconds_loop", "run_digest"}  # a time that no run has twice, and its inputs
_DAMAGE = (OSError, ValueError, LookupError, TypeError, EOFError, BadZipFile, zlib.error)


def write_chunk(path: Path, data: xr.Dataset, *, compress: bool = False, **marks: Any) -> None:
    """Write runs and marks on them, in one move; attributes and marks must be valid JSON."""
    arrays: dict[str, Any] = {}
    told: dict[str, Any] = {}
    for name, variable in data.variables.items():
        values = variable.to_numpy()
        arrays[f"{_OF}{name}"] = _bytes(values) if values.dtype.kind in "UO" else values
        told[str(name)] = {
            "dims": variable.dims,
            "shape": variable.shape,
            "attrs": variable.attrs,
            "kind": values.dtype.kind,
            "label": name in data.coords,
        }
    head = {"variables": told, "attrs": data.attrs, "marks": marks}
    arrays |= {_NAME: np.array(path.name), _HEAD: np.array(json.dumps(head))}
    whole = io.BytesIO()
    (np.savez_compressed if compress else np.savez)(whole, **arrays)
    write_whole(path, whole.getbuffer())


def marks_of(path: Path, error: type[ValueError] = ValueError) -> dict[str, Any]:
    """Return the marks on the runs of a chunk."""
    with _opened(path, error) as file:
        return dict(json.loads(str(file[_HEAD]))["marks"])


def load_chunk(
    path: Path, *, lazy: bool = False, error: type[ValueError] = ValueError
) -> xr.Dataset:
    """Return the runs of a chunk, with its marks as `encoding`.

    Lazy: numbers along `run` are read on use.
    """
    data: dict[str, xr.Variable] = {}
    labels: dict[str, xr.Variable] = {}
    with _opened(path, error) as file:
        head = json.loads(str(file[_HEAD]))
        for name, told in head["variables"].items():
            dims, shape = told["dims"], tuple(told["shape"])
            if lazy and dims[:1] == ["run"] and told["kind"] == "f" and not told["label"]:
                values = Rows({0: path}, name, shape[0], shape, "f", error).unread()
            else:
                values = _texts(file[f"{_OF}{name}"], told["kind"])
            own = labels if told["label"] else data
            own[name] = xr.Variable(dims, values, told["attrs"])
    found = xr.Dataset(data, labels, head["attrs"])
    found.encoding = head["marks"]
    return found


@dataclass(eq=False)
class Rows(BackendArray):
    """A variable along `run`; rows of chunks that are not there are NaN or ""."""

    chunks: Mapping[int, Path]
    name: str
    runs: int  # of a chunk
    shape: tuple[int, ...]
    kind: str  # "f", else texts
    error: type[ValueError] = ValueError

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values."""
        return np.dtype(np.float64 if self.kind == "f" else object)

    def unread(self) -> Any:
        """Return a Dataset's lazy array, which reads it on use."""
        return indexing.LazilyIndexedArray(self)

    def __getitem__(self, key: Any) -> Any:
        """Return a part."""
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._part)

    def _part(self, key: tuple[Any, ...]) -> Any:
        chosen = np.arange(self.shape[0])[key[0]]
        rows, others = np.atleast_1d(chosen), key[1:]
        empty: Any = np.nan if self.kind == "f" else ""
        none = np.broadcast_to(empty, (len(rows), *self.shape[1:]))
        found = np.array(_outer(none, others), dtype=self.dtype)
        numbers = rows // self.runs
        order = np.argsort(numbers, kind="stable")
        for at in np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1):
            number = int(numbers[at[0]]) if len(at) else -1
            if number in self.chunks:
                with _opened(self.chunks[number], self.error) as file:
                    values = _texts(file[f"{_OF}{self.name}"], self.dtype.kind)
                    found[at] = _outer(values[rows[at] - number * self.runs], others)
        return found if np.ndim(chosen) else found[0]


def _outer(values: Any, key: tuple[Any, ...]) -> Any:
    # An index for each axis but the first, each by itself.
    for axis in range(len(key), 0, -1):
        values = values[(slice(None),) * axis + (key[axis - 1],)]
    return values


@contextmanager
def _opened(path: Path, error: type[ValueError]) -> Generator[Any, None, None]:
    # The arrays of a chunk by name; any kind of damage is one error.
    try:
        with path.open("rb") as content, np.load(content) as file:
            if (name := str(file[_NAME])) != path.name:
                msg = f"a copy of {name}"
                raise ValueError(msg)
            yield file
    except _DAMAGE as cause:
        msg = f"{path} is damaged ({cause}): remove it, and run again"
        raise error(msg) from cause


def _bytes(texts: Any) -> Any:
    found = [text.encode() for text in texts.ravel().tolist()]
    return np.array(found, dtype="S").reshape(texts.shape)


def _texts(values: Any, kind: str) -> Any:
    # Values as they were given: texts, which are stored as bytes, as texts.
    if values.dtype.kind != "S":
        return values
    found = [text.decode() for text in values.ravel().tolist()]
    return np.array(found, dtype=kind).reshape(values.shape)


def digest_of(chunks: Iterable[Mapping[str, Any]]) -> str:
    """Return a digest of arrays (runs, ...) by name, however the runs are parted into chunks."""
    found: dict[str, Any] = {}
    for arrays in chunks:
        for name in arrays.keys() - _NOT_REACHED:
            found.setdefault(name, hashlib.sha256()).update(_content(np.asarray(arrays[name])))
    whole = "".join(f"{name} {found[name].hexdigest()}\n" for name in sorted(found))
    return hashlib.sha256(whole.encode()).hexdigest()


def _content(values: Any) -> bytes:
    if values.dtype.kind == "f":
        return np.where(np.isnan(values), np.nan, values).astype("<f8").tobytes()  # one NaN
    return "".join(f"{text}\0" for text in values.ravel().tolist()).encode()
