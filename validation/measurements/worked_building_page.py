"""The page of the worked building: tables, text and figures, from its numbers."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from frames.design.histories.demand_table import COUNTED
from frames.plots.plot_style import PALETTE, SMALL, caption, grid_of, new_figure
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BOUNDS = ("lower", "upper")
DEVICES = {"lir": "LIR-DCFP", "walled": "DCFP, same plates", "free": "DCFP, larger plates"}
UNITS = {
    "isolator displacement": ("mm", 1e3),
    "residual displacement": ("mm", 1e3),
    "interface slip": ("mm", 1e3),
    "residual interface slip": ("mm", 1e3),
    "rim force": ("kN", 1e-3),
    "minimum axial force": ("kN", 1e-3),
    "maximum axial force": ("kN", 1e-3),
    "uplifts, all bearings": ("-", 1.0),
    "maximum uplift": ("mm", 1e3),
    "base shear": ("kN", 1e-3),
    "storey shear": ("kN", 1e-3),
    "storey drift ratio": ("%", 1e2),
    "floor acceleration in plan": ("m/s2", 1.0),
}
LEVEL_COLUMNS = {"displacement": 1e3, "slip": 1e3, "seconds": 1.0}
DRAWN = ("isolator displacement", "base shear", "storey drift ratio", "floor acceleration in plan")
WHY = (
    "The chain begins with the code's displacement. *Spectrum* is the mean RotD100 spectrum of the "
    "scaled motions over the target, both at 5 % and the code's period; *B* is the damping factor "
    "of the code over that of the records (with EN 1998, 1/η): their product makes *records*, the "
    "displacement of linear oscillators with the code's own period and damping. *Settled* is where "
    "period and damping under these records agree with the displacement. *Centre* is the mean of "
    "the histories in the middle of the plan, *corner* that of the worst bearing.",
    "- **Spectrum**: RotD100 counts the largest direction of both components; ASCE 7-22 puts its "
    "target on it, so that what exceeds 1 is the mean above the target where another period of "
    "the range governs. EN 1998 has the mean of single components in a range up to 2 T and at the "
    "period 0, NCh2745 SRSS; the target of both falls with the square of the period beyond 2 s, "
    "the records do not.\n"
    "- **Damping factor**: η and B have a lower bound or a table; records give what they give.\n"
    "- **Iteration**, records to settled: a longer displacement has a longer period and less "
    "damping. Where the target's displacement does not grow with the period, beyond 2 s in two "
    "of the codes, the code's own iteration hardly feels that.\n"
    "- **Sliding in two directions against a linear oscillator**, settled to centre: what is left, "
    "the one step that belongs to the procedure itself and not to motions and factors.\n"
    "- **Torsion**, corner over centre, against the code's total over its displacement. Friction "
    "and stiffness of a pendulum go with the load that it carries, so that the eccentric mass has "
    "next to no lever; what the codes add is accidental eccentricity, which the histories do not "
    "have. ASCE 7-22 keeps 0.8 of D_TM as a least value for them.",
)


def number(value: float | None, factor: float = 1.0, digits: int = 4) -> str:
    """Return a number as the tables show it; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    shown = value * factor
    return f"{shown:.0f}" if abs(shown) >= 1000.0 else f"{shown:.{min(digits, 3)}g}"


def chain_rows(codes: Mapping[str, Any]) -> list[list[str]]:
    """Return the displacements from the code's formula to the worst bearing [mm]."""
    rows = []
    for code, known in codes.items():
        for bound in BOUNDS:
            e, free = known["equivalent"][bound], known["free"][bound]
            damping = e["B"] / e["B of records"]
            chain = [
                e["D"],
                e["records"],
                e["settled"],
                free["centre"],
                free["isolator displacement"],
            ]
            rows.append(
                [
                    code,
                    bound,
                    f"{e['T']:.2f}",
                    f"{100.0 * e['beta']:.1f}",
                    number(e["D"], 1e3),
                    f"{e['records'] / e['D'] / damping:.2f}",
                    f"{damping:.2f}",
                    *(f"{number(b, 1e3)} ({b / a:.2f})" for a, b in pairwise(chain)),
                    f"{number(e['total'], 1e3)} ({e['total'] / e['D']:.2f})",
                ]
            )
    return rows


def ratio_rows(codes: Mapping[str, Any]) -> list[list[str]]:
    """Return total displacement, base shear and drift, by the code and by the histories."""
    rows = []
    for code, known in codes.items():
        for bound in BOUNDS:
            e, free = known["equivalent"][bound], known["free"][bound]
            row = [code, bound]
            for ours, theirs, factor in (
                ("total", "isolator displacement", 1e3),
                ("V", "base shear", 1e-3),
                ("drift", "storey drift ratio", 1e2),
            ):
                row += [
                    number(e[ours], factor),
                    number(free[theirs], factor),
                    f"{free[theirs] / e[ours]:.2f}",
                ]
            rows.append(row)
    return rows


def device_rows(columns: Iterable[Mapping[str, Any]]) -> list[list[str]]:
    """Return what histories ask for, a column for each of several tables by bound."""
    kept = list(columns)
    return [
        [
            f"{name}, worst run" if name in COUNTED else name,
            unit,
            *(number(each.get(name), factor) for each in kept),
        ]
        for name, (unit, factor) in UNITS.items()
    ]


def device_table(asce: Mapping[str, Any]) -> str:
    """Return the three bearings side by side, in Markdown."""
    columns = [asce[key]["envelope"] for key in DEVICES]
    return table(("", "unit", *DEVICES.values()), device_rows(columns))


def code_row(code: str, known: Mapping[str, Any]) -> str:
    """Return how the LIR-DCFP fares under a code, as a row in Markdown."""
    demands, equivalent = known["lir"]["envelope"], known["equivalent"]["lower"]
    cells = [
        code,
        str(known["checks"]),
        str(len(known["failed"])),
        str(len(known["failed_with_uplift"])),
        number(equivalent["total"], 1e3),
        number(demands["isolator displacement"], 1e3),
        number(demands["interface slip"], 1e3),
        number(demands["base shear"], 1e-3),
        number(demands["storey drift ratio"], 1e2),
    ]
    return table((), [cells]).splitlines()[-1]


def page(found: Mapping[str, Any]) -> str:
    """Return the page in Markdown."""
    codes = found["codes"]
    asce = codes["ASCE 7-22"]
    seconds = asce["seconds"]
    by_code = [[c, *(number(f) for f in k["factors"].values())] for c, k in codes.items()]
    failures = [
        [c, str(k["checks"]), f"{len(k['failed'])}", f"{len(k['failed_with_uplift'])}",
         str(len(k["raised"])), "; ".join(k["failed_with_uplift"]) or "-"]
        for c, k in codes.items()
    ]  # fmt: skip
    return "\n\n".join([
        "# The worked building: codes against histories, and what the rims change",
        "Written by `python -m validation.measurements.worked_building` on "
        f"{found['date']} ({found['machine']}). The building, its bearings and seven motions are "
        "those of the [design guide](../design_guide.md): five storeys, 3 x 2 bays, eccentric "
        "mass, 12 bearings. The motions are scaled to each code's spectrum by its rule.",
        table(("factor on", *(n.split(",")[0].split(" 19")[0] for n in asce["factors"])), by_code),
        "## Plain DCFP without rims: equivalent-linear against the mean of seven histories",
        "Displacements in mm, in brackets over the one before. EN 1998 without γ_x; NCh2745 at the "
        "design level, D_D and D_TD, as its motions are.",
        table(("code", "bound", "T [s]", "β [%]", "code D", "spectrum", "B", "records", "settled",
               "centre", "corner", "code, with torsion"), chain_rows(codes)),
        *WHY,
        "![Displacement of the bearings by the codes' formulas and by histories]"
        "(figures/worked_building-chain.png)",
        table(("code", "bound", "total [mm]", "histories", "ratio", "V_b [kN]", "histories",
               "ratio", "drift [%]", "histories", "ratio"), ratio_rows(codes)),
        "Shears are those below the structure, without the reductions R_I, q and R_1. NCh2745 "
        "takes the stiffness of the upper bound for V_b at both. The codes' drift is that of their "
        "storey forces on storeys with the first mode of the fixed base; forces are statically "
        "distributed, histories have the higher modes that friction excites.",
        "## The LIR-DCFP: what the rims change (ASCE 7-22)",
        "Means of seven histories, the worst of the bounds. On the same plates the one-piece "
        "slider meets the same rims; on larger ones it meets none.",
        device_table(asce),
        "![The three bearings side by side](figures/worked_building-devices.png)",
        "The run that displaces a bearing most, at two levels of the model (ASCE 7-22, "
        f"{', '.join(asce['worst'])} bound):",
        table(
            ("level", "displacement [mm]", "largest slip [mm]", "time [s]"),
            [
                [level, *(number(r[k], f) for k, f in LEVEL_COLUMNS.items())]
                for level, r in found["contact"].items()
            ],
        ),
        "## The LIR-DCFP under three codes",
        "Means of seven histories, the worst of the bounds, uplift allowed; NCh2745 at the design "
        "level. Its checks have the bearings at the maximum level, motions 1.2 times as strong.",
        table(("", "unit", *codes), device_rows(k["lir"]["envelope"] for k in codes.values())),
        "Checks that fail, with uplift as the code counts it, and allowed:",
        table(("code", "checks", "fail", "fail with uplift allowed", "raised", "which fail"), failures),
        "## Time",
        "ASCE 7-22, two workers, kernels compiled before; the least of repeated measurements, on a "
        "machine that others shared.",
        table(("part", "s"), [[name, f"{value:.2f}"] for name, value in seconds.items()]),
    ]) + "\n"  # fmt: skip


def _bars(ax: Axes, groups: list[str], series: Mapping[str, list[float]]) -> None:
    width = 0.8 / len(series)
    for k, (name, values) in enumerate(series.items()):
        places = [j + (k - 0.5 * (len(series) - 1)) * width for j in range(len(groups))]
        ax.bar(places, values, width, label=name, color=PALETTE[k])
    ax.set_xticks(range(len(groups)), groups, fontsize=SMALL)
    ax.grid(visible=False, axis="x")


def figures(found: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the figures by name."""
    codes = found["codes"]
    chain = new_figure(3.0)
    [[ax]] = grid_of(chain, 1, 1)
    cases = [(known, bound) for known in codes.values() for bound in BOUNDS]
    equivalent = [known["equivalent"][bound] for known, bound in cases]
    free = [known["free"][bound] for known, bound in cases]
    _bars(
        ax,
        [f"{code}\n{bound}" for code in codes for bound in BOUNDS],
        {
            "code": [1e3 * e["D"] for e in equivalent],
            "records, the code's T and β": [1e3 * e["records"] for e in equivalent],
            "settled": [1e3 * e["settled"] for e in equivalent],
            "histories, centre": [1e3 * f["centre"] for f in free],
            "histories, worst bearing": [1e3 * f["isolator displacement"] for f in free],
        },
    )
    caption(ax, y="displacement [mm]")
    ax.legend(fontsize=SMALL, ncols=2)
    devices = new_figure(2.4)
    asce, [axes] = codes["ASCE 7-22"], grid_of(devices, 1, len(DRAWN))
    for ax, name in zip(axes, DRAWN, strict=True):
        unit, factor = UNITS[name]
        values = [factor * asce[key]["envelope"][name] for key in DEVICES]
        ax.bar(range(len(values)), values, 0.7, color=PALETTE[: len(values)])
        ax.set_xticks(range(len(values)), ["LIR", "DCFP", "DCFP,\nlarger"], fontsize=SMALL)
        ax.set_title(f"{name.removesuffix(' in plan')} [{unit}]", fontsize=SMALL)
        ax.grid(visible=False, axis="x")
    return {"chain": chain, "devices": devices}
