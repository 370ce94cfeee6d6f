"""The page of the study of FEMA P695's records, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.demo import bearing_for
from frames.design.hazard.motion_folder import RECORD_SETS
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR, RIMS, TAIL, WIDE, bearings_of
from validation.page import render, table
from validation.study.records_figures import CURVES, FLOOR, MEDIANS, SHOWN
from validation.study.records_runs import (
    ALL,
    COLLAPSE,
    DEVICES,
    FRACTILES,
    INTENSITY,
    LIMITS,
    ROOM,
    ROOM_FRICTION,
    ROOM_RADIUS,
    STEP,
    ULTIMATE,
    margin,
    yield_rotations,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from lir_element import LIRBearing

    Found = Mapping[str, Any]

SETS = (ALL, *RECORD_SETS)


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(globals(), CURVES=CURVES, MEDIANS=MEDIANS, found=found)


def _introduction(found: Found) -> str:
    columns, beams = (1e3 * value for value in yield_rotations().values())
    counts = ", ".join(
        f"{found['parts'][kind]['motions']} {kind}"
        for kind in RECORD_SETS
        if kind in found["parts"]
    )
    scales = ", ".join(f"{scale:g}" for scale in found["scales"])
    cost = found["cost"]
    return (
        "Written by `python -m validation.study.records` "
        f"({cost['date']}, {cost['machine']}). Auad, Castaldo and Almazan (2022) asked what the "
        "LIR-DCFP does to the reliability of a building that yields. This study asks the same with "
        "the building, the bearings and the time histories of this project; it does not repeat "
        "their models. The light frame of [yielding_comparison.md](yielding_comparison.md) (three "
        "storeys, nine bearings, plastic hinges) stands on the LIR-DCFP, on the DCFP of the same "
        "plates with rims, on a DCFP so large that it meets no rims, and on a LIR-DCFP with the "
        f"same rims whose sliders have {1e3 * ROOM_RADIUS:g} mm more in radius and an interface "
        f"friction of {ROOM_FRICTION:g} in place of "
        f"{bearing_for(1000e3).interface_friction:g}. "
        f"Record pairs of FEMA P695 ({counts}; horizontal, both at once, whole, and {TAIL:g} s to "
        f"come to rest) are scaled to {INTENSITY.label} of {scales} m/s2, so that factors differ "
        f"by record. Members yield at rotations of {columns:.1f} (columns) and {beams:.1f} mrad "
        f"(beams). All runs have a step of {1e3 * STEP:g} ms."
    )


def _definitions() -> str:
    rows = [
        ("rim contact", "a force of any rim"),
        ("slip over half of the overlap", "of the interface, any bearing; LIR-DCFPs alone"),
        ("storey drift 2 %", "limit of ASCE 7-22, chapter 17, for time histories"),
        ("ductility", "1 + plastic over yield rotation M_p L / 6EI, any hinge; limit 4"),
        ("floor acceleration", "in plan, mean of a floor: 0.5 g and 1 g"),
        (
            "collapse",
            f"ductility {ULTIMATE:g} (an assumption; the hinges do not degrade), or "
            "failure of a bearing: slip beyond the overlap, or a restrainer failure",
        ),
        ("failure of a bearing", "exceeds every limit state (docs/fragility.md)"),
        (
            "collapse margin ratio",
            "median of collapse over the Sa of the maximum considered "
            "earthquake that fills the capacity: its ASCE 7 displacement (17.5-1, nominal friction) "
            "is 250 mm; without spectral shape factor",
        ),
    ]
    return table(("term", "definition"), rows)


def _verdict(found: Found) -> str:
    limits = found["parts"][ALL]["limits"]
    pairs = [(own, other) for own in (LIR, ROOM) for other in (RIMS, WIDE)]
    rows = [
        (limit.name, *(_ratio(limits[limit.name]["ratios"][own].get(o)) for own, o in pairs))
        for limit in LIMITS
    ]
    head = ("limit state", *(f"{own} over {other}" for own, other in pairs))
    return "\n\n".join(
        [
            "Median of one device over that of another under all records (interval of 90 %): above 1 "
            "it is better, below 1 worse.",
            table(head, rows),
            _physics(found),
            _larger_sliders(found),
        ]
    )


def _ratio(value: list[float] | None) -> str:
    if value is None:
        return "-"
    low, high = (round(bound, 2) for bound in value[1:3])
    word = "better, " if low > 1.0 else "worse, " if high < 1.0 else ""
    return f"{word}{value[0]:.2f} ({value[1]:.2f} to {value[2]:.2f})"


def _last_held(found: Found, device: str) -> int:
    # The last stripe at which fewer than half of the records have failed a device's bearing.
    rows = found["parts"][ALL]["demands"][FLOOR][device]
    return max(k for k, row in enumerate(rows) if row[1] is not None)


def _floor_and_shear(found: Found, device: str, at: int) -> str:
    demands = found["parts"][ALL]["demands"]
    floor, shear = (demands[key][device][at][1] for key in (FLOOR, "base shear over weight"))
    return f"{_of(floor, 1.0 / STANDARD_GRAVITY, '.2f')} g and {_of(shear, 1.0, '.2f')} W"


def _larger_sliders(found: Found) -> str:
    at = _last_held(found, ROOM)
    margins = [margin(found, ALL, name) for name in (LIR, ROOM, RIMS)]
    own, larger, rims = ("none" if each is None else f"{each[0]:.2f}" for each in margins)
    failed = [
        sum(n for status, n in found["statuses"][name].items() if status != "ok")
        for name in (LIR, ROOM, RIMS)
    ]
    runs = sum(found["statuses"][LIR].values())
    return (
        "**Larger sliders.** How far its sliders may slip governs the collapse of the LIR-DCFP, and "
        f"is a choice of the designer: with {1e3 * ROOM_RADIUS:g} mm more in radius and an interface "
        f"friction of {ROOM_FRICTION:g} its bearings fail in {failed[1]} of {runs} runs in place "
        f"of {failed[0]} (DCFP with rims: {failed[2]}), and the collapse margin is {larger} in "
        f"place of {own} (DCFP with rims: {rims}). At {found['scales'][at]:g} m/s2 medians of "
        f"floor acceleration and base shear are {_floor_and_shear(found, ROOM, at)}. "
        "The price is the plan: dishes of "
        f"{_dish(bearing_for(1000e3).lateral_capacity, ROOM_RADIUS):.0f} mm in place of "
        f"{_dish(bearing_for(1000e3).lateral_capacity):.0f} mm."
    )


def _physics(found: Found) -> str:
    limits, at = found["parts"][ALL]["limits"], _last_held(found, LIR)
    failures = limits[COLLAPSE.name]["stripes"][LIR]
    alone = [name for name, own in limits.items() if own["stripes"][LIR] == failures]
    told = ", ".join(f"{name} {_floor_and_shear(found, name, at)}" for name in (LIR, RIMS))
    bearings = bearings_of("light").values()
    slip = 1e3 * min(b.resolved()["slip_capacity"] for b in bearings)
    overrun = found["statuses"][RIMS].get("rim_overrun", 0)
    runs = sum(found["statuses"][RIMS].values())
    return (
        "The interface slips instead of pushing on the rims, so that its friction limits "
        f"the force: at {found['scales'][at]:g} m/s2 medians of floor acceleration and base shear "
        f"are {told}. The price "
        "is travel: the sliders carry each other only until the slip uses up "
        f"their overlap ({slip:.0f} mm and more). The friction is the same at every intensity, "
        "and only it and the restoring force of the spheres bring the slip to a stop. "
        "Beyond that the bearing has failed, where a DCFP whose rims hold still stands "
        "and its frame yields. So the LIR-DCFP collapses at lower intensities than the "
        "DCFP **if** rims and plates bear the forces of the table below, and the frame, its "
        "connections and contents a floor acceleration of several g: nothing above breaks by "
        "acceleration in this model. Its rims are strong, but not without limit: they fail "
        "at a force (stiffness times deformation at failure) of "
        f"{_rim_strength(bearings)} times the design load of a bearing (corner, edge and centre), "
        f"and do so in {overrun} of {runs} runs of the DCFP with rims. Stiffness and deformation at "
        "failure are the defaults of the program and are not varied here. The sign of the collapse result depends on both: "
        "softer rims, or rims that fail earlier, let the DCFP collapse at lower intensities "
        "and narrow the comparison: [study_rims.md](study_rims.md) has rims that yield and break, "
        "down to half of the load, with which it does not turn. Read it for rims of this strength alone. A "
        "larger DCFP meets neither; its cost is its plan.\n\n"
        "The runs of the LIR-DCFP that exceed one of these are the same, those whose bearing "
        f"fails: {', '.join(alone)}. Where its bearings hold, all are kept. At the maximum "
        "considered earthquake, which fills the capacity by its definition, the slip is all that "
        "is left."
    )


def _rim_strength(bearings: Iterable[LIRBearing]) -> str:
    # Force at which the rims of each kind of bearing give way, over the design load.
    every = [bearing.resolved() for bearing in bearings]
    ratios = {round(o["rim_stiffness"] * o["rim_overrun"] / o["design_load"], 1) for o in every}
    return ", ".join(f"{ratio:.1f}" for ratio in sorted(ratios))


def _margins(found: Found) -> str:
    rows = []
    for kind in _kinds(found):
        for name in DEVICES:
            ratio = margin(found, kind, name)
            curve = found["parts"][kind]["limits"][COLLAPSE.name]["curves"][name]
            rows.append(
                (
                    kind,
                    name,
                    _median(curve),
                    _spread(curve),
                    "-" if ratio is None else f"{ratio[0]:.2f} ({ratio[1]:.2f} to {ratio[2]:.2f})",
                )
            )
    head = ("records", "device", "median [m/s2] (90 %)", "dispersion", "margin (90 %)")
    return (
        f"The maximum considered earthquake that fills the capacity has {INTENSITY.label} of "
        f"{found['considered']:.2f} m/s2 ({found['considered'] / STANDARD_GRAVITY:.2f} g).\n\n"
        + table(head, rows)
    )


def _fragilities(found: Found) -> str:
    note = (
        "Medians in m/s2 of all records (interval of 90 %, records resampled), and dispersion. "
        "Curves of each set are in study.json; there fewer than 20 records make intervals too "
        "narrow, as in the table above ([fragility.md](../fragility.md))."
    )
    rows = []
    for limit in LIMITS:
        own = found["parts"][ALL]["limits"][limit.name]["curves"]
        rows += [(limit.name, name, _median(own[name]), _spread(own[name])) for name in DEVICES]
    head = ("limit state", "device", "median", "dispersion")
    return f"{note}\n\n{table(head, rows)}"


def _demands(found: Found) -> str:
    shares = ", ".join(f"{100 * share:g} %" for share in FRACTILES)
    at = [_near(found, share) for share in (0.75, 1.0, 1.25)]
    rows = []
    for place in dict.fromkeys(at):
        for name in DEVICES:
            cells = []
            for quantity, (_, factor, form) in SHOWN.items():
                values = found["parts"][ALL]["demands"][quantity][name][place]
                cells.append(", ".join(_of(value, factor, form) for value in values))
            rows.append((f"{found['scales'][place]:g}", name, *cells))
    head = ("Sa [m/s2]", "device", *(text for text, _, _ in SHOWN.values()))
    note = (
        f"All records: fractiles of {shares} at the intensities next to 0.75, 1 and 1.25 of that "
        'of the maximum considered earthquake; "failed": that part has failed a bearing.'
    )
    return f"{note}\n\n{table(head, rows)}"


def _sizes(found: Found) -> str:
    bearing = bearing_for(1000e3)
    displacements = found["parts"][ALL]["demands"]["bearing displacement"][WIDE]
    rows = [
        (f"{scale:g}", *(f"{1e3 * d:.0f}, {_dish(d):.0f}" for d in (row[1], row[2], largest)))
        for scale, row, largest in zip(
            found["scales"], displacements, found["largest"], strict=True
        )
    ]
    return (
        "Displacement, and the diameter of the dish that it needs under the centre bearing, "
        f"2 (D R / L + a) [mm]. Those of the LIR-DCFP and the DCFP with rims are "
        f"{_dish(bearing.lateral_capacity):.0f} mm for {1e3 * bearing.lateral_capacity:.0f} mm, "
        f"with larger sliders {_dish(bearing.lateral_capacity, ROOM_RADIUS):.0f} mm.\n\n"
        + table(("Sa [m/s2]", "median", "84 %", "largest"), rows)
    )


def _dish(displacement: float, more: float = 0.0) -> float:
    # Diameter [mm] under the centre bearing for a displacement [m], of sliders larger by `more`.
    bearing = bearing_for(1000e3)
    length = 2.0 * bearing.radius - bearing.slider_height
    radius = max(b.slider_radius for b in bearings_of("light").values()) + more
    return 2e3 * (displacement * bearing.radius / length + radius)


def _failures(found: Found) -> str:
    rows = [
        (name, *(f"{number} `{status}`" for status, number in own.items()))
        for name, own in found["statuses"].items()
    ]
    told = "; ".join(f"{row[0]}: {', '.join(row[1:])}" for row in rows)
    failed = found["failed"]
    if not failed:
        return f"Statuses: {told}. No run failed numerically."
    first = "; ".join(f"{d}, {m} at {im:g} m/s2: {why}" for d, m, im, why in failed[:5])
    return (
        f"Statuses: {told}. {len(failed)} runs failed numerically and count as neither exceeding "
        f"nor keeping a limit: {first}{'; ...' if len(failed) > 5 else ''}."
    )


def _halved(found: Found) -> str:
    if "halved" not in found:
        return ""
    rows = []
    for run in found["halved"]:
        whole, half = run["runs"]
        cells = [
            ", ".join(_of(each[quantity], factor, form) for each in (whole, half))
            for quantity, (_, factor, form) in SHOWN.items()
        ]
        statuses = "`" + "`, `".join(dict.fromkeys((whole["status"], half["status"]))) + "`"
        rows.append((run["device"], run["motion"], f"{run['im']:g}", statuses, *cells))
    head = ("device", "motion", "Sa [m/s2]", "status", *(text for text, _, _ in SHOWN.values()))
    worst = {
        quantity: max(
            abs(whole[quantity] / half[quantity] - 1.0)
            for whole, half in (run["runs"] for run in found["halved"])
        )
        for quantity in ("bearing displacement", "storey drift, mean", FLOOR)
    }
    told = ", ".join(f"{100.0 * value:.1f} % of {key}" for key, value in worst.items())
    return (
        f"Runs at a step of {1e3 * STEP:g} ms, and at half of it; they differ by at most "
        f"{told}.\n\n{table(head, rows)}"
    )


def _cost(found: Found) -> str:
    cost, seconds = found["cost"], found["seconds"]
    loops = "; ".join(
        f"{name} {1e3 * total * len(seconds) / cost['runs']:.0f} ms a history, "
        f"{most:.1f} s the longest"
        for name, (total, most) in seconds.items()
    )
    return (
        f"{cost['runs']} histories, {cost['computed']} of them in this call: "
        f"{cost['clock']:.0f} s of clock, {cost['cpu']:.0f} s of processor time with "
        f"{cost['workers']} workers (compilation is cached), {cost['memory']:.0f} MB of memory at "
        f"most. The time loop takes: {loops}. Digest of the results database: `{cost['digest']}`."
    )


def _kinds(found: Found) -> list[str]:
    return [kind for kind in SETS if kind in found["parts"]]


def _near(found: Found, share: float) -> int:
    # Place of the stripe next to a share of the maximum considered earthquake.
    return int(np.argmin(np.abs(np.array(found["scales"]) - share * found["considered"])))


def _of(value: float | None, factor: float, form: str) -> str:
    return "failed" if value is None else f"{factor * value:{form}}"


def _median(curve: Mapping[str, Any]) -> str:
    if "why" in curve:
        return f"none: {str(curve['why']).split(':')[0].split(';')[0]}"
    value, low, high = curve["median"]
    return f"{value:.2f} ({low:.2f} to {high:.2f})"


def _spread(curve: Mapping[str, Any]) -> str:
    return "" if "why" in curve else f"{curve['dispersion'][0]:.2f}"
