"""Own numbers and figures of the part on loss: hazards, annual rates, shape of spectra."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.risk import Intensity, RiskWarning, expected_loss, mean_annual_frequency
from frames.risk.campaign.file import loss_in
from frames.risk.campaign.page import loss_curves
from frames.risk.campaign.tables import CONFIDENCE
from validation.study.capacities import bounds_of, draws, fitted
from validation.study.capacities import interval as ends_of
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from matplotlib.figure import Figure

    from frames.risk import HazardCurve
    from frames.risk.campaign.tables import CampaignTables

    Own = Mapping[str, Any]

OURS = "LIR-DCFP"
STRUCTURE = "B.10.35.001"
"""The component whose repair is most of what devices differ by."""

PERIODS = np.geomspace(0.6, 4.5, 10)
"""Of the average spectrum [s]: 0.2 to 1.5 times 3 s, where the records are usable."""

MEASURES = {
    "Sa(3 s)": Intensity(kind="Sa", period=3.0),
    "Sa(2 s)": Intensity(kind="Sa", period=2.0),
    "Sa_avg(0.6 to 4.5 s)": Intensity(kind="Sa_avg", periods=PERIODS.tolist()),
    "PGV": Intensity(kind="PGV"),
    "PGA": Intensity(kind="PGA"),
}
TARGET = float(np.sqrt(PERIODS[0] * PERIODS[-1]) / 3.0)
"""Sa(3 s) over the average of a spectrum that falls as 1 / T, as codes have it [-]."""

DRAWS = 300
ABOVE, BELOW, NEITHER = "higher", "lower", "not told apart"


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return losses and rates by hazard, and what the shape of spectra does to collapse."""
    tables = every["loss"]
    assert tables.comparison is not None
    at = tables.comparison.considered or 0.0
    given: Any = loss_in(tables.file)
    others = [each for each in given.components if each.name != STRUCTURE]
    less = given._asdict() | {"components": others, "confidence": CONFIDENCE}
    return {
        "annual": losses(tables.annual_loss),
        "without": losses(expected_loss(tables.data, tables.runs, **less).annual),
        "rates": {name: rates(tables, each) for name, each in given.hazard.items()},
        "shape": shape(tables, at),
        "components": [
            [each.name, each.damaged_by, list(each.medians), list(each.costs), each.quantity[0]]
            for each in given.components
        ],
        "hazards": {name: hazard_points(each, at) for name, each in given.hazard.items()},
    }


def hazard_points(hazard: HazardCurve, at: float) -> dict[str, float]:
    """Return intensities of 475 and 2,475 years [m/s2], the slope, the return period of one."""
    log_im, log_rate = np.log(hazard.im), np.log(hazard.rate)
    often, rare = np.exp(np.interp(np.log([475.0, 2475.0]), -log_rate, log_im)).tolist()
    slope = float(np.log(2475.0 / 475.0) / np.log(rare / often))
    period = 1.0 / float(hazard.rates(at))
    return {"475 years": often, "2475 years": rare, "slope": slope, "period": period}


def losses(annual: pd.DataFrame) -> dict[str, dict[str, Any]]:
    """Return the loss a year of each hazard and device with its interval, parts and ratio."""
    found: dict[str, dict[str, Any]] = {}
    for _, row in annual.iterrows():
        found.setdefault(str(row["hazard"]), {})[str(row["structure"])] = {
            "loss": [row[f"loss{end} [1/year]"] for end in ("", ", low", ", high")],
            "ratio": None
            if np.isnan(row["ratio [-]"])
            else [row[f"ratio{end} [-]"] for end in ("", ", low", ", high")],
            "collapse": row["collapse [1/year]"] / row["loss [1/year]"],
            "beyond": [row["below [-]"], row["above [-]"]],
        }
    return found


def rates(tables: CampaignTables, hazard: HazardCurve) -> dict[str, dict[str, Any]]:
    """Return annual rates of limit states by device, with the ratio of the first over it."""
    found: dict[str, dict[str, Any]] = {}
    for limit, curves in tables.curves.items():
        with warnings.catch_warnings(action="ignore", category=RiskWarning):
            risks = {name: mean_annual_frequency(c, hazard) for name, c in curves.items()}
        own = risks.get(OURS)
        found[limit] = {}
        for name, risk in risks.items():
            row: dict[str, Any] = {"rate": [risk.rate, *risk.interval(CONFIDENCE)], "ratio": None}
            if own is not None and name != OURS:
                again = ends_of((own.resampled / risk.resampled).tolist())
                row["ratio"] = [own.rate / risk.rate, *again]
            found[limit][name] = row
    return found


def shape(tables: CampaignTables, at: float) -> dict[str, Any]:
    """Return what the shape of spectra does to collapse, and how efficient measures are."""
    motions = tables.campaign.motions
    values = {
        name: np.array([measure.of(each) for each in motions.values()])
        for name, measure in MEASURES.items()
    }
    ratio = values["Sa(3 s)"] / values["Sa_avg(0.6 to 4.5 s)"]
    x, drawn, target = np.log(ratio), draws(len(motions), DRAWS), float(np.log(TARGET))
    lines, margins, efficiency = {}, {}, {}
    assert tables.comparison is not None
    for name, each in tables.runs.items():
        bounds = bounds_of(each, tables.comparison.collapse, list(motions))
        line, again = fitted(bounds, x), [fitted(bounds[rows], x[rows]) for rows in drawn]
        margins[name] = np.array([other.median(target) for other in again]) / at
        lines[name] = {
            "slope": [line.slope, *ends_of([other.slope for other in again])],
            "dispersions": [fitted(bounds).dispersion, line.dispersion],
            "margin": [line.median() / at, *ends_of([o.median() / at for o in again])],
            "corrected": [line.median(target) / at, *ends_of(margins[name].tolist())],
        }
        efficiency[name] = {
            measure: fitted(bounds * sizes[:, None]).dispersion for measure, sizes in values.items()
        }
    ratios = {
        name: [
            lines[OURS]["corrected"][0] / lines[name]["corrected"][0],
            *ends_of((margins[OURS] / each).tolist()),
        ]
        for name, each in margins.items()
        if name != OURS
    }
    middle = float(np.median(ratio))
    return {"median": middle, "lines": lines, "ratios": ratios, "efficiency": efficiency}


def told(ratio: list[float] | None) -> str:
    """Return a ratio with its interval, and on which side of 1 the interval lies."""
    if ratio is None:
        return "-"
    side = ABOVE if ratio[1] > 1.0 else BELOW if ratio[2] < 1.0 else NEITHER
    return f"{with_interval(ratio)}, {side}"


def figures(campaigns: Mapping[str, Any], own: Own) -> dict[str, Figure]:
    """Return expected losses over the intensity."""
    del own
    each = campaigns["loss"]
    return {"loss": loss_curves(each["tables"]["loss"], each["axis"])}
