"""The page of the study of loss, spectral shape and rates, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from validation.page import render, table
from validation.study.consequences import COMPONENTS, REPLACEMENT
from validation.study.hazards import SHORTEST
from validation.study.loss_figures import FLOORS, LOSSES, SHAPE
from validation.study.loss_runs import FLOOR_PERIODS, LIMITS, STRUCTURE
from validation.study.pairs import BY_LOAD, NAMES, OTHERS, OURS
from validation.study.published import published
from validation.study.records_runs import INTENSITY
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping

    Found = Mapping[str, Any]

ABOVE, BELOW, NEITHER = "higher", "lower", "not told apart"


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        BY_LOAD=BY_LOAD,
        FLOORS=FLOORS,
        INTENSITY=INTENSITY,
        LOSSES=LOSSES,
        NAMES=NAMES,
        OURS=OURS,
        SHAPE=SHAPE,
        found=found,
        published=published,
    )


def told(ratio: list[float]) -> str:
    """Return on which side of 1 an interval lies."""
    return ABOVE if ratio[1] > 1.0 else BELOW if ratio[2] < 1.0 else NEITHER


def _verdict(found: Found) -> str:
    lines = []
    for key, each in found["loss"]["annual"].items():
        words_ = [
            f"{name}: {with_interval(each[name]['ratio'])}, {told(each[name]['ratio'])}"
            for name in OTHERS
        ]
        lines.append(f"- **Annual loss, {key}**: {OURS}, over {'; '.join(words_)}.")
    sides = [told(each[name]["ratio"]) for each in found["without"].values() for name in OTHERS[1:]]
    lines.append(
        f"- **Without repair of the connections of beams** ({STRUCTURE}, of which most of the DCFPs' "
        f"repair is made): annual loss of {OURS}, {_counted(sides)}; "
        + "; ".join(
            f"{key}: {with_interval(each[OTHERS[1]]['ratio'])} of {OTHERS[1]}"
            for key, each in found["without"].items()
        )
        + "."
    )
    rates = found["rates"]
    for limit in LIMITS:
        sides = [
            told(row["ratio"])
            for each in rates.values()
            for row in each[limit.name].values()
            if "ratio" in row
        ]
        lines.append(f"- **Rate of {limit.name}**: that of {OURS}, is {_counted(sides)}.")
    lines.append(
        f"- **Collapse at the spectral shape of a code**: margin of {OURS}, over that of "
        + "; ".join(f"{name}: {with_interval(found['shape']['ratios'][name])}" for name in OTHERS)
        + "."
    )
    return "\n".join(lines)


def _counted(sides: list[str]) -> str:
    counts = ", ".join(f"{side} in {sides.count(side)}" for side in (BELOW, ABOVE, NEITHER))
    return f"{counts} of {len(sides)} comparisons"


def _losses(found: Found) -> str:
    loss = found["loss"]
    rows = []
    for k, im in enumerate(loss["im"]):
        cells = []
        for name in NAMES:
            curve = loss["curves"][name]
            three = [100.0 * curve[key][k] for key in ("mean", "low", "high")]
            down = 100.0 * curve["parts"]["collapse"][k]
            cells.append(f"{with_interval(three, 1)}; {down:.0f}")
        rows.append([f"{im:g}", *cells])
    unknown = sum(each["unknown"] for each in found["statuses"].values())
    return (
        "Expected loss in per cent of the cost of a new building, and after it the share of records "
        f"that collapse [%]. Runs whose analysis failed, {unknown}, are left out.\n\n"
        + table(["Sa(3 s) [m/s2]", *NAMES], rows)
    )


def _components() -> str:
    rows = [
        [
            each.name,
            each.text,
            "drift"
            if each.drift
            else "acceleration of the floor" + (" above" if each.above else ""),
            ", ".join(f"{m:g}" for m in each.medians),
            ", ".join(f"{b:g}" for b in each.dispersions),
            ", ".join(f"{c:.0f}" for c in each.costs),
            f"{each.count:.1f}: {each.quantity}",
        ]
        for each in COMPONENTS
    ]
    head = [
        "FEMA P-58",
        "component",
        "damaged by",
        "medians [-, g]",
        "dispersions",
        "repair, a unit [USD]",
        "units in a storey",
    ]
    return (
        "Components of FEMA P-58, second edition (database 3.1.2, from the damage and loss model "
        "library of NHERI SimCenter); damage states come one after the other, costs fall with the "
        "number that is mended. A new building costs "
        f"{REPLACEMENT:.0f} USD/m2 (Hwang and Lignos 2017, as in Kitayama and Cilsalar 2022); repair "
        "that costs more is a new building.\n\n" + table(head, rows)
    )


def _sites(found: Found) -> str:
    rows = [
        [
            name,
            *(f"{site['at'][key]:.2f}" for key in ("475", "2475")),
            f"{site['slope']:.1f}",
            f"{site['period']:.0f}",
            site["source"],
        ]
        for name, site in found["sites"].items()
    ]
    head = [
        "site",
        "Sa(3 s), 475 years [m/s2]",
        "2,475 years",
        "slope",
        "return period of the maximum considered [years]",
        "from",
    ]
    return (
        "The same bearings do not fit all sites: rates are given for the hazard as it is, and for "
        "its shape moved so that the intensity of 2,475 years is the maximum considered one of the "
        "bearings. What is beyond the given points goes on as a power law; motions that come more "
        f"often than once in {SHORTEST:.0f} years are left out.\n\n" + table(head, rows)
    )


def _rates(found: Found) -> str:
    rows = []
    for key in found["rates"]:
        for name in NAMES:
            cells = []
            for limit in LIMITS:
                row = found["rates"][key][limit.name].get(name)
                cells.append("-" if row is None else with_interval(row["rate"], 2, 1e4))
            own = found["loss"]["annual"][key][name]
            rows.append([key, name, *cells, with_interval(own["loss"], 2, 1e2)])
    head = [
        "hazard",
        "device",
        *(f"{limit.name} [1e-4/year]" for limit in LIMITS),
        "loss [% of a new building a year]",
    ]
    return table(head, rows)


def _shape(found: Found) -> str:
    shape = found["shape"]
    rows = []
    for name in NAMES:
        line = shape["lines"][name]
        rows.append(
            [
                name,
                with_interval(line["slope"]),
                f"{line['alone']:.2f}, {line['dispersion']:.2f}",
                with_interval(line["margin"]),
                with_interval(line["corrected"]),
                "-" if name == OURS else with_interval(shape["ratios"][name]),
            ]
        )
    head = [
        "device",
        "slope",
        "dispersion without, with it",
        "collapse margin, mean shape of the records",
        "at the target",
        f"{OURS}, over it, at the target",
    ]
    middle = float(np.median([*shape["ratio"].values()]))
    return (
        "SaRatio is Sa(3 s) over the geometric mean of Sa at ten periods from 0.6 to 4.5 s (0.2 to "
        "1.5 times 3 s). A record that is peaked at 3 s needs a larger Sa(3 s) to do the same; rare "
        "motions are peaked. The logarithm of each record's collapse capacity, known between two "
        f"intensities, is fitted by a line over ln SaRatio. Records have {middle:.2f} in the median; "
        f"the target, {shape['target']:.2f}, is a spectrum that falls as 1 / T, as codes have it "
        "between 0.6 and 4.5 s. It has no epsilon of a site: a target from disaggregation is higher.\n\n"
        + table(head, rows)
    )


def _efficiency(found: Found) -> str:
    efficiency = found["shape"]["efficiency"]
    rows = [
        [measure, *(with_interval(each[name]) for name in NAMES)]
        for measure, each in efficiency.items()
    ]
    best = min(efficiency, key=lambda m: float(np.mean([row[0] for row in efficiency[m].values()])))
    return (
        "Efficiency: dispersion of the collapse capacity in each measure; the smaller, the fewer "
        f"records are needed. Smallest on average over devices: {best}.\n\n"
        + table(["measure", *NAMES], rows)
    )


def _floors(found: Found) -> str:
    rows = []
    near = [int(np.argmin(abs(FLOOR_PERIODS - t))) for t in (0.05, 0.1, 0.2, 0.5, 1.0, 3.0)]
    for level, each in found["floors"].items():
        for name, own in each.items():
            for place, line in zip(("base", "roof"), own["median"], strict=True):
                cells = ["-" if line[k] is None else f"{line[k] / 9.80665:.2f}" for k in near]
                rows.append([level, name, place, *cells, f"{own['failed']} of {own['records']}"])
    head = [
        "intensity",
        "device",
        "level",
        *(f"{FLOOR_PERIODS[k]:.2f} s" for k in near),
        "records that fail",
    ]
    return (
        "Medians over records [g]. The impact of a slider on a rim is a pulse of milliseconds at the "
        "base: it shows at short periods first.\n\n" + table(head, rows)
    )


def _cost(found: Found) -> str:
    cost = found["cost"]
    floors = sum(each["records"] for level in found["floors"].values() for each in level.values())
    ends = "; ".join(
        f"{name}: " + ", ".join(f"{n} `{end}`" for end, n in own["counts"].items())
        for name, own in found["statuses"].items()
    )
    return (
        f"{cost['runs']} histories in the campaign ({cost['loop']:.0f} s in the time loop), and "
        f"{floors} for the floor spectra. Ends: {ends}. Digests of the results databases: "
        + ", ".join(f"`{digest}`" for digest in cost["digests"])
        + "."
    )
