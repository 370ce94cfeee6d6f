"""A part of the study that is one campaign under FEMA P695's far-field set."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from frames.risk.fragility.fitting import RESAMPLES
from validation.study.part import performed
from validation.study.records_runs import normalised

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    import xarray as xr

    from frames import GroundMotion
    from frames.risk import Campaign

    Motions = Mapping[str, GroundMotion]

RECORDS = "far-field"


def far_field(
    campaign: Callable[[Motions, Path], Campaign],
    found_of: Callable[[xr.Dataset, Motions, int], dict[str, Any]],
    store: Path,
    workers: int | str,
) -> dict[str, Any]:
    """Run a campaign of the far-field set, or go on with it, and return what is found."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    runs = campaign(motions, store)
    cost = performed(runs, workers)
    found = found_of(runs.results(), motions, RESAMPLES)
    return found | {"cost": cost, "records": len(motions)}
