"""Own numbers of the part on rims: in how many runs a rim yields."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from validation.study.steps import checked, checks_said  # noqa: F401  (of the template)

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

    from frames.risk.campaign.tables import CampaignTables

PLANS = {"smaller": "Smaller plan", "larger": "Larger plan"}


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return the share of runs in which a rim yields, by file and device [-]."""
    return {
        name: {"bent": _bent(tables), "checks": checked(tables)} for name, tables in every.items()
    }


def _bent(tables: CampaignTables) -> dict[str, float]:
    yields = tables.data["peak_rim_plastic"].max("bearing") > 0.0
    return {str(name): float(own.mean()) for name, own in yields.groupby("model")}


def conclusion(campaigns: Mapping[str, Any]) -> str:
    """Return where the best LIR-DCFP of a plan is ahead of a DCFP of the same plan, by limit."""
    words: dict[str, list[pd.Series[Any]]] = {}
    for told in campaigns.values():
        for _, row in told["tables"]["ratios"].iterrows():
            words.setdefault(str(row["limit state"]), []).append(row)
    parts = []
    for limit, rows in words.items():
        known = [float(row["ratio [-]"]) for row in rows if row["ratio [-]"] > 0.0]
        better = sum(row["verdict"] == "better" for row in rows)
        worse = sum(row["verdict"] == "worse" for row in rows)
        span = f" (median over median {min(known):.2f} to {max(known):.2f})" if known else ""
        parts.append(f"{limit} better in {better}, worse in {worse} of {len(rows)}{span}")
    return "; ".join(parts)
