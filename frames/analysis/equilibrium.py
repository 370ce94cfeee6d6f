"""The nonlinear equilibrium under permanent loads, also where Newton's method needs a way to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.assembly.assemble import node_geometric_stiffness
from frames.assembly.basis import bearing_rows
from frames.assembly.supports import load_path
from frames.kernel_data import Model, Run, contacts_of, model_arrays, run_arrays
from frames.kernels.stepping import solve_gravity
from lir_element.element import limit_detail
from lir_element.errors import AnalysisError, RunStatus
from lir_element.pieces import ready

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from frames._types import FloatArray
    from frames.assembly.assemble import System
    from frames.assembly.basis import Basis
    from lir_element.bundles.contact_data import Contacts

_FORCE_TOLERANCE = 1e-9  # of the total weight
_MAX_ITERATIONS = 100
_SOFTEST = 1e-2  # elastic sliding before slip over effective radius, where a search begins
_FACTORS = (0.1, 0.3, 0.7)  # by which it is brought down, the next where one fails
_MOST_STAGES = 60
_YIELDS = ("yield_displacement", "interface_yield")


class Equilibrium(NamedTuple):
    """A frame in equilibrium, as the kernels see it."""

    model: Model
    run: Run
    contacts: Contacts | None
    compiling: float  # s


def find_equilibrium(
    system: System,
    basis: Basis,
    linear: FloatArray,
    levels: Mapping[str, str],
    static_load: FloatArray | None,
) -> Equilibrium:
    """Find the equilibrium of a frame under its permanent loads.

    Newton's method starts from the linear solution. Where it fails, friction is softened: a large
    elastic sliding before slip, which is brought down to the true one stage by stage, each from
    the equilibrium before. The bearings are at rest before each solution, so that the last one is
    the equilibrium that was asked for.

    Parameters
    ----------
    system : System
        The frame.
    basis : Basis
        The frame in bearing coordinates.
    linear : ndarray, (n_free,)
        Displacements of the linear solution.
    levels : mapping of str to str
        Levels of the bearings by name.
    static_load : ndarray or None
        Constant loads of the bearings without vertical coupling [N].

    Returns
    -------
    Equilibrium
        What the kernels work on, the equilibrium being committed.

    Raises
    ------
    AnalysisError
        If there is no equilibrium, or a bearing carries no compression.
    """
    model = model_arrays(system, basis, static_load)
    chosen = [levels[name] for name, _, _, _ in system.bearings]
    tolerance = force_tolerance(system, _FORCE_TOLERANCE)
    guess = linear[basis.bearing_dofs]
    empty = run_arrays(model), contacts_of(system, chosen)
    compiling = ready(solve_gravity, model, *empty, tolerance, _MAX_ITERATIONS)

    def solve(first: FloatArray) -> tuple[RunStatus, Run, Contacts | None]:
        run, contacts = run_arrays(model), contacts_of(system, chosen)
        run.b[:] = first
        status = solve_gravity(model, run, contacts, tolerance, _MAX_ITERATIONS)
        return RunStatus(status), run, contacts

    status, run, contacts = solve(guess)
    if status is not RunStatus.OK and not _is_beyond(run):
        softer = _softened(model, solve, guess)
        if softer is not None:
            status, run, contacts = softer
    _raise_failure(system, run, status, linear)
    return Equilibrium(model, run, contacts, compiling)


def _softened(
    model: Model, solve: Callable[[FloatArray], tuple[RunStatus, Run, Contacts | None]],
    guess: FloatArray,
) -> tuple[RunStatus, Run, Contacts | None] | None:  # fmt: skip
    # Follow the equilibrium from soft friction to the true one; None if the way ends.
    props = model.props
    true = {name: props[name].copy() for name in _YIELDS}
    soft = _SOFTEST * float(props["length"].max())
    smallest = min(float(values.min()) for values in true.values())
    try:
        for name, values in true.items():
            props[name] = np.maximum(values, soft)
        found = solve(guess)
        for _ in range(_MOST_STAGES):
            if found[0] is not RunStatus.OK:
                return None
            if soft <= smallest:
                return found
            guess = found[1].b.copy()
            for factor in _FACTORS:
                for name, values in true.items():
                    props[name] = np.maximum(values, factor * soft)
                found = solve(guess)
                if found[0] is RunStatus.OK:
                    soft *= factor
                    break
    finally:
        for name, values in true.items():
            props[name] = values
    return None


def _is_beyond(run: Run) -> bool:
    # Whether a bearing lifted or passed a limit of its own: no way of solving changes that.
    return bool((run.new["axial_force"] <= 0.0).any())


def _raise_failure(system: System, run: Run, status: RunStatus, linear: FloatArray) -> None:
    # A bearing that lifts is the cause, whatever Newton's method made of it; then limits.
    lifted = np.flatnonzero(run.new["axial_force"] <= 0.0)
    beyond = np.flatnonzero(run.new["status"] != int(RunStatus.OK))
    props = np.concatenate([b.to_record() for _, _, _, b in system.bearings])
    place = int(run.counts["bearing"][0])
    detail = ""
    if len(lifted):
        # Newton's last trial may lift others: the linear solution tells which one is pulled
        moves = np.asarray(bearing_rows(system) @ linear).reshape(-1, 12)
        pull = props["axial_stiffness"] * (moves[:, 8] - moves[:, 2])
        status, place = RunStatus.UPLIFTED, int(np.argmax(pull))
        none = node_geometric_stiffness(system, np.zeros(len(system.members.names)))
        detail = load_path(system, none, linear, -pull).sentence()
    elif len(beyond):
        place = int(beyond[0])
        status = RunStatus(int(run.new["status"][place]))
        detail = limit_detail(props, run.new, place)
    if status in {RunStatus.NEWTON_FAILED, RunStatus.NO_EQUILIBRIUM, RunStatus.SINGULAR}:
        status = RunStatus.NO_REST
    if status is not RunStatus.OK:
        name = system.bearings[place][0]
        raise AnalysisError(status, 0.0, f'gravity, bearing "{name}"', detail)


def force_tolerance(system: System, relative: float) -> float:
    """Return a tolerance in N (and N m at 1 m) relative to the weight of the structure."""
    weight = float(np.abs(system.load).sum())
    return relative * max(weight, 1e-3 * system.gravity * float(system.node_mass[:, :3].sum()))
