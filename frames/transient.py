"""Time history analysis: gravity first, then the compiled time loop, then the Dataset."""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy import linalg

from frames.integration import advance, record
from frames.kernel_data import Setup, output_arrays
from frames.results import build_dataset
from frames.rigid import LARGEST_STEP, rigid_time_history
from frames.static import force_tolerance, gravity
from lir_element.element import limit_detail
from lir_element.errors import RunStatus
from lir_element.results import report, require_on_failure
from lir_element.validation import require_between, require_positive

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.ground_motion import GroundMotion
    from frames.model import Frame
    from frames.static import GravityState

METHODS = ("direct",)
_FORCE_TOLERANCE = 1e-7  # of the total weight
_MAX_ITERATIONS = 25
_ERROR_TOLERANCE = 2e-7  # of the effective radius, a step, where the program chooses
_ENERGY_TOLERANCE = 2e-4  # of the energy moved, that contacts may make or lose in a step
_ENERGY_FLOOR = 1e-6  # of weight times effective radius
_CHUNKS = 50


def time_history(
    model: Frame,
    motion: GroundMotion,
    duration: float | None = None,
    dt: float | None = None,
    level: str | Mapping[str, str] = "pendulum",
    method: Literal["direct"] = "direct",
    *,
    integrator: Literal["newmark", "generalised-alpha", "explicit"] | None = None,
    spectral_radius: float = 0.8,
    tolerance: float | None = None,
    record_every: int = 1,
    on_failure: Literal["warn", "raise"] = "warn",
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Analyse a frame on bearings under a ground motion.

    Parameters
    ----------
    model : Frame
        The structure and its bearings. It is brought into equilibrium under its permanent loads
        first; their axial forces enter the bearings.
    motion : GroundMotion
        Acceleration of the ground, up to three components.
    duration : float, optional
        Length of the analysis [s]; that of the motion if None. Beyond it the ground rests.
    dt : float, optional
        Step [s]. None: the step of the motion, at most 0.005 s, halved wherever the estimated
        error asks for it. A given step is halved only where Newton's method fails, or where a
        contact that opens or closes would make or lose energy.
    level : {"pendulum", "contact", "rigid_body"} or mapping
        Level of fidelity of the bearings: one for all, or by name of bearing ("pendulum" for
        those that it does not name). "rigid_body" takes one bearing with a mass on it.
    method : {"direct"}
        "direct": all degrees of freedom.
    integrator : {None, "newmark", "generalised-alpha", "explicit"}
        Time integration. None is Newmark's average acceleration, which conserves energy;
        "generalised-alpha" that of Chung and Hulbert (1993). At the level "rigid_body" None is
        Bossak's implicit method, and "explicit" takes small equal steps of `dt`.
    spectral_radius : float
        Of the generalised-alpha method at infinite frequency [-], in [0, 1]; 1 takes nothing out.
    tolerance : float, optional
        Error of a step over the effective radius where the program controls it: 2e-7 by default,
        1e-8 at the level "rigid_body".
    record_every : int
        Record every so many steps.
    on_failure : {"warn", "raise"}
        A run that fails hands back what was computed, with a warning and its reason in the
        attributes; or raises AnalysisError, whose `data` holds the same.
    progress : callable, optional
        Called with the share done (0 to 1) some fifty times.

    Returns
    -------
    xarray.Dataset
        See docs/results.md. Attributes hold status, message, versions, options and timings.

    Raises
    ------
    ValueError
        If an option is out of bounds.
    frames.ModelError
        If the model cannot work.
    lir_element.AnalysisError
        If there is no equilibrium under gravity, or (with ``on_failure="raise"``) a run fails.
    """
    _check_options(method, integrator, level, record_every, on_failure)
    record_every = int(record_every)
    if tolerance is not None:
        require_between("tolerance", tolerance, 1e-12, 1e-2, "-")
    require_between("spectral_radius", spectral_radius, 0.0, 1.0 + 1e-12, "-")
    length = motion.duration if duration is None else require_positive("duration", duration, "s")
    base = min(motion.dt, LARGEST_STEP) if dt is None else require_positive("dt", dt, "s")
    if level == "rigid_body":
        return rigid_time_history(
            model, motion, length, dt, integrator=integrator, tolerance=tolerance,
            record_every=record_every, on_failure=on_failure, progress=progress,
        )  # fmt: skip
    integrator = integrator or "newmark"
    began = perf_counter()
    state = gravity(model, level)
    error = _ERROR_TOLERANCE if tolerance is None else tolerance
    settings = _settings(
        state, base, error if dt is None else math.inf, integrator, spectral_radius
    )
    steps = max(1, math.ceil(length / base - 1e-9))
    out, states, bodies = output_arrays(state.model, state.contacts, steps // record_every + 1)
    _start(state, motion)
    prepared = perf_counter()
    code, base_steps = _march(state, settings, motion, out, steps, record_every, progress)
    finished = perf_counter()
    status, detail = _outcome(state, RunStatus(code))
    data = build_dataset(model, state, motion, out, states, bodies, base_steps // record_every + 1)
    counters = state.run.counters
    data.attrs |= {
        "title": f"time history of {model.name}",
        "motion": motion.name,
        "level": level if isinstance(level, str) else str(dict(level)),
        "method": method,
        "integrator": integrator,
        "spectral_radius": float(spectral_radius),
        "dt": float(base),
        "step_control": "error" if dt is None else "fixed",
        "tolerance": float(error) if dt is None else math.nan,
        "steps": int(counters[0]),
        "newton_iterations": int(counters[1]),
        "halvings": int(counters[2]),
        "degrees_of_freedom": int(state.system.mass.shape[0]),
        "seconds_gravity": prepared - began,
        "seconds_loop": finished - prepared,
    }
    name = state.system.bearings[int(counters[3])][0]
    where = f'bearing "{name}"' if status.is_bearing_failure else _culprit(state)
    return report(data, status, float(state.run.clock[0]), where, detail, on_failure=on_failure)


def _check_options(
    method: str, integrator: str | None, level: object, record_every: int, on_failure: str
) -> None:
    choices = (
        ("method", method, METHODS),
        ("integrator", integrator, (None, "newmark", "generalised-alpha", "explicit")),
    )
    for name, value, allowed in choices:
        if value not in allowed:
            msg = f"{name} = {value!r}: choose one of {allowed}"
            raise ValueError(msg)
    if integrator == "explicit" and level != "rigid_body":
        msg = f'integrator = "explicit" belongs to level="rigid_body", not to {level!r}'
        raise ValueError(msg)
    if not record_every >= 1 or record_every % 1:
        msg = f"record_every = {record_every!r} must be a whole number of at least 1"
        raise ValueError(msg)
    require_on_failure(on_failure)


def _settings(
    state: GravityState, dt: float, tolerance: float, integrator: str, radius: float
) -> Setup:
    alpha_m, alpha_f = 0.0, 0.0
    if integrator == "generalised-alpha":
        alpha_m, alpha_f = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    length = min(bearing.effective_radius for _, _, _, bearing in state.system.bearings)
    return Setup(
        dt=float(dt),
        alpha_m=float(alpha_m),
        alpha_f=float(alpha_f),
        beta=float(0.25 * (1.0 - alpha_m + alpha_f) ** 2),
        gamma=float(0.5 - alpha_m + alpha_f),
        force_tolerance=float(force_tolerance(state.system, _FORCE_TOLERANCE)),
        max_iterations=_MAX_ITERATIONS,
        energy_tolerance=_ENERGY_TOLERANCE,
        energy_floor=float(_ENERGY_FLOOR * length * np.abs(state.system.load).sum()),
        error_tolerance=float(tolerance * length),
    )


def _start(state: GravityState, motion: GroundMotion) -> None:
    # Accelerations at rest: the ground's first sample acts on what has mass.
    run, basis = state.run, state.basis
    first = np.array([motion.components[0, axis] for axis in range(3)])
    mass = np.block([[basis.mass_b, basis.mass_be], [basis.mass_be.T, np.eye(len(basis.omega2))]])
    right = -np.concatenate([basis.inertia_b, basis.inertia_e]) @ first
    acceleration = linalg.pinvh(mass) @ right if first.any() else np.zeros(len(right))
    n_b = len(run.b)
    run.a_b[:], run.a_e[:] = acceleration[:n_b], acceleration[n_b:]
    elastic = 0.5 * (run.b @ basis.stiffness_b @ run.b + basis.omega2 @ run.e**2)
    run.clock[:] = (0.0, 0.0, 0.0, elastic)
    run.energy[:] = 0.0
    run.counters[:] = 0


def _march(
    state: GravityState,
    settings: Setup,
    motion: GroundMotion,
    out: Any,
    steps: int,
    every: int,
    progress: Callable[[float], None] | None,
) -> tuple[int, int]:
    # Run the compiled loop in chunks; returns the status code and the base steps completed.
    run = state.run
    components = np.ascontiguousarray(motion.components)
    record(run, state.contacts, out, 0)
    chunk = steps if progress is None else max(1, -(-steps // _CHUNKS))
    for first in range(0, steps, chunk):
        last = min(first + chunk, steps)
        code = advance(
            state.model, run, state.contacts, settings, components, float(motion.dt), out, first,
            last, every,
        )  # fmt: skip
        if code != int(RunStatus.OK):
            return code, int(run.counters[6])
        if progress is not None:
            progress(last / steps)
    return int(RunStatus.OK), steps


def _outcome(state: GravityState, status: RunStatus) -> tuple[RunStatus, str]:
    run = state.run
    if status is RunStatus.STEP_TOO_SMALL:
        cause = RunStatus(int(run.counters[5]))
        if cause.is_bearing_failure:
            return cause, ""
        return status, f"last cause: {cause.meaning}"
    if status.is_bearing_failure:
        return status, limit_detail(state.model.props, run.new, int(run.counters[3]))
    return status, ""


def _culprit(state: GravityState) -> str:
    # The degree of freedom with the largest unbalanced force.
    place = int(np.argmax(np.abs(state.run.residual)))
    return f'degree of freedom "{state.system.dof_labels[state.basis.bearing_dofs[place]]}"'
