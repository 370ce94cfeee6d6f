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
    return render(
        globals(),
        CURVES=CURVES,
        MEDIANS=MEDIANS,
        found=found,
        INTENSITY=INTENSITY,
        ROOM=ROOM,
        ROOM_FRICTION=ROOM_FRICTION,
        ROOM_RADIUS=ROOM_RADIUS,
        STANDARD_GRAVITY=STANDARD_GRAVITY,
        STEP=STEP,
        TAIL=TAIL,
        bearing_for=bearing_for,
    )


def _introduction(found: Found) -> tuple[Any, ...]:
    columns, beams = (1e3 * value for value in yield_rotations().values())
    counts = ", ".join(
        f"{found['parts'][kind]['motions']} {kind}"
        for kind in RECORD_SETS
        if kind in found["parts"]
    )
    scales = ", ".join(f"{scale:g}" for scale in found["scales"])
    cost = found["cost"]
    return beams, columns, cost, counts, scales


def _definitions() -> Any:
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
    return rows


def _verdict(found: Found) -> tuple[Any, ...]:
    limits = found["parts"][ALL]["limits"]
    pairs = [(own, other) for own in (LIR, ROOM) for other in (RIMS, WIDE)]
    rows = [
        (limit.name, *(_ratio(limits[limit.name]["ratios"][own].get(o)) for own, o in pairs))
        for limit in LIMITS
    ]
    return pairs, rows


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


def _larger_sliders(found: Found) -> tuple[Any, ...]:
    at = _last_held(found, ROOM)
    margins = [margin(found, ALL, name) for name in (LIR, ROOM, RIMS)]
    own, larger, rims = ("none" if each is None else f"{each[0]:.2f}" for each in margins)
    failed = [
        sum(n for status, n in found["statuses"][name].items() if status != "ok")
        for name in (LIR, ROOM, RIMS)
    ]
    runs = sum(found["statuses"][LIR].values())
    return at, failed, larger, own, rims, runs


def _physics(found: Found) -> tuple[Any, ...]:
    limits, at = found["parts"][ALL]["limits"], _last_held(found, LIR)
    failures = limits[COLLAPSE.name]["stripes"][LIR]
    alone = [name for name, own in limits.items() if own["stripes"][LIR] == failures]
    told = ", ".join(f"{name} {_floor_and_shear(found, name, at)}" for name in (LIR, RIMS))
    bearings = bearings_of("light").values()
    slip = 1e3 * min(b.resolved()["slip_capacity"] for b in bearings)
    overrun = found["statuses"][RIMS].get("rim_overrun", 0)
    runs = sum(found["statuses"][RIMS].values())
    return alone, at, bearings, overrun, runs, slip, told


def _rim_strength(bearings: Iterable[LIRBearing]) -> str:
    # Force at which the rims of each kind of bearing give way, over the design load.
    every = [bearing.resolved() for bearing in bearings]
    ratios = {round(o["rim_stiffness"] * o["rim_overrun"] / o["design_load"], 1) for o in every}
    return ", ".join(f"{ratio:.1f}" for ratio in sorted(ratios))


def _margins(found: Found) -> Any:
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
    return rows


def _fragilities(found: Found) -> tuple[Any, ...]:
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
    return head, note, rows


def _demands(found: Found) -> tuple[Any, ...]:
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
    return head, note, rows


def _sizes(found: Found) -> tuple[Any, ...]:
    bearing = bearing_for(1000e3)
    displacements = found["parts"][ALL]["demands"]["bearing displacement"][WIDE]
    rows = [
        (f"{scale:g}", *(f"{1e3 * d:.0f}, {_dish(d):.0f}" for d in (row[1], row[2], largest)))
        for scale, row, largest in zip(
            found["scales"], displacements, found["largest"], strict=True
        )
    ]
    return bearing, rows


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


def _cost(found: Found) -> tuple[Any, ...]:
    cost, seconds = found["cost"], found["seconds"]
    loops = "; ".join(
        f"{name} {1e3 * total * len(seconds) / cost['runs']:.0f} ms a history, "
        f"{most:.1f} s the longest"
        for name, (total, most) in seconds.items()
    )
    return cost, loops


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
