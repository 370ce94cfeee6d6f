"""Recompute numbers of the study's pages from its archives, by numpy, scipy and zarr alone.

    python -m validation.study.recompute ARCHIVES [PAGES]

ARCHIVES is the folder of `python -m validation.study --archive ARCHIVES --store STORE`. Of two devices
of each campaign: runs that exceed a limit state, failed bearings, medians; their ratio, the exact p.
How far they are from the page's is written to its tables/recomputed.csv. The peak velocity of a sampled
pulse is 0.01 % off its nominal one, which is computed with here.
"""

from __future__ import annotations

import csv
import io
import math
import re
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from scipy import optimize, stats

TABLE = "tables/recomputed.csv"
FAILED, DRIFT = "bearing failure", ("storey drift 2 %", "storey drift, mean", 0.02)
LIMITS = {"study_buildings": DRIFT, "study_near_fault": DRIFT}
"""Limit state, quantity and limit of parts that have other members, or another collapse."""


def at_yield() -> dict[str, float]:
    """Return the rotation M L / (6 E I) at which columns and beams yield [rad]."""
    b, h, w, flange, web = 0.3, 0.4, 0.18, 0.0135, 0.0086  # box 300 x 16, I 400 x 180 mm
    inner, core = b - 2.0 * 0.016, h - 2.0 * flange
    plastic = w * flange * (h - flange) + web * core**2 / 4.0
    column = 3.5 * (b**3 - inner**3) / 4.0 / ((b**4 - inner**4) / 12.0)
    beam = 6.0 * plastic / ((w * h**3 - (w - web) * core**3) / 12.0)
    return {"column": column * 345e6 / 1.2e12, "beam": beam * 345e6 / 1.2e12}  # E 200 GPa


def exceeded(folder: Path, runs: dict[str, Any], part: str) -> Any:
    """Return 1 or 0 of each run, with failed bearings as 1; NaN if its analysis failed."""
    if part in LIMITS:
        over = runs[LIMITS[part][1]].astype(float) > LIMITS[part][2]
    else:
        data: Any = zarr.open_group(folder / "results.zarr", mode="r")
        yields = [at_yield()[str(name).split("-")[0]] for name in data["hinge"][:]]
        over = 1.0 + (data["peak_hinge_rotation"][:] / yields).max(axis=1) > 9.0
    known = np.isin(runs["outcome"], ("complete", FAILED))
    return np.where(known, (over | (runs["outcome"] == FAILED)).astype(float), np.nan)


def median(im: Any, over: Any) -> float:
    """Return the median of a lognormal curve by maximum likelihood."""
    x, sign = np.log(im), 2.0 * over - 1.0

    def unlikely(p: Any) -> Any:
        return -stats.norm.logcdf(sign * (x - p[0]) / math.exp(p[1])).sum()

    rules: Any = {"xatol": 1e-9, "fatol": 1e-12}
    start = np.array([x.mean(), -1.0])
    found: Any = optimize.minimize(unlikely, start, method="Nelder-Mead", options=rules)
    return math.exp(found.x[0])


def exact(own: dict[Any, float], other: dict[Any, float]) -> float:
    """Return p of the exact two-sided sign test: a record counts once, by the sum of its signs."""
    signs: dict[str, float] = {}
    for key in own.keys() & other.keys():
        record = re.sub(r", (\d+ degrees|then .*|horizontal)$", "", key[0])
        signs[record] = signs.get(record, 0.0) + own[key] - other[key]
    more, less = (sum(way * sign > 0.0 for sign in signs.values()) for way in (1, -1))
    return float(stats.binomtest(more, max(more + less, 1)).pvalue)


def table_of(path: str | Path, **chosen: str) -> list[dict[str, str]]:
    """Return rows of a table with these values, of all records together."""
    wanted = {"record set": "all"} | {key.replace("_", " "): v for key, v in chosen.items()}
    rows = csv.DictReader(io.StringIO(Path(path).read_text(encoding="utf-8"), newline=""))
    return [row for row in rows if all(row.get(key, v) == v for key, v in wanted.items())]


def numbers(path: Path, part: str, start: str) -> list[tuple[str, str, float]]:
    """Return numbers of a campaign: text, as on the page, recomputed."""
    rows, limit = table_of(path), LIMITS.get(part, ("collapse",))[0]
    runs = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    over = exceeded(path.parent, runs, part)
    row, found = table_of(f"{start}-ratios.csv", limit_state=limit)[0], []
    failed = (runs["outcome"] == FAILED) | (runs["status"] == "bearing_lost")
    medians, scores = [], []
    several = len({*runs["scale"]}) > 1  # one intensity, apart by rounding, has no median
    for name in (row["own"], row["over"]):
        own = (runs["model"] == name) & ~np.isnan(over)
        of = [runs[key][own] for key in ("motion", "scale", "parameter_set") if key in runs]
        scores.append(dict(zip(zip(*of, strict=True), over[own], strict=True)))
        curve = table_of(f"{start}-fragility.csv", structure=name, limit_state=limit)[0]
        margin = table_of(f"{start}-margins.csv", device=name)[0]
        found.append((f"{name}, over {limit}", curve["exceeded"], float(over[own].sum())))
        found.append(
            (
                f"{name}, failed",
                margin["bearing failed"],
                float(failed[runs["model"] == name].sum()),
            )
        )
        value = next((v for key, v in curve.items() if key.startswith("median [")), "")
        if value and several:
            medians.append(median(runs["scale"][own].astype(float), over[own]))
            found.append((f"{name}, median", value, medians[-1]))
    if len(medians) == 2:
        found.append(("ratio of medians", row["ratio [-]"], medians[0] / medians[1]))
    return [*found, ("exact p", row["p"], exact(*scores))]


def main(archives: str, pages: str = "docs/validation") -> None:
    """Print numbers of all archives, as on the page and recomputed; write a table of how far."""
    rows = []
    for path in sorted(Path(archives).glob("*.zip")):
        with tempfile.TemporaryDirectory() as place:
            zipfile.ZipFile(path).extractall(place)
            for found in sorted(Path(place).rglob("runs.csv")):
                start = f"{pages}/tables/{path.stem}-{found.parent.name}"
                if Path(f"{start}-ratios.csv").is_file():
                    print(f"{path.stem}, {found.parent.name}: page, recomputed, difference")
                    far = []
                    for text, page, again in numbers(found, path.stem, start):
                        far.append(abs(again - float(page)) / (abs(float(page)) or 1.0))
                        print(f"  {text}: {float(page):.6g}, {again:.6g}, {far[-1]:.1g}")
                    rows.append([path.stem, found.parent.name, len(far), f"{max(far):.1g}"])
    with Path(f"{pages}/{TABLE}").open("w", encoding="utf-8", newline="") as file:
        head = ["page", "campaign", "numbers", "largest relative difference"]
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


if __name__ == "__main__":
    main(*sys.argv[1:])
