"""Loss, annual rates, spectral shape, floor spectra: writes docs/validation/study_loss.md.

    python -m validation.study.loss --store loss-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from frames.risk import open_campaign
from frames.risk.fragility.fitting import RESAMPLES
from validation.study.loss_figures import figures
from validation.study.loss_page import page
from validation.study.loss_runs import best_campaign, campaign, floor_spectra, floors_of, found_of
from validation.study.part import performed, run_part, write_part
from validation.study.records_runs import normalised
from validation.study.rounded import csv_of, rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

NAME = "study_loss"
RECORDS = "far-field"


def write(found: Mapping[str, Any]) -> None:
    """Write the page, its figures, tables and the numbers."""
    rates = [
        {"hazard": key, "device": name, "limit": limit}
        | dict(zip(("rate [1/year]", "low", "high"), row["rate"], strict=True))
        for key, each in found["rates"].items()
        for limit, rows in each.items()
        for name, row in rows.items()
    ]
    losses = [
        {"device": name, "Sa(3 s) [m/s2]": im, "loss [-]": curve["mean"][k]}
        | {f"{part} [-]": values[k] for part, values in curve["parts"].items()}
        for name, curve in found["loss"]["curves"].items()
        for k, im in enumerate(found["loss"]["im"])
    ]
    tables = {f"{NAME}-rates.csv": csv_of(rates), f"{NAME}-loss.csv": csv_of(losses)}
    write_part(NAME, page(found), figures(found), found, tables)


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    costs = [
        performed(make(motions, store / name), workers)
        for name, make in (("runs", campaign), ("best", best_campaign))
    ]
    data = [open_campaign(store / name).results() for name in ("runs", "best")]
    cost = costs[-1] | {
        "runs": sum(each["runs"] for each in costs),
        "loop": sum(float(each["seconds_loop"].sum()) for each in data),
        "digests": [each["digest"] for each in costs],
    }
    floors = floors_of(floor_spectra(motions, store / "floors"))
    found: dict[str, Any] = rounded(
        found_of(data, motions, RESAMPLES) | {"floors": floors, "cost": cost}
    )
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("loss", given, run, write)


if __name__ == "__main__":
    main()
