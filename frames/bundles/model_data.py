"""The frame in bearing coordinates as the time loop reads it, and its bearings.

Coordinates that many bearings share, such as a diaphragm's, are listed apart:
frames/kernels/shared_tangent.py uses them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lir_element.bundles.contact_data import Contacts, contact_arrays
from lir_element.device.features import apply
from lir_element.layout import PROPS

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from frames._types import IntArray, SparseMatrix
    from frames.assembly.coordinates import Basis
    from frames.assembly.system import System

    Array = npt.NDArray[Any]

MANY = 200  # unknowns of bearings, from which on those that few share are kept apart
_SHARED_BY = 8  # bearings at least
_FEW = 0.1  # of the unknowns at most


class ReducedModel(NamedTuple):
    """The frame in bearing coordinates, and its bearings."""

    mass_b: Array
    mass_be: Array
    mass_eb: Array
    mass_e: Array
    stiffness_b: Array
    damping_b: Array  # of size zero if there is none
    omega2: Array
    damping_e: Array
    damping_be: Array  # full damping besides; of size zero if the modes' is diagonal
    damping_eb: Array
    damping_ee: Array
    load_b: Array
    load_e: Array
    inertia_b: Array
    inertia_e: Array
    props: Array
    start: Array  # (n_bearings, 13): first entry of each row of the maps below
    columns: Array
    values: Array
    place: Array  # (n_b,) of each coordinate in the tangent: those that many bearings share last
    at: Array  # (n_b,) the coordinates by place
    shared: Array  # (n_h,) those that many bearings share, if there are many coordinates


def model_arrays(system: System, basis: Basis, static_load: Array | None = None) -> ReducedModel:
    """Return the frame as the time loop reads it; `static_load` as in `features.apply`."""
    rows = system.bearing_rows[:, basis.bearing_dofs].tocsr()
    rows.sort_indices()
    count = len(system.bearings)
    pointers = rows.indptr.astype(np.int64)
    start = np.zeros((count, 13), dtype=np.int64)
    for k in range(count):
        start[k] = pointers[12 * k : 12 * k + 13]

    def plain(array: Array) -> Array:
        return np.ascontiguousarray(array, dtype=np.float64)

    shared = shared_coordinates(system, rows)
    at = order_of(shared, rows.shape[1])
    return ReducedModel(
        mass_b=plain(basis.mass_b),
        mass_be=plain(basis.mass_be),
        mass_eb=plain(basis.mass_be.T),
        mass_e=plain(basis.mass_e),
        stiffness_b=plain(basis.stiffness_b),
        damping_b=plain(basis.damping_b if basis.damping_b.any() else np.zeros((0, 0))),
        omega2=plain(basis.omega2),
        damping_e=plain(basis.damping_e),
        damping_be=plain(basis.damping_be),
        damping_eb=plain(basis.damping_be.T),
        damping_ee=plain(basis.damping_ee),
        load_b=plain(basis.load_b),
        load_e=plain(basis.load_e),
        inertia_b=plain(basis.inertia_b),
        inertia_e=plain(basis.inertia_e),
        props=apply(system.features, device_records(system), static_load),
        start=start,
        columns=rows.indices.astype(np.int64),
        values=plain(rows.data),
        place=np.argsort(at).astype(np.int64),
        at=at,
        shared=shared,
    )


def device_records(system: System) -> Array:
    """Return the properties of all bearings with everything modelled."""
    found = np.zeros(len(system.bearings), dtype=PROPS)
    for k, placed in enumerate(system.bearings):
        found[k : k + 1] = placed.bearing.to_record()
    return found


def contacts_of(system: System, levels: Sequence[str]) -> Contacts | None:
    """Return the contact points of those bearings whose level asks for them; None if none does."""
    chosen = [level == "contact" for level in levels]
    if not any(chosen):
        return None
    return contact_arrays([placed.bearing for placed in system.bearings], chosen, system.gravity)


def shared_coordinates(system: System, rows: SparseMatrix) -> IntArray:
    """Return those coordinates of b that many bearings share, if it pays to keep them apart.

    Shapes: rows (12 n_bearings, n_b), result (n_h,).
    """
    n_b = rows.shape[1]
    if n_b < MANY or len(system.parts.kind):
        return np.zeros(0, dtype=np.int64)
    row, column = rows.tocoo().coords
    pairs = np.unique(np.column_stack([column, row // 12]), axis=0)
    shared = np.flatnonzero(np.bincount(pairs[:, 0], minlength=n_b) >= _SHARED_BY)
    return shared if len(shared) <= _FEW * n_b else shared[:0]


def order_of(shared: IntArray, count: int) -> IntArray:
    """Return the coordinates (count,) with the shared ones last.

    Shapes: shared (n_h,), result (count,).
    """
    is_shared = np.zeros(count, dtype=np.int64)
    is_shared[shared] = 1
    return np.argsort(is_shared, kind="stable").astype(np.int64)
