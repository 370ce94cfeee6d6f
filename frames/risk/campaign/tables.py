"""Tables of a campaign, made once: its page, its CSV files and the study show the same ones."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.design.hazard.motion_set import facts_of
from frames.design.project.inputs import in_section
from frames.risk._errors import FragilityError
from frames.risk.campaign.ductility import with_ductility
from frames.risk.campaign.file import (
    comparison_in,
    distributions_in,
    fragility_in,
    loss_in,
    models_in,
    scaled_to,
)
from frames.risk.campaign.indices import index_table
from frames.risk.campaign.loss import expected_loss
from frames.risk.campaign.plot_response import failure_table, response_table, runs_by_model
from frames.risk.fragility.of_runs import fragility_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.frame import Frame
    from frames.risk.campaign.campaign import Campaign
    from frames.risk.campaign.file_schema import CampaignFile
    from frames.risk.campaign.loss import ExpectedLoss
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.intensity import Intensity
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns

CONFIDENCE = 0.9
"""Confidence of intervals [-]."""

ALL_RECORDS = "all"
"""All sets of records together."""

FILES = (
    "response",
    "failures",
    "fragility",
    "devices",
    "ratios",
    "margins",
    "tests",
    "loss",
    "annual_loss",
    "indices",
)
"""Tables that are written as CSV, in SI units, by their names."""


class CampaignTables:
    """Tables of a campaign's complete runs, by its file; each is made on first use."""

    def __init__(self, campaign: Campaign, file: CampaignFile) -> None:
        self.campaign, self.file = campaign, file
        asked, scaled = fragility_in(file), scaled_to(file)
        self.comparison, self._loss = comparison_in(file), loss_in(file)
        self.limits: list[LimitState] = [] if asked is None else asked.limits()
        if self.comparison is not None:
            self.limits.append(self.comparison.collapse)
        self.intensity = file.measured()
        self.axis = "factor on the motions"
        if scaled is not None:
            self.axis = f"{scaled.label} [{scaled.unit}]"

    def all(self) -> dict[str, pd.DataFrame]:
        """Return the tables that there are, by the names of `FILES`."""
        found = {name: getattr(self, name) for name in FILES}
        return {name: table for name, table in found.items() if len(table) or name in FILES[:2]}

    @cached_property
    def data(self) -> xr.Dataset:
        """The results."""
        return self.campaign.results()

    @cached_property
    def by_factor(self) -> dict[str, IntensityRuns]:
        """Runs by structure, over the factor on the motions."""
        return self._over(None)

    @cached_property
    def runs(self) -> dict[str, IntensityRuns]:
        """The same over the measure of the curves, with the ductility of hinges if needed."""
        return self.by_factor if self.intensity is None else self._over(self.intensity)

    def _over(self, intensity: Intensity | None) -> dict[str, IntensityRuns]:
        found = runs_by_model(self.data, self.campaign.motions, intensity)
        return with_ductility(found, self.data, lambda: self.frames, self.limits)

    @cached_property
    def frames(self) -> Mapping[str, Frame]:
        """The structures on their devices."""
        return models_in(self.file) if self.comparison is None else self.comparison.frames

    @cached_property
    def sets(self) -> dict[str, tuple[str, ...]]:
        """Names of the motions: all, and of each set of records if there are several."""
        motions = self.campaign.motions
        found = {ALL_RECORDS: list(motions)}
        if len(self.file.motions.fema_p695) > 1:
            for name, facts in facts_of(motions).items():
                found.setdefault(str(facts["set"]), []).append(name)
        return {kind: tuple(names) for kind, names in found.items()}

    def _of_set(self, records: str) -> dict[str, IntensityRuns]:
        if records == ALL_RECORDS:
            return self.runs
        names = self.sets[records]
        return {
            name: each.those(np.isin(each.of("motion").astype(str), names))
            for name, each in self.runs.items()
        }

    @cached_property
    def _fitted(self) -> dict[str, tuple[dict[str, dict[str, Fragility]], pd.DataFrame]]:
        # By set of records.
        return {records: _fitted(self._of_set(records), self.limits) for records in self.sets}

    @property
    def curves(self) -> dict[str, dict[str, Fragility]]:
        """Curves by limit state and structure, of all records."""
        return self._fitted[ALL_RECORDS][0]

    @cached_property
    def fragility(self) -> pd.DataFrame:
        """A row a structure and limit state; "no curve" has the reason if there is none."""
        return self._by_set(lambda records: self._fitted[records][1])

    def _by_set(self, make: Callable[[str], pd.DataFrame]) -> pd.DataFrame:
        # Tables of each set of records below each other, with its name if there are several.
        parts = {records: make(records) for records in self.sets}
        if len(parts) == 1:
            return parts[ALL_RECORDS]
        for records, table in parts.items():
            if len(table):
                table.insert(0, "record set", records)
        unnamed = parts[ALL_RECORDS].index.name is None
        return pd.concat(parts.values(), ignore_index=unnamed)

    @cached_property
    def response(self) -> pd.DataFrame:
        """Fractiles of the results, a row a structure and factor on the motions."""
        return response_table(self.by_factor)

    @cached_property
    def failures(self) -> pd.DataFrame:
        """Runs that did not go to their end, a row a structure and cause."""
        return failure_table(self.by_factor)

    @cached_property
    def devices(self) -> pd.DataFrame:
        """Sizes, a row a device; empty if none are compared."""
        if self.comparison is None:
            return pd.DataFrame()
        return self.comparison.sizes(self.runs)

    @cached_property
    def tests(self) -> pd.DataFrame:
        """Exact tests of the LIR-DCFP against others; empty if none are compared."""
        return self._by_set(lambda records: self._tests[records].copy())

    @cached_property
    def _tests(self) -> dict[str, pd.DataFrame]:
        own = self.comparison
        if own is None:
            return dict.fromkeys(self.sets, pd.DataFrame())
        return {records: own.tests(self._of_set(records), self.limits) for records in self.sets}

    @cached_property
    def ratios(self) -> pd.DataFrame:
        """Medians of the LIR-DCFP over those of others; empty if none are compared."""
        own = self.comparison
        if own is None:
            return pd.DataFrame()

        def made(records: str) -> pd.DataFrame:
            curves = self._fitted[records][0]
            return own.ratios(curves, self.limits, self._tests[records], CONFIDENCE)

        return self._by_set(made)

    @cached_property
    def margins(self) -> pd.DataFrame:
        """Collapse, a row a device; empty if none are compared."""
        own = self.comparison
        if own is None:
            return pd.DataFrame()
        name = own.collapse.name

        def made(records: str) -> pd.DataFrame:
            curves, table = self._fitted[records]
            rows = table[table["limit state"] == name]
            why = dict(zip(rows["structure"], rows["no curve"], strict=True))
            return own.margins(self._of_set(records), curves.get(name, {}), why, CONFIDENCE)

        return self._by_set(made)

    @cached_property
    def _losses(self) -> ExpectedLoss | None:
        if self._loss is None:
            return None
        told = self._loss._asdict() | {"confidence": CONFIDENCE}
        return in_section("loss", lambda: expected_loss(self.data, self.runs, **told))

    @property
    def loss(self) -> pd.DataFrame:
        """Expected loss, a row a structure and intensity; empty without a table of components."""
        return pd.DataFrame() if self._losses is None else self._losses.curves

    @property
    def annual_loss(self) -> pd.DataFrame:
        """Expected loss a year, a row a structure; empty without a table of components."""
        return pd.DataFrame() if self._losses is None else self._losses.annual

    @cached_property
    def indices(self) -> pd.DataFrame:
        """Sobol' indices, a row a parameter; empty unless Saltelli's sets were drawn."""
        sample = self.file.sample
        if sample is None or sample.kind != "saltelli" or sample.size is None:
            return pd.DataFrame()
        given = distributions_in(self.file)
        return index_table(self.data, given, samples=sample.size, seed=sample.seed)

    @cached_property
    def plan(self) -> pd.DataFrame:
        """Description of the runs, in words: a row a property."""
        return _planned(self.campaign, self.data, self.axis)


def _fitted(
    models: Mapping[str, IntensityRuns], limits: list[LimitState]
) -> tuple[dict[str, dict[str, Fragility]], pd.DataFrame]:
    # Curves by limit state and structure, and their table; without a curve it has the reason.
    found: dict[str, dict[str, Fragility]] = {}
    rows: list[dict[str, object]] = []
    for limit in limits:
        for name, runs in models.items():
            row: dict[str, object] = {"structure": name, "limit state": limit.name}
            row |= {"exceeded": np.nan, "known": np.nan}
            rows.append(row)
            try:
                over = runs.exceeded(limit)
                known = ~np.isnan(over)
                row |= {"exceeded": int(over[known].sum()), "known": int(known.sum())}
                curve: Any = fragility_of(runs, limit, method="stripes")
            except (FragilityError, ImportError) as cause:
                row["no curve"] = str(cause)
                continue
            found.setdefault(limit.name, {})[name] = curve
            interval = curve.interval(CONFIDENCE)
            for number, unit in (("median", curve.unit), ("dispersion", "-")):
                for end, word in (("value", ""), ("low", ", low"), ("high", ", high")):
                    row[f"{number}{word} [{unit}]"] = float(interval.loc[number, end])
            row["no curve"] = ""
    return found, pd.DataFrame(rows)


def _planned(campaign: Campaign, data: xr.Dataset, axis: str) -> pd.DataFrame:
    # Description of the runs, in words.
    plan: dict[str, Any] = campaign.store.plan()
    rows = {
        "structures": ", ".join(plan["models"]),
        "motions": f"{len(plan['motions'])}: {', '.join(plan['motions'])}",
        axis: ", ".join(f"{scale:g}" for scale in plan["scales"]),
    }
    for name in plan["parameters"]:
        values = np.unique(data[name].to_numpy())
        rows[f"parameter {name}"] = (
            f"{len(values)} values, {values[0]:.4g} to {values[-1]:.4g} (SI)"
        )
    if sample := plan["provenance"].get("sample"):
        rows["sets of parameters"] = f"{campaign.sets}, {sample}"
    options = plan["options"]
    rows["level of fidelity"] = str(options["level"])
    for word, key in (("step [s]", "dt"), ("duration [s]", "duration")):
        if options[key] is not None:
            rows[word] = f"{options[key]:g}"
    rows["runs"] = f"{plan['runs']}, in batches of {plan['batch']}"
    rows["begun with"] = f"lir-dcfp {plan['program']}"
    return pd.DataFrame({"what was run": rows})
