"""The page of the study of FEMA P695's records, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.demo import bearing_for
from frames.hazard.fema_records import RECORD_SETS
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.study_figures import CURVES, FLOOR, MEDIANS, SHOWN
from validation.measurements.study_runs import (
    ALL,
    COLLAPSE,
    DEVICES,
    FRACTILES,
    INTENSITY,
    LIMITS,
    STEP,
    ULTIMATE,
    margin,
    yield_rotations,
)
from validation.measurements.yielding_runs import LIR, RIMS, TAIL, WIDE, bearings_of
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Mapping

    Found = Mapping[str, Any]

SETS = (ALL, *RECORD_SETS)


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return "\n\n".join([
        "# A study: the records of FEMA P695 on LIR-DCFP, DCFP and a larger DCFP",
        _introduction(found),
        "## What counts as what",
        _definitions(),
        "## In short",
        _verdict(found),
        f"![Fragility of three devices against six limit states, all records](figures/{CURVES})",
        "All records; points are shares of stripes, bands of 90 % are from resampled records.",
        "## Collapse margin",
        _margins(found),
        "## Fragility",
        _medians_note(found),
        _fragilities(found),
        "## Demands",
        f"![Median ductility, floor acceleration, displacement left over the intensity](figures/{MEDIANS})",  # noqa: E501
        "Medians over all records, and the range of the middle 68 %; a line ends where half of "
        "the records have failed a bearing.",
        _demands(found),
        "## Size of the larger DCFP",
        _sizes(found),
        "## Runs that failed, and the step",
        _failures(found),
        _halved(found),
        "## Cost",
        _cost(found),
    ]) + "\n"  # fmt: skip


def _introduction(found: Found) -> str:
    columns, beams = (1e3 * value for value in yield_rotations().values())
    counts = ", ".join(f"{found['parts'][kind]['motions']} {kind}" for kind in RECORD_SETS
                       if kind in found["parts"])  # fmt: skip
    scales = ", ".join(f"{scale:g}" for scale in found["scales"])
    cost = found["cost"]
    return (
        "Written by `python -m validation.measurements.study` "
        f"({cost['date']}, {cost['machine']}). Auad, Castaldo and Almazan (2022) asked what the "
        "LIR-DCFP does to the reliability of a building that yields; this is the question with "
        "the building, the bearings and the time histories of this project, not a repetition of "
        "their models. The light frame of [yielding_comparison.md](yielding_comparison.md) (three "
        "storeys, nine bearings, plastic hinges) stands on the LIR-DCFP, on the DCFP of the same "
        "plates with rims, and on a DCFP so large that it meets no rims. "
        f"Record pairs of FEMA P695 ({counts}; horizontal, both at once, whole, and {TAIL:g} s to "
        f"come to rest) are scaled to {INTENSITY.label} of {scales} m/s2, so that factors differ "
        f"by record. Members yield at rotations of {columns:.1f} (columns) and {beams:.1f} mrad "
        f"(beams). All runs have a step of {1e3 * STEP:g} ms."
    )


def _definitions() -> str:
    rows = [
        ("rim contact", "a force of any rim"),
        ("slip over half of the overlap", "of the interface, any bearing; LIR-DCFP alone"),
        ("storey drift 2 %", "limit of ASCE 7-22, chapter 17, for time histories"),
        ("ductility", "1 + plastic over yield rotation M_p L / 6EI, any hinge; limit 4"),
        ("floor acceleration", "in plan, mean of a floor: 0.5 g and 1 g"),
        ("collapse", f"ductility {ULTIMATE:g} (an assumption; the hinges do not degrade), or "
         "failure of a bearing: slip beyond the overlap, or a rim overrun"),
        ("failure of a bearing", "exceeds every limit state (docs/fragility.md)"),
        ("collapse margin ratio", "median of collapse over the Sa of the maximum considered "
         "earthquake that fills the capacity: its ASCE 7 displacement (17.5-1, nominal friction) "
         "is 250 mm; without spectral shape factor"),
    ]  # fmt: skip
    return table(("term", "definition"), rows)


def _verdict(found: Found) -> str:
    limits = found["parts"][ALL]["limits"]
    lines = []
    for limit in LIMITS:
        for other, (value, low, high, _) in limits[limit.name]["ratios"].items():
            if low > 1.0:
                word = "better"
            elif high < 1.0:
                word = "worse"
            else:
                word = "neither better nor worse"
            lines.append(
                f"- {limit.name}: LIR-DCFP **{word}** than {other}, "
                f"{value:.2f} ({low:.2f} to {high:.2f}) times its median."
            )
    return "\n".join([*lines, "", _physics(found)])


def _physics(found: Found) -> str:
    part, limits = found["parts"][ALL]["demands"], found["parts"][ALL]["limits"]
    at = max(k for k, row in enumerate(part[FLOOR][LIR]) if row[1] is not None)
    failures = limits[COLLAPSE.name]["stripes"][LIR]
    alone = [name for name, own in limits.items() if own["stripes"][LIR] == failures]
    floors = [part[FLOOR][name][at][1] for name in (LIR, RIMS)]
    shears = [part["base shear over weight"][name][at][1] for name in (LIR, RIMS)]
    told = ", ".join(
        f"{name} {_of(value, 1.0 / STANDARD_GRAVITY, '.2f')} g and {_of(shear, 1.0, '.2f')} W"
        for name, value, shear in zip((LIR, RIMS), floors, shears, strict=True)
    )
    slip = 1e3 * min(b.resolved()["slip_capacity"] for b in bearings_of("light").values())
    return (
        "The interface slips instead of pushing on the rims, so that the force is bounded by its "
        f"friction: at {found['scales'][at]:g} m/s2 medians of floor acceleration and base shear "
        f"are {told}. What it gains "
        "in force it takes in travel: the sliders stand on each other until the slip uses up "
        f"their overlap ({slip:.0f} mm and more), and it is the same friction at every intensity, "
        "with nothing to bring the slip to a stop but friction and the restoring force of the "
        "spheres. Beyond that the bearing has failed, where a DCFP whose rims hold still stands "
        "and its frame yields. So the LIR-DCFP collapses at lower intensities than the "
        "DCFP **if** rims and plates bear the forces of the table below, and the frame, its "
        "connections and contents a floor acceleration of several g: rims are as strong as they "
        "need be in this model, and nothing above breaks by acceleration. A rim that breaks at a "
        "given force makes a DCFP fail where that force is reached. A larger DCFP "
        "meets neither; its cost is its plan.\n\n"
        "The runs of the LIR-DCFP that exceed one of these are the same, those whose bearing "
        f"fails: {', '.join(alone)}. Where its bearings hold, all are kept. At the maximum "
        "considered earthquake, which fills the capacity by its definition, the slip is all that "
        "is left. Larger sliders or another friction of the interface are not tried here."
    )


def _margins(found: Found) -> str:
    rows = []
    for kind in _kinds(found):
        for name in DEVICES:
            ratio = margin(found, kind, name)
            curve = found["parts"][kind]["limits"][COLLAPSE.name]["curves"][name]
            rows.append((
                kind, name, _median(curve), _spread(curve),
                "-" if ratio is None else f"{ratio[0]:.2f} ({ratio[1]:.2f} to {ratio[2]:.2f})",
            ))  # fmt: skip
    head = ("records", "device", "median [m/s2] (90 %)", "dispersion", "margin (90 %)")
    return (
        f"The maximum considered earthquake that fills the capacity has {INTENSITY.label} of "
        f"{found['considered']:.2f} m/s2 ({found['considered'] / STANDARD_GRAVITY:.2f} g).\n\n"
        + table(head, rows)
    )


def _medians_note(found: Found) -> str:
    return (
        "Medians in m/s2 (interval of 90 %, records resampled), dispersion, and the LIR-DCFP's "
        "median over that of the device, both under the same records. Fewer than 20 records "
        "make intervals too narrow ([fragility.md](../fragility.md))."
    )


def _fragilities(found: Found) -> str:
    rows = []
    for limit in LIMITS:
        for kind in _kinds(found):
            own = found["parts"][kind]["limits"][limit.name]
            for name in DEVICES:
                curve, ratio = own["curves"][name], own["ratios"].get(name)
                shown = (
                    "" if ratio is None else f"{ratio[0]:.2f} ({ratio[1]:.2f} to {ratio[2]:.2f})"
                )
                rows.append((limit.name, kind, name, _median(curve), _spread(curve), shown))
    head = ("limit state", "records", "device", "median", "dispersion", "LIR-DCFP over it")
    return table(head, rows)


def _demands(found: Found) -> str:
    shares = ", ".join(f"{100 * share:g} %" for share in FRACTILES)
    at = [_near(found, share) for share in (0.75, 1.0, 1.25)]
    texts = []
    for kind in _kinds(found):
        rows = []
        for place in dict.fromkeys(at):
            for name in DEVICES:
                cells = []
                for quantity, (_, factor, form) in SHOWN.items():
                    values = found["parts"][kind]["demands"][quantity][name][place]
                    cells.append(", ".join(_of(value, factor, form) for value in values))
                rows.append((f"{found['scales'][place]:g}", name, *cells))
        head = ("Sa [m/s2]", "device", *(text for text, _, _ in SHOWN.values()))
        texts.append(f"### {kind[0].upper()}{kind[1:]} records\n\n{table(head, rows)}")
    note = (
        f"Fractiles of {shares} at the intensities next to 0.75, 1 and 1.25 of that of the maximum "
        "considered earthquake; \"failed\": that part of the records has failed a bearing."
    )  # fmt: skip
    return "\n\n".join([note, *texts])


def _sizes(found: Found) -> str:
    bearing = bearing_for(1000e3)
    length = 2.0 * bearing.radius - bearing.slider_height
    radius = max(b.slider_radius for b in bearings_of("light").values())

    def dish(displacement: float) -> float:
        return 2e3 * (displacement * bearing.radius / length + radius)

    displacements = found["parts"][ALL]["demands"]["bearing displacement"][WIDE]
    rows = [
        (f"{scale:g}", *(f"{1e3 * d:.0f}, {dish(d):.0f}" for d in (row[1], row[2], largest)))
        for scale, row, largest in zip(
            found["scales"], displacements, found["largest"], strict=True
        )
    ]
    return (
        "Displacement, and the diameter of the dish that it needs under the centre bearing, "
        f"2 (D R / L + a) [mm]. Those of the LIR-DCFP and the DCFP with rims are "
        f"{dish(bearing.lateral_capacity):.0f} mm for {1e3 * bearing.lateral_capacity:.0f} mm.\n\n"
        + table(("Sa [m/s2]", "median", "84 %", "largest"), rows)
    )


def _failures(found: Found) -> str:
    rows = [(name, *(f"{number} `{status}`" for status, number in own.items()))
            for name, own in found["statuses"].items()]  # fmt: skip
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
        quantity: max(abs(whole[quantity] / half[quantity] - 1.0)
                      for whole, half in (run["runs"] for run in found["halved"]))
        for quantity in ("bearing displacement", "storey drift, mean", FLOOR)
    }  # fmt: skip
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
        f"most. The time loop takes: {loops}. Digest of the store: `{cost['digest']}`."
    )


def _kinds(found: Found) -> list[str]:
    return [kind for kind in SETS if kind in found["parts"]]


def _near(found: Found, share: float = 1.0) -> int:
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
