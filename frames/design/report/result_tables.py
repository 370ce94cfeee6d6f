"""Tables of a run in its report and its folder; description of its model and bearings."""

from __future__ import annotations

import math
import re
from dataclasses import fields
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.design.calculation.rendering import number as written
from frames.design.codes.isolation import with_property_bounds
from frames.design.histories.combined_forces import (
    combinations_of,
    member_combinations,
    reaction_combinations,
    uplift_table,
)
from frames.design.histories.demand_table import demands_by_motion, link_demands
from frames.design.histories.eccentricity import eccentricity_table
from frames.design.histories.force_demands import force_demands, raises_by_case
from frames.design.histories.suite import peaks_of_runs
from frames.design.report.model_tables import centre_table, mode_table
from frames.design.report.page import Table
from frames.design.report.tables import SHOWN
from frames.design.report.tender import grid_of, marked, replacement, rig, schedule
from frames.library.building import ARM
from frames.recording.force_rows import MEMBER_FORCES
from frames.results.quantities import QUANTITIES
from lir_element.device.friction import FrictionLaw
from lir_element.texts import joined, keeping_texts, worded

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.design.codes.bounds import BoundName
    from frames.design.project.design_run import ProjectRun
    from frames.frame import Frame
    from frames.statics.model_check import ModelCheck
    from lir_element import LIRBearing


_REACHED = {
    "displacement [m]": "displacement",
    "slip [m]": "slip",
    "rim force [N]": "rim_force",
    "largest load [N]": "axial_force",
    "least load [N]": "axial_tension",
}
"""Columns of each bearing's peaks in all runs at all bounds."""

BY_MOTION = "demands-by-motion"
"""Name of the table of peaks by motion."""

ECCENTRICITY = "eccentricity"
"""Name of the table of the effect of moved masses."""

_FRICTIONS = (
    "bottom surface",
    "top surface",
    "bottom surface, slow",
    "top surface, slow",
    "interface",
)
WITHOUT_FORCES = "members-without-forces"
"""Name of the table of elements that the tables of member forces leave out."""

LINKS = "links"
"""Name of the table of moat walls and dampers."""

COMBINED = ("member-combinations", "reaction-combinations", "uplift")
"""Names of the tables of forces by combination of loads."""

TABLES_OF_FORCES = (
    *("member-groups", "members", WITHOUT_FORCES, LINKS, "storeys", "reactions"),
    *COMBINED,
)
"""Tables that a structure has as far as it has members and levels."""


def bearing_table(run: ProjectRun) -> pd.DataFrame:
    """Return place, loads and largest demands of each bearing."""
    links = run.frame.bearings
    places = [run.frame.nodes[link.j] for link in links.values()]
    table = pd.DataFrame(
        {
            "x [m]": [place.x for place in places],
            "y [m]": [place.y for place in places],
            "average load [N]": [float(load) for load in run.loads],
        },
        index=pd.Index(list(links), name="bearing"),
    )
    table.insert(0, "axes", grid_of(run)[2])
    table.insert(0, "number", range(1, len(links) + 1))
    if len(set(run.kinds.values())) > 1:
        table.insert(2, "type", [run.kinds[name] for name in links])
    for title, name in _REACHED.items():
        values = [peaks_of_runs(data, name).max(axis=0) for data in run.runs.parts]
        table[title] = QUANTITIES[name].sign * np.max(values, axis=0)
    return marked(table, run)


def friction_table(run: ProjectRun) -> pd.DataFrame:
    """Return the friction coefficients of the bearings at each bound."""
    tables = []
    for kind, nominal in devices_by_type(run).items():
        columns: dict[str, list[float]] = {}
        bounds: tuple[BoundName, ...] = ("lower", "nominal", "upper")
        for bound in bounds:
            device = with_property_bounds(nominal, bound, run.bounds)
            fast, slow = (
                [law.f_max for law in device.frictions],
                [law.f_min for law in device.frictions],
            )
            columns[bound] = [*fast, *slow, device.interface_friction]
        rows = [joined(row, kind, by=", ") for row in _FRICTIONS]
        tables.append(pd.DataFrame(columns, index=pd.Index(rows, name="friction coefficient")))
    return pd.concat(tables)


def devices_by_type(run: ProjectRun) -> dict[str, LIRBearing]:
    """Return a bearing of each type; the type's name is "" if there is only one."""
    found: dict[str, LIRBearing] = {}
    for name, link in run.frame.bearings.items():
        found.setdefault(run.kinds.get(name, ""), link.bearing)
    return found if len(found) > 1 else {"": next(iter(found.values()))}


@keeping_texts
def run_tables(run: ProjectRun) -> dict[str, pd.DataFrame]:
    """Return all tables of this module, by name."""
    raises = raises_by_case(run.checks)
    forces = force_demands(run.cases, raises)
    return {
        "bearings": bearing_table(run),
        "friction": friction_table(run),
        "modes": mode_table(run),
        "centres": centre_table(run),
        "schedule": schedule(run),
        "rig": rig(run),
        "replacement": replacement(run),
        "motions": run.motions.table(),
        "member-groups": member_groups(run, forces.get("members")),
        WITHOUT_FORCES: without_forces(run.frame),
        LINKS: link_demands(run.cases),
        "programme": run.programme,
        BY_MOTION: demands_by_motion(run.cases),
        **forces,
        **combined_tables(run, forces),
        ECCENTRICITY: eccentricity_table(run.cases),
    }


def combined_tables(run: ProjectRun, forces: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Return the forces of members and bearings by combination of loads, and the uplift demands."""
    combinations = combinations_of(run.frame, run.combined)
    if not combinations:
        return dict.fromkeys(COMBINED, pd.DataFrame())
    bounds = run.equivalent.bounds.values()
    symbol = getattr(run.code.analysis(), "reduced_by", "")
    known = [each.trace.value(symbol) for each in bounds if symbol in each.trace]
    reactions = reaction_combinations(forces["reactions"], combinations)
    gaps = np.max([peaks_of_runs(data, "gap").max(axis=0) for data in run.runs.parts], axis=0)
    pulled = [
        np.subtract(each.trace.values("N_E"), each.trace.values("N_minimum"))
        for each in bounds
        if "N_minimum" in each.trace and not run.system.unknown_loads
    ]
    names = list(run.frame.bearings)
    linear = dict(zip(names, np.max(pulled, axis=0), strict=True)) if pulled else {}
    found = {
        "reaction-combinations": reactions,
        "uplift": uplift_table(reactions, dict(zip(names, gaps, strict=True)), linear),
    }
    if "members" in forces:
        judged = [level.name for level in run.rules.levels if level.judges_structure]
        own = forces["members"][forces["members"].index.isin(judged)]
        name = "member-combinations"
        found[name] = member_combinations(own, combinations, max(known, default=1.0))
    return found


_ROUND_OFF = 1e-6  # of the largest force, or moment, below which a row is left out


def member_groups(run: ProjectRun, forces: pd.DataFrame | None) -> pd.DataFrame:
    """Return the extremes of the members' forces by group, over bounds and stations.

    Members of the same kind of name at the same heights are a group.
    """
    if forces is None:
        return pd.DataFrame()
    judged = [level.name for level in run.rules.levels if level.judges_structure]
    governing = forces[(forces["governs"] == "yes") & forces.index.isin(judged)].reset_index()
    governing = governing[~governing["member"].str.startswith(ARM)]  # rigid: nothing to design
    names = group_names(run.frame)
    order = {name: k for k, name in enumerate(dict.fromkeys(names.values()))}
    group = governing["member"].map(names)
    parts = dict(iter(governing.groupby([group, "force"])))
    rows, void = [], governing["void"].any()
    for name, force in sorted(parts, key=lambda key: (order[key[0]], MEMBER_FORCES.index(key[1]))):
        part = parts[name, force]
        row = {"group": name, "members": part["member"].nunique(), "force": force}
        row["unit"] = part["unit"].iloc[0]
        for extreme, title, sign in (("min", "smallest", -1.0), ("max", "largest", 1.0)):
            those = part[part["extreme"] == extreme]
            worst = those.iloc[int(np.argmax(sign * those["value"].to_numpy()))]
            row[title] = float(worst["value"])
            station = joined(worst["member"], worst["station"], by=" ")
            row[f"member of {title}"] = joined(station, worst["bound"], by=", ")
        if void:
            row["void"] = joined(*dict.fromkeys(part["void"]))
        rows.append(row)
    table = pd.DataFrame(rows).set_index("group")
    size = table[["smallest", "largest"]].abs().max(axis=1)
    return table[size > _ROUND_OFF * size.groupby(table["unit"]).transform("max")]


def without_forces(frame: Frame) -> pd.DataFrame:
    """Return the elements of superelements that the tables of member forces leave out."""
    rows = [
        {"kind": one.kind, "elements": one.number, "which": one.which, "why": one.why}
        for part in frame.superelements.values()
        for one in part.elements.without
    ]
    return pd.DataFrame(rows).set_index("kind") if rows else pd.DataFrame()


def group_names(frame: Frame) -> dict[str, str]:
    """Return the group of each member and line element: its kind of name, and its heights."""
    ends = {name: (member.i, member.j) for name, member in frame.members.items()}
    for part in frame.superelements.values():
        ends |= dict(zip(part.elements.names, part.elements.nodes, strict=True))
    found = {}
    for name, nodes in ends.items():
        ends_at = sorted({round(frame.nodes[node].z, 6) for node in nodes})
        heights = f"{ends_at[0]:g}"
        if len(ends_at) > 1:
            heights = worded("{first} to {last}", first=heights, last=f"{ends_at[1]:g}")
        kind = re.sub(r"[-_ ]*\d+", "", name)
        found[name] = worded("{kind} at {heights} m", kind=kind, heights=heights)
    return found


_SHOWN = SHOWN | {
    "N s/m": ("kN s/m", 1e-3),
    "kg/m3": ("kg/m³", 1.0),
    "kg m2": ("kg m²", 1.0),
}


def _applies(name: str, bearing: LIRBearing) -> bool:
    # True if a field describes a property of a bearing.
    if name == "bouc_wen_exponent":
        return bearing.friction_law == "bouc-wen"
    if name == "uplift_capacity":
        return math.isfinite(bearing.uplift_capacity)
    return name != "rim_hardening" or math.isfinite(bearing.rim_yield_force)


def device_table(bearing: LIRBearing) -> Table:
    """Return the properties of a bearing: given values, defaults, and derived values."""
    derived = [
        ("effective radius", bearing.effective_radius, "m"),
        ("pendulum period", bearing.period, "s"),
        ("displacement capacity", bearing.lateral_capacity, "m"),
        ("characteristic strength ratio Q/W", bearing.effective_friction, "-"),
        ("stable limit of interface slip", bearing.slip_stability, "m"),
    ]
    rows = [
        (title, _quantity(value, unit, "not limited"), _unit(value, unit), "derived")
        for title, value, unit in derived
    ]
    resolved = bearing.resolved()
    for field in fields(bearing):
        name, value, origin = field.name, getattr(bearing, field.name), "given"
        if (value is None and name not in resolved) or not _applies(name, bearing):
            continue
        if value is None:
            value, origin = resolved[name], "default"
        elif value == field.default:
            origin = "default"
        unit = field.metadata.get("unit", "")
        shown = _quantity(value, unit, field.metadata.get("endless") or "not limited")
        rows.append((field.metadata["title"], shown, _unit(value, unit), origin))
    return Table(("property", "value", "unit", "origin"), rows, frozenset({3}))


def model_table(model: ModelCheck) -> Table:
    """Return the totals of a model under its permanent loads."""
    across = [abs(force) for force in model.loads[:2]]
    taken = sum(force for _, force in model.supports)
    periods = ", ".join(f"{value:.3g}" for value in model.periods)
    rows = [
        ("mass", f"{1e-3 * model.mass:.5g}", "t"),
        ("permanent vertical load", f"{1e-3 * model.weight:.5g}", "kN"),
        ("of which non-mass loads", f"{-1e-3 * model.loads[2] + 0.0:.5g}", "kN"),
    ]
    if any(across):
        rows += [
            (worded("permanent load along {axis}", axis=axis), f"{1e-3 * force:.5g}", "kN")
            for axis, force in zip("xy", model.loads[:2], strict=True)
        ]
    rows += [
        ("carried by the bearings", f"{1e-3 * model.carried:.5g}", "kN"),
        ("carried by other supports", f"{1e-3 * taken + 0.0:.5g}", "kN"),
        ("periods, fixed base", periods or "none, rigid", "s" if periods else ""),
        ("period on the bearings, sliding", f"{model.isolated_period:.3g}", "s"),
    ]
    return Table(("quantity", "value", "unit"), rows)


def loads_table(model: ModelCheck) -> Table:
    """Return the permanent loads and pressures of each bearing."""
    rows = [
        (
            load.name,
            written(1e-3 * load.axial_force),
            f"{1e-6 * load.pressure:.3g}",
            f"{1e3 * load.settlement:.2g}",
            f"{load.period:.3g}",
            _held(load.slip_stability, load.slip_capacity),
        )
        for load in model.bearings
    ]
    head = (
        "bearing",
        "axial force [kN]",
        "pressure [MPa]",
        "settlement [mm]",
        "pendulum period [s]",
        "stable limit of interface slip / overlap",
    )
    return Table(head, rows, frozenset({5}))


def _held(stable: float, overlap: float) -> str:
    if math.isinf(stable):
        return "rigid slider"
    end = f"{1e3 * overlap:.3g} mm"
    if stable >= overlap:
        return worded("all {overlap}", overlap=end)
    held = 1e3 * max(stable, 0.0)
    return worded("{stable:.3g} of {overlap}", stable=held, overlap=end)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _unit(value: object, unit: str) -> str:
    if _is_number(value) and not math.isfinite(float(value)):  # type: ignore[arg-type]  # a number
        return ""
    return "" if unit in {"", "-"} else _SHOWN.get(unit, (unit, 1.0))[0]


def _quantity(value: object, unit: str, endless: str) -> str:
    # A value in the unit shown; equal pairs once.
    if isinstance(value, tuple):
        parts = [_quantity(each, unit, endless) for each in value]
        return parts[0] if len(set(parts)) == 1 else joined(*parts)
    if isinstance(value, FrictionLaw):
        return _friction(value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not _is_number(value):
        return str(value)
    number = float(value)  # type: ignore[arg-type]  # a number
    if not math.isfinite(number):
        return endless
    shown = _SHOWN.get(unit, (unit, 1.0))[1] * number
    return written(shown)


def _friction(law: FrictionLaw) -> str:
    if law.f_max == law.f_min:
        return f"{law.f_max:.4g}"
    return worded("{fast:.4g} at high speed, {slow:.4g} at rest", fast=law.f_max, slow=law.f_min)
