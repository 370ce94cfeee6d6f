"""Exact paired tests of two structures under the same records, with a false-discovery rate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy.stats import binomtest, false_discovery_control

from frames.risk._errors import FragilityError
from frames.risk.fragility.limit_state import LimitState
from lir_element.argument_checks import require_between, require_choice

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from frames.risk.fragility.runs import IntensityRuns

ALL = np.inf
"""Scale of the row that counts a record once, over all its scales."""

BETTER, WORSE, ALIKE, FEW = "better", "worse", "not told apart", "too few differ"


def paired_tests(
    runs: Mapping[str, IntensityRuns],
    pairs: Sequence[tuple[str, str]],
    measures: Sequence[LimitState | str],
    rate: float = 0.1,
) -> pd.DataFrame:
    """Compare structures record by record, by exact two-sided sign tests.

    A record differs at a scale if one structure alone exceeds the limit state (McNemar's exact
    test), or if its demand is larger. The row of scale infinity counts each record once, by the
    structure that has more of its scales. So do several sets of parameters at one scale, and
    motions made of one record: turned, repeated, without their vertical component.

    Parameters
    ----------
    runs : mapping of str to IntensityRuns
        Runs by structure, under the same motions at the same scales.
    pairs : sequence of tuple of str
        The structure that is tested, and the one it is tested against.
    measures : sequence of LimitState or str
        Limit states, or quantities of `frames.peaks`, whose demand is compared.
    rate : float
        False-discovery rate [-] of the verdicts, 0 to 1.

    Returns
    -------
    pandas.DataFrame
        A row a measure, pair and scale: "measure", "own", "over", "scale", "records" (known of
        both). "more" and "less": records in which "own" alone exceeds, or has the larger, or
        smaller, demand. "p", "q" (p adjusted for its family) and "verdict" on "own": "better" or
        "worse" if q is at most `rate`, else "not told apart", or "too few differ".

    Raises
    ------
    FragilityError
        If a structure is not in `runs`, or `rate` is out of its bounds.

    Notes
    -----
    Rows of one scale are one family, rows of all scales another one: each has the false-discovery
    rate of Benjamini and Hochberg (1995). Rows in which so few records differ that no outcome has a
    p of `rate` are left out of the family (Tarone 1990; Gilbert 2005). Tests of one campaign share
    records; the rate holds for tests that depend positively on each other.

    Examples
    --------
    In the how-to: "How to compute fragility and risk" (docs/fragility.md).
    """
    require_between("rate", rate, 0.0, 1.0, error=FragilityError)
    for name in {name for pair in pairs for name in pair}:
        require_choice("structure", name, tuple(runs), error=FragilityError)
    rows = [
        {"measure": getattr(measure, "name", measure), "own": own, "over": other} | row
        for measure in measures
        for own, other in pairs
        for row in _counted(_scores(runs[own], measure), _scores(runs[other], measure))
    ]
    found = pd.DataFrame(rows)
    whole = found["scale"] == ALL
    for family in (whole, ~whole):
        _decide(found, family.to_numpy(), rate)
    return found


def _scores(runs: IntensityRuns, measure: LimitState | str) -> pd.Series[float]:
    # Exceedance or demand by record, motion, scale, and number of the set of parameters.
    score = runs.exceeded(measure) if isinstance(measure, LimitState) else runs.demand(measure)
    keys = pd.DataFrame({"record": runs.records, "motion": runs.of("motion")})
    keys["scale"] = runs.of("scale")
    keys["set"] = keys.groupby(["motion", "scale"]).cumcount()
    return pd.Series(score, pd.MultiIndex.from_frame(keys))


def _counted(own: pd.Series[float], other: pd.Series[float]) -> Iterator[dict[str, float]]:
    # A row a scale and one of all; two failed bearings count as equal.
    both = pd.concat([own, other], axis=1, join="inner").dropna()
    more = (both[0] > both[1]).astype(int) - (both[0] < both[1]).astype(int)
    for scale, signs in more.groupby(level="scale"):
        yield _row(float(scale), signs)
    yield _row(ALL, more)


def _row(scale: float, signs: pd.Series[int]) -> dict[str, float]:
    # A record counts once.
    found = signs.groupby(level="record").sum()
    more, less = int((found > 0).sum()), int((found < 0).sum())
    p = binomtest(more, more + less).pvalue if more + less else 1.0
    return {"scale": scale, "records": len(found), "more": more, "less": less, "p": float(p)}


def _decide(found: pd.DataFrame, family: np.ndarray, rate: float) -> None:
    # Writes q and verdict of the rows of a family.
    differ = found["more"] + found["less"]
    able = family & (0.5 ** (differ - 1.0) <= rate).to_numpy()
    found.loc[family, "q"] = np.nan
    found.loc[family, "verdict"] = FEW
    if not able.any():
        return
    found.loc[able, "q"] = false_discovery_control(found.loc[able, "p"])
    side = np.where(found["more"] < found["less"], BETTER, WORSE)
    found.loc[able, "verdict"] = np.where(found["q"] <= rate, side, ALIKE)[able]
