"""The check of modelling assumptions: effects that a run left out, and those it needed.

It reads the Dataset alone: the run's own peaks decide on an effect that it left out.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames.bundles.peak_data import FULL_SLIP, LOOSE
from frames.results.bearing_findings import (
    equilibrium,
    full_contact,
    held_by_friction,
    met_with_slip,
    slip_stability,
    strained,
    time_step,
    yielding,
)
from frames.results.findings import Finding, Findings, by_whom, finding, percent
from frames.results.formulas import left_out
from frames.results.level_doubts import levels_of_bearings
from frames.results.peak_response import largest, summed
from frames.results.recorded import names_of
from lir_element.argument_checks import require_type
from lir_element.device.features import Features
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames._types import FloatArray

NEAR = 0.95
"""Share of a limit at which it counts as reached in a run that left out something else as well."""

SMALL = {
    "plate_rotation": 0.02,  # of the largest displacement
    "velocity_dependence": 0.02,  # of friction
    "second_direction": 0.02,  # of the x direction
    "vertical_coupling": 0.05,  # of the static axial force
    "pressure_dependence": 0.02,  # of friction
    "friction_heating": 0.02,  # of friction
}
"""Limits of an effect that is left out."""

LOOSE_SLIP = 0.1
"""Slip of loose sliders beyond that imposed by rims, over the largest slip, above which it is
reported.
"""

BARE = 0.02
"""The same over the sliders' radius, below which it is not reported."""

LOOSE_ERROR = 0.3
"""Share of that slip by which steps of 1 ms and 0.125 ms differ (docs/choices_time_step.md)."""

_NAMED = 3
"""Bearings that a sentence names."""

_ASKING = frozenset({"full_contact", "slip_stability"})


def audit(data: xr.Dataset) -> Findings:
    """Check the modelling assumptions of a time history.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history, also one that was saved and loaded.

    Returns
    -------
    tuple of Finding
        One for each feature, in the order of `Features.names()`. Then one each on full contact, on
        the stable limit of interface slip, and on the sum of all forces. If they apply, further
        ones: on rim contact with a slip, on the yield displacement, on the rotation of hinges, on
        nodes accelerated by more than 50 g, and on the error of a given step.

    Raises
    ------
    TypeError
        If it is no Dataset.

    Notes
    -----
    A recording that leaves steps or variables out (`Recording`) keeps the peaks of all steps, so
    that nothing is missed; with ``level="rigid_body"`` and `record_every` alone only the recorded
    steps are seen.

    Examples
    --------
    >>> from frames import audit, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> [found.feature for found in audit(data) if found.mattered]
    ['velocity_dependence', 'yield_displacement']
    >>> audit(data)[0].sentence
    'rims: not needed, reached 95 % of the displacement capacity'
    """
    require_type("data", data, xr.Dataset, "a Dataset of time_history")
    out = left_out(data)
    found = [_JUDGES[name](data, name in out) for name in Features.names()]
    whole = (
        full_contact(data),
        slip_stability(data),
        *met_with_slip(data),
        *held_by_friction(data),
        *yielding(data),
        *strained(data),
        *equilibrium(data),
        *time_step(data),
    )
    return Findings((*found, *whole))


def audit_report(data: xr.Dataset) -> str:
    """Return the assumption check of a time history as text, a line a finding.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history.

    Returns
    -------
    str
        Lines that begin with "!" report an omitted effect that mattered, or a slip beyond the
        stable limit.

    Examples
    --------
    >>> from frames import audit_report, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> audit_report(data).splitlines()[0]
    '  rims: not needed, reached 95 % of the displacement capacity'
    """
    return repr(audit(data))


def needed_level(findings: tuple[Finding, ...]) -> str:
    """Return the cheapest level that is sufficient: "pendulum", or "contact"."""
    return "contact" if asking_for_contact(findings) else "pendulum"


def asking_for_contact(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings that need the level "contact" for some bearings."""
    return tuple(f for f in findings if f.bearings and f.feature in _ASKING)


def _rims(data: xr.Dataset, out: bool) -> Finding:
    limit = data.variables["rim_displacement"].values
    share = float((largest(data, "sliding").values / limit).max())
    met = largest(data, "rims_met")
    mattered = share >= (_reached(data, "rims") if out else 1.0)
    if np.isinf(limit).all():
        return finding("rims", out, False, 0.0, "the bearings have none")
    if out or not met.values.any():
        text = worded("reached {share} of the displacement capacity", share=percent(share))
        return finding("rims", out, out and mattered, share, text)
    bent = summed(data, "rim_plastic")
    text = joined(worded("met by {whom}", whom=by_whom(met)), _bent_rims(data, bent))
    return finding("rims", out, True, share, text, doubtful=np.isinf(bent).any())


def _bent_rims(data: xr.Dataset, bent: FloatArray) -> str:
    names = names_of(data, "bearing")
    broken = names[np.isinf(bent)]
    if broken.size:
        who = ", ".join(str(name) for name in broken[:_NAMED])
        if broken.size > _NAMED:
            who = worded("{names} and {count} more", names=who, count=broken.size - _NAMED)
        return worded(
            "a rim of {names} broke: the slider passed over the flange, on the same "
            "sphere, without restraint",
            names=who,
        )
    k = int(np.argmax(bent))
    if not bent[k] > 0.0:
        return ""
    share = bent[k] / float(data.variables["rim_overrun"].values[k])
    return worded(
        "{count} of them yielded, by up to {bent:.3g} mm ({bearing}, {share} of the deformation at "
        "which it breaks)",
        count=(bent > 0.0).sum(),
        bent=1e3 * bent[k],
        bearing=names[k],
        share=percent(share),
    )


def _interface(data: xr.Dataset, out: bool) -> Finding:
    if np.isinf(data.variables["interface_friction"].values).all():
        return finding("interface", out, False, 0.0, "the slider is rigid")
    share = float(largest(data, "interface_share").values.max())
    loose = "" if out else _loose_slip(data)
    if out or (share < FULL_SLIP and not loose):
        mattered = out and share >= _reached(data, "interface")
        text = worded("carried {share} of its friction strength", share=percent(share))
        return finding("interface", out, mattered, share, text)
    slips, slipped = largest(data, "slip").values, largest(data, "slipped")
    text = worded("slipped up to {slip:.3g} mm", slip=1e3 * slips.max())
    text = joined(text, by_whom(slipped) if slipped.values.any() else "", by=", ")
    text = joined(text, loose)
    return finding("interface", out, True, share, text, doubtful=bool(loose))


def _loose_slip(data: xr.Dataset) -> str:
    # Slip of sliders under almost no load, beyond the slip that the rims impose. The displacement
    # gives the latter for any motion of the sliders. Without mass, at the level "pendulum", they
    # slip no further.
    bodies = np.array(levels_of_bearings(data)) != "pendulum"
    if not bodies.any():
        return ""
    slips, moved = largest(data, "slip").values, largest(data, "displacement").values
    tilts = data.variables["rim_displacement"].values / data.variables["radius"].values
    room = data.variables["length"].values * tilts.min(axis=1)  # until rim contact
    free = bodies * np.minimum(summed(data, "slip_loose"), slips - np.maximum(moved - room, 0.0))
    k = int(np.argmax(free))
    by, least = float(free[k]), BARE * float(data.variables["slider_radius"].values[k])
    if not by > max(LOOSE_SLIP * float(slips.max()), least):
        return ""
    return worded(
        "{bearing}: {slip:.3g} of {total:.3g} mm of slip occurred under less than {share} "
        "of the load at rest, with the sliders out of contact. No step resolves this; "
        "count on {factor} of those {slip:.3g} mm",
        bearing=names_of(data, "bearing")[k],
        slip=1e3 * by,
        total=1e3 * slips[k],
        share=percent(LOOSE),
        factor=percent(1.0 + LOOSE_ERROR),
    )


def _uplift(data: xr.Dataset, out: bool) -> Finding:
    least = 0.0 - float(largest(data, "vertical_tension").values.max())
    happened = largest(data, "lifted")
    if out or not (happened.values > 0.0).any():  # the stop of one that failed may carry nothing
        return finding(
            "uplift",
            out,
            out and least <= 0.0,
            least,
            worded("smallest N {least:.2f} W", least=least),
        )
    return finding("uplift", out, True, least, worded("lifted off: {whom}", whom=by_whom(happened)))


def _plate_rotation(data: xr.Dataset, out: bool) -> Finding:
    shift = float(largest(data, "centre_shift").values.max())
    moved = float(largest(data, "displacement").values.max())
    share = shift / moved if moved > 0.0 else 0.0
    text = worded(
        "tilt moves the spheres' centres by up to {shift:.2g} mm, {share} of the largest "
        "displacement",
        shift=1e3 * shift,
        share=percent(share, 1),
    )
    return finding("plate_rotation", out, share > SMALL["plate_rotation"], share, text)


def _velocity_dependence(data: xr.Dataset, out: bool) -> Finding:
    if not data.variables["friction_drop"].values.any():
        text = "no friction depends on speed"
        return finding("velocity_dependence", out, False, 0.0, text)
    work = float(summed(data, "sliding_work"))
    share = float(summed(data, "sliding_work_lower")) / work if work > 0.0 else 0.0
    text = worded(
        "over the paths slid, friction is {share} below that at high speed", share=percent(share, 1)
    )
    return finding("velocity_dependence", out, share > SMALL["velocity_dependence"], share, text)


def _second_direction(data: xr.Dataset, out: bool) -> Finding:
    if not out:
        moves = largest(data, "displacement_along").values
        x, y = float(moves[0]), float(moves[1])
        share = _ratio(y, x)
        text = worded(
            "displacement along y reached {y:.3g} mm, along x {x:.3g} mm", y=1e3 * y, x=1e3 * x
        )
    else:
        peak = data["peak_ground_velocity"]
        x, y = float(peak.sel(axis="x")), float(peak.sel(axis="y"))
        coupled = float(data.attrs["plane_coupling"])
        share = max(_ratio(y, x), coupled)
        text = worded(
            "peak ground velocity along y {share} of that along x, pushed along x the bearings "
            "move along y by {coupled} of it",
            share=percent(_ratio(y, x)),
            coupled=percent(coupled, 1),
        )
    return finding("second_direction", out, share > SMALL["second_direction"], share, text)


def _vertical_coupling(data: xr.Dataset, out: bool) -> Finding:
    share = float(largest(data, "vertical_change").values.max())
    text = worded("axial forces differ from those at rest by up to {share}", share=percent(share))
    return finding("vertical_coupling", out, share > SMALL["vertical_coupling"], share, text)


def _pressure_dependence(data: xr.Dataset, out: bool) -> Finding:
    if "pressure_rate" not in data or not data.variables["pressure_rate"].values.any():
        text = "no friction depends on pressure"
        return finding("pressure_dependence", out, False, 0.0, text)
    share = _ratio(float(summed(data, "sliding_work_pressed")), float(summed(data, "sliding_work")))
    text = worded("over the paths slid, it changes friction by {share}", share=percent(share, 1))
    return finding("pressure_dependence", out, share > SMALL["pressure_dependence"], share, text)


def _friction_heating(data: xr.Dataset, out: bool) -> Finding:
    if "softening_rate" not in data or not data.variables["softening_rate"].values.any():
        text = "no friction depends on temperature"
        return finding("friction_heating", out, False, 0.0, text)
    share = _ratio(float(summed(data, "sliding_work_heated")), float(summed(data, "sliding_work")))
    hottest = float(np.nanmax(largest(data, "temperature").values[:, :2]))
    text = worded(
        "the surfaces reached {hottest:.0f} C, over the paths slid that changes friction by "
        "{share}",
        hottest=hottest,
        share=percent(share, 1),
    )
    return finding("friction_heating", out, share > SMALL["friction_heating"], share, text)


def _reached(data: xr.Dataset, own: str) -> float:
    others = set(left_out(data)) - {own}
    return NEAR if others else 1.0


def _ratio(value: float, base: float) -> float:
    if base > 0.0:
        return value / base
    return math.inf if value > 0.0 else 0.0


_JUDGES: dict[str, Callable[[xr.Dataset, bool], Finding]] = {
    "rims": _rims,
    "interface": _interface,
    "uplift": _uplift,
    "plate_rotation": _plate_rotation,
    "velocity_dependence": _velocity_dependence,
    "second_direction": _second_direction,
    "vertical_coupling": _vertical_coupling,
    "pressure_dependence": _pressure_dependence,
    "friction_heating": _friction_heating,
}
