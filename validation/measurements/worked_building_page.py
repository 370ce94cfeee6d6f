"""The page of the worked building: tables, text and figures, from its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from frames.design.histories.demand_table import COUNTED
from frames.plots.plot_style import PALETTE, SMALL, caption, grid_of, new_figure
from validation.page import render, table

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

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
DRAWN = ("isolator displacement", "base shear", "storey drift ratio", "floor acceleration in plan")


def number(value: float | None, factor: float = 1.0, digits: int = 4) -> str:
    """Return a number as the tables show it; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    shown = value * factor
    return f"{shown:.0f}" if abs(shown) >= 1000.0 else f"{shown:.{min(digits, 3)}g}"


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


def which_fail(checks: Sequence[str]) -> str:
    """Return the checks that fail on their value, and the titles of those without a valid one."""
    void = [each.partition(", no valid value: ") for each in checks if ", no valid value: " in each]
    others = [each for each in checks if ", no valid value: " not in each]
    said = "; ".join(each for each in others if not each.startswith("runs that failed"))
    if not void:
        return said or "-"
    titles = "; ".join(dict.fromkeys(head.partition(" (")[0] for head, _, _ in void))
    return f"{said}. Without a valid value, because {void[0][2]}: {titles}"


def page(found: Mapping[str, Any]) -> str:
    """Return the page in Markdown."""
    codes = found["codes"]
    return render(globals(), found=found, codes=codes, asce=codes["ASCE 7-22"])


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
