"""Documents for suppliers and testers: schedule of bearings by type, plan with axes, the rig."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from frames.design.codes.bounds import ENDS
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.prototype_programme import PlannedTest
from frames.design.devices.bearing_numbers import enter_bearing
from frames.design.devices.limits import PROPOSED_LIMIT
from frames.design.devices.plates import PLATE_SHARE, YIELD_STRESS, Make, made
from frames.design.histories.demand_table import largest_of_bounds
from frames.design.histories.eccentricity import levels_of
from frames.design.histories.suite import peaks_of_runs
from frames.design.testing.expected import LOOPS, loop_numbers
from frames.design.testing.programme import SPECIMENS
from frames.results.bearing_geometry import plate_tilts, rim_face
from frames.statics.centres import lifting_stiffness
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.project.design_run import ProjectRun
    from lir_element import LIRBearing

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""Letters of axes; I and O are left out, because they look like numbers."""

CLEARANCE = 0.005
"""Free height over a bearing when it is drawn out [m], a proposal."""

_SAME_LINE = 0.10  # m: places that near are on one axis


class Axis(NamedTuple):
    """A line of the grid of bearings: 1, 2, 3 across x; A, B, C across y."""

    name: str
    at: float  # m


def axes_along(places: Sequence[float], letters: bool) -> tuple[list[Axis], list[str]]:
    """Return the axes across a direction, and the name of each place's own.

    Places that follow each other by less than 100 mm are on one axis, at their mean.
    """
    at, order = np.sort(places), np.argsort(places)
    group = np.empty(len(order), dtype=int)
    group[order] = np.cumsum(np.diff(at, prepend=at[0]) > _SAME_LINE)
    middles = np.bincount(group, places) / np.bincount(group)
    names = [lettered(n) if letters else str(n + 1) for n in range(len(middles))]
    axes = [Axis(name, float(middle)) for name, middle in zip(names, middles, strict=True)]
    return axes, [names[n] for n in group]


def lettered(n: int) -> str:
    """Return the name of the n-th lettered axis, from 0: A to Z, then AA, AB."""
    rest, letter = divmod(n, len(LETTERS))
    return (lettered(rest - 1) if rest else "") + LETTERS[letter]


def grid_of(run: ProjectRun) -> tuple[list[Axis], list[Axis], list[str]]:
    """Return the axes across x and across y, and the crossing of each bearing, "B-3"."""
    nodes = [run.frame.nodes[link.j] for link in run.frame.bearings.values()]
    across_x, numbers = axes_along([node.x for node in nodes], letters=False)
    across_y, letters = axes_along([node.y for node in nodes], letters=True)
    crossings = [f"{one}-{other}" for one, other in zip(letters, numbers, strict=True)]
    return across_x, across_y, crossings


class OfType(NamedTuple):
    """A type of bearing, its places among the bearings, and how it is made."""

    name: str
    bearing: LIRBearing
    places: list[int]
    make: Make


def types_of(run: ProjectRun) -> list[OfType]:
    """Return the types of a project's bearings."""
    names, found = list(run.frame.bearings), []
    for name, kind in run.types.items():
        places = [names.index(one) for one in kind.columns]
        make = made(
            kind.bearing,
            run.limits,
            displacement=_to_allow(run, places),
            rim_force=_reached(run, "rim_force", places),
            rim_width=run.rim_width,
        )
        found.append(OfType(name, kind.bearing, places, make))
    return found


def _to_allow(run: ProjectRun, places: list[int]) -> float:
    # By the equivalent-linear analysis and by the time histories of all levels [m].
    found = [largest_of_bounds(each, "displacement") for each in levels_of(run.cases).values()]
    reached = float(np.fmax.reduce(np.array(found)[:, places], axis=None))
    return float(np.fmax(run.equivalent.allowed_displacement, reached))


def _reached(run: ProjectRun, name: str, places: list[int]) -> float:
    # The largest of any run; NaN if a run did not keep it.
    return float(np.max([peaks_of_runs(d, name)[:, places].max() for d in run.runs.parts]))


def schedule(run: ProjectRun) -> pd.DataFrame:
    """Return the schedule of bearings: a row a property with its unit, a column a type."""
    columns, kinds = {}, list(dict.fromkeys(run.system.bearings))
    units: dict[str, str] = {}
    for one in types_of(run):
        kind = "kind in the test programme", "-", float(kinds.index(one.bearing) + 1)
        rows = [kind, *_made(one), *_loaded(run, one), *_moved(run, one), *_looped(run, one)]
        units |= {title: unit for title, unit, _ in rows}
        columns[one.name] = {title: value for title, _, value in rows}
    table = pd.DataFrame(columns, index=pd.Index(list(units), name="of the bearings"))
    table = table.replace(math.inf, math.nan)
    table.insert(0, "unit", list(units.values()))
    return marked(table, run, [title in _OF_RUNS or title.startswith(_MOVED) for title in units])


_MOVED = "displacement, time histories"
_OF_RUNS = {
    *("outside diameter, bottom plate", "outside diameter, top plate", "total height"),
    *("thickness at the vertex, bottom plate", "thickness at the vertex, top plate"),
    *("height of the rims", "width of the rims", "mass of the bearing"),
    *("largest load with the earthquake", "least load with the earthquake that presses"),
    *("largest uplift of any run", "largest interface slip of any run"),
    *("rotation of the slider", "rotation between the plates, governing run"),
}
"""Properties that follow from time histories, also by the size of plates and rims."""


def marked(
    table: pd.DataFrame, run: ProjectRun, of_runs: Sequence[bool] | None = None
) -> pd.DataFrame:
    """Return a table with the number of failed runs in a column, at rows that follow from runs."""
    count = int((run.runs.of("status") != "ok").sum())
    failed = worded("{count} of {n} runs failed", count=count, n=len(run.runs))
    rows = [True] * len(table) if of_runs is None else of_runs
    return table.assign(void=[failed if each else "" for each in rows]) if count else table


Row = tuple[str, str, float]
"""Title, unit and value."""


def _made(one: OfType) -> list[Row]:
    bearing, make = one.bearing, one.make
    faces = [2.0 * rim_face(bearing, k) for k in (0, 1)]
    return [
        ("number of bearings", "-", float(len(one.places))),
        ("outside diameter, bottom plate", "m", make.diameters[0]),
        ("outside diameter, top plate", "m", make.diameters[1]),
        ("total height", "m", make.height),
        ("thickness at the vertex, bottom plate", "m", make.plates.thickness[0]),
        ("thickness at the vertex, top plate", "m", make.plates.thickness[1]),
        ("inside diameter of the bottom rim", "m", faces[0]),
        ("inside diameter of the top rim", "m", faces[1]),
        ("height of the rims", "m", make.plates.rim),
        ("width of the rims", "m", make.plates.wall),
        ("radius of the bottom surface", "m", bearing.radii[0]),
        ("radius of the top surface", "m", bearing.radii[1]),
        ("diameter of the slider", "m", 2.0 * bearing.slider_radius),
        ("height of the slider", "m", bearing.slider_height),
        ("mass of the slider", "kg", make.sliders),
        ("mass of the bearing", "kg", make.mass),
    ]


def _loaded(run: ProjectRun, one: OfType) -> list[Row]:
    loads = [run.loads[k] for k in one.places]
    least, most = run.types[one.name].asked.loads
    return [
        ("permanent load, mean", "N", sum(loads) / len(loads)),
        ("permanent load, least bearing", "N", min(loads)),
        ("permanent load, largest bearing", "N", max(loads)),
        ("largest load with the earthquake", "N", most),
        ("least load with the earthquake that presses", "N", least),
        ("largest uplift of any run", "m", _reached(run, "gap", one.places)),
    ]


def _moved(run: ProjectRun, one: OfType) -> list[Row]:
    bearing, rows = one.bearing, []
    levels = levels_of(run.cases)
    for level, cases in levels.items():
        title = _MOVED
        if len(levels) > 1:
            title = worded("{what}, level {level}", what=title, level=level)
        values = largest_of_bounds(cases, "displacement")[one.places]
        rows.append((title, "m", float(np.fmax.reduce(values))))
    rim = bearing.lateral_capacity
    turn = min(_to_allow(run, one.places), rim) / bearing.effective_radius
    return [
        *rows,
        ("displacement to allow, equivalent-linear", "m", run.equivalent.allowed_displacement),
        ("displacement at which a rim is met", "m", rim),
        ("largest interface slip of any run", "m", _reached(run, "slip", one.places)),
        ("interface slip at the end of the overlap", "m", bearing.resolved()["slip_capacity"]),
        ("rotation of the slider", "rad", math.asin(min(turn, 1.0))),
        ("rotation between the plates, governing run", "rad", _rotation(run, one.places)),
    ]


def _rotation(run: ProjectRun, places: list[int]) -> float:
    # Values of the run with the largest bearing displacement; NaN if rotations were not kept.
    data = run.governing
    if "node_displacement" not in data:
        return math.nan
    names = [str(data["bearing"].to_numpy()[k]) for k in places]
    turns = [np.subtract(*plate_tilts(data, name)) for name in names]
    return float(np.linalg.norm(turns, axis=-1).max())


def _looped(run: ProjectRun, one: OfType) -> list[Row]:
    # k_eff, energy and friction at the design displacement, and the acceptance of prototypes.
    worst = max(run.equivalent.bounds.values(), key=lambda each: each.displacement)
    load = sum(run.loads[k] for k in one.places) / len(one.places)
    speed = 2.0 * math.pi * worst.displacement / worst.period
    test = PlannedTest("", worst.displacement, load, 3.0, speed, "", "")
    ends = [with_property_bounds(one.bearing, end, run.bounds) for end in ENDS]
    numbers = loop_numbers(test, one.bearing, ends, run.bounds)
    rows = [("displacement of these loops", "m", worst.displacement)]
    for title, value in zip(LOOPS, numbers, strict=True):
        name, _, unit = title.removesuffix("]").partition(" [")
        rows.append((name, unit, value))
    return rows


_RIG = {
    "largest vertical load [N]": ("vertical load [N]", "max"),
    "least vertical load [N]": ("vertical load [N]", "min"),
    "largest lateral force [N]": ("largest force [N]", "max"),
    "stroke, each way [m]": ("displacement [m]", "max"),
    "largest speed [m/s]": ("peak speed [m/s]", "max"),
}


def rig(run: ProjectRun) -> pd.DataFrame:
    """Return the required capacity of a rig for each kind of bearing, and the number of tests."""
    table = (
        run.programme.groupby("bearings", sort=False).agg(**_RIG).rename_axis("bearings to test")
    )
    table.insert(0, "prototypes", SPECIMENS)
    return marked(table, run)


def replacement(run: ProjectRun) -> pd.DataFrame:
    """Return clearances and jacking loads of each bearing type, and the limit for recentring."""
    loads, stiffness = np.array(run.loads), np.array(list(lifting_stiffness(run.frame).values()))
    rows = {}
    for one in types_of(run):
        own = loads[one.places]
        lifts = own / one.bearing.resolved()["axial_stiffness"] + CLEARANCE
        rows[one.name] = {
            "largest permanent load [N]": own.max(),
            "lift [m]": lifts.max(),
            "jacking force [N]": (own + stiffness[one.places] * lifts).max(),
            "residual slip, largest of any run [m]": _reached(run, "slip_left", one.places),
            "residual slip that may stay [m]": _may_stay(run, one),
        }
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("type to replace")
    return marked(table, run)


def _may_stay(run: ProjectRun, one: OfType) -> float:
    # Residual displacement that leaves the design slip for the next earthquake.
    if one.bearing.is_dcfp or not math.isfinite(one.bearing.lateral_capacity):
        return math.nan
    holds = enter_bearing(one.bearing, run.bounds).value("s_lim")
    left = max(holds - run.types[one.name].asked.slip, 0.0)
    return left if run.limits.slip_left is None else min(left, run.limits.slip_left)


def texts(run: ProjectRun) -> dict[str, str]:
    """Return the values in the texts for supplier and owner: lengths [mm], masses [kg], clauses."""
    kinds, gap = types_of(run), run.limits.moat_gap
    clearance = max(_to_allow(run, one.places) for one in kinds)
    shortest = min(one.bearing.effective_radius for one in kinds)
    lengths = {
        "clearance": clearance,  # horizontal, all around
        "rise": shortest - math.sqrt(shortest**2 - min(clearance, shortest) ** 2),
        "diameter": max(max(one.make.diameters) for one in kinds),  # of the largest piece
        "height": max(one.make.height for one in kinds),
        "free": CLEARANCE,
    }
    return {name: f"{1e3 * length:.0f}" for name, length in lengths.items()} | {
        "moat": "" if gap is None else f"{1e3 * gap:.0f}",
        "mass": f"{max(one.make.mass for one in kinds):.0f}",
        # dimensions that are proportioned here
        "proposals": joined(*dict.fromkeys(w for one in kinds for w in one.make.proposed), by=", "),
        "stress": f"{1e-6 * YIELD_STRESS:.0f}",
        "share": f"{PLATE_SHARE:g}",
        "clause": next(
            (p.clause for p in run.provisions if "inspection" in p.what), PROPOSED_LIMIT
        ),
    }
