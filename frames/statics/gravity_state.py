"""A frame in equilibrium under its permanent loads, as recording and results read it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from frames.assembly.ritz import LARGE, is_large
from frames.assembly.supports import held_sideways
from frames.statics.sanity_checks import held_periods, sanity_warnings
from lir_element.texts import html_table, worded

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.coordinates import Basis
    from frames.assembly.supports import LoadPath
    from frames.assembly.system import System
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState
    from lir_element.bundles.contact_data import Contacts


@dataclass(frozen=True, repr=False)
class GravityState:
    """A frame in equilibrium under its permanent loads.

    Attributes
    ----------
    system : System
        Matrices over the free degrees of freedom.
    linear : ndarray, (n_free,)
        Displacements under permanent loads on linear springs in place of bearings.
    geometric : csr_array, (n_free, n_free)
        Geometric stiffness of the members under gravity.
    node_geometric : csr_array, (6 n_nodes, 6 n_nodes)
        The same over all nodal displacements.
    member_forces : ndarray, (n_members,)
        The members' axial forces it was made with, tension positive [N].
    basis : Basis
        The frame in bearing coordinates.
    model, run : ReducedModel, IntegrationState
        Input of the kernels; `run` holds the equilibrium as committed state.
    contacts : Contacts or None
        Sliders of the bearings at the level 'contact'.
    displacement : ndarray, (n_free,)
        Displacements q under gravity.
    axial_forces : ndarray, (n_bearings,)
        Axial forces of the bearings, compression positive [N].
    seconds : float
        Time of computation, compilation aside [s].
    load_path : LoadPath
        Forces of the bearings under the weight above them, and forces of supports beside them.
    parts : NonlinearElements or None
        Links and hinged members, at rest.

    Examples
    --------
    >>> from frames import gravity, lumped_mass
    >>> from frames.demo import bearing_for
    >>> state = gravity(lumped_mass(bearing_for(2000e3), mass=204e3))
    >>> str(state).split(";")[0]
    'GravityState: 2001 kN on 1 bearings, 2001 to 2001 kN each'
    """

    system: System
    linear: FloatArray
    geometric: SparseMatrix
    node_geometric: SparseMatrix
    member_forces: FloatArray
    basis: Basis
    model: ReducedModel
    run: IntegrationState
    contacts: Contacts | None
    displacement: FloatArray
    axial_forces: FloatArray
    seconds: float
    load_path: LoadPath
    parts: NonlinearElements | None

    @cached_property
    def part_shift(self) -> FloatArray:
        """Displacements of massless DOFs by forces of nonlinear parts, (n_free, m) [m/N, ...]."""
        return self.basis.shift(self.system.part_rows.T.toarray())

    @property
    def held_periods(self) -> tuple[float, ...]:
        """Periods of the structure with its bearings and their plates held, longest first [s]."""
        return held_periods(self.basis.omega2, self.basis.mass_e)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Unusual properties of the model, a sentence each: lost loads, numbers in other units."""
        found = sanity_warnings(self.system, self.axial_forces, self.held_periods)
        lost = self.load_path.sentence()
        beside = held_sideways(self.system, self.node_geometric, self.basis, self.axial_forces)
        return (*([lost] if lost else []), *beside, *self._vectors(), *found)

    def _vectors(self) -> list[str]:
        # Substitute for all modes of a large structure.
        if not is_large(self.system):
            return []
        return [
            worded(
                "{count} load-dependent vectors replace all modes of {free} displacements. "
                "Floor accelerations differ by a few percent, vertical ones of single nodes "
                "by more. For all modes stay below {most}, with a coarser mesh",
                free=len(self.displacement),
                count=len(self.basis.omega2),
                most=LARGE,
            )
        ]

    def __repr__(self) -> str:
        """Return sizes and axial forces on one line."""
        low, high = 1e-3 * self.axial_forces.min(), 1e-3 * self.axial_forces.max()
        return (
            f"GravityState: {1e-3 * self.axial_forces.sum():.4g} kN on {len(self.axial_forces)} "
            f"bearings, {low:.4g} to {high:.4g} kN each; {len(self.displacement)} degrees of "
            f"freedom, {len(self.basis.omega2)} fixed-base modes"
        )

    def _repr_html_(self) -> str:
        rows = [
            (name, f"{1e-3 * force:.4g} kN")
            for (name, _, _, _), force in zip(self.system.bearings, self.axial_forces, strict=True)
        ]
        return html_table(repr(self), rows, ("bearing", "axial force"))


def expand(basis: Basis, b: FloatArray, e: FloatArray, *, offset: bool = True) -> FloatArray:
    """Return displacements q (..., n_free) of the free DOFs from b (..., n_b) and eta."""
    q: FloatArray = b @ basis.expand_b.T + e @ basis.expand_e.T
    return q + basis.offset if offset else q
