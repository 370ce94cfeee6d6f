"""Gravity: the equilibrium under permanent loads, which a time history starts from."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace
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
from frames.assembly.nonlinear import with_axial_forces
from frames.assembly.ritz import basis_of
from frames.assembly.supports import load_path
from frames.bundles.nonlinear_data import parts_arrays
from frames.model import sanity_checks
from frames.model.frame_data import FrameData
from frames.statics.blas_threads import blas_threads_for
from frames.statics.equilibrium import find_equilibrium, put_at_rest
from frames.statics.gravity_state import GravityState, expand
from frames.statics.springs import first_displacement, have_same_springs
from lir_element.argument_checks import require_choice, require_type
from lir_element.device.features import LEVELS

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.coordinates import Basis
    from frames.assembly.system import System
    from lir_element import Features


def gravity(
    frame: FrameData,
    features: Features | None = None,
    level: str | Mapping[str, str] = "pendulum",
) -> GravityState:
    """Return a frame in equilibrium under its permanent loads.

    A first, linear solution gives the members' axial forces and so the geometric stiffness. The
    bearings are then solved with all their nonlinearity, so that their axial forces are those of
    the equilibrium.

    Parameters
    ----------
    frame : Frame
        The model, with at least one bearing.
    features : Features, optional
        Modelled features; all if None. Without vertical coupling the equilibrium is found again,
        with the bearings' axial forces of the first one as their constant loads.
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
        After Ctrl-C: there is no equilibrium to return yet.

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

    `like` is that of the same structure on other bearings, with these features and levels: data
    independent of bearings come from there.
    """
    prepared = prepare(frame, features, level, like)
    began = perf_counter()
    if like is not None and prepared.geometric is like.geometric:
        return at_rest(prepared, like.basis, 0.0, like=like)
    basis = basis_of(prepared.system, prepared.geometric, frame.damping)
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
        of_nodes = node_geometric_stiffness(system, member_forces)
        geometric = geometric_stiffness(system, of_nodes)
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
    """Return the level of each bearing."""
    require_type("level", level, (str, Mapping), "a level, or levels by name of bearing")
    given = dict.fromkeys(names, level) if isinstance(level, str) else dict(level)
    unknown = sorted(set(given) - set(names))
    if unknown:
        msg = f'level names "{unknown[0]}": the model has the bearings {", ".join(names)}'
        raise ValueError(msg)
    for value in given.values():
        require_choice("level of a bearing", value, LEVELS)
    return {name: given.get(name, "pendulum") for name in names}
