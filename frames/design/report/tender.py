"""What suppliers and testers get: schedule of the bearings by type, plan with axes, the rig."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from frames.design.codes.bounds import ENDS
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.prototype_programme import PlannedTest
from frames.design.devices.bearing_numbers import enter_bearing
from frames.design.devices.plates import Make, made
from frames.design.histories.demand_table import largest_of_bounds
from frames.design.histories.eccentricity import levels_of
from frames.design.histories.suite import peaks_of_runs
from frames.design.testing.expected import LOOPS, loop_numbers
from frames.design.testing.programme import SPECIMENS
from frames.plots.bearing_geometry import plate_tilts, rim_face
from frames.statics.centres import lifting_stiffness
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.project.design_run import ProjectRun
    from lir_element import LIRBearing

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""Of axes; I and O are left out, which look like numbers."""

CLEARANCE = 0.005
"""By which a bearing is free when it is drawn out [m], a proposal."""

JACK_RESERVE = 1.5
"""Capacity of jacks over the force that lifts, a proposal."""

_SAME_LINE = 0.10  # m: places that near are on one axis


class Axis(NamedTuple):
    """A line of the grid of bearings: 1, 2, 3 across x; A, B, C across y."""

    name: str
    at: float  # m


def axes_along(places: Sequence[float], letters: bool) -> tuple[list[Axis], list[str]]:
    """Return the axes across a direction, and the name of each place's own.

    Places that follow each other by less than 100 mm are on one axis, at their mean.
    """
    order = sorted(range(len(places)), key=lambda k: places[k])
    groups = [[order[0]]]
    for before, k in pairwise(order):
        if places[k] - places[before] > _SAME_LINE:
            groups.append([])
        groups[-1].append(k)
    axes, names = [], [""] * len(places)
    for n, group in enumerate(groups):
        name = lettered(n) if letters else str(n + 1)
        axes.append(Axis(name, sum(places[k] for k in group) / len(group)))
        for k in group:
            names[k] = name
    return axes, names


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
    forces = np.nanmax([peaks_of_runs(d, "rim_force").max(axis=0) for d in run.runs.parts], axis=0)
    for name, kind in run.types.items():
        places = [names.index(one) for one in kind.columns]
        make = made(
            kind.bearing,
            run.limits,
            displacement=run.equivalent.allowed_displacement,
            rim_force=float(forces[places].max()),
            rim_width=run.rim_width,
        )
        found.append(OfType(name, kind.bearing, places, make))
    return found


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
    table.insert(0, "unit", list(units.values()))
    return table


Row = tuple[str, str, float]
"""Title, unit and value."""


def _made(one: OfType) -> list[Row]:
    bearing, make = one.bearing, one.make
    faces = [2.0 * rim_face(bearing, k) for k in (0, 1)]
    rows = [
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
    return [(title, unit, v if math.isfinite(v) else math.nan) for title, unit, v in rows]


def _loaded(run: ProjectRun, one: OfType) -> list[Row]:
    loads = [run.loads[k] for k in one.places]
    least, most = run.types[one.name].asked.loads
    return [
        ("permanent load, mean", "N", sum(loads) / len(loads)),
        ("permanent load, least bearing", "N", min(loads)),
        ("permanent load, largest bearing", "N", max(loads)),
        ("largest load with the earthquake", "N", most),
        ("least load with the earthquake that presses", "N", least),
        ("largest uplift of any run", "m", _uplift(run, one.places)),
    ]


def _uplift(run: ProjectRun, places: list[int]) -> float:
    # 0 where nothing lifts off, NaN where a run did not keep its gap.
    gaps = []
    for data in run.runs.parts:
        lifted = peaks_of_runs(data, "time_lifted")[:, places] > 0.0
        gaps.append(np.where(lifted, peaks_of_runs(data, "gap")[:, places], 0.0).max())
    return float(max(gaps)) if not np.isnan(gaps).any() else math.nan


def _moved(run: ProjectRun, one: OfType) -> list[Row]:
    bearing, rows = one.bearing, []
    several = len(run.rules.levels) > 1
    for level, cases in levels_of(run.cases).items():
        title = "displacement, time histories"
        title = worded("{what}, level {level}", what=title, level=level) if several else title
        values = largest_of_bounds(cases, "displacement")[one.places]
        rows.append((title, "m", float(np.nanmax(values))))
    allowed, rim = run.equivalent.allowed_displacement, bearing.lateral_capacity
    slip = max(peaks_of_runs(d, "slip")[:, one.places].max() for d in run.runs.parts)
    turn = math.asin(min(min(allowed, rim) / bearing.effective_radius, 1.0))
    return [
        *rows,
        ("displacement to allow, equivalent-linear", "m", allowed),
        ("displacement at which a rim is met", "m", rim if math.isfinite(rim) else math.nan),
        ("largest interface slip of any run", "m", float(slip)),
        ("interface slip at the end of the overlap", "m", bearing.resolved()["slip_capacity"]),
        ("rotation of the slider", "rad", turn),
        ("rotation between the plates, governing run", "rad", _rotation(run, one.places)),
    ]


def _rotation(run: ProjectRun, places: list[int]) -> float:
    # Of the run that displaces a bearing most; NaN where rotations of nodes were not kept.
    data = run.governing
    if "node_displacement" not in data:
        return math.nan
    names = [str(data["bearing"].to_numpy()[k]) for k in places]
    turns = [np.subtract(*plate_tilts(data, name)) for name in names]
    return float(np.linalg.norm(turns, axis=-1).max())


def _looped(run: ProjectRun, one: OfType) -> list[Row]:
    # k_eff, energy and friction at the design displacement, and what is accepted of prototypes.
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


def rig(programme: pd.DataFrame) -> pd.DataFrame:
    """Return what a rig must reach for each kind of bearing, and how many are tested."""
    rows = {}
    for kind, tests in programme.groupby("bearings", sort=False):
        energy = tests["cycles"] * tests["EDC, upper [J]"]
        rows[str(kind)] = {
            "prototypes": SPECIMENS,
            "largest vertical load [N]": tests["vertical load [N]"].max(),
            "least vertical load [N]": tests["vertical load [N]"].min(),
            "largest lateral force [N]": tests["largest force [N]"].max(),
            "stroke, each way [m]": tests["displacement [m]"].max(),
            "largest speed [m/s]": tests["peak speed [m/s]"].max(),
            "most cycles": tests["cycles"].max(),
            "most energy of a test [J]": energy.max(),
        }
    table = pd.DataFrame.from_dict(rows, orient="index")
    table.index.name = "bearings to test"
    return table


def replacement(run: ProjectRun) -> pd.DataFrame:
    """Return what takes a bearing of each type out, and when it is to be centred again."""
    stiffness = list(lifting_stiffness(run.frame).values())
    rows = {}
    for one in types_of(run):
        axial = one.bearing.resolved()["axial_stiffness"]
        lifts = [run.loads[k] / axial + CLEARANCE for k in one.places]
        forces = [
            run.loads[k] + stiffness[k] * lift for k, lift in zip(one.places, lifts, strict=True)
        ]
        rows[one.name] = {
            "largest permanent load [N]": max(run.loads[k] for k in one.places),
            "lift [m]": max(lifts),
            "jacking force [N]": max(forces),
            "capacity of the jacks [N]": JACK_RESERVE * max(forces),
            "residual slip, largest of any run [m]": _left(run, one.places),
            "residual slip that may stay [m]": _may_stay(run, one),
        }
    table = pd.DataFrame.from_dict(rows, orient="index")
    table.index.name = "type to replace"
    return table


def _left(run: ProjectRun, places: list[int]) -> float:
    each = [peaks_of_runs(data, "slip_left")[:, places] for data in run.runs.parts]
    return float(max(values.max() for values in each))


def _may_stay(run: ProjectRun, one: OfType) -> float:
    # What leaves the next earthquake the slip that this design asks for.
    if one.bearing.is_dcfp or not math.isfinite(one.bearing.lateral_capacity):
        return math.nan
    holds = enter_bearing(one.bearing, run.bounds).value("s_lim")
    left = max(holds - run.types[one.name].asked.slip, 0.0)
    return left if run.limits.slip_left is None else min(left, run.limits.slip_left)


class Care(NamedTuple):
    """Numbers of the specification for use, in mm, kN and kg as text."""

    clearance: str  # horizontal, all around
    rise: str  # of the structure at that displacement
    diameter: str  # of the largest piece to be moved
    height: str
    mass: str
    moat: str  # clear distance of the project, empty without
    free: str  # clearance of a bearing that is drawn out


def care(run: ProjectRun) -> Care:
    """Return the numbers of the specification for use."""
    kinds = types_of(run)
    reached = [
        float(np.nanmax(largest_of_bounds(cases, "displacement")))
        for cases in levels_of(run.cases).values()
    ]
    clearance = max(run.equivalent.allowed_displacement, *reached)
    shortest = min(one.bearing.effective_radius for one in kinds)
    rise = shortest - math.sqrt(shortest**2 - min(clearance, shortest) ** 2)
    gap = run.limits.moat_gap
    return Care(
        clearance=_mm(clearance),
        rise=_mm(rise),
        diameter=_mm(max(max(one.make.diameters) for one in kinds)),
        height=_mm(max(one.make.height for one in kinds)),
        mass=f"{max(one.make.mass for one in kinds):.0f}",
        moat="" if gap is None else _mm(gap),
        free=_mm(CLEARANCE),
    )


def _mm(length: float) -> str:
    return f"{1e3 * length:.0f}"


def proposals(run: ProjectRun) -> str:
    """Return which dimensions are proportioned here, in words; empty if all are given."""
    found = dict.fromkeys(what for one in types_of(run) for what in one.make.proposed)
    return joined(*found, by=", ")


def void_said(run: ProjectRun) -> str:
    """Return why numbers of time histories are none for design; empty if they are."""
    why = joined(*dict.fromkeys(each.asked.void for each in run.types.values() if each.asked.void))
    return worded("no values for design: {why}", why=why) if why else ""


def code_periods(run: ProjectRun) -> list[tuple[str, str]]:
    """Return the effective period of the code at each bound, in s."""
    return [(name, f"{each.period:.3g}") for name, each in run.equivalent.bounds.items()]
