"""Fragility of runs: the fit that belongs to how they were made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from frames._errors import FragilityError
from frames.fragility.cloud_fit import fit_cloud
from frames.fragility.fitting import fit_capacities, fit_stripes
from frames.fragility.incremental import IDA
from frames.fragility.limit_state import LimitState
from frames.fragility.resampling import RESAMPLES
from frames.fragility.runs import IntensityRuns
from lir_element.door import require_choice, require_type

if TYPE_CHECKING:
    from frames.fragility.curve import CollapseFragility, Fragility


def fragility_of(
    runs: IDA | IntensityRuns,
    limit: LimitState,
    *,
    method: Literal["capacities", "stripes", "cloud"] | None = None,
    resamples: int = RESAMPLES,
    seed: int = 1,
) -> Fragility | CollapseFragility:
    """Return the fragility of a structure against a limit state.

    Parameters
    ----------
    runs : IDA or IntensityRuns
        Of `ida`, `multiple_stripes`, `cloud_analysis`, or read from `time_histories`.
    limit : LimitState
        The limit state.
    method : {"capacities", "stripes", "cloud"}, optional
        `fit_capacities` (an IDA, by default), `fit_stripes` (other runs, by default: whether each
        exceeds the limit), or `fit_cloud` (a regression of the demands, which takes few runs but
        trusts in its line).
    resamples, seed : int
        Resamples of the records for the bands, and their seed.

    Returns
    -------
    Fragility or CollapseFragility
        The curve; of five parameters for a cloud with failures of bearings.

    Raises
    ------
    FragilityError
        If the runs do not determine a curve, or do not suit the method.
    ImportError
        If the method needs the package `pyFragility` (extra "fragility") and it is not installed.
    """
    require_type("runs", runs, (IDA, IntensityRuns), "an IDA or IntensityRuns")
    require_type("limit", limit, LimitState, "a LimitState")
    is_ida = isinstance(runs, IDA)
    chosen = method or ("capacities" if is_ida else "stripes")
    require_choice("method", chosen, ("capacities", "stripes", "cloud"), error=FragilityError)
    each = runs.runs if isinstance(runs, IDA) else runs
    records = [str(name) for name in each.table["motion"]]
    im, name, unit = each.table["im"].to_numpy(), limit.name, each.intensity.unit
    if chosen == "capacities":
        if not isinstance(runs, IDA):
            msg = "capacities are of an IDA: run frames.ida, or take method='stripes'"
            raise FragilityError(msg)
        found = runs.capacities(limit)
        return fit_capacities(
            found["capacity"].to_numpy(), list(found.index), censored=found["censored"].to_numpy(),
            name=name, unit=unit, resamples=resamples, seed=seed,
        )  # fmt: skip
    if chosen == "stripes":
        return fit_stripes(
            im, each.exceeded(limit), records, name=name, unit=unit, resamples=resamples, seed=seed
        )
    if limit.quantity is None or limit.limit is None:
        msg = f"{limit.name} has no demand to regress: take method='stripes'"
        raise FragilityError(msg)
    return fit_cloud(
        im, each.demand(limit.quantity), limit.limit, records,
        name=name, unit=unit, resamples=resamples, seed=seed,
    )  # fmt: skip
