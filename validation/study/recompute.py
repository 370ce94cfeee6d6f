"""Recompute numbers of the study's pages from its archives, by numpy, scipy and zarr alone.

    python -m validation.study.recompute ARCHIVES [PAGES]

ARCHIVES is the folder of `python -m validation.study --archive ARCHIVES --store STORE`, PAGES that of
the pages. Of two devices of each campaign: shares of runs that exceed a limit state and whose bearing
fails, medians of the curves; the ratio of both medians, and the exact p of the paired test.
"""

from __future__ import annotations

import csv
import math
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import zarr
from scipy import optimize, stats

if TYPE_CHECKING:
    from collections.abc import Iterator

LIMITS = dict.fromkeys(
    ("study_buildings", "study_near_fault"), ("storey drift 2 %", "storey drift, mean", 0.02)
)
"""Limit state, quantity and limit of parts that have other members, or another collapse."""

COLLAPSE, FAILED, ULTIMATE = "collapse", "bearing failure", 9.0


def at_yield() -> dict[str, float]:
    """Return the rotation M L / (6 E I) at which columns and beams yield [rad]."""
    stress, modulus, column, beam = 345e6, 200e9, 3.5, 6.0
    b, h, w, flange, web = 0.3, 0.4, 0.18, 0.0135, 0.0086  # I 400 x 180; box 300 x 16 mm
    inner, core = b - 2.0 * 0.016, h - 2.0 * flange
    plastic = w * flange * (h - flange) + web * core**2 / 4.0
    of_box = (b**3 - inner**3) / 4.0 / ((b**4 - inner**4) / 12.0)
    of_beam = plastic / ((w * h**3 - (w - web) * core**3) / 12.0)
    parts = {"column": of_box * column, "beam": of_beam * beam}
    return {name: stress / (6.0 * modulus) * value for name, value in parts.items()}


def exceeded(folder: Path, runs: dict[str, Any], part: str) -> Any:
    """Return 1 or 0 of each run, with failed bearings as 1; NaN if its analysis failed."""
    if part in LIMITS:
        _, quantity, most = LIMITS[part]
        over = runs[quantity].astype(float) > most
    else:
        data = zarr.open_group(folder / "results.zarr", mode="r")
        yields = [at_yield()[str(name).split("-")[0]] for name in data["hinge"][:]]
        turned = data["peak_hinge_rotation"][:] / np.array(yields)
        over = 1.0 + turned.max(axis=1) > ULTIMATE
    known = np.isin(runs["outcome"], ("complete", FAILED))
    return np.where(known, (over | (runs["outcome"] == FAILED)).astype(float), np.nan)


def median(im: Any, over: Any) -> float:
    """Return the median of a lognormal curve by maximum likelihood."""

    def unlikely(p: Any) -> float:
        z = (np.log(im) - p[0]) / math.exp(p[1])
        return -float(np.where(over > 0.0, stats.norm.logcdf(z), stats.norm.logsf(z)).sum())

    rules = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 5000}
    start = [float(np.log(im).mean()), math.log(0.4)]
    return math.exp(optimize.minimize(unlikely, start, method="Nelder-Mead", options=rules).x[0])


def exact(own: dict[Any, float], other: dict[Any, float]) -> float:
    """Return p of the exact two-sided sign test: a record counts once, by the sum of its signs."""
    signs: dict[str, float] = {}
    for key in own.keys() & other.keys():
        signs[key[0]] = signs.get(key[0], 0.0) + own[key] - other[key]
    more, less = (sum(way * sign > 0.0 for sign in signs.values()) for way in (1, -1))
    return float(stats.binomtest(more, more + less).pvalue) if more + less else 1.0


def table_of(path: str | Path, **chosen: str) -> list[dict[str, str]]:
    """Return rows of a table with these values, of all records together."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    wanted = {"record set": "all"} | {key.replace("_", " "): v for key, v in chosen.items()}
    return [row for row in rows if all(row.get(key, v) == v for key, v in wanted.items())]


def numbers(
    runs: dict[str, Any], over: Any, limit: str, start: str
) -> Iterator[tuple[str, float, float]]:
    """Yield numbers of a campaign: text, as on the page, recomputed."""
    row = table_of(f"{start}-ratios.csv", limit_state=limit)[0]
    medians, scores = [], []
    for name in (row["own"], row["over"]):
        model = runs["model"] == name
        own = model & ~np.isnan(over)
        keys = zip(*(runs[key][own] for key in ("motion", "scale", "parameter_set")), strict=True)
        scores.append(dict(zip(keys, over[own], strict=True)))
        curve = table_of(f"{start}-fragility.csv", structure=name, limit_state=limit)[0]
        share = float(curve["exceeded"]) / float(curve["known"])
        yield f"{name}, share over {limit}", share, float(over[own].mean())
        margin = table_of(f"{start}-margins.csv", device=name)[0]
        failed = (runs["outcome"] == FAILED) | (runs["status"] == "bearing_lost")
        share = float(margin["bearing failed"]) / float(margin["runs"])
        yield f"{name}, share of failed bearings", share, float(failed[model].mean())
        if value := next((v for key, v in curve.items() if key.startswith("median [")), ""):
            medians.append(median(runs["scale"][own].astype(float), over[own]))
            yield f"{name}, median", float(value), medians[-1]
    if row["ratio [-]"]:
        yield "ratio of medians", float(row["ratio [-]"]), medians[0] / medians[1]
    yield "exact p", float(row["p"]), exact(*scores)


def main(archives: str, pages: str = "docs/validation") -> None:
    """Print numbers of all archives, as on the page and recomputed."""
    for path in sorted(Path(archives).glob("*.zip")):
        with tempfile.TemporaryDirectory() as place:
            zipfile.ZipFile(path).extractall(place)
            for found in sorted(Path(place).rglob("runs.csv")):
                start = f"{pages}/tables/{path.stem}-{found.parent.name}"
                if not Path(f"{start}-ratios.csv").is_file():
                    continue
                rows = table_of(found)
                runs = {key: np.array([row[key] for row in rows]) for key in rows[0]}
                runs.setdefault("parameter_set", np.full(len(rows), ""))
                limit = LIMITS[path.stem][0] if path.stem in LIMITS else COLLAPSE
                over = exceeded(found.parent, runs, path.stem)
                print(f"{path.stem}, {found.parent.name}: {len(rows)} runs")
                for text, one, again in numbers(runs, over, limit, start):
                    near = f"recomputed {again:.6g}, difference {again - one:.1g}"
                    print(f"  {text}: page {one:.6g}, {near}")


if __name__ == "__main__":
    main(*sys.argv[1:])
