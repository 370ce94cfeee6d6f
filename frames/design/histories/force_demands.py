"""Forces in members, storeys and under bearings for design: of suites, as a code counts them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.design.histories.demand_table import said
from frames.design.histories.least_shears import Raise
from frames.design.histories.suite import motion_of, peaks_of_runs, suite_of
from frames.results.recorded import REACHED

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    import xarray as xr

    from frames._types import BoolArray, FloatArray, IntArray
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.histories.suite import Suite

    Runs = Mapping[str, Mapping[Bound, xr.Dataset]]


class _Kind(NamedTuple):
    # A table: the variable it is of, its dimensions with the heads of their columns, its forces.
    variable: str
    columns: dict[str, str]
    forces: str


_KINDS = {
    "members": _Kind("member_force", {"member": "member", "station": "station"}, "component"),
    "storeys": _Kind("storey_force", {"section": "storey"}, "storey_component"),
    "reactions": _Kind("reaction_force", {"bearing": "bearing", "side": "side"}, "reaction"),
}
EXTREMES = ("max", "min")
"""Words of a table for the largest and the smallest value."""

_SIGN = np.array([1.0, -1.0])
_DIGITS = 3  # after the point, of forces: what is less than a millinewton is round-off


def force_demands(
    runs: Runs, rules: HistoryRules, raises: Mapping[tuple[str, str], Raise] | None = None
) -> dict[str, pd.DataFrame]:
    """Return what time histories ask of members, storeys and what bearings stand on and carry.

    Parameters
    ----------
    runs : mapping of str to mapping of str to xarray.Dataset
        Time histories by level of the seismic action, then by bound, that kept forces
        (`Recording`); a row a motion.
    rules : HistoryRules
        How the code counts them.
    raises : mapping, optional
        By level and bound what the code's least shears raise (`raises_of_runs`): the earthquake's
        part of forces of members, storeys and drifts, and that of reactions and of the whole
        structure's foot. Forces of members are taken as above the isolation.

    Returns
    -------
    dict of str to pandas.DataFrame
        "members", "storeys" and "reactions", as far as the structure has them: a row for each
        level, bound, section, force and extreme [N, N m], with the permanent loads of the model:

        - value: the mean or the largest of the runs' extremes, as "statistic" says, with its rest
          times "raised by"; permanent: its part of the permanent loads, the rest being the
          earthquake's;
        - motion: whose extreme is farthest out, single: that extreme, time [s]: when, and all six
          forces of the section at that instant, not raised;
        - governs: whether no other bound of that level is farther out;
        - void: that "value" is no value for design, for so many runs failed; empty where it is one.

        Of storeys drifts besides [-], which are no forces and have nothing at once.
    """
    import pandas as pd

    found: dict[str, pd.DataFrame] = {}
    known = raises or {}
    for name, kind in _KINDS.items():
        parts = []
        for level, each in runs.items():
            tables = []
            for bound, data in each.items():
                if REACHED + kind.variable not in data:
                    continue
                suite, more = suite_of(data, rules), known.get((level, bound), Raise())
                table = _of_bound(data, kind, suite, _factors(data, name, kind, more))
                if name == "storeys":
                    table = pd.concat([table, _drifts(data, suite, more.above)])
                tables.append(table.assign(level=level, bound=bound))
            parts += _with_governing(tables, [*kind.columns.values(), "force", "extreme"])
        if parts:
            table = pd.concat(parts, ignore_index=True)
            first = ["level", "bound"]
            rest = [column for column in table.columns if column not in first]
            found[name] = table[[*first, *rest]].set_index("level")
    return found


def _factors(data: xr.Dataset, name: str, kind: _Kind, more: Raise) -> FloatArray:
    # Of each section, which are in the order of the table: the foot of the lowest level is the
    # first of the storeys.
    shape = tuple(data.sizes[dim] for dim in kind.columns)
    factors = np.full(shape, more.isolation if name == "reactions" else more.above)
    if name == "storeys":
        factors[0] = more.isolation
    return factors.ravel()


def _of_bound(data: xr.Dataset, kind: _Kind, suite: Suite, factors: FloatArray) -> pd.DataFrame:
    import pandas as pd

    dims, six = tuple(kind.columns), kind.forces
    order = ("run", *dims, six, "extreme")
    together = data[REACHED + kind.variable].transpose(*order, f"{six}_at_once").to_numpy()
    times = data[f"{REACHED}{kind.variable}_at"].transpose(*order).to_numpy()
    rest = data[f"{REACHED}{kind.variable}_at_rest"].transpose(*order[:-1]).to_numpy()[0]
    runs = len(together)
    together, times = together.reshape(runs, -1, 6, 2, 6), times.reshape(runs, -1, 6, 2)
    own = np.einsum("rscwc->rscw", together)
    value, which = _counted(own * _SIGN, suite)
    still = rest.reshape(-1, 6)[:, :, None]
    more = factors[:, None, None]
    value = np.where(more > 1.0, still + more * (value * _SIGN - still), value * _SIGN)

    def of_motion(values: FloatArray) -> FloatArray:
        index = which.reshape(1, *which.shape, *(1,) * (values.ndim - 4))
        found: FloatArray = np.take_along_axis(values, index, axis=0)[0]
        return found

    labels = [list(map(str, data[dim].to_numpy())) for dim in (*dims, six)]
    names = pd.MultiIndex.from_product(
        [*labels, EXTREMES], names=[*kind.columns.values(), "force", "extreme"]
    )
    table = names.to_frame(index=False)
    table["unit"] = ["N m" if force[0] in "MT" else "N" for force in table["force"]]
    table["value"] = _shown(value)
    table["permanent"] = _shown(np.repeat(rest.ravel(), 2))
    table["raised by"] = np.repeat(factors, 12)
    table = _with_motions(table, data, suite, which.ravel())
    table["single"] = _shown(of_motion(own))
    table["time [s]"] = of_motion(times).ravel()
    acting = of_motion(together).reshape(-1, 6)
    for k, force in enumerate(labels[-1]):
        table[f"{force} then"] = _shown(acting[:, k])
    table["void"] = _void(suite)
    return table


def _shown(values: FloatArray) -> FloatArray:
    return np.asarray(np.round(values, _DIGITS).ravel() + 0.0)  # no -0


def _void(suite: Suite) -> str:
    # Which runs and why is in the table of demands.
    return f"{sum(suite.failed)} of {len(suite.failed)} runs failed" if suite.void else ""


def _drifts(data: xr.Dataset, suite: Suite, factor: float) -> pd.DataFrame:
    # Of the means of the storeys' nodes.
    import pandas as pd

    if f"{REACHED}drift" not in data:
        return pd.DataFrame()
    each, times = peaks_of_runs(data, "drift"), peaks_of_runs(data, "drift_at")
    value, which = _counted(each, suite)
    table = pd.DataFrame({"storey": list(map(str, data["level"].to_numpy()[1:]))})
    table = table.assign(force="drift", extreme=EXTREMES[0], unit="1", value=factor * value)
    table["raised by"] = factor
    table = _with_motions(table, data, suite, which)
    columns = np.arange(len(which))
    return table.assign(
        **{"single": each[which, columns], "time [s]": times[which, columns]},
        void=_void(suite),
    )


def _counted(values: FloatArray, suite: Suite) -> tuple[FloatArray, IntArray]:
    # The value for design of those of the runs, and the run that is farthest out of those that
    # count.
    counts: BoolArray = ~np.array(suite.failed) if suite.is_usable else np.full(len(values), True)
    known = np.where(counts.reshape(-1, *(1,) * (values.ndim - 1)), values, -np.inf)
    return suite.values(values), np.asarray(np.nan_to_num(known, nan=-np.inf).argmax(axis=0))


def _with_motions(
    table: pd.DataFrame, data: xr.Dataset, suite: Suite, which: IntArray
) -> pd.DataFrame:
    motions = np.array([motion_of(data, k) for k in range(data.sizes["run"])], dtype=object)
    return table.assign(statistic=said(suite), motion=motions[which])


def _with_governing(tables: list[pd.DataFrame], rows: list[str]) -> list[Any]:
    # Of the tables of all bounds, with the same rows each.
    if not tables:
        return []
    sign = np.where(tables[0]["extreme"] == EXTREMES[0], 1.0, -1.0)
    out = np.stack([sign * table["value"].to_numpy() for table in tables])
    most = out.max(axis=0)
    found = []
    for table, mine in zip(tables, out, strict=True):
        if not table[rows].equals(tables[0][rows]):
            msg = "the bounds of a level are not of one structure"
            raise AssertionError(msg)
        governs = np.where(mine == most, "yes", "no")
        found.append(table.assign(governs=governs))
    return found
