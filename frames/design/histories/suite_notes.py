"""What the notes of checks say of runs: small gaps, doubts, what was left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.design.calculation.standing import OWN
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.histories.suite import motion_of, parted, peaks_of_runs

if TYPE_CHECKING:
    import xarray as xr

    from frames.design.calculation.check import Bound, Check


def contact_notes(data: xr.Dataset, least: float) -> str:
    """Return the runs in which bearings lifted off by no more than a gap [m], in words."""
    time, gap = peaks_of_runs(data, "time_lifted"), peaks_of_runs(data, "gap")
    small = (time > 0.0) & ~parted(data, least)
    words = [
        f"{motion_of(data, int(k))}: {1e3 * gap[k, small[k]].max():.2g} mm, "
        f"{time[k, small[k]].max():.3g} s"
        for k in np.flatnonzero(small.any(axis=1))
    ]
    if not words:
        return ""
    return f"gaps up to {1e3 * least:g} mm count as contact ({'; '.join(words)})"


def audit_notes(data: xr.Dataset) -> str:
    """Return what the assumption checks of runs mark, by motion."""
    doubts = [str(value) for value in data["doubts"].to_numpy()]
    return "; ".join(
        f"assumption check of {motion_of(data, k)}: {d}" for k, d in enumerate(doubts) if d
    )


def left_out_checks(
    data: xr.Dataset, doubts: list[str], bound: Bound, void: str = ""
) -> list[Check]:
    """Return the check that nothing that runs left out mattered; none where they left out nothing."""
    features = str(data.attrs.get("features_left_out", "none"))
    if features == "none":
        return []
    t = Trace()
    t.given(
        "n_spoilt",
        float(sum(" left out: " in d for d in doubts)),
        note="by their assumption checks",
    )
    t.given("n_allowed", 0.0)
    judge, title = (
        CheckBuilder(t, bound, OWN, void=void),
        "runs whose modelling assumptions are violated",
    )
    return [judge("no code: assumption check", title, "n_spoilt", "<=", "n_allowed", note=features)]
