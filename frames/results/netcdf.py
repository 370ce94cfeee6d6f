"""Files of results written and read through h5py alone, six times as fast as through h5netcdf.

h5netcdf looks each dimension and variable up in the file whenever it names one: 5 ms a variable, of
which results have 150. What is laid out here is what it lays out (netCDF 4: scales of dimensions,
their numbers, fill values); xarray encodes and decodes it as ever. Where a Dataset or a file has
something that results do not have, `written` and `read` return None: that is for h5netcdf.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from xarray import conventions

if TYPE_CHECKING:
    from pathlib import Path

_NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable."
_OF_HDF5 = frozenset({
    "CLASS", "DIMENSION_LIST", "NAME", "REFERENCE_LIST", "_NCProperties", "_Netcdf4Coordinates",
    "_Netcdf4Dimid",
})  # fmt: skip
_NUMBERS = frozenset("iuf")
_ENCODED = frozenset({"_FillValue", "complevel", "dtype", "shuffle", "zlib"})
"""Of an encoding, what is written here."""
_HARMLESS = frozenset({
    "chunksizes", "contiguous", "coordinates", "fletcher32", "original_shape", "preferred_chunks",
    "source", "szip", "zstd", "bzip2", "blosc",
})  # fmt: skip
"""Of an encoding, what tells of the file read from, unless it is of another compression."""


def written(data: xr.Dataset, encoding: Mapping[Hashable, Mapping[str, Any]]) -> bytes | None:
    """Return a Dataset as the content of a netCDF file.

    Parameters
    ----------
    data : xarray.Dataset
        Any.
    encoding : mapping of str to mapping
        How variables are stored, as xarray takes it.

    Returns
    -------
    bytes or None
        None if there is something in the Dataset that results do not have.
    """
    import h5py

    own = data.copy()  # whose encodings are its own
    for name, stored in encoding.items():
        own[name].encoding = dict(stored)
    variables, attributes = conventions.cf_encoder(*conventions.encode_dataset_coordinates(own))
    if not (_is_plain(attributes) and all(_is_ordinary(n, v) for n, v in variables.items())):
        return None
    with h5py.File("results", "w", driver="core", backing_store=False, track_order=True) as file:
        version = f"version=2,h5py={h5py.__version__},hdf5={h5py.version.hdf5_version}"
        file.attrs["_NCProperties"] = np.bytes_(version)
        _put_attributes(file, attributes)
        numbers = _put_variables(file, variables)
        for name, variable in variables.items():
            _label(file, str(name), variable, numbers)
        file.flush()
        return bytes(file.id.get_file_image())


def _is_plain(attributes: Mapping[Any, Any]) -> bool:
    # Texts, lists of texts and numbers, by names that are not taken.
    def plain(value: Any) -> bool:
        texts = value if isinstance(value, list) else [value]
        if texts and all(isinstance(one, str) for one in texts):
            return True
        return np.asarray(value).dtype.kind in _NUMBERS and np.size(value) > 0

    return all(
        isinstance(name, str) and "/" not in name and name not in _OF_HDF5 and plain(value)
        for name, value in attributes.items()
    )


def _is_ordinary(name: Hashable, variable: xr.Variable) -> bool:
    # Numbers or texts over dimensions that are not empty, and nothing asked for that is not here.
    is_text = _is_text(variable)
    encoding = {key: value for key, value in variable.encoding.items() if value is not None}
    asked = {key for key in _HARMLESS if encoding.get(key) is True} - {"contiguous"}
    return (
        isinstance(name, str)
        and "/" not in name
        and not name.startswith("_nc4_non_coord_")
        and (name not in variable.dims or variable.dims == (name,))
        and all(isinstance(dim, str) for dim in variable.dims)
        and len(set(variable.dims)) == variable.ndim
        and variable.size > 0
        and (is_text or _is_number(variable.dtype))
        and not (is_text and "_FillValue" in variable.attrs)
        and (is_text or encoding.get("dtype") is None)  # cf_encoder has made numbers of it
        and set(encoding) <= _ENCODED | _HARMLESS
        and not asked
        and _is_plain(variable.attrs)
    )


def _is_text(variable: xr.Variable) -> bool:
    if variable.dtype.kind == "U":
        return True
    return variable.dtype.kind == "O" and all(isinstance(one, str) for one in variable.values.flat)


def _put_attributes(owner: Any, attributes: Mapping[Any, Any]) -> None:
    for name, value in attributes.items():
        is_number = np.isscalar(value) and not isinstance(value, str)
        owner.attrs[name] = np.atleast_1d(value) if is_number else value


def _put_scale(file: Any, name: str, size: int) -> None:
    # A dimension without coordinates.
    scale = file.create_dataset(name, (size,), ">f4", track_order=True)
    scale.make_scale(_NO_VARIABLE + f"{size:10}".encode())


def _dataset(file: Any, name: str, variable: xr.Variable) -> Any:
    # The values of a variable, as they are to be stored.
    import h5py

    values, options = variable.values, dict[str, Any]()
    if _is_text(variable):
        return file.create_dataset(
            name, data=values.astype(object), dtype=h5py.string_dtype(), track_order=True
        )
    if variable.encoding.get("zlib") and variable.shape:
        options = {"compression": "gzip", "compression_opts": variable.encoding.get("complevel")}
        options |= {"shuffle": bool(variable.encoding.get("shuffle"))}
    return file.create_dataset(
        name,
        data=values,
        fillvalue=variable.attrs.get("_FillValue"),
        track_order=True,
        **options,
    )


def _put_variables(file: Any, variables: Mapping[Hashable, xr.Variable]) -> dict[str, int]:
    # All values, and the scales of dimensions; returns the numbers of these.
    sizes: dict[Any, int] = {}
    for variable in variables.values():
        sizes |= variable.sizes
    for name, size in sizes.items():
        if name not in variables:
            _put_scale(file, name, size)
    for each, variable in variables.items():
        stored = _dataset(file, str(each), variable)
        if each in sizes:
            stored.make_scale(str(each).encode())
    numbers = {name: number for number, name in enumerate(sizes)}
    for name, number in numbers.items():
        file[name].attrs["_Netcdf4Dimid"] = np.int32(number)
    return numbers


def _label(file: Any, name: str, variable: xr.Variable, numbers: Mapping[str, int]) -> None:
    # The dimensions and the attributes of a variable.
    stored, own = file[name], [numbers[str(dim)] for dim in variable.dims]
    if own:
        stored.attrs["_Netcdf4Coordinates"] = np.array(own, np.int32)
    if own and name not in numbers:
        stored.attrs["_Netcdf4Dimid"] = np.int32(own[0])
        for axis, dim in enumerate(variable.dims):
            stored.dims[axis].attach_scale(file[str(dim)])
    given = dict(variable.attrs)
    if "_FillValue" in given:
        given["_FillValue"] = variable.dtype.type(given["_FillValue"])
    _put_attributes(stored, given)


def read(path: str | Path) -> xr.Dataset | None:
    """Read a netCDF file, all of it.

    Parameters
    ----------
    path : str or path
        The file.

    Returns
    -------
    xarray.Dataset or None
        None if it has something that files of results do not have.

    Raises
    ------
    OSError
        If it is no file of HDF5.
    """
    import h5py

    source = os.path.abspath(path)
    variables: dict[Hashable, xr.Variable] = {}
    with h5py.File(path, "r", track_order=True) as file:
        attributes, numbers = _attributes(file), _numbers(file)
        for name, stored in file.items():
            if not isinstance(stored, h5py.Dataset):
                return None
            if bytes(stored.attrs.get("NAME", b"")).startswith(_NO_VARIABLE):
                continue
            kept, dims = _attributes(stored), _dimensions(name, stored, numbers)
            letters = h5py.check_string_dtype(stored.dtype)
            is_text = letters is not None and letters.length is None
            is_known = is_text or _is_number(stored.dtype)
            if attributes is None or kept is None or dims is None or not is_known:
                return None
            values = stored.asstr()[...] if is_text else stored[...]
            encoding = _encoding(stored, dims, is_text) | {"source": source}
            variables[name] = xr.Variable(dims, values, kept, encoding)
    decoded, rest, coordinates = conventions.decode_cf_variables(variables, attributes or {})
    data = xr.Dataset(decoded, attrs=rest)
    data = data.set_coords(coordinates & set(decoded))
    data.encoding["source"] = source
    return data.load()


def _is_number(kind: np.dtype[Any]) -> bool:
    return kind.kind in _NUMBERS and kind.isnative and kind.metadata is None


def _attributes(owner: Any) -> dict[str, Any] | None:
    # Texts and numbers, a number alone where there is one; None where there is anything else.
    found = {}
    for name in owner.attrs:
        if name in _OF_HDF5:
            continue
        value = owner.attrs[name]
        if isinstance(value, np.ndarray):
            if value.ndim != 1 or not (value.dtype.kind in _NUMBERS or value.dtype.kind == "O"):
                return None
            value = value.tolist() if value.dtype.kind == "O" else value
            value = value[0] if len(value) == 1 else value
        elif not isinstance(value, str | np.number):
            return None
        found[name] = value
    return found


def _numbers(file: Any) -> dict[int, str]:
    # The dimensions by their numbers.
    scales = (
        (name, stored.attrs.get("_Netcdf4Dimid"))
        for name, stored in file.items()
        if "CLASS" in stored.attrs
    )
    return {int(number): name for name, number in scales if number is not None}


def _dimensions(name: str, stored: Any, numbers: Mapping[int, str]) -> tuple[str, ...] | None:
    # By the numbers of the scales: to follow references to them takes ten times as long.
    if not stored.shape:
        return ()
    if "CLASS" in stored.attrs:
        return (name,) if stored.ndim == 1 else None
    own = [int(number) for number in stored.attrs.get("_Netcdf4Coordinates", ())]
    if len(own) != stored.ndim or not set(own) <= set(numbers):
        return None
    return tuple(numbers[number] for number in own)


def _encoding(stored: Any, dims: tuple[str, ...], is_text: bool) -> dict[str, Any]:
    # How it is stored, as far as it matters to who saves it again.
    found: dict[str, Any] = {"dtype": str if is_text else stored.dtype}
    found |= {"original_shape": stored.shape, "chunksizes": stored.chunks}
    found |= {"contiguous": stored.chunks is None}
    if stored.chunks:
        found["preferred_chunks"] = dict(zip(dims, stored.chunks, strict=True))
    if stored.compression == "gzip":
        found |= {"zlib": True, "complevel": stored.compression_opts, "shuffle": stored.shuffle}
    return found
