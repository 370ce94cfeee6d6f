"""What time histories ask of links, moat walls and dampers, as a code counts them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.design.histories.demand_table import said
from frames.design.histories.eccentricity import cases_of
from frames.design.histories.suite import names_of, peaks_of_runs

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    import xarray as xr

    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules

    Runs = Mapping[str, Mapping[Bound, xr.Dataset]]

_COLUMNS = {"deformation [m]": "link_deformation", "force [N]": "link_force"}


def link_demands(runs: Runs, rules: HistoryRules, moved: Runs | None = None) -> pd.DataFrame:
    """Return how far links are deformed and which forces they exert, for design."""
    import pandas as pd

    tables = []
    for case in cases_of(runs, rules, moved):
        if not case.keeps("link_force"):
            continue
        suite = case.suite
        table = pd.DataFrame({"link": names_of(case.data, "link_force")})
        table = table.assign(bound=case.bound, statistic=said(suite))
        for title, name in _COLUMNS.items():
            more, _ = case.added(lambda one, name=name: peaks_of_runs(one, name))  # type: ignore[misc]
            table[title] = suite.values(peaks_of_runs(case.data, name)) + more
        forces = case.all_runs(lambda one: peaks_of_runs(one, "link_force"))
        counts = np.full(len(forces), True)  # of those that failed none, if the others stand
        counts[: len(suite.failed)] = not suite.is_usable or ~np.array(suite.failed)
        known = np.where(counts[:, None], forces, -np.inf)
        which = np.nan_to_num(known, nan=-np.inf).argmax(axis=0)
        table["motion"] = np.array(case.motions, dtype=object)[which]
        table["its force [N]"] = forces[which, np.arange(len(which))]
        tables.append(table.assign(void=suite.void, level=case.level))
    return pd.concat(tables).set_index("level") if tables else pd.DataFrame()


def largest_of_links(table: pd.DataFrame) -> pd.DataFrame:
    """Return the row of each link and level whose force is largest of all bounds."""
    if table.empty:
        return table
    rows = table.reset_index()
    force = rows["force [N]"].fillna(-np.inf)
    return rows.loc[force.groupby([rows["level"], rows["link"]]).idxmax()].sort_index()
