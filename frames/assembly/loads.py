"""Masses and permanent loads at the nodes of a frame, and loads of spans as forces of clamped ends.

By Betti's theorem the force of a clamp is the work of the load on the deflection under a unit
displacement of this end, negative. With the shape functions of the elastic stiffness, which are
exact for end displacements, it is exact, with shear deformation and without.

Source: Przemieniecki, Theory of Matrix Structural Analysis (1968), sec. 5.6 [Prz68], with the shape
functions of a beam with shear deformation as in Friedman & Kosmatka, An improved two-node
Timoshenko beam finite element, Comput. Struct. 47 (1993) 473-481.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from frames.assembly.members import shear_parameters
from frames.model.axes import to_global
from frames.model.load_combinations import load_masses

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.members import MemberArrays
    from frames.assembly.system import MemberTable
    from frames.model.frame_data import FrameData
    from frames.model.load_combinations import AppliedLoads, SpanLoad

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact to degree 5: load 1, shapes 3


def span_end_forces(
    members: MemberArrays, place: Mapping[str, int], spans: Sequence[SpanLoad]
) -> FloatArray:
    """Return the end forces of clamped members under tapered loads, in local axes.

    Shapes: result (n, 12).
    """
    forces = np.zeros((members.length.size, 12))
    if not spans:
        return forces
    rows = np.array([place[span.member] for span in spans], dtype=np.int64)
    a, b = (np.array([getattr(span.load, end) for span in spans]) for end in "ab")
    near, far = (
        np.einsum("kab,kb->ka", members.axes[rows], [getattr(span.load, end) for span in spans])
        for end in ("start", "end")
    )
    length = members.length[rows]
    phi_y, phi_z = (phi[rows] for phi in shear_parameters(members))
    found = np.zeros((len(spans), 12))
    for point, weight in zip(0.5 * (1.0 + _POINTS), 0.5 * _WEIGHTS, strict=True):
        share = (a + point * (b - a)) / length
        part = (weight * (b - a))[:, None] * (near + point * (far - near))  # N
        found[:, 0] -= part[:, 0] * (1.0 - share)
        found[:, 6] -= part[:, 0] * share
        for axis, turn, sign, phi in ((1, 5, 1.0, phi_y), (2, 4, -1.0, phi_z)):
            for end, (move, slope) in enumerate(_shapes(share, phi)):
                found[:, 6 * end + axis] -= part[:, axis] * move
                found[:, 6 * end + turn] -= sign * part[:, axis] * slope * length
    np.add.at(forces, rows, found)
    return forces


def _shapes(s: FloatArray, phi: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    # Deflection at s = x / L of a unit displacement and of a unit slope (over L) of ends i and j.
    below = 1.0 / (1.0 + phi)
    near = below * (1.0 - 3.0 * s**2 + 2.0 * s**3 + phi * (1.0 - s))
    far = below * (3.0 * s**2 - 2.0 * s**3 + phi * s)
    bulge = 0.5 * phi * (s - s**2)
    return [
        (near, below * (s - 2.0 * s**2 + s**3 + bulge)),
        (far, below * (s**3 - s**2 - bulge)),
    ]


def lumped_masses(
    frame: FrameData, index: Mapping[str, int], members: MemberTable, applied: AppliedLoads
) -> tuple[FloatArray, FloatArray]:
    """Return the masses at the nodes: lumped ones, those of members, and those that loads make.

    Shapes: mass (n_nodes, 6), weighing (n_nodes, 6).
    """
    mass = np.zeros((len(index), 6))
    for name, values in frame.masses.items():
        mass[index[name]] += values
    half = 0.5 * members.arrays.density * members.arrays.area * members.arrays.length
    for end in (0, 1):
        np.add.at(mass[:, :3], members.nodes[:, end], half[:, None])
    weighing = mass.copy()
    for name, values in frame.weightless_masses.items():
        weighing[index[name]] -= values
    for name, made in load_masses(frame, applied).items():
        mass[index[name], :3] += made
    return mass, weighing


def permanent_loads(
    frame: FrameData,
    index: Mapping[str, int],
    members: MemberTable,
    weighing: FloatArray,
    applied: AppliedLoads,
) -> FloatArray:
    """Return weights and permanent loads at the nodes, superelements left out.

    Shapes: weighing (n_nodes, 6), result (6 n_nodes,).
    """
    load = np.zeros((len(index), 6))
    load[:, 2] -= frame.weight_factor * frame.gravity * weighing[:, 2]
    for name, values in frame.loads.items():
        load[index[name]] += values
    for name, values, _ in applied.nodes:
        load[index[name]] += values
    flat = load.ravel()
    np.subtract.at(flat, members.dofs, to_global(members.fixed_end, members.arrays.axes))
    return flat
