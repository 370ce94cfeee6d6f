"""Loss, annual rates, spectral shape, floor spectra: writes docs/validation/study_loss.md.

    python -m validation.study.loss --store loss-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from frames.risk import open_campaign
from frames.risk.fragility.resampling import RESAMPLES
from validation.page import DPI, FOLDER
from validation.study.loss_figures import figures
from validation.study.loss_page import page
from validation.study.loss_runs import best_campaign, campaign, floor_spectra, floors_of, found_of
from validation.study.records import options_of, performed
from validation.study.records_runs import normalised
from validation.study.rounded import rounded, written

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

NAME = "study_loss"
RECORDS = "far-field"


def write(found: Mapping[str, Any], folder: Path = FOLDER) -> None:
    """Write the page, its figures, tables and the numbers."""
    for name, figure in figures(found).items():
        figure.savefig(folder / "figures" / name, dpi=DPI, metadata={"Software": None})
    (folder / f"{NAME}.md").write_text(page(found), encoding="utf-8")
    (folder / f"{NAME}.json").write_text(json.dumps(found) + "\n", encoding="utf-8")
    rates = [
        {"hazard": key, "device": name, "limit": limit}
        | dict(zip(("rate [1/year]", "low", "high"), row["rate"], strict=True))
        for key, each in found["rates"].items()
        for limit, rows in each.items()
        for name, row in rows.items()
    ]
    written(rates, folder / "tables" / f"{NAME}-rates.csv")
    losses = [
        {"device": name, "Sa(3 s) [m/s2]": im, "loss [-]": curve["mean"][k]}
        | {f"{part} [-]": values[k] for part, values in curve["parts"].items()}
        for name, curve in found["loss"]["curves"].items()
        for k, im in enumerate(found["loss"]["im"])
    ]
    written(losses, folder / "tables" / f"{NAME}-loss.csv")
    print(f"written to {folder}")


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaign, and write the page."""
    options = options_of("loss", given)
    if options.again:
        write(json.loads((FOLDER / f"{NAME}.json").read_text(encoding="utf-8")))
        return
    motions = normalised(MotionSet.fema_p695(RECORDS))
    with tempfile.TemporaryDirectory() as folder:
        store = options.store or Path(folder)
        costs = [
            performed(make(motions, store / name), options.workers)
            for name, make in (("runs", campaign), ("best", best_campaign))
        ]
        data = [open_campaign(store / name).results() for name in ("runs", "best")]
        cost = costs[-1] | {
            "runs": sum(each["runs"] for each in costs),
            "loop": sum(float(each["seconds_loop"].sum()) for each in data),
            "digests": [each["digest"] for each in costs],
        }
        floors = floors_of(floor_spectra(motions, store / "floors"))
        found = found_of(data, motions, RESAMPLES) | {"floors": floors, "cost": cost}
        write(rounded(found))


if __name__ == "__main__":
    main()
