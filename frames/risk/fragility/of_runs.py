"""Fragility of runs: the fit that belongs to how they were made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from frames.risk._errors import FragilityError
from frames.risk.fragility.cloud_fit import fit_cloud
from frames.risk.fragility.fitting import RESAMPLES, fit_capacities, fit_stripes
from frames.risk.fragility.incremental import IDA, capacities_of
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.runs import CLOUD, HUNT, IntensityRuns
from lir_element.argument_checks import require_choice, require_type

if TYPE_CHECKING:
    from frames.risk.fragility.curve import CollapseFragility, Fragility


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
        Runs of `ida`, `multiple_stripes`, `cloud_analysis`, or read from `time_histories`.
    limit : LimitState
        The limit state.
    method : {"capacities", "stripes", "cloud"}, optional
        `fit_capacities`: default for an IDA and its runs. `fit_cloud`: default for `cloud_analysis`
        if the limit state has a demand; a regression, which needs few runs but assumes a line.
        `fit_stripes`: default for other runs, by the exceedance of the limit in each. Runs of an
        IDA have capacities alone: their intensities were chosen by their outcome, which biases both
        other fits.
    resamples, seed : int
        Resamples of the records for the bands, and their seed.

    Returns
    -------
    Fragility or CollapseFragility
        The curve; of five parameters for a cloud with failures of bearings.

    Raises
    ------
    FragilityError
        If the runs do not determine a curve, or do not suit the method; the column "plan" of their
        table marks runs that were chosen by their outcome.
    ImportError
        If the method needs the package `pyFragility` (extra "fragility") and it is not installed.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Intensity, LimitState, cloud_analysis, fragility_of
    >>> frame, pulse = example(1.0)
    >>> intensity = Intensity(kind="PGA", measure="x")
    >>> motions = {f"pulse {k}": pulse.scaled(1.0 + 0.05 * k) for k in range(4)}
    >>> runs = cloud_analysis(frame, motions, intensity=intensity, scales=(0.8, 1.2), workers=1)
    >>> limit = LimitState("far", "bearing displacement", 0.05)
    >>> curve = fragility_of(runs, limit, resamples=20)
    >>> 0.5 < curve.median < 2.0
    True
    """
    require_type("runs", runs, (IDA, IntensityRuns), "an IDA or IntensityRuns")
    require_type("limit", limit, LimitState, "a LimitState")
    each = runs.runs if isinstance(runs, IDA) else runs
    plans = [HUNT] * len(each.table) if isinstance(runs, IDA) else each.of("plan").tolist()
    chosen = method or _usual({*plans}, limit)
    require_choice("method", chosen, ("capacities", "stripes", "cloud"), error=FragilityError)
    common: dict[str, Any] = {
        "name": limit.name,
        "intensity": each.intensity,
        "resamples": resamples,
        "seed": seed,
    }
    if chosen == "capacities":
        if HUNT not in plans:
            msg = "capacities are of an IDA: run frames.risk.ida, or use method='stripes'"
            raise FragilityError(msg)
        found = capacities_of(each, limit)
        at, censored = found["capacity"].to_numpy(), found["censored"].to_numpy()
        return fit_capacities(at, list(found.index), censored=censored, **common)
    _require_beforehand(plans, chosen)
    im, records = each.of("im"), each.records
    if chosen == "stripes":
        return fit_stripes(im, each.exceeded(limit), records, **common)
    if limit.quantity is None or limit.limit is None:
        msg = f"{limit.name} has no demand to regress: use method='stripes'"
        raise FragilityError(msg)
    return fit_cloud(im, each.demand(limit.quantity), limit.limit, records, **common)


def _require_beforehand(plans: list[str], method: str) -> None:
    # Refuse runs whose intensities were chosen by their outcome.
    hunted = plans.count(HUNT)
    if hunted:
        msg = (
            f"method = {method!r} would be biased: intensities of {hunted} of {len(plans)} runs "
            "were chosen by outcomes (hunt and fill). Use method='capacities', or multiple_stripes"
        )
        raise FragilityError(msg)


def _usual(plans: set[str], limit: LimitState) -> Literal["capacities", "stripes", "cloud"]:
    # The fit that belongs to a plan.
    if HUNT in plans:
        return "capacities"
    return "cloud" if plans == {CLOUD} and limit.quantity is not None else "stripes"
