"""The page of the study of buildings, from its numbers alone; its tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from validation.page import render, table
from validation.study.buildings_figures import CURVES_FIGURE, RATIOS_FIGURE
from validation.study.buildings_numbers import (
    DEFINITIONS,
    HALVED_AT,
    LIR,
    STEPPED,
    UNHARMED,
    UPLIFT,
)
from validation.study.buildings_runs import (
    HEIGHT,
    LENGTH,
    SCALES,
    SPAN,
    THICKNESS,
    WALL_YIELDS,
)
from validation.study.paired import (
    DEVICES,
    LIMITS,
    OTHERS,
    as_csv,
    cost_line,
    told_lir,
)
from validation.study.records_figures import SHOWN
from validation.study.records_runs import COLLAPSE, INTENSITY, STEP, ULTIMATE
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Found = Mapping[str, Any]

NAME = "study_buildings"


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        CURVES_FIGURE=CURVES_FIGURE,
        LIR=LIR,
        RATIOS_FIGURE=RATIOS_FIGURE,
        cost_line=cost_line,
        found=found,
        HALVED_AT=HALVED_AT,
        HEIGHT=HEIGHT,
        INTENSITY=INTENSITY,
        LENGTH=LENGTH,
        LIMITS=LIMITS,
        SPAN=SPAN,
        STEP=STEP,
        THICKNESS=THICKNESS,
        ULTIMATE=ULTIMATE,
        UPLIFT=UPLIFT,
        WALL_YIELDS=WALL_YIELDS,
        told_lir=told_lir,
    )


def _introduction(found: Found) -> tuple[Any, ...]:
    cost = found["cost"]
    scales = ", ".join(f"{scale:g}" for scale in SCALES)
    fewer = [name for name, own in found["buildings"].items() if own["records"] < found["records"]]
    spared = f" To save time, {_of(fewer)} are run under every second record." if fewer else ""
    return cost, scales, spared


def _verdict(found: Found) -> Any:
    lines = []
    for limit in LIMITS:
        for other in OTHERS:
            above, below, open_, values = [], [], [], []
            for name, own in found["buildings"].items():
                ratio = own["limits"][limit.name]["ratios"][other]
                if ratio is None:
                    continue
                values.append(ratio[0])
                (above if ratio[1] > 1.0 else below if ratio[2] < 1.0 else open_).append(name)
            if not values:
                lines.append(f"- **{limit.name}**, over {other}: no median on one of both.")
                continue
            lines.append(
                f"- **{limit.name}**, {LIR} over {other}: {min(values):.2f} to {max(values):.2f} in "
                f"{len(values)} buildings; better in {_of(above)}, worse in {_of(below)}, not told apart "
                f"in {_of(open_)}."
            )
    return lines


def _verdict_definitions(found: Found) -> str:
    words = []
    for other in OTHERS:
        own = {
            each.name: [
                ratio[0]
                for building in found["buildings"].values()
                if (ratio := building["definitions"][each.name]["ratios"][other]) is not None
            ]
            for each in DEFINITIONS
            if each.bearings
        }
        known = {name: values for name, values in own.items() if values}
        low = min(known, key=lambda name: min(known[name]))
        high = max(known, key=lambda name: max(known[name]))
        words.append(
            f"over {other} from {min(known[low]):.2f} ({low}) to {max(known[high]):.2f} ({high})"
        )
    return f"By definition and building the ratio of medians goes {'; '.join(words)}."


def _of(names: Sequence[str]) -> str:
    return f"{len(names)} ({'; '.join(names)})" if names else "none"


def _buildings(found: Found) -> tuple[Any, ...]:
    rows = []
    for name, each in found["buildings"].items():
        own = each["facts"]
        rows.append(
            [
                name,
                f"{own['period']:.2f}",
                f"{own['strength']:.2f}",
                f"{own['slenderness']:.2f}",
                f"{1e-6 * own['weight']:.1f}",
                f"{1e-3 * own['least load']:.0f} to {1e-3 * own['largest load']:.0f}",
                f"{1e3 * own['least slider']:.0f} to {1e3 * own['largest slider']:.0f}",
                f"{1e3 * own['slider height']:.0f}",
            ]
        )
    head = [
        "building",
        "period, fixed base [s]",
        "strength V / W [-]",
        "height over width [-]",
        "weight W [MN]",
        "loads of bearings [kN]",
        "radii of sliders, smaller plan [mm]",
        "height of sliders [mm]",
    ]
    return head, rows


def _medians(found: Found) -> Any:
    rows = []
    for name, own in found["buildings"].items():
        for device in own["statuses"]:
            cells = []
            for limit in LIMITS:
                each = own["limits"][limit.name]
                median = each["medians"][device]
                cells.append(with_interval(median) if median else _why(each["why"][device]))
            collapse = own["limits"][COLLAPSE.name]["medians"][device]
            margin = [value / found["considered"] for value in collapse] if collapse else None
            rows.append([name, device, *cells, with_interval(margin)])
    return rows


def _why(text: str) -> str:
    return f"none: {text.split(':')[0].split(';')[0]}"


def _ratios(found: Found) -> tuple[Any, ...]:
    rows = [
        [
            name,
            other,
            *(with_interval(own["limits"][limit.name]["ratios"][other]) for limit in LIMITS),
        ]
        for name, own in found["buildings"].items()
        for other in OTHERS
    ]
    return rows, [limit.name for limit in LIMITS]


def _ends(found: Found) -> tuple[Any, ...]:
    rows = []
    for name, own in found["buildings"].items():
        for device in own["statuses"]:
            ends = ", ".join(f"{n} `{end}`" for end, n in own["statuses"][device].items())
            shares = own["limits"][COLLAPSE.name]["shares"][device]
            told = ", ".join(f"{over}/{failed}/{unknown}" for _, over, failed, _, unknown in shares)
            rows.append([name, device, ends, told])
    scales = ", ".join(f"{scale:g}" for scale in SCALES)
    return rows, scales


def _uplift(found: Found) -> tuple[Any, ...]:
    rows = []
    for name, own in found["buildings"].items():
        for device in own["statuses"]:
            cells = {
                level: f"{over} of {n}, {1e3 * mid:.1f}"
                for level, n, over, mid in own["uplift"][device]
            }
            rows.append([name, device, *(cells.get(scale, "-") for scale in SCALES)])
    head = ["building", "device", *(f"{scale:g} m/s2" for scale in SCALES)]
    return head, rows


def _definitions(found: Found) -> str:
    parts = []
    for other in OTHERS:
        rows = [
            [
                each.name,
                *(
                    with_interval(own["definitions"][each.name]["ratios"][other])
                    for own in found["buildings"].values()
                ),
            ]
            for each in DEFINITIONS
        ]
        head = [f"collapse is; {LIR} over {other}", *found["buildings"]]
        parts.append(table(head, rows))
    counts = [
        [
            each.name,
            *(
                ", ".join(
                    f"{own['definitions'][each.name]['counts'][device][0]}"
                    for device in own["statuses"]
                )
                for own in found["buildings"].values()
            ),
        ]
        for each in DEFINITIONS
    ]
    parts.append(
        f"Runs that collapse by each definition ({', '.join(DEVICES)}):\n\n"
        + table(["collapse is", *found["buildings"]], counts)
    )
    return (
        "Ratios of the medians by what is called collapse. Where the failure of a bearing does not count, a "
        "run is judged until its bearing failed: what the building would do after that is not known here, so "
        "that these lines flatter the device whose bearings fail.\n\n" + "\n\n".join(parts)
    )


def _unharmed(found: Found) -> tuple[Any, ...]:
    rows = []
    for name, own in found["buildings"].items():
        for device in own["statuses"]:
            failed, *counts = own["unharmed"][device]
            if failed:
                rows.append([name, device, str(failed), *(str(count) for count in counts)])
    head = [
        "building",
        "device",
        "runs whose bearing failed",
        *(f"frame at ductility {bound:g} or less until then" for bound in UNHARMED),
    ]
    return head, rows


def _steps(found: Found) -> tuple[Any, ...]:
    shown = {quantity: SHOWN[quantity] for quantity in STEPPED}
    rows, apart = [], []
    for row in found["halved"]:
        whole, half = row["runs"]
        statuses = "`" + "`, `".join(dict.fromkeys((whole["status"], half["status"]))) + "`"
        cells = [
            ", ".join(f"{factor * each[quantity]:{form}}" for each in (whole, half))
            for quantity, (_, factor, form) in shown.items()
        ]
        rows.append([row["building"], row["device"], row["motion"], statuses, *cells])
        if statuses.count("`") > 2:
            apart.append(f"{row['building']}, {row['device']}")
    worst = {
        quantity: max(
            abs(whole[quantity] / half[quantity] - 1.0)
            for whole, half in (row["runs"] for row in found["halved"])
            if whole["status"] == half["status"] == "ok"
            and half[quantity] > 1e-3  # a slip below 1 mm is none
        )
        for quantity in shown
    }
    told = ", ".join(
        f"{100.0 * worst[q]:.1f} % of {text.split(' [')[0]}" for q, (text, *_) in shown.items()
    )
    ends = f"ends differ in {'; '.join(apart)}" if apart else "all end alike"
    head = ["building", "device", "record", "status", *(text for text, *_ in shown.values())]
    return ends, head, rows, told


def csv_tables(found: Found) -> dict[str, str]:
    """Return the tables by the names of their files, SI units."""
    medians = [
        [name, device, limit.name, *(own["limits"][limit.name]["medians"][device] or [None] * 3)]
        for name, own in found["buildings"].items()
        for device in own["statuses"]
        for limit in LIMITS
    ]
    ratios = [
        [name, other, each.name, *(own["definitions"][each.name]["ratios"][other] or [None] * 3)]
        for name, own in found["buildings"].items()
        for other in OTHERS
        for each in DEFINITIONS
    ]
    shares = [
        [name, device, limit.name, *row]
        for name, own in found["buildings"].items()
        for limit in LIMITS
        for device in own["statuses"]
        for row in own["limits"][limit.name]["shares"][device]
    ]
    return {
        f"{NAME}-medians.csv": as_csv(
            ["building", "device", "limit state", "median [m/s2]", "low [m/s2]", "high [m/s2]"],
            medians,
        ),
        f"{NAME}-definitions.csv": as_csv(
            ["building", f"{LIR} over", "collapse is", "ratio [-]", "low [-]", "high [-]"], ratios
        ),
        f"{NAME}-shares.csv": as_csv(
            ["building", "device", "limit state", "Sa [m/s2]", "over", "bearings failed", "known",
             "unknown"],
            shares,
        ),
    }  # fmt: skip
