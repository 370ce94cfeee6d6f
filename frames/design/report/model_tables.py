"""Tables of a project's model: its modes with shares of mass, and the centres of its levels."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.pendulum import FrictionPendulum
from frames.statics.centres import floor_centres
from frames.statics.modes import modes

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.design.project.design_run import ProjectRun

_COUNT = 6


def mode_table(run: ProjectRun) -> pd.DataFrame:
    """Return periods and shares of mass of the first modes, and the sums of these shares.

    On sliding bearings, on a fixed base, and on the effective stiffness at each bound; shares are
    of the mass and of its inertia about the vertical through its centre.
    """
    ways: dict[str, Any] = {"sliding": "sliding", "fixed base": "fixed"}
    for bound in run.equivalent.bounds:
        ways[f"k_eff at {bound}"] = _stiffness_at(run, bound)
    columns, sums = {}, {}
    for title, bearings in ways.items():
        found = modes(run.frame, _COUNT, bearings=bearings)
        columns[f"period, {title} [s]"] = found.periods
        shares = (*found.mass_ratios.T[:2], found.torsion_ratios)
        for name, share in zip(("mass x", "mass y", "torsion"), shares, strict=True):
            columns[f"{name}, {title}"] = np.round(share, 4)
            sums[f"{name}, {title}"] = round(float(share.sum()), 4)
    length = min(map(len, columns.values()))
    index = pd.Index([*map(str, range(1, length + 1)), "sum"], name="mode")
    values = {
        name: [*column[:length], sums.get(name, math.nan)] for name, column in columns.items()
    }
    return pd.DataFrame(values, index=index)


def centre_table(run: ProjectRun) -> pd.DataFrame:
    """Return the centres of mass and stiffness of each level, that of the bearings on top.

    Of the level on the bearings the centre of stiffness is that of their pendulums, N / L.
    """
    links = run.frame.bearings.values()
    tops = [run.frame.nodes[link.j] for link in links]
    pendulum = np.divide(run.loads, [link.bearing.effective_radius for link in links])
    bearings = np.average([(node.x, node.y) for node in tops], axis=0, weights=pendulum)
    levels = {level.name: {*level.nodes} for level in run.frame.levels}
    rows = {}
    for one in floor_centres(run.frame):
        is_base = not levels[one.level].isdisjoint(link.j for link in links)
        (x, y), (u, v) = one.mass_centre, bearings if is_base else one.stiffness_centre
        rows[one.level] = {
            "z [m]": one.z,
            "mass [t]": 1e-3 * one.mass,
            "x of mass [m]": x,
            "y of mass [m]": y,
            "x of stiffness [m]": u,
            "y of stiffness [m]": v,
            "e_x over the side [-]": (x - u) / one.sides[0] if one.sides[0] else math.nan,
            "e_y over the side [-]": (y - v) / one.sides[1] if one.sides[1] else math.nan,
        }
    table = pd.DataFrame.from_dict(rows, orient="index").round(6) + 0.0  # no -0
    table.index.name = "level"
    return table


def _stiffness_at(run: ProjectRun, bound: str) -> FloatArray:
    # Effective stiffness of each bearing at a bound's displacement, (n_bearings,) [N/m].
    d = run.equivalent.bounds[bound].displacement
    system = with_property_bounds(run.system, bound, run.bounds)  # type: ignore[arg-type]  # its names
    pairs = zip(system.bearings, system.loads, strict=True)
    return np.array([FrictionPendulum.of(one).force(d, load) / d for one, load in pairs])
