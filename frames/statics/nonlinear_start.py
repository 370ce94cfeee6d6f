"""Nonlinear parts of a structure under its permanent loads: at rest, and elastic."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.assembly.nonlinear_parts import BOUC_WEN, HINGE, SCRATCH, STATE_SIZE, STRIDE
from frames.bundles.nonlinear_data import parts_arrays
from frames.kernels.hinges import is_outside, set_forces, set_stress
from frames.model.laws import Bilinear, BoucWen

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.basis import Basis
    from frames.assembly.nonlinear_parts import NonlinearParts
    from frames.assembly.system import System
    from frames.bundles.nonlinear_data import NonlinearElements


def parts_at_rest(
    system: System, basis: Basis, displacement: FloatArray
) -> NonlinearElements | None:
    """Return the nonlinear parts as a time history starts with them.

    Shapes: displacement (n_free,).
    """
    found = system.parts
    if not len(found.kind):
        return None
    parts = parts_arrays(found, system.part_rows, basis)
    d = np.asarray(system.part_rows @ displacement)
    d[np.abs(found.elastic) <= 0.0] = 0.0  # put in later
    refuse_yielding(found, d)
    parts.d_old[:], parts.d[:] = d, d
    for k in np.flatnonzero(found.kind == BOUC_WEN):
        parts.old[k, 0] = d[found.first[k]] / found.par[k, 6]
    parts.new[:] = parts.old
    return parts


def refuse_yielding(found: NonlinearParts, d: FloatArray) -> None:
    """Raise a ModelError if a part yields at deformations (m,) under permanent loads."""
    for k, link in enumerate(found.links):
        if not isinstance(link.law, Bilinear | BoucWen):
            continue
        force = link.law.stiffness * abs(float(d[found.first[k]]))
        if force > link.law.yield_force:
            message = (
                f'link "{link.name}" carries {force:.4g} N (N m) of the permanent loads and yields '
                f"at {link.law.yield_force:.4g}: make it stronger, let other parts carry them, or "
                "turn it out of their direction"
            )
            raise ModelError(message)
    sigma, forces, at_rest, scratch = (
        np.zeros(3),
        np.zeros(5),
        np.zeros(STATE_SIZE),
        np.zeros(SCRATCH),
    )
    for k, member in enumerate(found.hinged, start=len(found.links)):
        par = found.par[k]
        set_forces(par, at_rest, d[found.first[k] : found.first[k + 1]], forces)
        for hinge, end in enumerate("ij"):
            at = HINGE + STRIDE * hinge
            set_stress(par, hinge, at_rest, forces, sigma)
            if par[at + 8] > 0.0 and is_outside(par, at, sigma, scratch):
                n, m_y, m_z = sigma
                message = (
                    f'the hinge at end {end} of member "{member}" yields under the permanent '
                    f"loads, with N = {n:.4g} N, My = {m_y:.4g} N m, Mz = {m_z:.4g} N m: make the "
                    "member stronger, or release its moments there"
                )
                raise ModelError(message)
