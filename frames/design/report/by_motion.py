"""What each motion gave, in a report: the values that means are taken of, in parts of a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.report.columns import in_parts
from frames.design.report.page import Table, page_table
from frames.design.report.tables import in_mm_and_kn

if TYPE_CHECKING:
    import pandas as pd

BY_MOTION = "demands-by-motion"
"""Name of the table of what each motion gave."""


def motion_tables(table: pd.DataFrame) -> list[Table]:
    """Return the columns that means are taken of, a row a run, in parts that fit a page."""
    keys = ["motion", "bound"]
    for key, usual in (("level", None), ("masses moved", ""), ("scale", 1.0), ("failed", "no")):
        values = table[key]
        if values.nunique() > 1 or (usual is not None and (values != usual).any()):
            keys.append(key)
    values = [
        title for title in table.columns if "[" in title and not title.partition(", farthest")[1]
    ]
    shown = in_mm_and_kn(table[[*keys, *values]].set_index("motion"))
    return in_parts(page_table(shown, "motion"), keep=len(keys))
