"""Tables of a run that a report shows and its folder keeps: bearings, friction, modes, members."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.eccentricity import eccentricity_table
from frames.design.histories.suite import peaks_of_runs
from frames.recording.recovery import member_forces
from frames.results.envelopes import envelope
from frames.statics.modes import modes

if TYPE_CHECKING:
    from frames.design.codes.bounds import BoundName
    from frames.design.project.design_run import ProjectRun
    from lir_element import LIRBearing

_REACHED = {
    "displacement [m]": ("displacement", 1.0),
    "slip [m]": ("slip", 1.0),
    "rim force [N]": ("rim_force", 1.0),
    "largest load [N]": ("axial_force", 1.0),
    "least load [N]": ("axial_tension", -1.0),
}
"""What each bearing reached in all runs at all bounds: the largest of a quantity, with a sign."""

ECCENTRICITY = "eccentricity"
"""Name of the table of what moved masses raise."""

_FRICTIONS = (
    "bottom surface",
    "top surface",
    "bottom surface, slow",
    "top surface, slow",
    "interface",
)
_COUNT = 6
_ROUND_OFF = 1e-6  # of the largest force, or moment: histories are kept in single precision
_COMPONENTS = {"N": "N", "Vy": "N", "Vz": "N", "T": "N m", "My": "N m", "Mz": "N m"}


def bearing_table(run: ProjectRun) -> pd.DataFrame:
    """Return where each bearing stands, what it carries, and the largest that runs asked of it.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    pandas.DataFrame
        A row a bearing; places and displacements [m], forces [N], in the names of the columns.
        Largest of all runs, those with moved masses among them, whatever the code makes of them.
    """
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
    if len(set(run.types.values())) > 1:
        table.insert(0, "type", [run.types[name] for name in links])
    for title, (name, sign) in _REACHED.items():
        both = (*run.runs.values(), *run.moved.values())
        every = (data for each in both for data in each.values())
        values = [peaks_of_runs(data, name).max(axis=0) for data in every]
        table[title] = sign * np.max(values, axis=0)
    return table


def friction_table(run: ProjectRun) -> pd.DataFrame:
    """Return the friction coefficients of the bearings at each bound.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    pandas.DataFrame
        Rows: both surfaces at high and at low speed, and the interface (infinite: rigid slider);
        columns: bounds [-].
    """
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
        rows = [f"{row}, {kind}" if kind else row for row in _FRICTIONS]
        tables.append(pd.DataFrame(columns, index=pd.Index(rows, name="friction coefficient")))
    return pd.concat(tables)


def devices_by_type(run: ProjectRun) -> dict[str, LIRBearing]:
    """Return a bearing of each type, the type's name "" where there is one alone.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    dict of str to LIRBearing
        Friction nominal.
    """
    found: dict[str, LIRBearing] = {}
    for name, link in run.frame.bearings.items():
        found.setdefault(run.types.get(name, ""), link.bearing)
    return found if len(found) > 1 else {"": next(iter(found.values()))}


def mode_table(run: ProjectRun) -> pd.DataFrame:
    """Return the first periods of the structure on sliding bearings, and held at its base.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    pandas.DataFrame
        Periods [s] and participating masses along x and y [-], four decimals, of both.
    """
    columns = {}
    for title, bearings in (("sliding", "sliding"), ("held", "fixed")):
        found = modes(run.frame, _COUNT, bearings=bearings)  # type: ignore[arg-type]  # its words
        columns[f"period, {title} [s]"] = found.periods
        for k, axis in enumerate("xy"):
            columns[f"mass {axis}, {title}"] = np.round(found.mass_ratios[:, k], 4)
    length = min(map(len, columns.values()))
    index = pd.Index(range(1, length + 1), name="mode")
    return pd.DataFrame({name: values[:length] for name, values in columns.items()}, index=index)


def member_table(run: ProjectRun) -> pd.DataFrame:
    """Return the extremes of the members' forces in the governing run, by group.

    Members of the same kind of name at the same heights are a group.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    pandas.DataFrame
        A row a group and component, in local axes: number of members, unit, smallest and largest
        value, each with its member. Empty for a structure without members. What is below a
        millionth of the largest of its unit is left out: round-off.
    """
    frame = run.frame
    if not frame.members:
        return pd.DataFrame()
    found = envelope(member_forces(frame, run.governing))
    largest = found["largest"].transpose("member", "end", "component").to_numpy()
    smallest = found["smallest"].transpose("member", "end", "component").to_numpy()
    names = [str(name) for name in found["member"].to_numpy()]
    components = [str(name) for name in found["component"].to_numpy()]
    groups: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        ends = (frame.nodes[frame.members[name].i].z, frame.nodes[frame.members[name].j].z)
        heights = " to ".join(f"{height:g}" for height in sorted(set(ends)))
        kind = re.sub(r"[-_ ]*\d+", "", name)
        groups.setdefault(f"{kind} at {heights} m", []).append(k)
    rows = []
    for group, members in groups.items():
        for c, component in enumerate(components):
            high, low = (
                largest[members][:, :, c].max(axis=1),
                smallest[members][:, :, c].min(axis=1),
            )
            rows.append(
                {
                    "group": group,
                    "members": len(members),
                    "force": component,
                    "unit": _COMPONENTS[component],
                    "smallest": float(low.min()),
                    "member of smallest": names[members[int(low.argmin())]],
                    "largest": float(high.max()),
                    "member of largest": names[members[int(high.argmax())]],
                }
            )
    table = pd.DataFrame(rows).set_index("group")
    size = table[["smallest", "largest"]].abs().max(axis=1)
    return table[size > _ROUND_OFF * size.groupby(table["unit"]).transform("max")]


def run_tables(run: ProjectRun) -> dict[str, pd.DataFrame]:
    """Return all tables of this module, by name.

    Parameters
    ----------
    run : ProjectRun
        The run.

    Returns
    -------
    dict of str to pandas.DataFrame
        "bearings", "friction", "modes", "members", "programme" of tests, "eccentricity" of masses.
    """
    return {
        "bearings": bearing_table(run),
        "friction": friction_table(run),
        "modes": mode_table(run),
        "members": member_table(run),
        "programme": run.programme,
        ECCENTRICITY: eccentricity_table(run.runs, run.moved, run.rules),
    }
