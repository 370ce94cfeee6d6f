"""Loss, annual rates, spectral shape, floor spectra: writes docs/validation/study_loss.md.

    python -m validation.study.loss --store loss-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk import open_campaign
from frames.risk.fragility.fitting import RESAMPLES
from validation.page import render
from validation.study.consequences import COMPONENTS, REPLACEMENT
from validation.study.hazards import SHORTEST
from validation.study.loss_figures import FLOORS, LOSSES, SHAPE, figures
from validation.study.loss_runs import (
    FLOOR_PERIODS,
    LIMITS,
    STRUCTURE,
    best_campaign,
    campaign,
    floor_spectra,
    floors_of,
    found_of,
)
from validation.study.pairs import BY_LOAD, NAMES, OTHERS, OURS, UNBREAKABLE
from validation.study.part import performed, run_part, write_part
from validation.study.records_runs import COLLAPSE, INTENSITY, normalised
from validation.study.rounded import csv_of, rounded, with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    Found = Mapping[str, Any]

NAME = "study_loss"
RECORDS = "far-field"


def write(found: Mapping[str, Any]) -> None:
    """Write the page, its figures, tables and the numbers."""
    rates = [
        {"hazard": key, "device": name, "limit": limit}
        | dict(zip(("rate [1/year]", "low", "high"), row["rate"], strict=True))
        for key, each in found["rates"].items()
        for limit, rows in each.items()
        for name, row in rows.items()
    ]
    losses = [
        {"device": name, "Sa(3 s) [m/s2]": im, "loss [-]": curve["mean"][k]}
        | {f"{part} [-]": values[k] for part, values in curve["parts"].items()}
        for name, curve in found["loss"]["curves"].items()
        for k, im in enumerate(found["loss"]["im"])
    ]
    tables = {f"{NAME}-rates.csv": csv_of(rates), f"{NAME}-loss.csv": csv_of(losses)}
    write_part(NAME, page(found), figures(found), found, tables)


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    costs = [
        performed(make(motions, store / name), workers)
        for name, make in (("runs", campaign), ("best", best_campaign))
    ]
    data = [open_campaign(store / name).results() for name in ("runs", "best")]
    cost = costs[-1] | {
        "runs": sum(each["runs"] for each in costs),
        "loop": sum(float(each["seconds_loop"].sum()) for each in data),
        "digests": [each["digest"] for each in costs],
    }
    floors = floors_of(floor_spectra(motions, store / "floors"))
    found: dict[str, Any] = rounded(
        found_of(data, motions, RESAMPLES) | {"floors": floors, "cost": cost}
    )
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("loss", given, run, write)


def collapsed(found: Found) -> tuple[float, dict[str, float]]:
    """Return the stripe next to the maximum considered earthquake, and shares that collapse."""
    stripes = found["stripes"][COLLAPSE.name]
    levels = [row[0] for row in stripes[OURS]]
    k = min(range(len(levels)), key=lambda n: abs(levels[n] - found["considered"]))
    return levels[k], {name: rows[k][1] / rows[k][2] for name, rows in stripes.items()}


def moved(found: Found, name: str) -> float:
    """Return what SaRatio changes of a collapse margin [%]."""
    line = found["shape"]["lines"][name]
    return 100.0 * float(line["corrected"][0] / line["margin"][0] - 1.0)


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
        UNBREAKABLE=UNBREAKABLE,
        FLOOR_PERIODS=FLOOR_PERIODS,
        LIMITS=LIMITS,
        REPLACEMENT=REPLACEMENT,
        SHORTEST=SHORTEST,
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


def _losses(found: Found) -> tuple[Any, ...]:
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
    return rows, unknown


def _components() -> Any:
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
    return rows


def _sites(found: Found) -> Any:
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
    return rows


def _rates(found: Found) -> Any:
    rows = []
    for key in found["rates"]:
        for name in NAMES:
            cells = []
            for limit in LIMITS:
                row = found["rates"][key][limit.name].get(name)
                cells.append("-" if row is None else with_interval(row["rate"], 2, 1e4))
            own = found["loss"]["annual"][key][name]
            rows.append([key, name, *cells, with_interval(own["loss"], 2, 1e2)])
    return rows


def _shape(found: Found) -> tuple[Any, ...]:
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
    middle = float(np.median([*shape["ratio"].values()]))
    return middle, rows, shape


def _efficiency(found: Found) -> tuple[Any, ...]:
    efficiency = found["shape"]["efficiency"]
    rows = [
        [measure, *(with_interval(each[name]) for name in NAMES)]
        for measure, each in efficiency.items()
    ]
    best = min(efficiency, key=lambda m: float(np.mean([row[0] for row in efficiency[m].values()])))
    return best, rows


def _floors(found: Found) -> tuple[Any, ...]:
    rows = []
    near = [int(np.argmin(abs(FLOOR_PERIODS - t))) for t in (0.05, 0.1, 0.2, 0.5, 1.0, 3.0)]
    for level, each in found["floors"].items():
        for name, own in each.items():
            for place, line in zip(("base", "roof"), own["median"], strict=True):
                cells = ["-" if line[k] is None else f"{line[k] / 9.80665:.2f}" for k in near]
                rows.append([level, name, place, *cells, f"{own['failed']} of {own['records']}"])
    return near, rows


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


if __name__ == "__main__":
    main()
