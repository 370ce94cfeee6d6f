"""Accidental eccentricity in a report: what moved masses raise, and what it is of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.design.calculation.standing import MEMORY
from frames.design.codes.registry import code_named
from frames.design.report.columns import in_parts
from frames.design.report.page import Table, page_table
from frames.results.quantities import JUDGED

if TYPE_CHECKING:
    import pandas as pd

    from frames.design.project.design_run import ProjectRun


_TITLES = {name.replace("_", " "): quantity.heading for name, quantity in JUDGED.items()}
_TITLES |= {"axial tension": "maximum axial tension"}  # as the table has it, not its negative
"""What the demands call the quantities of ``eccentricity.csv``."""


def raised_tables(table: pd.DataFrame) -> list[Table]:
    """Return the way that raises each quantity most at each bound; none without moved runs."""
    if table.empty:
        return []
    size = table["factor"].fillna(0.0) + table["added"].fillna(0.0)
    worst = table.loc[size.groupby([table["level"], table["bound"], table["quantity"]]).idxmax()]
    worst["quantity"] = worst["quantity"].replace(_TITLES)
    worst = worst.sort_index().set_index("quantity")
    worst.loc[worst["void"] != "", ["factor", "added"]] = math.nan  # of what failed runs reached
    worst["factor"] = worst["factor"].map(_factor)  # a pure number, whatever unit its row has
    order = ["level", "bound", "masses", "unit", "centred", "moved", "factor", "added", "motions"]
    if worst["level"].nunique() == 1:
        order.remove("level")
    return in_parts(page_table(worst[order], "largest"))


def _factor(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.4g}"


def eccentricity_said(run: ProjectRun) -> str:
    """Return what of accidental eccentricity is in the demands, in words."""
    asked = code_named(run.equivalent.code).histories
    clause = MEMORY.cited(f"{asked.cited} {asked.eccentricity_clause}".strip())
    asked_for = asked.accidental_eccentricity > 0.0
    share = 100.0 * run.rules.accidental_eccentricity
    if not run.moved:
        said = f"; {clause} asks {100.0 * asked.accidental_eccentricity:g} % of the plan's sides"
        return f"Accidental eccentricity is not in these demands{said if asked_for else ''}."
    every = [data for each in run.moved.values() for data in each.values()]
    count, seconds = sum(d.sizes["run"] for d in every), float(every[0].attrs["seconds"])
    return (
        f"Accidental eccentricity ({clause}): the masses of all floors moved by {share:g} % of the "
        f"plan's sides each way, {count} time histories more in {seconds:.3g} s. The factor of the "
        "way that is worst multiplies what the suite gives; slip, rim force, eccentricity of the "
        "sliders' resultant and lost axial force, which begin at a threshold, grow by the "
        "difference."
    )
