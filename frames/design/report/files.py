"""The files of a project's run: results, tables, checks with their calculations; read again."""

from __future__ import annotations

import hashlib
import json
import shutil
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import pandas as pd

from frames.batch.runs import BOUND, HAZARD, Runs, tagged
from frames.design._errors import ProjectError
from frames.design.calculation.check import COLUMNS, Check, Checks
from frames.design.calculation.standing import standing_of
from frames.design.histories.demand_table import headed
from frames.design.report.result_tables import BY_MOTION, ECCENTRICITY, TABLES_OF_FORCES, run_tables
from frames.design.report.writing import report_html
from frames.results.storage import csv_of, from_text, load, make_folder, save, write_whole
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    import xarray as xr

    from frames.design.project.design_run import ProjectRun


UNFINISHED = "unfinished"
"""Folder among the results that keeps the time histories of a run until all are complete."""

_ENDS = 2  # steps of a run that keeps its first and its last one alone


def write_run(
    run: ProjectRun, folder: Path, source: str, *, figures: bool = True, language: str = ""
) -> list[Path]:
    """Write what a run gave."""
    make_folder(folder)
    old = (*folder.glob("runs-*.nc"), *folder.glob("moved-*.nc"))
    cut = folder.glob(".*.part")  # of a process that was killed
    of_before = folder / "interrupted.nc"  # which version 0.2 wrote
    for stale in (folder / "run.json", of_before, *old, *cut):  # the first is written last
        stale.unlink(missing_ok=True)
    written = {}
    for (word, label), (_, data) in run.by_file.items():
        path = written[f"{word} {label}"] = folder / f"{word}-{label}.nc"
        save(data, path, compress=word == "runs" and data.sizes.get("time", 0) > _ENDS)
    for name, content in run.tables.items():
        written[name] = folder / name
        write_whole(written[name], content)
    governing = folder / "governing.nc"
    save(run.governing, governing, compress=True)
    judged = write_judgement(run, folder, source, figures=figures, language=language)
    kept = [*judged, *written.values(), governing]
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    return kept


def write_judgement(
    run: ProjectRun, folder: Path, source: str, *, figures: bool = True, language: str = ""
) -> list[Path]:
    """Write what follows from a run's time histories, as `write_run` does; return the files."""
    for stale in ("view.html", "report.pdf"):  # with the checks of before
        (folder / stale).unlink(missing_ok=True)
    tables = run_tables(run)
    for name in TABLES_OF_FORCES:
        if not len(tables.get(name, ())):  # those of an earlier run, of another structure
            (folder / f"{name}.csv").unlink(missing_ok=True)
            tables.pop(name, None)
    indexed = {
        name: table for name, table in tables.items() if name not in {ECCENTRICITY, BY_MOTION}
    }
    texts = {
        "project.toml": source,
        **{f"{name}.csv": csv_of(table) for name, table in indexed.items()},
        f"{BY_MOTION}.csv": csv_of(tables[BY_MOTION], index=False),
        "equivalent-linear.csv": csv_of(run.equivalent.to_dataframe()),
        "demands.csv": csv_of(headed(run.demands).assign(void=run.demands["void"])),
        "provisions.csv": csv_of(pd.DataFrame(run.provisions), index=False),
        "checks.csv": csv_of(run.checks.to_dataframe(), index=False),
        "checks.txt": calculations(run),
        "report.html": report_html(run, source, tables, figures=figures, language=language),
    }
    if len(tables[ECCENTRICITY]):
        texts[f"{ECCENTRICITY}.csv"] = csv_of(tables[ECCENTRICITY], index=False)
    else:  # of an earlier run
        (folder / f"{ECCENTRICITY}.csv").unlink(missing_ok=True)
    texts["run.json"] = json.dumps(_facts(run, folder), indent=2) + "\n"
    written = []
    for name, text in texts.items():
        path = folder / name
        write_whole(path, text)
        written.append(path)
    return written


def read_histories(folder: Path, inputs: Mapping[str, str]) -> tuple[Runs, xr.Dataset]:
    """Read the time histories that a project's run left, and those of the governing run."""
    facts = folder / "run.json"
    if not facts.is_file():
        partly = (folder / UNFINISHED).is_dir()
        msg = f"{folder} holds {'an interrupted run' if partly else 'no run'}: `lir run` makes one"
        raise ProjectError(msg)
    kept = _read_facts(facts)
    was = kept["inputs"]
    other = sorted(name for name in {*was, *inputs} if was.get(name) != inputs.get(name))
    if other:
        msg = (
            f"the time histories in {folder} are of another input ({', '.join(other)} differ): "
            "`lir run` makes new ones"
        )
        raise ProjectError(msg)
    try:
        _require_unchanged(folder, kept.get("digests", {}))
        runs = Runs(*_read(folder, kept))
        governing = load(folder / "governing.nc")
    except (OSError, RuntimeError) as cause:  # the latter of HDF5, on a damaged part
        msg = f"{folder}: {cause}: `lir run` writes all files anew"
        raise ProjectError(msg) from cause
    if any("peak_reaction_force" not in data for data in runs.parts):
        version = kept["lir_dcfp_version"]
        msg = (
            f"the time histories in {folder} were made by a version ({version}) that kept no "
            "forces of members and bearings: `lir run` makes new ones"
        )
        raise ProjectError(msg)
    return runs, governing


def _read_facts(path: Path) -> dict[str, Any]:
    # run.json, or a ProjectError.
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        parts = kept["inputs"], kept["runs"], kept["lir_dcfp_version"], kept["governing_case"]
    except (OSError, ValueError, LookupError, TypeError, RecursionError) as cause:
        msg = f"{path} is damaged ({type(cause).__name__}: {cause}): `lir run` writes it anew"
        raise ProjectError(msg) from cause
    if not isinstance(parts[0], dict) or not isinstance(parts[1], dict):
        msg = f"{path} is damaged: `lir run` writes it anew"
        raise ProjectError(msg)
    return dict(kept)


def _require_unchanged(folder: Path, digests: Mapping[str, str]) -> None:
    # Each file of time histories must be as it was written.
    for name, digest in digests.items():
        if _digest(folder / name) != digest:
            msg = f"{name} is not as it was written: its SHA-256 is not the one in run.json"
            raise OSError(msg)


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _read(
    folder: Path, kept: Mapping[str, Mapping[str, Mapping[str, str]]]
) -> Iterator[xr.Dataset]:
    # Files of time histories with their tags, as run.json names them.
    for word in ("runs", "moved"):
        for label, told in kept.get(word, {}).items():
            tags = {HAZARD: told.get("level", ""), BOUND: told.get("bound", label)}
            yield tagged(load(folder / f"{word}-{label}.nc"), **tags)


def calculations(run: ProjectRun) -> str:
    """Return all checks, each with its calculation."""
    blocks = [f"{run.frame.name}\n\n{run.equivalent!r}\n\n{run.checks}"]
    for check in run.checks:
        lines = [str(check), f"standing: {check.standing}"]
        if check.note:
            lines.append(f"note: {check.note}")
        lines += (f"    {line}" for line in check.trace.text().splitlines())
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks) + "\n"


def _facts(run: ProjectRun, folder: Path) -> dict[str, object]:
    held = [*(f"{word}-{label}.nc" for word, label in run.by_file), "governing.nc"]
    return {
        "project": run.frame.name,
        "written": datetime.now(tz=UTC).isoformat(timespec="seconds"),
        "lir_dcfp_version": package_version(),
        "passed": run.checks.passed,
        "checks": len(run.checks),
        "failed": [str(check) for check in run.checks.failed],
        "governing_case": run.governing_case,
        "fixed_base_period": _fixed_base_period(run),
        "inputs": dict(run.inputs),
        "digests": {name: _digest(folder / name) for name in held if (folder / name).is_file()},
        **{word: _told_of(run, word) for word in ("runs", "moved")},
    }


def _told_of(run: ProjectRun, word: str) -> dict[str, dict[str, object]]:
    # What run.json says of files of time histories, by the words that their names have.
    return {
        label: {
            "level": case.level,
            "bound": case.bound,
            "runs": data.sizes["run"],
            "not_ok": [str(s) for s in data["status"].to_numpy() if str(s) != "ok"],
            "seconds": float(data.attrs["seconds"]),
        }
        for (first, label), (case, data) in run.by_file.items()
        if first == word
    }


def _fixed_base_period(run: ProjectRun) -> float | None:
    # Of the structure whose base is held, too, as its formulas have it [s]; None without them.
    for each in run.equivalent.bounds.values():
        for symbol in ("T_fb", "T_f"):
            if symbol in each.trace:
                return each.trace.value(symbol)
    return None


_NUMBERS = ("demand", "limit")
_TEXTS = tuple(name for name in COLUMNS if name not in _NUMBERS)
_SHOWN = {"m": "mm"}


def read_checks(folder: Path) -> Checks:
    """Return the checks that ``checks.csv`` holds, without their calculations."""
    path = folder / "checks.csv"
    if not path.is_file():
        msg = f"{path} is missing: `lir report` writes it from the histories of the run"
        raise ProjectError(msg)
    try:
        table = pd.read_csv(path, dtype=dict.fromkeys(_TEXTS, str), keep_default_na=False)
    except (OSError, ValueError) as cause:
        msg = f"{path} cannot be read ({cause}): `lir report` writes it anew"
        raise ProjectError(msg) from cause
    missing = sorted({*_TEXTS, *_NUMBERS, "verdict"} - {*map(str, table.columns)})
    if missing:
        msg = f"{path} has no column {', '.join(missing)}: `lir report` writes it anew"
        raise ProjectError(msg)
    return Checks(_check(row) for row in table.to_dict("records"))


def _check(row: dict[Any, Any]) -> Check:
    texts = {name: from_text(row[name]) for name in _TEXTS}
    beyond = {
        "does not apply": "procedure",
        "needs agreement": "agreement",
        "raised": "minimum",
    }
    scope = beyond.get(row["verdict"], "any")
    shown = _SHOWN.get(row["unit"], "")
    numbers = {name: float(row[name]) for name in _NUMBERS}
    texts["standing"] = standing_of(row["standing"])
    return Check(**texts, **numbers, scope=scope, shown=shown)  # type: ignore[arg-type]  # Check judges them
