"""The study in one paper, from the numbers of its parts: writes docs/validation/study_summary.md.

    python -m validation.study.summary

It runs nothing: the parts do (`python -m validation.study`).
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from validation.page import FOLDER, render
from validation.study.pairs import OURS as EQUAL
from validation.study.part import write_part
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    Parts = Mapping[str, Mapping[str, Any]]
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    Rows = list[tuple[str, dict[str, Sequence[float]]]]

NAME = "study_summary"
FIGURE = f"{NAME}-ratios.png"
READ = ("rims", "device", "buildings", "motions", "after", "loss", "uncertainty")
DRIFT, FLOOR, COLLAPSE = "storey drift 2 %", "floor acceleration 1 g", "collapse"
REFERENCE = 1
"""Which of the plans of the device's part is the example."""

PLANS = {0: "smaller", 1: "larger"}
"""How the part on rims calls these plans."""

RIMS = ("rims that never break", "rims of 2 W", "rims of 1 W", "rims of 0.5 W")


def parts_of(folder: Path = FOLDER) -> dict[str, dict[str, Any]]:
    """Return the numbers of the parts by name."""
    return {
        name: json.loads((folder / f"study_{name}.json").read_text(encoding="utf-8"))
        for name in READ
    }


def page(parts: Parts) -> str:
    """Return the page in Markdown."""
    return render(globals(), PLAIN=PLAIN, parts=parts, with_interval=with_interval)


def _plan(parts: Parts, place: int = REFERENCE) -> Mapping[str, Any]:
    return dict(parts["device"]["plans"][place])


def _width(plan: Mapping[str, Any]) -> str:
    return f"{1e3 * plan['plan']:.0f} mm"


def _abstract(parts: Parts) -> tuple[Any, ...]:
    plan = _plan(parts)
    ours, pair = plan["devices"]["LIR-DCFP"], plan["pairs"][PLAIN]["ratios"]
    plains = [
        f"{plan['devices'][rims]['margin'][0]:.2f} ({rims})"
        for rims in RIMS
        if rims in plan["devices"]
    ]
    verdicts = [
        f"{limit} {with_interval(pair[limit])}" for limit in (DRIFT, "ductility 4", FLOOR, COLLAPSE)
    ]
    after = parts["after"]["ratios"]["storey drift 4 %"]
    return after, ours, plains, plan, verdicts


def _carried(parts: Parts) -> str:
    # Of the runs in which a stop carries on after a failed bearing: in how many a frame collapses.
    words = []
    for name, rows in parts["after"]["stripes"].items():
        if "stop" in name:
            failed, collapsed = (sum(row[key] for row in rows) for key in ("failed", "collapsed"))
            words.append(f"{collapsed} of {failed} ({name.split(':', maxsplit=1)[0]})")
    return " and ".join(words)


def equal_ratios(found: Mapping[str, Any], other: str) -> list[float]:
    """Return margins of the LIR-DCFP over those of a DCFP of the same cost, at some costs."""
    own, their = (
        {
            sum(kept["cost"].values()): kept["margin"][0]
            for plan in found["plans"]
            if "margin" in (kept := plan["devices"][kind])
        }
        for kind in ("LIR-DCFP", other)
    )
    costs = sorted(their)
    return [
        margin / float(np.interp(cost, costs, [their[each] for each in costs]))
        for cost, margin in sorted(own.items())
        if costs and costs[0] <= cost <= costs[-1]
    ]


def _equal_cost(parts: Parts) -> str:
    words = []
    for rims in (RIMS[0], RIMS[2], RIMS[3]):
        found = equal_ratios(parts["device"], rims)
        words.append(f"{rims} {min(found):.2f} to {max(found):.2f}")
    return (
        "At equal cost, by assumed prices, the collapse margin of the LIR-DCFP over that of a DCFP, of a "
        f"larger plan then, is: {'; '.join(words)}."
    )


def _plans_words(parts: Parts) -> str:
    words = []
    for rims in (RIMS[0], RIMS[2], RIMS[3]):
        ratios = {
            _width(plan): plan["pairs"][rims]["ratios"][COLLAPSE]
            for plan in parts["device"]["plans"]
        }
        ahead = [name for name, (_, low, *_rest) in ratios.items() if low > 1.0]
        behind = [name for name, (_, _low, high, *_rest) in ratios.items() if high < 1.0]
        found = [
            f"{word} at {', '.join(names)}"
            for word, names in (("ahead", ahead), ("behind", behind))
            if names
        ]
        level = len(ratios) - len(ahead) - len(behind)
        found += [f"level at {level} of {len(ratios)} plans"] if level else []
        words.append(f"{rims} {', '.join(found)}")
    return f"By collapse it is, over the plans, against {'; against '.join(words)}."


def _runs(parts: Parts) -> str:
    # Histories of all parts; those of the device's search are listed one by one.
    total = sum(part["cost"]["runs"] for name, part in parts.items() if name != "device") + sum(
        each["runs"] for each in parts["device"]["costs"]
    )
    return f"{round(total, -2):,}"


def _method(parts: Parts) -> Any:
    plans = ", ".join(_width(plan) for plan in parts["device"]["plans"])
    return plans


def _margins(parts: Parts) -> tuple[Any, ...]:
    # Collapse margins by plan and rims; those of 2 W are of the part on rims, by plan.
    rows = []
    others = parts["rims"]["margins"]
    for place, plan in enumerate(parts["device"]["plans"]):
        cells = [with_interval(plan["devices"]["LIR-DCFP"]["margin"])]
        for rims in RIMS:
            name = f"DCFP, {PLANS.get(place, 'no such')} plan, {rims}"
            own = plan["devices"].get(rims, {}).get("margin") or others.get(name)
            cells.append(with_interval(own) if own else "-")
        rows.append([_width(plan), *cells])
    plan = _plan(parts)
    return plan, rows


def _robust(parts: Parts) -> str:
    words = []
    for limit in (DRIFT, "ductility 4", FLOOR, COLLAPSE):
        ratios = [ratio for _, found in comparisons(parts) if (ratio := found.get(limit))]
        better = sum(low > 1.0 for _, low, *_rest in ratios)
        worse = sum(high < 1.0 for _, _low, high, *_rest in ratios)
        words.append(
            f"- **{limit}**: {min(r[0] for r in ratios):.2f} to {max(r[0] for r in ratios):.2f} in "
            f"{len(ratios)} comparisons; better in {better}, worse in {worse}, not told apart in "
            f"{len(ratios) - better - worse}"
        )
    rows = [row for each in parts["motions"]["seconds"].values() for row in each["LIR-DCFP"]]
    plains = [
        row for each in parts["motions"]["seconds"].values() for row in each[f"DCFP, {PLAIN}"]
    ]
    counts = [
        f"{name} {sum(r['collapsed'] for r in own)} of {sum(r['known'] for r in own)}"
        for name, own in (("LIR-DCFP", rows), ("DCFP", plains))
    ]
    return (
        "\n".join(words)
        + f"\n\n**A second shock** collapses, of the buildings that survived the first: "
        f"{'; '.join(counts)} ([study_motions.md](study_motions.md)). **Properties**: the share of the record in "
        "the variance of ductility, and the order of the properties, are not known from the samples. Rims "
        "that break at one deformation lose the DCFP its margin where they are soft "
        "([study_uncertainty.md](study_uncertainty.md))."
    )


def _loss(parts: Parts) -> tuple[Any, ...]:
    found = parts["loss"]
    rows = []
    for site, devices in found["loss"]["annual"].items():
        own = devices[EQUAL]
        cells = [
            with_interval(devices[name]["ratio"])
            for name in (f"DCFP, {RIMS[0]}", f"DCFP, {PLAIN}", f"DCFP, {RIMS[3]}")
        ]
        rows.append([site, f"{100.0 * own['loss'][0]:.2f}", *cells])
    return found, rows


def _without(found: Mapping[str, Any]) -> str:
    # Ranges of the same ratios without the connections of beams, by the DCFP's rims.
    words = []
    for rims in (RIMS[0], RIMS[2], RIMS[3]):
        ratios = [each[f"DCFP, {rims}"]["ratio"][0] for each in found["without"].values()]
        words.append(f"{min(ratios):.2f} to {max(ratios):.2f} ({rims})")
    return ", ".join(words)


def _cost(parts: Parts) -> Any:
    rows = []
    for plan in parts["device"]["plans"]:
        costs = {
            name: sum(each["cost"].values())
            for name, each in plan["devices"].items()
            if each["cost"]
        }
        own = costs["LIR-DCFP"]
        rows.append(
            [_width(plan), f"{own:,.0f}"]
            + [f"{own / costs[rims]:.2f}" for rims in (RIMS[0], RIMS[2], RIMS[3])]
        )
    return rows


def _repeat(parts: Parts) -> Any:
    rows = []
    for name, part in parts.items():
        if name == "device":
            runs = sum(each["runs"] for each in part["costs"])
            seconds = sum(each["seconds"] for each in part["costs"])
            digests = [each["digest"] for each in part["costs"]]
        else:
            cost = part["cost"]
            runs, seconds = cost["runs"], part.get("loop", cost.get("loop", cost.get("cpu")))
            own = cost.get("digests") or [cost["digest"]]
            digests = list(own.values()) if isinstance(own, dict) else own
        more = f" and {len(digests) - 1} more" if len(digests) > 1 else ""
        rows.append([name, str(runs), f"{seconds:.0f}", f"`{digests[0][:16]}`{more}"])
    return rows


def write(parts: Parts) -> None:
    """Write the page and its figure."""
    write_part(NAME, page(parts), {FIGURE: figure_of(parts)})


def main(given: Sequence[str] | None = None) -> None:
    """Write the page from the numbers of the parts; options of the parts mean nothing here."""
    del given
    write(parts_of())


PLAIN = "rims of 1 W"
LIMIT = 1.6
"""Where the figure ends; intervals that go on have an arrow."""

LIMITS = ("storey drift 2 %", "ductility 4", "floor acceleration 1 g", "collapse")


def comparisons(parts: Parts) -> Rows:
    """Return conditions, and of each the ratios of medians by limit state: value, low, high."""
    rows: Rows = []
    for plan in parts["device"]["plans"]:
        ratios = plan["pairs"][PLAIN]["ratios"]
        rows.append((f"plan {1e3 * plan['plan']:.0f} mm", _known(ratios)))
    for name, each in parts["buildings"]["buildings"].items():
        ratios = {limit: each["limits"][limit]["ratios"].get(f"DCFP, {PLAIN}") for limit in LIMITS}
        rows.append((name, _known(ratios)))
    for angle in ("30", "60"):
        limits = parts["motions"]["angles"]["limits"]
        ratios = {limit: limits[limit][angle]["ratio"] for limit in LIMITS}
        rows.append((f"records turned by {angle} degrees", _known(ratios)))
    after = parts["after"]["ratios"]
    rows.append(("a stop after failure", _known({k: after[k][1] for k in LIMITS if k in after})))
    shape = parts["loss"]["shape"]["ratios"][f"DCFP, {PLAIN}"]
    rows.append(("spectral shape of a code", {"collapse": shape}))
    return rows


def _known(ratios: Mapping[str, Sequence[float] | None]) -> dict[str, Sequence[float]]:
    return {limit: ratio[:3] for limit, ratio in ratios.items() if ratio}


def figure_of(parts: Parts) -> Figure:
    """Return ratios with their intervals, a panel a limit state, a row a condition."""
    rows = comparisons(parts)
    figure = ps.new_figure(0.6 + 0.26 * len(rows))
    (panels,) = ps.grid_of(figure, 1, len(LIMITS), share_x=True, share_y=True)
    for panel, limit in zip(panels, LIMITS, strict=True):
        panel.axvline(1.0, color=ps.GREY, linewidth=0.8)
        for k, (_, ratios) in enumerate(rows):
            if limit not in ratios:
                continue
            value, low, high = ratios[limit]
            sure = low > 1.0 or high < 1.0
            shown = min(high, LIMIT)
            panel.plot([low, shown], [k, k], color="black", linewidth=1.0)
            if high > LIMIT:
                panel.plot([LIMIT], [k], ">", color="black", markersize=4)
            fill = "black" if sure else "white"
            panel.plot([value], [k], "o", color="black", markerfacecolor=fill, markersize=4)
        panel.set_xlim(0.75, LIMIT + 0.05)
        ps.caption(panel, title=limit.replace("acceleration", "\nacceleration"), x="LIR over DCFP")
    panels[0].set_yticks(range(len(rows)), [name for name, _ in rows])
    panels[0].set_ylim(len(rows) - 0.5, -0.5)
    return figure


if __name__ == "__main__":
    main()
