"""The building of the design guide under three codes: writes docs/validation/worked_building.md.

    python -m validation.measurements.worked_building

The input is the project's file that docs/design_guide.md shows. For each code the equivalent-linear
analysis is compared with time histories on the same bearings as plain DCFP without rims, then the
LIR-DCFP is run and checked. Numbers go to docs/validation/worked_building.json; `--page` writes the
page anew from them. Needs the optional extras "cli" and "fema".
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
import time
import warnings
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from frames import gravity, time_history
from frames.design import bounded_histories, history_demands, pair_spectrum, with_property_bounds
from frames.design.histories.demand_table import COUNTED
from frames.design.project.design_run import evaluate_run, run_project
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.report.files import write_run
from frames.recording.recording import Recording
from frames.statics.modes import modes
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.benchmark import machine
from validation.measurements.worked_building_page import figures, page
from validation.page import DPI, FOLDER

if TYPE_CHECKING:
    import pandas as pd

    from frames import Frame
    from frames.design import MotionSet
    from frames.design.codes.bounds import BoundName
    from frames.design.codes.outcome import BoundResult
    from frames.design.project.check_register import Preliminary

NAME = "worked_building"
GUIDE = FOLDER.parent / "design_guide.md"
SPECTRA = {
    "ASCE 7-22": "s_ms = 0.9\ns_m1 = 0.5",
    "EN 1998": 'a_g = "2400 mm/s2"\nground_type = "C"',
    "NCh2745": 'soil = "II"\nzone = 1',
}
"""Section [spectrum] by code: one site, 1.3 to 1.4 m/s2 at 2.5 s with 5 % at the design level."""

SYMBOLS = {
    "ASCE 7-22": ("D_M", "D_TM", "T_M", "beta_M", "V_b", "V_st"),
    "EN 1998": ("d_dc", "d_bd", "T_eff", "xi_eff", "V_b", "V_s"),
    "NCh2745": ("D_D", "D_TD", "T_D", "beta_D", "V_b", "V_b"),
}
"""Displacement, the same with torsion, period, damping, base shear and shear above, at the level
of motion that the histories have. EN 1998: shear over q, and without gamma_x."""

MIDDLE = ("bearing-1-1", "bearing-2-1")
"""Bearings on either side of the middle of the plan."""

ROWS = (
    "isolator displacement",
    "residual displacement",
    "interface slip",
    "residual interface slip",
    "rim force",
    "minimum axial force",
    "maximum axial force",
    "uplifts, all bearings",
    "maximum uplift",
    "base shear",
    "storey shear",
    "storey drift ratio",
    "floor acceleration in plan",
)
"""What is kept of the histories."""


def project_text(code: str = "ASCE 7-22") -> str:
    """Return the project's file of the guide, for one of the codes."""
    found = re.search(r"```toml\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL)
    if found is None:
        msg = f"{GUIDE} shows no project's file"
        raise ValueError(msg)
    text = found[1].replace(f'"{next(iter(SPECTRA))}"', f'"{code}"')
    return text.replace(SPECTRA["ASCE 7-22"], SPECTRA[code])


def storey_stiffness(frame: Frame) -> list[float]:
    """Return stiffnesses of storeys [N/m] that have the frame's first mode on a fixed base."""
    found, system = modes(frame, 1, "fixed"), gravity(frame).system
    mass, levels = system.node_mass[:, 0], np.array([level.z for level in frame.levels])
    floor = np.abs(system.coordinates[:, 2, None] - levels).argmin(axis=1)
    axis = int(found.mass_ratios[0, :2].argmax())
    shares = np.bincount(floor, mass)
    shape = np.bincount(floor, mass * found.shapes[:, axis, 0]) / shares
    omega2 = (2.0 * np.pi / found.periods[0]) ** 2
    force = omega2 * shares * shape
    return [float(abs(force[k:].sum() / (shape[k] - shape[k - 1]))) for k in range(1, len(levels))]


def equivalent_numbers(
    code: str, result: BoundResult, motions: MotionSet, stiffness: list[float], heights: list[float]
) -> dict[str, float]:
    """Return what the equivalent-linear analysis gives at one bound, and the records beside it."""
    known = dict(
        zip(
            ("D", "total", "T", "beta", "V", "V_s"),
            (result.trace.value(name) for name in SYMBOLS[code]),
            strict=True,
        )
    )
    above = known["V_s"] * (1.5 if code == "EN 1998" else 1.0)  # V_s of EN 1998 is over q
    forces = np.array(result.storey_forces[1:])
    shears = above * np.cumsum(forces[::-1])[::-1] / forces.sum()
    known["drift"] = float(max(shears / (np.array(stiffness) * heights)))
    length, friction = result.trace.values("L")[0], result.trace.values("mu")[0]
    known["records"] = displacement_of(motions, known["T"], known["beta"])
    known["B of records"] = displacement_of(motions, known["T"], 0.05) / known["records"]
    factor = result.trace.value({"EN 1998": "eta", "NCh2745": "B_D"}.get(code, "B_M"))
    known["B"] = 1.0 / factor if code == "EN 1998" else factor
    known["settled"] = settled(motions, length, friction)
    return known


def displacement_of(motions: MotionSet, period: float, damping: float) -> float:
    """Return the mean RotD100 displacement of a linear oscillator under motions [m]."""
    found = [pair_spectrum(m, [period], damping, "RotD100")[0] for m in motions.values()]
    return float(np.mean(found)) * (period / (2.0 * np.pi)) ** 2


def settled(motions: MotionSet, length: float, friction: float) -> float:
    """Return the displacement that stiffness and damping at it give under motions [m]."""

    def beyond(d: float) -> float:
        stiffness = 1.0 / length + friction / d  # over the weight [1/m]
        damping = 2.0 / np.pi * friction / (friction + d / length)
        period = 2.0 * np.pi / np.sqrt(STANDARD_GRAVITY * stiffness)
        return displacement_of(motions, period, damping) - d

    return float(brentq(beyond, 0.02, 1.0, xtol=1e-4))


def demands_by_bound(table: pd.DataFrame) -> dict[str, dict[str, float]]:
    """Return what histories ask for in SI units, by bound; in the envelope the largest uplift."""
    if "level" in table.columns:  # the first one, where there are two
        table = table[table["level"] == table["level"].iloc[0]]
    rows = [row for row in ROWS if row in table.index]
    bounds = [name for name in ("lower", "nominal", "upper", "value") if name in table.columns]
    found = {c: {row: float(table[c][row]) for row in rows} for c in bounds}
    worst = {row: float(table["worst"][row]) for row in rows if row in COUNTED}
    return found | {"envelope": {row: float(table["envelope"][row]) for row in rows} | worst}


def lenient_parts(source: Path, folder: Path) -> ProjectInputs:
    """Return a project whose runs count where a bearing lifts off."""
    text = source.read_text(encoding="utf-8") + "[analysis]\nuplift_allowed = true\n"
    other = folder / "uplift.toml"
    other.write_text(text, encoding="utf-8")
    return ProjectInputs(read_project(other), folder)


def device_numbers(
    parts: ProjectInputs, known: Preliminary, *, rims: bool
) -> dict[str, dict[str, float]]:
    """Return what the histories of a project ask of rigid sliders, by bound."""
    plain = {n: link.bearing.as_dcfp(rims=rims) for n, link in known.frame.bearings.items()}
    runs = bounded_histories(
        known.frame.with_bearings(plain),
        known.motions,
        parts.bounds(),
        level=parts.file.analysis.level,
        record=Recording(every=None),
    )
    found = demands_by_bound(history_demands(runs, parts.rules()))
    for bound, data in runs.items():
        moved = data["peak_displacement"].sel(bearing=list(MIDDLE))
        found[bound]["centre"] = float(moved.mean())
    return found


def measured(code: str, folder: Path) -> dict[str, Any]:
    """Run the building under a code; times of its parts in seconds."""
    source = folder / "project.toml"
    source.write_text(project_text(code), encoding="utf-8")
    parts = ProjectInputs(read_project(source), folder)
    seconds, began = {}, time.perf_counter()

    def lap(name: str) -> None:
        nonlocal began
        seconds[name] = time.perf_counter() - began
        began = time.perf_counter()

    frame = parts.frame()
    lap("structure")
    gravity(frame)
    lap("gravity")
    known = preliminary(parts)
    lap("`lir check`: equivalent-linear analysis, motions scaled")
    run = run_project(parts)
    lap("`lir run`: 7 motions at 3 bounds, the governing run again, checks")
    lenient = lenient_parts(source, folder)
    centred = run.runs.centred  # masses where they are, as the formulas have them
    again = evaluate_run(lenient, known, centred, run.governing)
    judged = evaluate_run(lenient, known, run.runs, run.governing)
    lap("of it demands and checks")
    write_run(run, folder / "results", project_text(code))
    lap("report and files")
    stiffness = storey_stiffness(known.frame)
    heights = [b.z - a.z for a, b in pairwise(known.frame.levels)]
    scaling = known.motions.scaling
    return {
        "seconds": seconds,
        "factors": {} if scaling is None else dict(scaling.factors),
        "weight": known.system.seismic_weight,
        "equivalent": {
            bound: equivalent_numbers(code, result, known.motions, stiffness, heights)
            for bound, result in known.equivalent.bounds.items()
        },
        "limits": [f"{c.title} ({c.bound})" for c in known.equivalent.checks.inapplicable],
        "free": device_numbers(lenient, known, rims=False),
        "lir": demands_by_bound(again.demands),
        "worst": run.governing_case.rsplit(" bound, ", 1)[0].rsplit(", ", 1),
        "checks": len(run.checks),
        "failed": [f"{c.title} ({c.concerns})" for c in run.checks.failed],
        "failed_with_uplift": [str(c.statement) for c in judged.checks.failed],
        "raised": [str(c.statement) for c in judged.checks.raised],
        "walled": device_numbers(lenient, known, rims=True) if code == "ASCE 7-22" else {},
    }


def at_levels(name: str, bound: BoundName) -> dict[str, dict[str, float]]:
    """Return one run of the building under ASCE 7-22 at two levels of the model."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "project.toml"
        source.write_text(project_text(), encoding="utf-8")
        parts = ProjectInputs(read_project(source), Path(folder))
        known = preliminary(parts)
    frame, found = with_property_bounds(known.frame, bound, parts.bounds()), {}
    for level in ("pendulum", "contact"):
        began = time.perf_counter()
        data = time_history(frame, known.motions[name], level=level)
        moves = data["bearing_displacement"].sel(axis=["x", "y"]).to_numpy()
        found[level] = {
            "displacement": float(np.linalg.norm(moves, axis=-1).max()),
            "slip": float(data["interface_slip_size"].max()),
            "seconds": time.perf_counter() - began,
        }
    return found


def write(found: dict[str, Any]) -> None:
    """Write the page and its figures from the numbers."""
    for name, figure in figures(found).items():
        path = FOLDER / "figures" / f"{NAME}-{name}.png"
        figure.savefig(path, dpi=DPI, metadata={"Software": None})
    (FOLDER / f"{NAME}.md").write_text(page(found), encoding="utf-8")


def main() -> None:
    """Run the building under each code and write the page, or write it anew from the numbers."""
    parser = argparse.ArgumentParser(prog=f"python -m validation.measurements.{NAME}")
    parser.add_argument("--page", action="store_true", help="the page alone, from the numbers")
    parser.add_argument("--contact", action="store_true", help="that comparison and the page")
    kept = FOLDER / f"{NAME}.json"
    options = parser.parse_args()
    if not (options.page or options.contact):
        found: dict[str, Any] = {
            "date": datetime.now(UTC).date().isoformat(),
            "machine": machine(),
            "codes": {},
        }
        before = json.loads(kept.read_text(encoding="utf-8"))["codes"] if kept.is_file() else {}
        for code in SPECTRA:
            with (
                tempfile.TemporaryDirectory() as folder,
                warnings.catch_warnings(action="ignore"),
            ):  # what runs leave doubtful is in their checks
                found["codes"][code] = measured(code, Path(folder))
            seconds = found["codes"][code]["seconds"]
            other = before.get(code, {}).get("seconds", {})
            for name in seconds.keys() & other.keys():  # a busy machine only adds time
                seconds[name] = min(seconds[name], other[name])
            print(code, seconds, flush=True)
            kept.write_text(json.dumps(found, indent=1), encoding="utf-8")
    found = json.loads(kept.read_text(encoding="utf-8"))
    if not options.page:
        with warnings.catch_warnings(action="ignore"):
            found["contact"] = at_levels(*found["codes"]["ASCE 7-22"]["worst"])
        kept.write_text(json.dumps(found, indent=1), encoding="utf-8")
    write(found)


if __name__ == "__main__":
    main()
