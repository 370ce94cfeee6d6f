"""Findings of the assumption check on bearings: full contact, stable slip, impacts, friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.results.findings import Finding, finding, percent, remark
from frames.results.formulas import VIOLENT
from frames.results.level_doubts import level_doubts, levels_of_bearings
from frames.results.peak_response import final_value, largest
from frames.results.recorded import names_of
from lir_element.device.specification import STACK_RANGE, stack_stiffness
from lir_element.texts import joined, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import xarray as xr

KERN = 0.25
"""Eccentricity over slider radius up to which a circular contact is closed all over."""

HOLDS = 0.8
"""Slip over its stable limit s* without rims, `slip_stability`, above which it is reported."""

OVERLAPS = 0.9
"""The same over the slip at which the sliders' overlap ends, `slip_capacity`."""

SPUN = 0.5
"""Spin of the sliders [rad] above which the level 'contact' is needed: the residual slip depends on
it (docs/validation/slip.md).
"""

EDGE = 0.5
"""Eccentricity over slider radius beyond which one edge carries nearly all."""

IMPACT = 0.2
"""Rise of the axial force over that at rest, at rim contact with a slip, above which it is
reported.
"""

COMPLETE = ("ok", "bearing_lost")
"""Ends of runs that went on to the end of their motion."""

STUCK = 0.5
"""Largest displacement over the one that friction holds, L Q/W, below which the yield displacement
counts (docs/limits.md)."""

SLID = 20.0
"""Largest displacement over the yield displacement from which on a bearing has slid."""

LEFT_OVER = 0.1
"""Displacement at the end over the one that friction holds, L Q/W, above which it is reported."""


def full_contact(data: xr.Dataset) -> Finding:
    """Check the assumptions of the level 'pendulum': full contact, sliders that do not spin."""
    offsets = largest(data, "eccentricity").values
    names = names_of(data, "bearing")
    share = float(offsets.max())
    if share <= KERN:
        verdict = "holds"
    elif share <= EDGE:
        verdict = "partial contact, no tipping"
    else:
        verdict = "edge contact" if share < 1.0 else "the slider tips"
    text = worded(
        "full contact: e/a = {value:.2f} in {bearing}: {verdict}",
        value=share,
        bearing=names[int(np.argmax(offsets))],
        verdict=verdict,
    )
    doubts = level_doubts(data)
    if doubts.bearings:
        text = joined(text, doubts.sentence)
    has_spin = "slider_spin" in data or "peak_spin" in data
    spins = largest(data, "spin").values if has_spin else np.zeros(len(names))
    spun = (spins > SPUN) & (np.array(levels_of_bearings(data)) == "pendulum")
    if spun.any():
        spin = worded(
            "the sliders spun by {angle:.2g} rad, on which the slip depends", angle=spins.max()
        )
        text = joined(text, spin)
    asking = {*doubts.bearings, *(str(name) for name in names[spun])}
    is_marked = doubts.marked or bool(spun.any())
    return Finding(
        feature="full_contact",
        left_out=is_marked,
        mattered=bool(asking),
        number=share,
        sentence=joined(text, 'rerun with level="contact"' if is_marked else ""),
        bearings=tuple(str(name) for name in names if str(name) in asking),
    )


def slip_stability(data: xr.Dataset) -> Finding:
    """Check the stability of the residual slip."""
    # docs/theory.md (2.7), with the friction of high speed; a rigid slider holds without end
    friction = data.variables["interface_friction"].values
    rubbed = [data.variables[name].transpose("bearing", ...) for name in ("friction_max", "radius")]
    held = data.variables["length"].values * friction
    held -= (rubbed[0].values * rubbed[1].values).sum(axis=1)
    slip = largest(data, "slip").values
    shares = slip / np.maximum(held, 1e-12)
    overlaps = (
        slip / data.variables["slip_capacity"].values if "slip_capacity" in data else 0 * shares
    )
    worst, last = int(np.argmax(shares)), int(np.argmax(overlaps))
    share = float(shares[worst])
    names, parts = names_of(data, "bearing"), []
    if share > HOLDS:
        limit = 1e3 * max(float(held[worst]), 0.0)
        parts.append(
            worded(
                "{bearing}: the slip of {slip:.3g} mm exceeds the stable limit of "
                "{limit:.3g} mm, so the interface may slip further without rim contact: "
                "raise mu_h",
                bearing=names[worst],
                slip=1e3 * slip[worst],
                limit=limit,
            )
        )
    if overlaps[last] > OVERLAPS:
        limit = 1e3 * float(data.variables["slip_capacity"].values[last])
        parts.append(
            worded(
                "{bearing} slipped {slip:.4g} of {total:.4g} mm, the overlap of the "
                "sliders: a few per cent more and it fails. Raise mu_h or the capacity",
                bearing=names[last],
                slip=1e3 * slip[last],
                total=limit,
            )
        )
    text = joined(*parts)
    if not parts:
        text = worded(
            "the slip reached {share} of the stable limit without rim contact", share=percent(share)
        )
    if np.isinf(friction).all():
        text = "the slider is rigid"
    at_pendulum = np.array(levels_of_bearings(data)) == "pendulum"
    close = ((shares > HOLDS) | (overlaps > OVERLAPS)) & at_pendulum
    found = "slip_stability", False, bool(parts), share, text
    return finding(*found, doubtful=bool(parts), bearings=names[close])


def met_with_slip(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check rim contact with a slip."""
    # docs/theory.md (2.9): force from the axial stiffness and the closing speed. The first contact
    # is without slip, and old files lack the stiffness: no finding.
    if "axial_stiffness" not in data.variables:
        return ()
    closing = largest(data, "closing")
    static = data.variables["static_axial_force"].values
    stiffness = data.variables["axial_stiffness"].values
    rises = closing.values * np.sqrt(stiffness / (static * STANDARD_GRAVITY))
    k = int(np.argmax(rises))
    if not rises[k] > IMPACT:
        return ()
    height = data.variables["radius"].values.sum(axis=1) - data.variables["length"].values
    area = np.pi * data.variables["slider_radius"].values ** 2
    assumed = bool(np.isclose(stiffness[k], stack_stiffness(area[k], height[k]), rtol=1e-6))
    low, high = STACK_RANGE
    text = worded(
        "rim contact of {bearing} with slip at {time:.2f} s stops {speed:.3g} mm/s "
        "along the slider, which raises its axial force by up to {share} of the load at "
        "rest",
        bearing=names_of(data, "bearing")[k],
        time=closing.at[k],
        speed=1e3 * closing.values[k],
        share=percent(float(rises[k])),
    )
    if assumed:
        estimate = worded(
            "the axial stiffness, {k:.3g} N/m, is a default estimate: run with {low:g} and "
            "{high:g} times it, or set the manufacturer's value",
            k=stiffness[k],
            low=low,
            high=high,
        )
        text = joined(text, estimate)
    return (finding("impacts", False, True, float(rises[k]), text, doubtful=assumed),)


def held_by_friction(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check the effect of elastic sliding before slip."""
    # Up to L Q/W friction holds a bearing at any place: a displacement in that range depends on the
    # whole earlier motion (docs/limits.md).
    if "yield_displacement" not in data.variables:
        return ()
    rubbed = [data.variables[name].transpose("bearing", ...) for name in ("friction_max", "radius")]
    held = (rubbed[0].values * rubbed[1].values).sum(axis=1)
    yields = data.variables["yield_displacement"].values.max(axis=-1)
    moved = largest(data, "displacement").values
    slid = (held > 0.0) & (moved > SLID * yields)
    shares = np.where(slid, moved / np.maximum(held, 1e-12), np.inf)
    ended = "exceeded" not in data.attrs and data.attrs.get("status", "ok") in COMPLETE
    rest = np.where(slid, final_value(data, "displacement"), 0.0) * ended
    least, most = int(np.argmin(shares)), int(np.argmax(rest / np.maximum(held, 1e-12)))
    names, parts = names_of(data, "bearing"), []
    if shares[least] < STUCK:
        parts.append(
            worded(
                "{bearing} moved {share} of its friction length (L Q/W = {held:.3g} mm): "
                "yield_displacement = {yield_displacement:.2g} mm changes such a peak by "
                "about 10 %, smaller ones by more",
                bearing=names[least],
                share=percent(float(shares[least])),
                held=1e3 * held[least],
                yield_displacement=1e3 * yields[least],
            )
        )
    if LEFT_OVER * held[most] < rest[most] <= held[most]:  # beyond it it still swings
        parts.append(
            worded(
                "{bearing} has a residual displacement of {rest:.3g} mm, and friction can "
                "hold up to {held:.3g} mm: use the median of many runs",
                bearing=names[most],
                rest=1e3 * rest[most],
                held=1e3 * held[most],
            )
        )
    if not parts:
        return ()
    least_share, text = float(shares[least]), joined(*parts)
    return (finding("yield_displacement", False, True, least_share, text),)


BALANCED = 2e-3
"""Sum of all forces over the weight, of moments over weight times half the structure's extent, up
to which a run is in equilibrium. Ordinary runs keep 1e-6 of forces and 1e-4 of moments: modal
damping does not include the rotations by axial forces (docs/theory.md, 5).
"""

ROUGH = 0.05
"""Estimated error of a given step over the peak displacement above which it is reported."""

LONG = 0.05
"""Given step above which ground motion between its points is lost [s]."""

_LIGHT = 1e-2  # of the nodes' mean mass: a node that weighs next to nothing beside the others

TURNED = 0.05
"""Plastic rotation from which on a hinge is doubtful [rad]: compact members of steel begin to lose
strength at 4 to 11 yield rotations (ASCE/SEI 41-17, chapter 9), others before."""


def equilibrium(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check the equilibrium of forces, weight and inertia, and the motion of nodes."""
    if "imbalance" not in data and "peak_imbalance" not in data:
        return ()
    gaps = largest(data, "imbalance")
    text, most, doubtful = "equilibrium: not checked, because supports carry load", 0.0, False
    if gaps.values.size:
        k = int(np.argmax(gaps.values))
        most, name = float(gaps.values[k]), str(names_of(data, "resultant")[k])
        doubtful = most > BALANCED
        over = "the weight" if name.startswith("F") else "weight times half the extent"
        text = worded(
            "equilibrium: forces and inertia agree within {most:.1g} of the weight", most=most
        )
        if doubtful:
            text = worded(
                "equilibrium: {name} of bearing forces, weight and inertia differ by "
                "{difference:.3g} % of {over} at t = {time:.4g} s: do not use forces or "
                "accelerations of this run for design",
                name=name,
                difference=100.0 * most,
                over=over,
                time=float(gaps.at[k]),
            )
    return (remark("equilibrium", most, text, doubtful=doubtful), *_violence(data))


def _violence(data: xr.Dataset) -> tuple[Finding, ...]:
    found = largest(data, "violence")
    k = int(np.argmax(found.values))
    most = float(found.values[k]) / STANDARD_GRAVITY
    if not most > 0.0:
        return ()
    mass = data["node_mass"].transpose("node", "axis").to_numpy().max(axis=1)
    own, mean = float(mass[k]), float(mass[mass > 0.0].mean())
    struck = bool(largest(data, "rims_met").values.any() or largest(data, "lifted").values.any())
    cause = "check the stiffness of the parts that hold its mass"
    if own < _LIGHT * mean:
        cause = worded(
            "its mass of {mass:.3g} kg is negligible against {mean:.3g} kg at a mean node: "
            "add the actual mass, or none",
            mass=own,
            mean=mean,
        )
    elif struck:
        cause = "an impact, at a rim or in landing: compare smaller steps, and softer rims"
    text = worded(
        "accelerations: node {node} reached {most:.3g} g at t = {time:.4g} s (structures "
        "stay below {limit:.0f} g): {cause}",
        node=names_of(data, "node")[k],
        most=most,
        time=float(found.at[k]),
        limit=VIOLENT / STANDARD_GRAVITY,
        cause=cause,
    )
    return (remark("accelerations", most, text, doubtful=True),)


def time_step(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check a given step of a run."""
    error = float(data.attrs.get("estimated_error", np.nan))
    if data.attrs.get("step_control") != "fixed" or not np.isfinite(error):
        return ()
    step = float(data.attrs["dt"])
    doubtful = error > ROUGH or step > LONG
    text = worded(
        "time step: as given, estimated error {error:.1g} % of the displacement reached",
        error=100.0 * error,
    )
    if doubtful:
        text = worded(
            "time step: the given step of {step:.3g} s causes errors of up to about {error:.2g} % "
            "of the largest displacement, and more by ground motion that it skips: leave dt out, "
            "or compare a smaller one (step_sensitivity)",
            step=step,
            error=100.0 * error,
        )
    return (remark("time_step", error, text, doubtful=doubtful),)


def yielding(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check the rotation of hinges."""
    # They keep their strength here; those of steel lose it from about TURNED on.
    if "hinge" not in data.dims:
        return ()
    turned = largest(data, "hinge_rotation")
    k = int(np.argmax(turned.values))
    most = float(turned.values[k])
    text = worded("plastic rotation of hinges up to {turned:.3g} mrad", turned=1e3 * most)
    if most > TURNED:
        text = worded(
            "plastic rotation of hinge {hinge}: {turned:.3g} mrad at t = {time:.4g} s "
            "exceeds {limit:.0f} mrad, beyond which strength loss is not modelled: treat "
            "this run as member failure",
            hinge=names_of(data, "hinge")[k],
            turned=1e3 * most,
            time=float(turned.at[k]),
            limit=1e3 * TURNED,
        )
    return (finding("yielding", False, most > 0.0, most, text, doubtful=most > TURNED),)


def strained(data: xr.Dataset) -> tuple[Finding, ...]:
    """Check if imported members, which stay elastic, would have yielded."""
    most = float(data.attrs.get("strain_over_limit", 0.0))
    if most <= 1.0:
        return ()
    count = int(data.attrs["strain_over_limit_count"])
    text = worded(
        "{member} strains to {strain:.3g} times the linear limit of its material at t = "
        "{time:.4g} s ({count} imported members exceed theirs), but stays elastic here. "
        "Compare with the OpenSees model, isolated by isolate",
        member=data.attrs["strain_over_limit_in"],
        strain=most,
        time=float(data.attrs["strain_over_limit_at"]),
        count=count,
    )
    return (finding("yielding", False, True, most, text, doubtful=True),)
