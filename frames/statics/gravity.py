"""Gravity: the equilibrium under permanent loads, which a time history starts from."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError, ModelWarning
from frames.assembly.assemble import (
    assemble,
    geometric_stiffness,
    member_axial_forces,
    node_geometric_stiffness,
)
from frames.assembly.basis import Basis, build_basis
from frames.assembly.nonlinear import with_axial_forces
from frames.assembly.supports import LoadPath, load_path
from frames.bundles.nonlinear_data import parts_arrays
from frames.model import sanity_checks
from frames.model.frame_data import FrameData
from frames.statics.blas_threads import blas_threads_for
from frames.statics.equilibrium import find_equilibrium, put_at_rest
from frames.statics.sanity_checks import held_periods, sanity_warnings
from frames.statics.springs import first_displacement, have_same_springs
from lir_element.argument_checks import require_choice, require_type
from lir_element.element import LEVELS
from lir_element.tables import html_table

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.assemble import System
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState
    from lir_element import Features
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
        What the kernels work on; `run` holds the equilibrium as committed state.
    contacts : Contacts or None
        Sliders of the bearings at the level 'contact'.
    displacement : ndarray, (n_free,)
        Displacements q under gravity.
    axial_forces : ndarray, (n_bearings,)
        Axial forces of the bearings, compression positive [N].
    seconds : float
        Time of computation, compilation aside [s].
    load_path : LoadPath
        What the bearings carry of the weight above them, and what supports take past them.
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
        """How forces of nonlinear parts displace what has no mass, (n_free, m) [m/N, ...]."""
        return self.basis.shift(self.system.part_rows.T.toarray())

    @property
    def held_periods(self) -> tuple[float, ...]:
        """Periods of the structure with its bearings and their plates held, longest first [s]."""
        return held_periods(self.basis.omega2, self.basis.mass_e)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is strange about the model, a sentence each: lost loads, numbers in other units."""
        found = sanity_warnings(self.system, self.axial_forces, self.held_periods)
        lost = self.load_path.sentence()
        return (lost, *found) if lost else found

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


def gravity(
    frame: FrameData,
    features: Features | None = None,
    level: str | Mapping[str, str] = "pendulum",
) -> GravityState:
    """Bring a frame into equilibrium under its permanent loads.

    The members' axial forces of a first, linear solution give the geometric stiffness; the
    bearings are then solved with all their nonlinearity, so that their axial forces are those of
    the equilibrium.

    Parameters
    ----------
    frame : Frame
        The model, with at least one bearing.
    features : Features, optional
        What is modelled; everything if None. Without vertical coupling the equilibrium is sought
        again, the bearings' axial forces of the first one being their constant loads.
    level : str or mapping
        Level of fidelity of the bearings, one for all or by name of bearing ("pendulum" for those
        that it does not name).

    Returns
    -------
    GravityState
        The equilibrium.

    Raises
    ------
    ModelError
        If the model cannot work, or is unstable under its permanent loads.
    TypeError
        If it is no Frame.
    AnalysisError
        If there is no equilibrium, or a bearing carries no compression.
    KeyboardInterrupt
        After Ctrl-C: there is no equilibrium yet that could be handed back.

    Warns
    -----
    ModelWarning
        If supports other than bearings carry weight, or numbers look as if given in other units
        (`Frame.check` lists the same).

    Examples
    --------
    >>> from frames import gravity, lumped_mass
    >>> from frames.demo import bearing_for
    >>> state = gravity(lumped_mass(bearing_for(2000e3), mass=204e3))
    >>> (state.axial_forces / 1e3).round(0).tolist()
    [2001.0]
    """
    require_type("frame", frame, FrameData, "a Frame")
    with blas_threads_for(frame):
        return equilibrium_of(frame, features, level)


def equilibrium_of(
    frame: FrameData,
    features: Features | None,
    level: str | Mapping[str, str],
    like: GravityState | None = None,
) -> GravityState:
    """Return the state of `gravity`, to the bit.

    `like` is that of the same structure on other bearings, with these features and levels: what
    does not depend on bearings is taken from there.
    """
    prepared = prepare(frame, features, level, like)
    began = perf_counter()
    if like is not None and prepared.geometric is like.geometric:
        return at_rest(prepared, like.basis, 0.0, like=like)
    basis = build_basis(prepared.system, prepared.geometric, frame.damping)
    return at_rest(prepared, basis, perf_counter() - began)


class Prepared(NamedTuple):
    """A frame as matrices, before the choice of a basis."""

    system: System
    geometric: SparseMatrix
    node_geometric: SparseMatrix
    member_forces: FloatArray
    linear: FloatArray
    """Displacements on linear springs (n_free,)."""
    levels: dict[str, str]
    seconds: float


def prepare(
    frame: FrameData,
    features: Features | None,
    level: str | Mapping[str, str],
    like: GravityState | None = None,
) -> Prepared:
    """Check a frame and make its matrices, geometric stiffness included.

    Arguments as of `equilibrium_of`.
    """
    if like is None:
        sanity_checks.refuse_extent(frame)
    for doubt in sanity_checks.sanity_warnings(frame):
        warnings.warn(doubt, ModelWarning, stacklevel=3)
    began = perf_counter()
    levels = levels_of(tuple(frame.bearings), level)
    points = [name for name, own in levels.items() if own == "contact"]
    if like is None:
        system = assemble(frame, features, points)
    else:
        system = like.system.on(link.bearing for link in frame.bearings.values())
    if not system.bearings:
        message = "the frame has no bearing: add one with add_bearing"
        raise ModelError(message)
    if like is not None and have_same_springs(system, like.system):
        linear, member_forces = like.linear, like.member_forces
    else:
        linear = first_displacement(system, points)
        member_forces = member_axial_forces(system, linear)
    if like is not None and member_forces.tobytes() == like.member_forces.tobytes():
        geometric, of_nodes = like.geometric, like.node_geometric
    else:
        geometric = geometric_stiffness(system, member_forces)
        of_nodes = node_geometric_stiffness(system, member_forces)
        parts = with_axial_forces(system.parts, system.members, member_forces)
        system = system if parts is system.parts else replace(system, parts=parts)
    seconds = perf_counter() - began
    return Prepared(system, geometric, of_nodes, member_forces, linear, levels, seconds)


def at_rest(
    prepared: Prepared,
    basis: Basis,
    seconds: float,
    *,
    silent: bool = False,
    like: GravityState | None = None,
) -> GravityState:
    """Find the equilibrium under permanent loads in a basis, that of `like` if it is given."""
    began = perf_counter()
    system, geometric, of_nodes, member_forces, linear, levels, before = prepared
    parts = parts_arrays(system.parts, system.part_rows, basis)
    model = None if like is None else like.model
    found = find_equilibrium(system, basis, linear, levels, None, parts, model)
    compiling = found.compiling
    axial_forces = np.array(found.run.old["axial_force"])
    if not system.features.vertical_coupling:
        load = -found.run.old["force"][:, 8]
        found = find_equilibrium(system, basis, linear, levels, load, parts, model)
    displacement = expand(basis, found.run.b, found.run.e)
    if parts is not None:
        put_at_rest(system, parts, displacement)
    state = GravityState(
        system=system,
        linear=linear,
        geometric=geometric,
        node_geometric=of_nodes,
        member_forces=member_forces,
        basis=basis,
        model=found.model,
        run=found.run,
        contacts=found.contacts,
        displacement=displacement,
        axial_forces=axial_forces,
        seconds=before + seconds + perf_counter() - began - compiling,
        load_path=load_path(system, of_nodes, displacement, axial_forces),
        parts=parts,
    )
    for doubt in () if silent else state.doubts:
        warnings.warn(doubt, ModelWarning, stacklevel=3)
    return state


def levels_of(names: tuple[str, ...], level: str | Mapping[str, str]) -> dict[str, str]:
    """Look up the level of each bearing."""
    require_type("level", level, (str, Mapping), "a level, or levels by name of bearing")
    given = dict.fromkeys(names, level) if isinstance(level, str) else dict(level)
    unknown = sorted(set(given) - set(names))
    if unknown:
        msg = f'level names "{unknown[0]}": the model has the bearings {", ".join(names)}'
        raise ValueError(msg)
    for value in given.values():
        require_choice("level of a bearing", value, LEVELS)
    return {name: given.get(name, "pendulum") for name in names}


def expand(basis: Basis, b: FloatArray, e: FloatArray, *, offset: bool = True) -> FloatArray:
    """Return displacements q (..., n_free) of the free DOFs from b (..., n_b) and eta."""
    q: FloatArray = b @ basis.expand_b.T + e @ basis.expand_e.T
    return q + basis.offset if offset else q
