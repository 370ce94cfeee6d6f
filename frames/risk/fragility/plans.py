"""How the intensities of runs were chosen, which decides what may be fitted to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.risk._errors import FragilityError

if TYPE_CHECKING:
    import pandas as pd

STRIPES, CLOUD, HUNT, GIVEN = "stripes", "cloud", "hunt", "given"
"""Plans of runs: intensities that are common to the motions; factors on them; intensities that
followed from the outcomes of the runs before; and others, of which nothing is known."""

PLAN = "plan"
"""Column of a table of runs that holds their plan, so that every part of the table keeps it."""


def plans_of(table: pd.DataFrame) -> list[str]:
    """Return the plan of each run of a table, "given" where the table does not tell."""
    if PLAN not in table.columns:
        return [GIVEN] * len(table)
    found = [str(each) for each in table[PLAN].fillna(GIVEN)]
    unknown = sorted({*found} - {STRIPES, CLOUD, HUNT, GIVEN})
    if unknown:
        msg = f"plan = {unknown[0]!r}: choose one of {STRIPES}, {CLOUD}, {HUNT}, {GIVEN}"
        raise FragilityError(msg)
    return found


def require_beforehand(table: pd.DataFrame, method: str) -> None:
    """Refuse runs whose intensities were chosen by their outcome."""
    hunted = plans_of(table).count(HUNT)
    if hunted:
        msg = (
            f"method = {method!r}: the intensities of {hunted} of {len(table)} runs were chosen by "
            "the outcome of the runs before (hunt and fill): motions that exceed the limit early "
            "have no runs above it, which biases such a curve (of a known truth, stripes gave a "
            "median 20 to 30 % too high and up to twice the dispersion). Take "
            "method='capacities', or run frames.multiple_stripes"
        )
        raise FragilityError(msg)
