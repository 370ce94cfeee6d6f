"""End of an analysis, and reliability of its results."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.results.assumption_checks import audit
from frames.results.findings import Finding, Findings, remark
from frames.results.peak_response import largest
from lir_element.argument_checks import listed
from lir_element.element import about_to_snap, limit_detail, opening_of
from lir_element.errors import RunStatus
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import xarray as xr

    from frames.statics.gravity_state import GravityState

PROMISE = 1e-3
"""Largest share of the input by which the energy balance of a completed run may be open [-]."""

ASKED_FOR = 1e-2
"""The same for the energy removed by the generalised-alpha method on purpose; from `PROMISE` on a
warning gives the share.
"""

LEAST_INPUT = 1e-6
"""Input over weight and effective radius below which it measures the energy balance [-]."""


TUMBLED = 0.3
"""Tilt of a slider beyond the one at its rim above which it tumbles [rad]."""


RESOLVED = 0.3
"""Base step times frequency of a mass on a stop, up to which forces are within 2 % [rad]."""


class Outcome(NamedTuple):
    """The end of a run."""

    status: RunStatus
    time: float  # s
    where: str
    detail: str


def energy_status(data: xr.Dataset) -> tuple[RunStatus, str, tuple[Finding, ...]]:
    """Check a completed run by its energy balance, and by its sliders if they are bodies."""
    gap, numerical, given = (
        float(largest(data, name).values)
        for name in ("energy_gap", "energy_numerical", "energy_input")
    )
    least = (
        LEAST_INPUT * float(data.variables["weight"]) * float(data.variables["length"].values.min())
    )
    scale = max(given, abs(least))
    gap, numerical = gap / scale, numerical / scale
    data.attrs |= {"energy_error": gap, "numerical_share": numerical}
    doubt = _tumbled(data)
    if doubt:
        return RunStatus.INACCURATE, doubt, _noted("inaccurate", gap, doubt)
    allowed = ASKED_FOR if data.attrs["integrator"] == "generalised-alpha" else PROMISE
    if gap <= PROMISE and numerical <= allowed:
        if numerical <= PROMISE:
            return RunStatus.OK, "", ()
        doubt = worded(
            "the generalised-alpha method dissipated {share:.3g} % of the input energy "
            "(more than {limit:g} %): use a spectral_radius nearer to 1, or a smaller dt",
            share=100.0 * numerical,
            limit=100.0 * PROMISE,
        )
        return RunStatus.OK, doubt, _noted("numerical damping", numerical, doubt)
    detail = worded(
        "the energy balance is in error by {gap:.3g} % of the input (at most {sound:g} "
        "%), and the time integration dissipates {share:.3g} % (at most {limit:g} %)",
        gap=100.0 * gap,
        sound=100.0 * PROMISE,
        share=100.0 * numerical,
        limit=100.0 * allowed,
    )
    return RunStatus.INACCURATE, detail, _noted("inaccurate", gap, detail)


def _noted(name: str, number: float, text: str) -> tuple[Finding, ...]:
    # Not marked: the status shows it, or a warning.
    return (
        remark(
            name.replace(" ", "_"),
            number,
            worded("{name}: {text}", name=name, text=text),
            doubtful=False,
        ),
    )


def _tumbled(data: xr.Dataset) -> str:
    """Return the doubt about a run in which a slider tumbled, or an empty string."""
    if "body_rotation" not in data and "peak_tilt" not in data:
        return ""
    tilt = largest(data, "tilt").values  # NaN without contact points
    sine = (data["rim_displacement"] / data["radius"]).to_numpy().max(axis=1)
    lying = np.arcsin(np.minimum(sine, 1.0))
    beyond = np.nan_to_num(tilt - lying, nan=-np.inf)
    k = int(beyond.argmax())
    if beyond[k] <= TUMBLED:
        return ""
    worst, degrees, rim = data["bearing"].to_numpy()[k], np.degrees(tilt[k]), np.degrees(lying[k])
    return worded(
        "the slider of bearing {bearing} overturned: it tilted by {tilt:.0f} degrees "
        "(at rim contact {rim:.0f}). Later results depend on the step: treat this as "
        "failure of the bearing",
        bearing=worst,
        tilt=degrees,
        rim=rim,
    )


def final_status(
    data: xr.Dataset, state: GravityState, end: tuple[RunStatus, str]
) -> tuple[Outcome, Findings]:
    """Return the status of a run after the check of its assumptions."""
    status, detail = end
    data.attrs |= _exceeded(state, status)
    findings = audit(data)
    name = state.system.bearings[int(state.run.counts["bearing"][0])].name
    where = f'bearing "{name}"' if status.is_bearing_failure else culprit(state)
    if status is RunStatus.OK:
        status, detail, noted = energy_status(data)
        findings = Findings((*findings, *noted))
        lost = _lost(state, float(data.attrs["dt"]))
        if lost:
            k, told = lost
            status = RunStatus.BEARING_LOST
            detail = f"{told}; {detail}" if detail else told
            where = f'bearing "{state.system.bearings[k].name}"'
            return Outcome(status, float(state.run.old["failed_at"][k]), where, detail), findings
    return Outcome(status, float(state.run.clock["time"][0]), where, detail), findings


def _lost(state: GravityState, dt: float) -> tuple[int, str] | None:
    # The first bearing that failed in a run that continued, and the failed part in words.
    states = state.run.old
    failed = np.flatnonzero(states["failed"])
    if not len(failed):
        return None
    order = failed[np.argsort(states["failed_at"][failed], kind="stable")]
    told = [
        f"{state.system.bearings[k].name} at {float(states['failed_at'][k]):.4g} s "
        f"({RunStatus(abs(int(states['failed'][k]))).name.lower()})"
        for k in order
    ]
    text = f"{len(order)} of {len(states)} bearings failed: {listed(told)}"
    props, masses = state.model.props[failed], state.axial_forces[failed] / STANDARD_GRAVITY
    rings = np.sqrt(props["backup_stiffness"] / masses) * np.isfinite(props["backup_drop"])
    quickest = float(rings.max())
    if dt * quickest > RESOLVED:
        text += (
            f"; a landing on a stop lasts about {1e3 * np.pi / quickest:.2g} ms, less than "
            f"steps of {1e3 * dt:.3g} ms resolve: for its forces use dt = "
            f"{RESOLVED / quickest:.1g} s"
        )
    return int(order[0]), text


def _exceeded(state: GravityState, status: RunStatus) -> dict[str, object]:
    # Values of a bearing at the step that its limit ended: that step is in no history.
    k, run = int(state.run.counts["bearing"][0]), state.run
    if int(run.new["status"][k]) != status:
        return {}  # found otherwise, and not by a step in equilibrium
    values = {
        RunStatus.SLIP_EXCEEDED: ("slip", np.hypot(*run.new["slip"][k])),
        RunStatus.RIM_OVERRUN: ("rim_force", run.new["rim_force"][k].max()),
        RunStatus.UPLIFT_EXCEEDED: ("gap", opening_of(state.model.props, run.new, k)),
    }
    if status not in values:
        return {}
    name, value = values[status]
    return {
        "exceeded": name,
        "exceeded_value": float(value),
        "exceeded_at": float(run.clock["time"][0]),
        "exceeded_bearing": state.system.bearings[k].name,
    }


def loop_status(state: GravityState, status: RunStatus) -> tuple[RunStatus, str]:
    """Return how a run ended that its loop left with `status`, and the number behind it."""
    run = state.run
    if status is RunStatus.STEP_TOO_SMALL:
        cause = RunStatus(int(run.counts["cause"][0]))
        if cause.is_bearing_failure:
            return cause, ""
        near = about_to_snap(state.model.props, run.old)
        if near is not None:
            run.counts["bearing"][0] = near[0]
            return RunStatus.SLIP_UNSTABLE, near[1]
        return status, f"last cause: {cause.meaning}{_without_inertia(state)}"
    if status.is_bearing_failure:
        return status, limit_detail(state.model.props, run.new, int(run.counts["bearing"][0]))
    return status, ""


def _without_inertia(state: GravityState) -> str:
    # Plates that rotate without inertia have to be in equilibrium at every instant; there may be
    # none if the friction of a tilted slider and a rim is overcome.
    labels, inertia = state.system.dof_labels, state.system.mass.diagonal()
    turning = [
        labels[place].rsplit(" ", 1)[0]
        for place in state.basis.bearing_dofs
        if labels[place].endswith((" rx", " ry")) and not inertia[place] > 0.0
    ]
    if not turning:
        return ""
    return (
        f'; node "{turning[0]}" and others have no rotational inertia: add some at the '
        "bearings, add_mass(node, 0.0, (J, J, 0.0)) with 1 to 100 kg m2"
    )


def culprit(state: GravityState) -> str:
    """Return the name of the degree of freedom with the largest unbalanced force."""
    place = int(np.argmax(np.abs(state.run.residual)))
    return f'degree of freedom "{state.system.dof_labels[state.basis.bearing_dofs[place]]}"'
