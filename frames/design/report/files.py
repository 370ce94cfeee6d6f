"""The files of a project's run: results, tables, checks; read again, and printed as a PDF."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess  # our own file, by a browser found on PATH  # noqa: S404
import tempfile
from datetime import UTC, datetime
from pathlib import Path
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

    import xarray as xr
    from pypdf import PdfReader

    from frames.design.project.design_run import ProjectRun


UNFINISHED = "unfinished"
"""Folder among the results that keeps the time histories of a run until all are complete."""

_ENDS = 2  # steps of a run that keeps its first and its last one alone


def write_run(run: ProjectRun, folder: Path, source: str, *, figures: bool = True) -> list[Path]:
    """Write the results of a run."""
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
    judged = write_judgement(run, folder, source, figures=figures)
    kept = [*judged, *written.values(), governing]
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    return kept


def write_judgement(
    run: ProjectRun, folder: Path, source: str, *, figures: bool = True, language: str = ""
) -> list[Path]:
    """Write the results derived from a run's time histories, as `write_run`; return the files."""
    for stale in ("view.html", "report.pdf"):  # with the checks of before
        (folder / stale).unlink(missing_ok=True)
    tables = run_tables(run)
    for name in (*TABLES_OF_FORCES, ECCENTRICITY):
        if not len(tables.get(name, ())):  # those of an earlier run, of another structure
            (folder / f"{name}.csv").unlink(missing_ok=True)
            tables.pop(name, None)
    bare = {ECCENTRICITY, BY_MOTION}  # without an index
    texts = {
        "project.toml": source,
        **{f"{name}.csv": csv_of(table, index=name not in bare) for name, table in tables.items()},
        "equivalent-linear.csv": csv_of(run.equivalent.to_dataframe()),
        "demands.csv": csv_of(headed(run.demands).assign(void=run.demands["void"])),
        "provisions.csv": csv_of(pd.DataFrame(run.provisions), index=False),
        "checks.csv": csv_of(run.checks.to_dataframe(), index=False),
        "checks.txt": calculations(run),
        "report.html": report_html(run, source, tables, figures=figures, language=language),
    }
    texts["run.json"] = json.dumps(_facts(run, folder), indent=2) + "\n"
    for name, text in texts.items():
        write_whole(folder / name, text)
    return [folder / name for name in texts]


def read_histories(folder: Path, inputs: Mapping[str, str]) -> tuple[Runs, xr.Dataset]:
    """Read the time histories that a project's run left, and those of the governing run."""
    facts = folder / "run.json"
    if not facts.is_file():
        partly = (folder / UNFINISHED).is_dir()
        msg = (
            f"{folder} has {'an interrupted run' if partly else 'no run'}: run `lir run` to the end"
        )
        raise ProjectError(msg)
    kept = _read_facts(facts)
    was = kept["inputs"]
    other = sorted(name for name in {*was, *inputs} if was.get(name) != inputs.get(name))
    if other:
        msg = (
            f"the time histories in {folder} belong to other input ({', '.join(other)} "
            "differ): run `lir run` again"
        )
        raise ProjectError(msg)
    try:
        _require_unchanged(folder, kept.get("digests", {}))
        runs = Runs(*_read(folder, kept))
        governing = load(folder / "governing.nc")
    except (OSError, RuntimeError) as cause:  # the latter of HDF5, on a damaged part
        msg = f"{folder}: {cause}: run `lir run` again"
        raise ProjectError(msg) from cause
    if any("peak_reaction_force" not in data for data in runs.parts):
        version = kept["lir_dcfp_version"]
        msg = (
            f"the time histories in {folder} are of version {version} and have no forces of "
            "members and bearings: run `lir run` again"
        )
        raise ProjectError(msg)
    return runs, governing


def _read_facts(path: Path) -> dict[str, Any]:
    # run.json, or a ProjectError.
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        parts = kept["inputs"], kept["runs"], kept["lir_dcfp_version"], kept["governing_case"]
    except (OSError, ValueError, LookupError, TypeError, RecursionError) as cause:
        msg = f"{path} is damaged ({type(cause).__name__}: {cause}): run `lir run` again"
        raise ProjectError(msg) from cause
    if not isinstance(parts[0], dict) or not isinstance(parts[1], dict):
        msg = f"{path} is damaged: run `lir run` again"
        raise ProjectError(msg)
    return dict(kept)


def _require_unchanged(folder: Path, digests: Mapping[str, str]) -> None:
    # Each file of time histories must be as it was written.
    for name, digest in digests.items():
        if _digest(folder / name) != digest:
            msg = f"{name} was changed after the run: its SHA-256 is not the one in run.json"
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
    # Entries of run.json on files of time histories, by the words in their names.
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
    # Periods of the structure on a fixed base, as its formulas have them [s]; None without them.
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
        msg = f"{path} is missing: run `lir report` to write it again"
        raise ProjectError(msg)
    try:
        table = pd.read_csv(path, dtype=dict.fromkeys(_TEXTS, str), keep_default_na=False)
    except (OSError, ValueError) as cause:
        msg = f"{path} cannot be read ({cause}): run `lir report` to write it again"
        raise ProjectError(msg) from cause
    missing = sorted({*_TEXTS, *_NUMBERS, "verdict"} - {*map(str, table.columns)})
    if missing:
        msg = f"{path} has no column {', '.join(missing)}: run `lir report` to write it again"
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


BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
"""Programs that print, as searched on PATH."""

PASSES = 4
"""Largest number of prints of the report until its contents list the right pages."""

_LONGEST = 300.0  # s that a print may take
_PLACE = re.compile(r'(<span class="page" data-page="([^"]*)">)[^<]*(</span>)')


def print_report(page: Path, paper: Path) -> Path:
    """Print a report.

    Contents are filled with the numbers of pages that the print before gave, until they agree.
    """
    browser = _browser()
    try:
        from pypdf import PdfReader, PdfWriter
    except ImportError as cause:
        msg = 'a PDF with page numbers needs pypdf: pip install "lir-dcfp[pdf]"'
        raise ProjectError(msg) from cause
    text, numbers = page.read_text(encoding="utf-8"), dict[str, int]()
    with tempfile.TemporaryDirectory(prefix="lir-report-") as folder:
        for _ in range(PASSES):
            filled, made = Path(folder) / "report.html", Path(folder) / "report.pdf"
            filled.write_text(with_pages(text, numbers), encoding="utf-8")
            _print(browser, filled, made)
            found = pages_of(PdfReader(made))
            if found == numbers:
                writer = PdfWriter(made, incremental=True)  # keeps the content that Chromium wrote
                writer.add_metadata({"/Producer": f"lir-dcfp {package_version()}, Chromium"})
                writer.write(paper)
                return paper
            numbers = found
    msg = (
        f"{page}: page numbers of the contents are still wrong after {PASSES} prints: print the "
        "page from a browser"
    )
    raise ProjectError(msg)


def with_pages(text: str, numbers: dict[str, int]) -> str:
    """Return a report whose contents name pages."""
    return _PLACE.sub(lambda found: f"{found[1]}{numbers.get(found[2], '')}{found[3]}", text)


def pages_of(reader: PdfReader) -> dict[str, int]:
    """Return the pages of a PDF's named places, from 1 on."""
    places = {
        name.removeprefix("/"): reader.get_destination_page_number(place)
        for name, place in reader.named_destinations.items()
    }
    return {name: number + 1 for name, number in places.items() if number is not None}


def _browser() -> str:
    for name in BROWSERS:
        if found := shutil.which(name):
            return found
    msg = (
        f"no browser that prints is on PATH ({', '.join(BROWSERS)}): install Chromium, or print "
        "report.html from any browser"
    )
    raise ProjectError(msg)


def _print(browser: str, page: Path, paper: Path) -> None:
    command = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={paper.parent / 'profile'}",
        "--no-pdf-header-footer",
        "--generate-pdf-document-outline",
        f"--print-to-pdf={paper}",
        page.as_uri(),
    ]
    try:
        done = subprocess.run(  # noqa: S603
            command, capture_output=True, text=True, timeout=_LONGEST, check=False
        )
    except subprocess.TimeoutExpired as cause:
        msg = f"{browser} did not print within {_LONGEST:g} s: print report.html from a browser"
        raise ProjectError(msg) from cause
    if done.returncode or not paper.is_file():
        told = (done.stderr.strip().splitlines() or ["no message"])[-1]
        msg = f"{browser} did not print ({told}): print report.html from a browser"
        raise ProjectError(msg)
