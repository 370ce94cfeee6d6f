"""The nonlinear equilibrium under permanent loads, with a path if Newton's method fails.

Nonlinear parts of the structure are elastic there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError
from frames.assembly.assemble import node_geometric_stiffness
from frames.assembly.supports import load_path
from frames.assembly.system import BOUC_WEN, HINGE, SCRATCH, STATE_SIZE, STRIDE
from frames.bundles.model_data import ReducedModel, contacts_of, device_records, model_arrays
from frames.bundles.nonlinear_data import part_sizes
from frames.bundles.run_data import AT_REST, STILL, IntegrationState, output_arrays, run_arrays
from frames.kernels.hinges import is_outside, set_forces, set_stress
from frames.kernels.integration import integrate_chunk
from frames.model.laws import Bilinear, BoucWen
from frames.statics.springs import spring_forces
from lir_element.device.features import apply
from lir_element.device.friction import least_coefficients
from lir_element.element import limit_detail
from lir_element.errors import AnalysisError, RunStatus
from lir_element.interruptible import ready

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from frames._types import FloatArray
    from frames.assembly.coordinates import Basis
    from frames.assembly.system import NonlinearParts, System
    from frames.bundles.nonlinear_data import NonlinearElements
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Records

_FORCE_TOLERANCE = 1e-9  # of the total weight
_MAX_ITERATIONS = 100
_SOFTNESSES = (0.1, 1e-2, 1e-3)  # stiffness of the pendulum over that of friction: starts
_FACTORS = (0.1, 0.3, 0.7)  # to which it is reduced, the next if one fails
_MOST_STAGES = 60
_YIELDS = ("yield_displacement", "interface_yield", "torsion_yield")


class Equilibrium(NamedTuple):
    """A frame in equilibrium, with the arrays of the kernels."""

    model: ReducedModel
    run: IntegrationState
    contacts: Contacts | None
    compiling: float  # s


def find_equilibrium(
    system: System,
    basis: Basis,
    linear: FloatArray,
    levels: Mapping[str, str],
    static_load: FloatArray | None,
    parts: NonlinearElements | None,
    like: ReducedModel | None = None,
) -> Equilibrium:
    """Find the equilibrium of a frame under its permanent loads.

    Newton's method starts from the linear solution. If it fails, friction is softened: the elastic
    stiffness before sliding is ten times that of the pendulum, and is raised to the true one stage
    by stage, each from the equilibria before. The bearings are at rest before each solution, so
    that the last one is the true equilibrium. `like` is of the same basis and other bearings.

    Shapes: linear (n_free,).
    """
    if like is None:
        model = model_arrays(system, basis, static_load)
    else:
        props = apply(system.features, device_records(system), static_load)
        model = like._replace(props=props)
    chosen = [levels[placed.name] for placed in system.bearings]
    settings = AT_REST._replace(
        force_tolerance=force_tolerance(system, _FORCE_TOLERANCE), max_iterations=_MAX_ITERATIONS
    )
    guess = linear[basis.bearing_dofs]
    spare = [(run_arrays(model), contacts_of(system, chosen))]
    out, _, _ = output_arrays(model, spare[0][1], 1, part_sizes(parts))
    compiling = 0.0
    if like is None:
        compiling = ready(integrate_chunk, model, *spare[0], parts, settings, STILL, out, -1, 0)

    def solve(first: FloatArray) -> tuple[RunStatus, IntegrationState, Contacts | None]:
        run, contacts = spare.pop() if spare else (run_arrays(model), contacts_of(system, chosen))
        run.b[:] = first
        status = integrate_chunk(model, run, contacts, parts, settings, STILL, out, -1, 0)
        return RunStatus(status), run, contacts

    status, run, contacts = solve(guess)
    if status is not RunStatus.OK:
        softer = _softened(model, solve, guess)
        if softer is not None:
            status, run, contacts = softer
    _raise_failure(system, run, status, linear)
    return Equilibrium(model, run, contacts, compiling)


def _softened(
    model: ReducedModel,
    solve: Callable[[FloatArray], tuple[RunStatus, IntegrationState, Contacts | None]],
    guess: FloatArray,
) -> tuple[RunStatus, IntegrationState, Contacts | None] | None:
    # Follow the equilibrium from soft friction to the true one; None if no path leads there.
    true = {name: model.props[name].copy() for name in _YIELDS}
    try:
        for softness in _SOFTNESSES:
            found = _way_from(softness, model.props, true, solve, guess)
            if found is not None:
                return found
    finally:
        for name, values in true.items():
            model.props[name] = values
    return None


def _way_from(
    softness: float,
    props: Records,
    true: Mapping[str, FloatArray],
    solve: Callable[[FloatArray], tuple[RunStatus, IntegrationState, Contacts | None]],
    guess: FloatArray,
) -> tuple[RunStatus, IntegrationState, Contacts | None] | None:
    # The same from one softness.
    _soften(props, true, softness)
    found = solve(guess)
    before: tuple[float, FloatArray] | None = None
    for _ in range(_MOST_STAGES):
        if found[0] is not RunStatus.OK:
            return None
        if all(np.array_equal(props[name], values) for name, values in true.items()):
            return found
        here = softness, found[1].b.copy()
        for less, first in _next_guesses(here, before):
            _soften(props, true, less)
            found = solve(first)
            if found[0] is RunStatus.OK:
                before, softness = here, less
                break
    return None


def _next_guesses(
    here: tuple[float, FloatArray], before: tuple[float, FloatArray] | None
) -> Iterator[tuple[float, FloatArray]]:
    # Less softness and a first guess: on the line through both equilibria (while nothing slips,
    # displacements are linear in the softness), then the last one.
    softness, b = here
    for factor in _FACTORS:
        if before is not None:
            yield (
                factor * softness,
                b + (1.0 - factor) * softness * ((b - before[1]) / (before[0] - softness)),
            )
        yield factor * softness, b


def _soften(props: Records, true: Mapping[str, FloatArray], softness: float) -> None:
    # Elastic sliding before slip with which each contact is 1 / softness times as stiff as the
    # pendulum: mu N / u = N / (softness L), (5.4). The same for all, because no slider finds its
    # place if the interface is softer than the pendulum.
    low = least_coefficients(props)
    slid = softness * props["length"][:, None] * low
    held = np.where(props["fused"] == 0, props["interface_friction"], 0.0)
    twisting = props["torsion_lever"] > 0.0
    twist = np.where(
        twisting, slid.min(axis=1) / np.where(twisting, props["torsion_lever"], 1.0), 0
    )
    soft = {
        "yield_displacement": slid,
        "interface_yield": softness * props["length"] * held,
        "torsion_yield": twist,
    }
    for name, values in true.items():
        props[name] = np.maximum(values, soft[name])


def _raise_failure(
    system: System, run: IntegrationState, status: RunStatus, linear: FloatArray
) -> None:
    # A bearing that lifts is the cause, for any end of Newton's method; then limits. Lifting in
    # Newton's last trial is no evidence: the linear solution is.
    lifted = run.new["axial_force"] <= 0.0
    beyond = np.flatnonzero(run.new["status"] != int(RunStatus.OK))
    if status is RunStatus.OK and not (lifted.any() or len(beyond)):
        return
    forces = spring_forces(system, linear)
    if status is not RunStatus.OK:
        lifted = forces < 0.0
    place = int(run.counts["bearing"][0])
    detail = ""
    if lifted.any():
        status, place = RunStatus.UPLIFTED, int(np.argmin(np.where(lifted, forces, np.inf)))
        none = node_geometric_stiffness(system, np.zeros(len(system.members.names)))
        detail = load_path(system, none, linear, forces).sentence()
    elif len(beyond):
        place = int(beyond[0])
        status = RunStatus(int(run.new["status"][place]))
        props = np.concatenate([placed.bearing.to_record() for placed in system.bearings])
        detail = limit_detail(props, run.new, place)
    if status in {RunStatus.NEWTON_FAILED, RunStatus.NO_EQUILIBRIUM, RunStatus.SINGULAR}:
        status = RunStatus.NO_REST
    if status is not RunStatus.OK:
        name = system.bearings[place].name
        raise AnalysisError(status, 0.0, f'gravity, bearing "{name}"', detail)


def force_tolerance(system: System, relative: float) -> float:
    """Return a tolerance in N (and N m at 1 m) relative to the weight of the structure."""
    weight = float(np.abs(system.load).sum())
    return relative * max(weight, 1e-3 * system.gravity * float(system.node_mass[:, :3].sum()))


def put_at_rest(system: System, parts: NonlinearElements, displacement: FloatArray) -> None:
    """Start nonlinear parts from the displacements under permanent loads.

    Shapes: displacement (n_free,).
    """
    found = system.parts
    d = np.asarray(system.part_rows @ displacement)
    d[np.abs(found.elastic) <= 0.0] = 0.0  # added later
    refuse_yielding(found, d)
    parts.d_old[:], parts.d[:] = d, d
    for k in np.flatnonzero(found.kind == BOUC_WEN):
        parts.old[k, 0] = d[found.first[k]] / found.par[k, 6]
    parts.new[:] = parts.old


def refuse_yielding(found: NonlinearParts, d: FloatArray) -> None:
    """Raise a ModelError if a part yields at deformations (m,) under permanent loads."""
    for k, link in enumerate(found.links):
        if not isinstance(link.law, Bilinear | BoucWen):
            continue
        force = link.law.stiffness * abs(float(d[found.first[k]]))
        if force > link.law.yield_force:
            message = (
                f'link "{link.name}" carries {force:.4g} N (N m) of the permanent loads, but '
                f"yields at {link.law.yield_force:.4g}: make it stronger, add parts that "
                "carry them, or change its direction"
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
                    f'the hinge at end {end} of member "{member}" yields under permanent '
                    f"loads (N = {n:.4g} N, My = {m_y:.4g} N m, Mz = {m_z:.4g} N m): "
                    "strengthen the member, or release its moments there"
                )
                raise ModelError(message)
