"""The files that a project's run leaves: results, tables, checks with their calculations."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from frames.report.writing import report_html
from frames.results.storage import save
from lir_element.results.dataset import package_version

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from frames.project.design_run import ProjectRun


def write_run(run: ProjectRun, folder: Path, source: str) -> list[Path]:
    """Write what a run gave.

    Parameters
    ----------
    run : ProjectRun
        The run.
    folder : Path
        Made if it is not there; files of an earlier run are written over.
    source : str
        Text of the project's file, which is kept beside the results.

    Returns
    -------
    list of Path
        ``project.toml``; ``runs-<bound>.nc``, the time histories; ``equivalent-linear.csv``,
        ``demands.csv``, ``checks.csv`` in SI units; ``checks.txt`` with each calculation;
        ``governing.nc``, the histories of one run; ``report.html``; ``run.json``: version, date,
        outcome.
    """
    folder.mkdir(parents=True, exist_ok=True)
    texts = {
        "project.toml": source,
        "equivalent-linear.csv": run.equivalent.to_dataframe().to_csv(),
        "demands.csv": run.demands.to_csv(),
        "checks.csv": run.checks.to_dataframe().to_csv(index=False),
        "checks.txt": calculations(run),
        "report.html": report_html(run, source),
        "run.json": json.dumps(_facts(run), indent=2) + "\n",
    }
    written = []
    for name, text in texts.items():
        path = folder / name
        path.write_text(text, encoding="utf-8")
        written.append(path)
    for name, data in {**{f"runs-{b}": d for b, d in run.runs.items()},
                       "governing": run.governing}.items():  # fmt: skip
        path = folder / f"{name}.nc"
        save(data, path, compress=True)
        written.append(path)
    return written


def write_interrupted(data: xr.Dataset, folder: Path) -> Path:
    """Write the runs that were complete when a project's run was interrupted; return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "interrupted.nc"
    save(data, path, compress=True)
    return path


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


def _facts(run: ProjectRun) -> dict[str, object]:
    return {
        "project": run.frame.name,
        "written": datetime.now(tz=UTC).isoformat(timespec="seconds"),
        "lir_dcfp_version": package_version(),
        "passed": run.checks.passed,
        "checks": len(run.checks),
        "failed": [str(check) for check in run.checks.failed],
        "runs": {
            bound: {
                "runs": data.sizes["run"],
                "not_ok": [str(s) for s in data["status"].to_numpy() if str(s) != "ok"],
                "seconds": float(data.attrs["seconds"]),
            }
            for bound, data in run.runs.items()
        },
    }
