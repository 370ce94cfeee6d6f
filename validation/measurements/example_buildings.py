"""The example buildings, run: writes the tables and figures of docs/example_buildings.md.

    python -m validation.measurements.example_buildings FOLDER

FOLDER holds projects by the names of the examples, written by ``lir new --example`` and run by
``lir run``; of those that it lacks the kept numbers stay. Numbers go to
docs/validation/example_buildings.json; `--page` writes the tables anew from them. Needs the optional extra "cli", and OpenSeesPy.
"""

from __future__ import annotations

import argparse
import json
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.plots import model_view
from validation.page import FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Mapping

NAMES = ("office", "imported", "near-fault", "hospital")
PAGE = FOLDER.parent / "example_buildings.md"
KEPT = FOLDER / "example_buildings.json"
FIGURES = FOLDER.parent / "figures"
BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
DPI = 80
MOST = 6  # ratios shown of each building
ASKED = {  # quantity: shown as, factor, digits
    "isolator displacement": ("displacement, mm", 1e3, 0),
    "residual displacement": ("residual displacement, mm", 1e3, 0),
    "interface slip": ("interface slip, mm", 1e3, 1),
    "rim force": ("rim force, kN", 1e-3, 0),
    "maximum axial force": ("largest axial force, MN", 1e-6, 1),
    "maximum uplift": ("uplift, worst run, mm", 1e3, 1),
    "base shear": ("base shear, MN", 1e-6, 1),
    "storey drift ratio": ("storey drift, %", 1e2, 3),
    "floor acceleration in plan": ("floor acceleration, m/s²", 1.0, 1),
}
"""Demands that the page shows: the envelope of the bounds, the worst run of uplift."""


def main() -> None:
    """Read the results of the buildings; write numbers, figures and the page's tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--page", action="store_true", help="write the page from the kept numbers")
    chosen = parser.parse_args()
    if chosen.page == (chosen.folder is not None):
        parser.error("give the folder of the projects, or --page")
    if chosen.page:
        found = json.loads(KEPT.read_text(encoding="utf-8"))
    else:
        found = measured(chosen.folder)
        KEPT.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    PAGE.write_text(rebuilt(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")


def measured(folder: Path) -> dict[str, Any]:
    """Return what the page says of each project that was run, and draw its figures."""
    found = json.loads(KEPT.read_text(encoding="utf-8"))
    for name in (name for name in NAMES if (folder / name).is_dir()):
        inputs = ProjectInputs(read_project(folder / name / "project.toml"), folder / name)
        found[name] = of_building(folder / name / "results", inputs)
        draw(name, inputs)
    return {name: found[name] for name in NAMES}


def of_building(results: Path, inputs: ProjectInputs) -> dict[str, Any]:
    """Return numbers of one project, from its files of results alone but for the sliders."""
    run = json.loads((results / "run.json").read_text(encoding="utf-8"))
    demands = pd.read_csv(results / "demands.csv")
    bearings = pd.read_csv(results / "bearings.csv")
    checks = pd.read_csv(results / "checks.csv", keep_default_na=False)
    worst = next(c for c in demands if c.startswith("worst of all"))
    levels = sorted({str(level) for level in demands["level"]}, key=len)  # "design" first
    asked: dict[str, dict[str, float]] = {}
    for row in demands.to_dict("records"):
        if row["quantity"] in ASKED:
            column = worst if row["quantity"] == "maximum uplift" else "envelope of these"
            asked.setdefault(row["level"], {})[row["quantity"]] = float(row[column])
    return {
        "code": inputs.code().name,
        "device_level": inputs.file.analysis.level,
        "weight": float(bearings["average load [N]"].sum()),
        "fixed": float(pd.read_csv(results / "modes.csv")["period, fixed base [s]"].max()),
        "runs": {k: v["runs"] for k, v in run["runs"].items()},
        "moved": {k: v["runs"] for k, v in run["moved"].items()},
        "levels": levels,
        "demands": asked,
        "types": types_of(bearings, inputs),
        "checks": len(checks),
        "failed": list(run["failed"]),
        "agree": [
            row["title"] for row in checks.to_dict("records") if row["verdict"] == "needs agreement"
        ],
        "ratios": highest(checks),
        "written": run["written"],
    }


def types_of(bearings: pd.DataFrame, inputs: ProjectInputs) -> dict[str, Any]:
    """Return the loads of the bearings of each type, and the device it is."""
    name = bearings["type"] if "type" in bearings else pd.Series("standard", bearings.index)
    frame = inputs.frame()
    found = {}
    for kind, own in bearings.groupby(name, sort=False):
        device = frame.bearings[own["bearing"].iloc[0]].bearing
        area = math.pi * device.slider_radius**2
        found[str(kind)] = {
            "count": len(own),
            "slider": device.slider_radius,
            "capacity": device.capacity,
            "loads": [float(own["average load [N]"].min()), float(own["average load [N]"].max())],
            "most": float(own["largest load [N]"].max()),
            "area": area,
        }
    return found


def highest(checks: pd.DataFrame) -> list[list[Any]]:
    """Return title, ratio and verdict of the checks with the highest ratios, each title once."""
    told = checks[~checks["symbol"].isin(["n", "S_mean"])]
    rows = told.assign(ratio=pd.to_numeric(told["ratio"])).sort_values("ratio", ascending=False)
    first = rows.drop_duplicates("title").head(MOST)
    return [
        [row["title"], round(float(row["ratio"]), 3), row["verdict"]]
        for row in first.to_dict("records")
    ]


def draw(name: str, inputs: ProjectInputs) -> None:
    """Draw the model of a building."""
    figure = model_view(inputs.frame())
    figure.set_size_inches(5.6, 4.2)
    figure.savefig(FIGURES / f"building-{name}.png", dpi=DPI, bbox_inches="tight")


def rebuilt(page: str, found: Mapping[str, Any]) -> str:
    """Return the page with the tables of these numbers."""
    block = f"{BEGIN}\n\n{render(globals(), found=found)}\n{END}"
    pattern = re.escape(BEGIN) + ".*?" + re.escape(END)
    return re.sub(pattern, lambda _: block, page, count=1, flags=re.DOTALL)


def runs_of(runs: Mapping[str, Any], level: str) -> dict[str, int]:
    """Return the numbers of runs of a level by bound; all where levels are not told apart."""
    own = {k: int(n) for k, n in runs.items() if k.startswith(f"{level}-")}
    own = own or {k: int(n) for k, n in runs.items()}
    return {key.rpartition("-")[2]: n for key, n in own.items()}


if __name__ == "__main__":
    main()
