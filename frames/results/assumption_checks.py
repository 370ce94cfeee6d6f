"""The check of modelling assumptions: whether what a run left out mattered, what it had was needed.

It reads the Dataset alone: what a run left out is judged by what the run itself reached.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames.peak_data import FULL_SLIP, LOOSE
from frames.results.energy_balance import Remark, equilibrium, time_step
from frames.results.formulas import left_out
from frames.results.level_doubts import level_doubts, levels_of_bearings
from frames.results.peak_response import Extreme, largest, left, total
from lir_element.argument_checks import require_type
from lir_element.device.features import Features
from lir_element.device.specification import STACK_RANGE, stack_stiffness
from lir_element.tables import html_table
from lir_element.units import STANDARD_GRAVITY

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
"""What must not be exceeded by an effect that is left out."""

KERN = 0.25
"""Eccentricity over slider radius up to which a circular contact is closed all over."""

HOLDS = 0.8
"""Slip over its stable limit s* without rims, `slip_stability`, from which a run says so."""

OVERLAPS = 0.9
"""The same over the slip at which the sliders' overlap ends, `slip_capacity`."""

LOOSE_SLIP = 0.1
"""Slip that loose sliders gained beyond what rims made them, over the largest slip, from which a
run says so."""

BARE = 0.02
"""The same over the sliders' radius, below which nothing is said of it."""

LOOSE_ERROR = 0.3
"""Share of that slip by which it differs between steps of 1 ms and 0.125 ms (docs/choices.md)."""

SPUN = 0.5
"""Spin of the sliders [rad] beyond which the level 'contact' is asked for: the residual slip
depends on it (docs/validation/slip.md)."""

EDGE = 0.5
"""Eccentricity over slider radius beyond which one edge carries nearly all."""

TURNED = 0.05
"""Plastic rotation from which on a hinge is doubtful [rad]: compact members of steel begin to lose
strength at 4 to 11 yield rotations (ASCE/SEI 41-17, chapter 9), others before."""

IMPACT = 0.2
"""Rise of the axial force over that at rest, where a rim is met with a slip, that is told."""

COMPLETE = ("ok", "bearing_lost")
"""Ends of runs that went on to the end of their motion."""

STUCK = 0.5
"""Largest displacement over the one that friction holds, L Q/W, below which the yield displacement
counts (docs/limits.md)."""

SLID = 20.0
"""Largest displacement over the yield displacement from which on a bearing has slid."""

LEFT_OVER = 0.1
"""Displacement at the end over the one that friction holds, L Q/W, from which it is told."""

_NAMED = 3
"""Bearings that a sentence names."""

_ASKING = frozenset({"full_contact", "slip_stability"})


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What the assumption check found on one feature.

    Attributes
    ----------
    feature : str
        Of `Features.names()`; or "full_contact": what the level 'pendulum' takes for granted; or
        "slip_stability": whether the residual slip holds; or "impacts": whether rims were met with
        a slip; or "yield_displacement": whether elastic sliding before slip counts; or "yielding":
        whether hinges turned further than they keep their strength; or "equilibrium",
        "accelerations" and "time_step": whether the numbers of the run belong together.
    left_out : bool
        Whether the run left it out.
    mattered : bool
        Left out: whether that spoils the run. Modelled: whether it came into play.
    number : float
        What the judgement rests on; the sentence says what it is.
    sentence : str
        For people.
    doubtful : bool
        Whether what came into play asks to be looked at.
    bearings : tuple of str
        At the level "pendulum", for which it asks for the level "contact".

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, audit, lumped_mass, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> found = audit(data)[1]
    >>> found.feature, found.left_out, found.mattered
    ('interface', False, False)
    """

    feature: str
    left_out: bool
    mattered: bool
    number: float
    sentence: str
    doubtful: bool = False
    bearings: tuple[str, ...] = ()


class Findings(tuple[Finding, ...]):
    """Findings of a run, which print as text and as a table in a notebook."""

    __slots__ = ()

    def __repr__(self) -> str:
        """Return a line a finding; "!" begins warnings."""
        return report_of(self)

    def _repr_html_(self) -> str:
        rows = [tuple(line.split(": ", 1)) for line in report_of(self).splitlines()]
        return html_table("check of modelling assumptions", rows)


def audit(data: xr.Dataset) -> tuple[Finding, ...]:
    """Judge what a time history left out, and what of the rest it needed.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history, also one that was saved and loaded.

    Returns
    -------
    tuple of Finding
        One for each feature, in the order of `Features.names()`, one on full contact, one on the
        stable limit of interface slip, where it applies one on rims that were met with a slip and
        one on the yield displacement; of a structure with hinges one on how far they turned; one
        on the sum of all forces, and where it applies one on nodes accelerated by more than 50 g
        and one on the error of a step that was given.

    Raises
    ------
    TypeError
        If it is no Dataset.

    Notes
    -----
    A recording that leaves steps or variables out (`Recording`) keeps what was reached at all
    steps, so that nothing is missed; with ``level="rigid_body"`` and `record_every` alone only the
    recorded steps are seen.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, audit, lumped_mass, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> [found.feature for found in audit(data) if found.mattered]
    ['velocity_dependence', 'yield_displacement']
    >>> audit(data)[0].sentence
    'rims: not needed, reached 95 % of the displacement capacity'
    """
    require_type("data", data, xr.Dataset, "a Dataset of time_history")
    out = left_out(data)
    found = [_JUDGES[name](data, name in out) for name in Features.names()]
    remarks = tuple(_remarked(each) for each in (*equilibrium(data), *time_step(data)))
    whole = (
        _full_contact(data),
        _slip_stability(data),
        *_met_with_slip(data),
        *_held_by_friction(data),
        *_yielding(data),
        *_strained(data),
    )
    return Findings((*found, *whole, *remarks))


def audit_report(data: xr.Dataset) -> str:
    """Return the assumption check of a time history as text, a line a finding.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history.

    Returns
    -------
    str
        Lines that begin with "!" tell of something left out that mattered, or of a slip that the
        interface may not hold.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, audit_report, lumped_mass, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> audit_report(data).splitlines()[0]
    '  rims: not needed, reached 95 % of the displacement capacity'
    """
    return report_of(audit(data))


def report_of(findings: tuple[Finding, ...]) -> str:
    """Return findings as text: what was left out first, then what was modelled."""
    ordered = sorted(findings, key=lambda finding: not finding.left_out)
    marks = ("! " if is_missing(finding) or finding.doubtful else "  " for finding in ordered)
    return "\n".join(m + finding.sentence for m, finding in zip(marks, ordered, strict=True))


def doubts_of(data: xr.Dataset) -> tuple[str, ...]:
    """Return what the assumption check of a result marks with "!", a sentence each."""
    lines = str(data.attrs.get("audit", "")).splitlines()
    return tuple(line[2:] for line in lines if line.startswith("! "))


def is_missing(finding: Finding) -> bool:
    """Return whether the run should be repeated with what it left out."""
    return finding.left_out and finding.mattered


def needed_level(findings: tuple[Finding, ...]) -> str:
    """Return the cheapest level that is sufficient: "pendulum", or "contact"."""
    return "contact" if asking_for_contact(findings) else "pendulum"


def asking_for_contact(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings that ask for the level "contact" for some bearings."""
    return tuple(f for f in findings if f.bearings and f.feature in _ASKING)


def _rims(data: xr.Dataset, out: bool) -> Finding:
    limit = data.variables["rim_displacement"].to_numpy()
    share = float((largest(data, "sliding").values / limit).max())
    met = largest(data, "rims_met")
    mattered = share >= (_reached(data, "rims") if out else 1.0)
    if np.isinf(limit).all():
        return _finding("rims", out, False, 0.0, "the bearings have none")
    if out or not met.values.any():
        text = f"reached {_share(share)} of the displacement capacity"
        return _finding("rims", out, out and mattered, share, text)
    bent = total(data, "rim_plastic")
    text = f"met by {_by_whom(met)}{_bent_rims(data, bent)}"
    return replace(_finding("rims", out, True, share, text), doubtful=bool(np.isinf(bent).any()))


def _bent_rims(data: xr.Dataset, bent: FloatArray) -> str:
    names = data["bearing"].to_numpy()
    broken = names[np.isinf(bent)]
    if broken.size:
        who = ", ".join(str(name) for name in broken[:_NAMED])
        more = f" and {broken.size - _NAMED} more" if broken.size > _NAMED else ""
        return (
            f"; a rim broke of {who}{more}: the slider went on over the flange, on the same "
            "sphere, and nothing holds it there"
        )
    k = int(np.argmax(bent))
    if not bent[k] > 0.0:
        return ""
    share = bent[k] / float(data["rim_overrun"][k])
    return (
        f"; {int((bent > 0.0).sum())} of them yielded, by up to {1e3 * bent[k]:.3g} mm "
        f"({names[k]}, {_share(share)} of the deformation at which it breaks)"
    )


def _interface(data: xr.Dataset, out: bool) -> Finding:
    if np.isinf(data.variables["interface_friction"].to_numpy()).all():
        return _finding("interface", out, False, 0.0, "the slider is rigid")
    share = float(largest(data, "interface_share").values.max())
    loose = "" if out else _loose_slip(data)
    if out or (share < FULL_SLIP and not loose):
        mattered = out and share >= _reached(data, "interface")
        text = f"carried {_share(share)} of what its friction holds"
        return _finding("interface", out, mattered, share, text)
    slips, slipped = largest(data, "slip").values, largest(data, "slipped")
    who = f", {_by_whom(slipped)}" if slipped.values.any() else ""
    text = f"slipped up to {1e3 * float(slips.max()):.3g} mm{who}{loose}"
    return replace(_finding("interface", out, True, share, text), doubtful=bool(loose))


def _loose_slip(data: xr.Dataset) -> str:
    # What sliders slipped while next to nothing pressed them, beyond what the rims made them slip:
    # that is given by the displacement, on whatever the sliders did. Without mass, at the level
    # "pendulum", they slip no further.
    bodies = np.array(levels_of_bearings(data)) != "pendulum"
    if not bodies.any():
        return ""
    slips, moved = largest(data, "slip").values, largest(data, "displacement").values
    tilts = data.variables["rim_displacement"].to_numpy() / data.variables["radius"].to_numpy()
    room = data.variables["length"].to_numpy() * tilts.min(axis=1)  # until a rim is met
    free = bodies * np.minimum(total(data, "slip_loose"), slips - np.maximum(moved - room, 0.0))
    k = int(np.argmax(free))
    by, least = float(free[k]), BARE * float(data["slider_radius"][k])
    if not by > max(LOOSE_SLIP * float(slips.max()), least):
        return ""
    return (
        f"; {data['bearing'].to_numpy()[k]} slipped {1e3 * by:.3g} of its {1e3 * slips[k]:.3g} mm "
        f"under less than {_share(LOOSE)} of its load at rest: its sliders fly and bounce, which "
        f"no step settles; count on {_share(1.0 + LOOSE_ERROR)} of those {1e3 * by:.3g} mm"
    )


def _uplift(data: xr.Dataset, out: bool) -> Finding:
    least = 0.0 - float(largest(data, "vertical_tension").values.max())
    happened = largest(data, "lifted")
    if out or not (happened.values > 0.0).any():  # the stop of one that failed may carry nothing
        return _finding("uplift", out, out and least <= 0.0, least, f"smallest N {least:.2f} W")
    return _finding("uplift", out, True, least, f"lifted off: {_by_whom(happened)}")


def _plate_rotation(data: xr.Dataset, out: bool) -> Finding:
    shift = float(largest(data, "centre_shift").values.max())
    moved = float(largest(data, "displacement").values.max())
    share = shift / moved if moved > 0.0 else 0.0
    text = f"tilt moves the spheres' centres by up to {1e3 * shift:.2g} mm, {_share(share, 1)} of "
    text += "the largest displacement"
    return _finding("plate_rotation", out, share > SMALL["plate_rotation"], share, text)


def _velocity_dependence(data: xr.Dataset, out: bool) -> Finding:
    if not data.variables["friction_drop"].to_numpy().any():
        text = "no friction depends on speed"
        return _finding("velocity_dependence", out, False, 0.0, text)
    work = float(total(data, "sliding_work"))
    share = float(total(data, "sliding_work_lower")) / work if work > 0.0 else 0.0
    text = f"over the paths slid, friction is {_share(share, 1)} below that at high speed"
    return _finding("velocity_dependence", out, share > SMALL["velocity_dependence"], share, text)


def _second_direction(data: xr.Dataset, out: bool) -> Finding:
    if not out:
        moves = largest(data, "displacement_along").values
        x, y = float(moves[0]), float(moves[1])
        share = _ratio(y, x)
        text = f"displacement along y reached {1e3 * y:.3g} mm, along x {1e3 * x:.3g} mm"
    else:
        peak = data["peak_ground_velocity"]
        x, y = float(peak.sel(axis="x")), float(peak.sel(axis="y"))
        coupled = float(data.attrs["plane_coupling"])
        share = max(_ratio(y, x), coupled)
        text = f"peak ground velocity along y {_share(_ratio(y, x))} of that along x, pushed along "
        text += f"x the bearings move along y by {_share(coupled, 1)} of it"
    return _finding("second_direction", out, share > SMALL["second_direction"], share, text)


def _vertical_coupling(data: xr.Dataset, out: bool) -> Finding:
    share = float(largest(data, "vertical_change").values.max())
    text = f"axial forces differ from those at rest by up to {_share(share)}"
    return _finding("vertical_coupling", out, share > SMALL["vertical_coupling"], share, text)


def _pressure_dependence(data: xr.Dataset, out: bool) -> Finding:
    if "pressure_rate" not in data or not data.variables["pressure_rate"].to_numpy().any():
        text = "no friction depends on pressure"
        return _finding("pressure_dependence", out, False, 0.0, text)
    share = _ratio(float(total(data, "sliding_work_pressed")), float(total(data, "sliding_work")))
    text = f"over the paths slid, it changes friction by {_share(share, 1)}"
    return _finding("pressure_dependence", out, share > SMALL["pressure_dependence"], share, text)


def _friction_heating(data: xr.Dataset, out: bool) -> Finding:
    if "softening_rate" not in data or not data.variables["softening_rate"].to_numpy().any():
        text = "no friction depends on temperature"
        return _finding("friction_heating", out, False, 0.0, text)
    share = _ratio(float(total(data, "sliding_work_heated")), float(total(data, "sliding_work")))
    hottest = float(np.nanmax(largest(data, "temperature").values[:, :2]))
    text = f"the surfaces reached {hottest:.0f} C, over the paths slid that changes friction by "
    text += _share(share, 1)
    return _finding("friction_heating", out, share > SMALL["friction_heating"], share, text)


def _full_contact(data: xr.Dataset) -> Finding:
    offsets = largest(data, "eccentricity").values
    names = data.variables["bearing"].to_numpy()
    share = float(offsets.max())
    if share <= KERN:
        verdict = "holds"
    elif share <= EDGE:
        verdict = "partial contact, no tipping"
    else:
        verdict = "edge contact" if share < 1.0 else "the slider tips"
    text = f"full contact: e/a = {share:.2f} in {names[int(np.argmax(offsets))]}: {verdict}"
    doubts = level_doubts(data)
    if doubts.bearings:
        text += f"; {doubts.sentence}"
    has_spin = "slider_spin" in data or "reached_spin" in data
    spins = largest(data, "spin").values if has_spin else np.zeros(len(names))
    spun = (spins > SPUN) & (np.array(levels_of_bearings(data)) == "pendulum")
    if spun.any():
        text += f"; the sliders spun by {float(spins.max()):.2g} rad, on which the slip depends"
    asking = {*doubts.bearings, *(str(name) for name in names[spun])}
    is_marked = doubts.marked or bool(spun.any())
    return Finding(
        feature="full_contact",
        left_out=is_marked,
        mattered=bool(asking),
        number=share,
        sentence=f'{text}; rerun with level="contact"' if is_marked else text,
        bearings=tuple(str(name) for name in names if str(name) in asking),
    )


def _slip_stability(data: xr.Dataset) -> Finding:
    # docs/theory.md (2.7), with the friction of high speed; a rigid slider holds without end
    friction = data.variables["interface_friction"].to_numpy()
    rubbed = [data.variables[name].transpose("bearing", ...) for name in ("friction_max", "radius")]
    held = data.variables["length"].to_numpy() * friction
    held -= (rubbed[0].to_numpy() * rubbed[1].to_numpy()).sum(axis=1)
    slip = largest(data, "slip").values
    shares = slip / np.maximum(held, 1e-12)
    overlaps = (
        slip / data.variables["slip_capacity"].to_numpy() if "slip_capacity" in data else 0 * shares
    )
    worst, last = int(np.argmax(shares)), int(np.argmax(overlaps))
    share = float(shares[worst])
    names, parts = data.variables["bearing"].to_numpy(), []
    if share > HOLDS:
        limit = 1e3 * max(float(held[worst]), 0.0)
        parts.append(
            f"{names[worst]} slipped {1e3 * slip[worst]:.3g} mm, without rims the interface "
            f"holds {limit:.3g} mm: where the motion turns again in that direction, the sliders "
            "slip on; raise mu_h"
        )
    if overlaps[last] > OVERLAPS:
        limit = 1e3 * float(data["slip_capacity"][last])
        parts.append(
            f"{names[last]} slipped {1e3 * slip[last]:.4g} mm of the {limit:.4g} mm at which "
            "the sliders' overlap ends: a few per cent decide whether it fails; raise mu_h or "
            "the capacity"
        )
    text = "; ".join(parts) or f"the slip reached {_share(share)} of what holds without rims"
    if np.isinf(friction).all():
        text = "the slider is rigid"
    finding = _finding("slip_stability", False, bool(parts), share, text)
    at_pendulum = np.array(levels_of_bearings(data)) == "pendulum"
    close = ((shares > HOLDS) | (overlaps > OVERLAPS)) & at_pendulum
    return replace(finding, doubtful=bool(parts), bearings=tuple(str(n) for n in names[close]))


def _met_with_slip(data: xr.Dataset) -> tuple[Finding, ...]:
    # docs/theory.md (2.9): what the axial stiffness makes of the closing speed; of the first
    # contact, whose slip is none, and of files from before there is nothing to say.
    if "axial_stiffness" not in data.variables:
        return ()
    closing = largest(data, "closing")
    static = data.variables["static_axial_force"].to_numpy()
    stiffness = data.variables["axial_stiffness"].to_numpy()
    rises = closing.values * np.sqrt(stiffness / (static * STANDARD_GRAVITY))
    k = int(np.argmax(rises))
    if not rises[k] > IMPACT:
        return ()
    height = data.variables["radius"].to_numpy().sum(axis=1) - data.variables["length"].to_numpy()
    area = np.pi * data.variables["slider_radius"].to_numpy() ** 2
    assumed = bool(np.isclose(stiffness[k], stack_stiffness(area[k], height[k]), rtol=1e-6))
    low, high = STACK_RANGE
    text = (
        f"{data['bearing'].to_numpy()[k]} met a rim with a slip at {closing.at[k]:.2f} s: the "
        f"axial stiffness stops {1e3 * closing.values[k]:.3g} mm/s along the slider, by which the "
        f"axial force rises by up to {_share(float(rises[k]))} of that at rest, and the bearing's "
        "force with it"
    )
    if assumed:
        text += (
            f"; this stiffness of {stiffness[k]:.3g} N/m is the default, an estimate: run with "
            f"{low:g} and {high:g} times that, or give the maker's"
        )
    finding = _finding("impacts", False, True, float(rises[k]), text)
    return (replace(finding, doubtful=assumed),)


def _held_by_friction(data: xr.Dataset) -> tuple[Finding, ...]:
    # Up to L Q/W friction holds a bearing wherever it stops: what is reached there goes by all
    # that the motion did before (docs/limits.md).
    if "yield_displacement" not in data.variables:
        return ()
    rubbed = [data.variables[name].transpose("bearing", ...) for name in ("friction_max", "radius")]
    held = (rubbed[0].to_numpy() * rubbed[1].to_numpy()).sum(axis=1)
    yields = data.variables["yield_displacement"].to_numpy().max(axis=-1)
    moved = largest(data, "displacement").values
    slid = (held > 0.0) & (moved > SLID * yields)
    shares = np.where(slid, moved / np.maximum(held, 1e-12), np.inf)
    ended = "exceeded" not in data.attrs and data.attrs.get("status", "ok") in COMPLETE
    rest = np.where(slid, left(data, "displacement"), 0.0) * ended
    least, most = int(np.argmin(shares)), int(np.argmax(rest / np.maximum(held, 1e-12)))
    names, parts = data.variables["bearing"].to_numpy(), []
    if shares[least] < STUCK:
        parts.append(
            f"{names[least]} moved {_share(float(shares[least]))} of what its friction holds "
            f"(L Q/W = {1e3 * held[least]:.3g} mm): a yield_displacement of "
            f"{1e3 * yields[least]:.2g} mm moves such a peak by some 10 %, far smaller ones by more"
        )
    if LEFT_OVER * held[most] < rest[most] <= held[most]:  # beyond it it still swings
        parts.append(
            f"{names[most]} is left {1e3 * rest[most]:.3g} mm aside, friction holds up to "
            f"{1e3 * held[most]:.3g} mm: the residual displacement of one run means little, take "
            "the median of many"
        )
    if not parts:
        return ()
    finding = _finding("yield_displacement", False, True, float(shares[least]), "; ".join(parts))
    return (finding,)


def _yielding(data: xr.Dataset) -> tuple[Finding, ...]:
    # Hinges keep their strength here; those of steel lose it from about TURNED on.
    if "hinge" not in data.dims:
        return ()
    turned = largest(data, "hinge_rotation")
    k = int(np.argmax(turned.values))
    most = float(turned.values[k])
    text = f"plastic rotation of hinges up to {1e3 * most:.3g} mrad"
    if most > TURNED:
        text = (
            f"plastic rotation of hinge {data['hinge'].to_numpy()[k]}: {1e3 * most:.3g} mrad at "
            f"t = {float(turned.at[k]):.4g} s: members lose strength from about {1e3 * TURNED:.0f} "
            "mrad on, which is not modelled; take it as the beginning of a failure"
        )
    finding = _finding("yielding", False, most > 0.0, most, text)
    return (replace(finding, doubtful=most > TURNED),)


def _strained(data: xr.Dataset) -> tuple[Finding, ...]:
    # Imported members are linear: said where they would have yielded.
    most = float(data.attrs.get("strain_over_limit", 0.0))
    if most <= 1.0:
        return ()
    count = int(data.attrs["strain_over_limit_count"])
    text = (
        f"{data.attrs['strain_over_limit_in']} strains {most:.3g} times as far as its material "
        f"keeps its stiffness, at t = {float(data.attrs['strain_over_limit_at']):.4g} s ({count} "
        "imported members are beyond that): here they stay elastic, in OpenSees they yield, and "
        "displacements differ; put the bearings under the model there by isolate, and compare"
    )
    return (replace(_finding("yielding", False, True, most, text), doubtful=True),)


def _remarked(remark: Remark) -> Finding:
    return Finding(
        feature=remark.feature,
        left_out=False,
        mattered=remark.doubtful,
        number=remark.number,
        sentence=remark.sentence,
        doubtful=remark.doubtful,
    )


def _finding(feature: str, out: bool, mattered: bool, number: float, text: str) -> Finding:
    label = feature.replace("_", " ")
    if out:
        sentence = f"{label} left out: {text}"
    else:
        sentence = f"{label}: {text}" if mattered else f"{label}: not needed, {text}"
    return Finding(
        feature=feature, left_out=out, mattered=bool(mattered), number=number, sentence=sentence
    )


def _by_whom(happened: Extreme) -> str:
    # "3 of 9 bearings, first at 4.17 s", from a quantity (bearing,) that is 1 once it happens.
    those = happened.values > 0.0
    first = float(happened.at[those].min())
    return f"{int(those.sum())} of {len(those)} bearings, first at {first:.2f} s"


def _reached(data: xr.Dataset, own: str) -> float:
    others = set(left_out(data)) - {own}
    return NEAR if others else 1.0


def _share(value: float, digits: int = 0) -> str:
    return f"{100.0 * value:.{digits}f} %" if value < 10.0 else "more than 1000 %"


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
