"""Parts of the study that are campaign files of the package: run, and written as a page each.

A part is `<part>.toml`, or several `<part>-<name>.toml`, and the template `<part>.md.j2`. The template
has `campaigns`, by the names of files (`only` is the first), each with "tables" (DataFrames by
`frames.risk.campaign.tables.FILES`), "plan", "cost", "digest", "considered" and "motions";
`written`, `figure_of(name)`, the functions of `shown` and those of `<part>.py`, if there is one.
That may have `numbers(every)`, of the `CampaignTables` by file, plain numbers, which the template has
as `own`; and `figures(campaigns, own)`, by name.
"""

from __future__ import annotations

import datetime
import json
import os
import platform
import warnings
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from frames import ModelWarning, MotionWarning
from frames.design.project.inputs import bearing_of, motions_of
from frames.risk.campaign.file import campaign_file, read_campaign
from frames.risk.campaign.page import comparison_figures, loss_curves
from frames.risk.campaign.tables import CampaignTables
from lir_element import DesignWarning
from lir_element.errors import AnalysisWarning
from validation.measurements.benchmark import processor
from validation.page import DPI, FOLDER, render
from validation.study import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from matplotlib.figure import Figure

    from frames.risk.campaign.file_schema import CampaignFile

    Told = Mapping[str, Any]
    """Of a campaign: its tables by name, "plan", "cost", "digest", "considered", "motions"."""

HERE = Path(__file__).parent
PARTS = ["near_fault", "records", "device", "buildings", "motions", "after", "loss", "uncertainty"]
"""In the order of a run; the summary, which needs all, is no campaign."""

TRIED_SECONDS = 10.0
"""Duration of a trial's histories [s]."""

DIGITS = 5
"""Significant digits of numbers in JSON."""

PULSES = "periods", "period_ratios", "velocities", "shapes"
"""Of pulses: what a trial has few of."""


@contextmanager
def quietly() -> Generator[None, None, None]:
    """Leave out warnings: what is doubtful of a run or a model is in the tables."""
    with warnings.catch_warnings():
        for kind in (AnalysisWarning, ModelWarning, MotionWarning, DesignWarning):
            warnings.simplefilter("ignore", kind)
        yield


def files_of(part: str) -> dict[str, Path]:
    """Return the campaign files of a part by name; empty if it has none."""
    found = [HERE / f"{part}.toml", *sorted(HERE.glob(f"{part}-*.toml"))]
    return {path.stem.removeprefix(f"{part}-"): path for path in found if path.is_file()}


def name_of(part: str) -> str:
    """Return the name of a part's page."""
    return "study" if part == "records" else f"study_{part}"


def run(
    part: str, store: Path, to: Path = FOLDER, workers: int = 1, few: int | None = None
) -> None:
    """Run a part in a store, or go on with it; write page, numbers, tables and figures to a folder.

    A trial has `few` records of each set and intensities.
    """
    every: dict[str, CampaignTables] = {}
    facts: dict[str, Told] = {}
    with quietly():
        for name, path in files_of(part).items():
            file = campaign_file(path) if few is None else tried(campaign_file(path), few)
            campaign = read_campaign(file, store=store / part / name)
            campaign.run(workers=workers, progress=True)
            every[name] = tables = CampaignTables(campaign, file)
            facts[name] = _facts(tables)
            for kind, table in tables.all().items():
                text = table.to_csv(index=table.index.name is not None)
                _put(_table_path(part, to, name, kind), text)
        module = own_module(part)
        numbers = module.numbers(every) if hasattr(module, "numbers") else {}
        told = rounded({"campaigns": facts, "own": numbers})
        _put(to / f"{name_of(part)}.json", json.dumps(told) + "\n")
        text = write(part, to)
        for target, draw in _figures(part, every).items():
            if f"figures/{target}" in text:
                _save(draw(), to / "figures" / target)


def write(part: str, folder: Path = FOLDER) -> str:
    """Write and return the page of a part, with its own figures, from the numbers in its folder."""
    module, text = own_module(part), page(part, folder)
    _put(folder / f"{name_of(part)}.md", text)
    if hasattr(module, "figures"):
        for name, figure in module.figures(**told_of(part, folder)).items():
            _save(figure, folder / "figures" / f"{name_of(part)}-{name}.png")
    print(f"{name_of(part)}.md is written to {folder}")
    return text


def page(part: str, folder: Path = FOLDER) -> str:
    """Return the page of a part from the numbers in a folder."""
    told, module = told_of(part, folder), own_module(part)
    names = vars(module) if module is not None else {}
    return render(
        vars(shown) | names | {"__file__": str(HERE / f"{part}.py")},
        **told,
        only=next(iter(told["campaigns"].values())),
        figure_of=lambda name: f"figures/{name_of(part)}-{name}.png",
        written=_written(part, told["campaigns"]),
    )


def told_of(part: str, folder: Path = FOLDER) -> dict[str, Any]:
    """Return "campaigns" of a part, by name with tables as DataFrames, and its "own" numbers."""
    given: dict[str, Any] = json.loads((folder / f"{name_of(part)}.json").read_text("utf-8"))
    for name, each in given["campaigns"].items():
        paths = {kind: _table_path(part, folder, name, kind) for kind in each["tables"]}
        each["tables"] = {
            kind: pd.read_csv(path) if path.read_text("utf-8").strip() else pd.DataFrame()
            for kind, path in paths.items()
        }
    return given


def _table_path(part: str, folder: Path, name: str, kind: str) -> Path:
    return folder / "tables" / f"{name_of(part)}-{name}-{kind}.csv"


def own_module(part: str) -> Any:
    """Return the module of a part's own numbers and figures, None without one."""
    name = f"validation.study.{part}"
    return import_module(name) if find_spec(name) is not None else None


def tried(file: CampaignFile, few: int) -> CampaignFile:
    """Return a campaign's file with few short records, intensities and sets at level pendulum."""
    short = {"level": "pendulum", "duration": TRIED_SECONDS}
    changed: dict[str, Any] = {"analysis": file.analysis.model_copy(update=short)}
    given, bearing = file.motions, bearing_of(file.bearing)
    if given.pulses is not None:
        pulses = given.pulses.model_copy(
            update={name: _few(getattr(given.pulses, name), few) for name in PULSES}
        )
        changed["motions"] = given.model_copy(update={"pulses": pulses})
        return file.model_copy(update=changed)
    folder = (file.source_path or Path()).parent
    sets = [given.model_copy(update={"fema_p695": (name,)}) for name in given.fema_p695] or [given]
    read = [motions_of(each, folder, lambda: bearing.period) for each in sets]
    key = "intensities" if given.intensities else "scales"
    names = tuple(name for each in read for name in list(each)[:few])
    changed["motions"] = given.model_copy(
        update={"only": names, key: _few(getattr(given, key), few)}
    )
    if file.sample is not None:
        changed["sample"] = file.sample.model_copy(update={"size": 2 * few})
    return file.model_copy(update=changed)


def _few(values: tuple[Any, ...], few: int) -> tuple[Any, ...]:
    # So many of them, the first and the last among them.
    places = {k * (len(values) - 1) // max(few - 1, 1) for k in range(few)} if values else ()
    return tuple(values[k] for k in sorted(places))


def _facts(tables: CampaignTables) -> Told:
    comparison, seconds = tables.comparison, tables.data["seconds_loop"]
    cost = {
        "runs": len(seconds),
        "loop": float(seconds.sum()),
        "date": f"{datetime.date.today():%Y-%m-%d}",
        "machine": f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}",
    }
    return {
        "tables": list(tables.all()),
        "plan": tables.plan["what was run"].to_dict(),
        "cost": cost,
        "digest": tables.campaign.digest(),
        "considered": None if comparison is None else comparison.considered,
        "motions": len(tables.campaign.motions),
        "axis": tables.axis,
    }


def rounded(value: Any) -> Any:
    """Return nested mappings and lists with all numbers rounded to significant digits."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(each) for each in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _figures(part: str, every: Mapping[str, CampaignTables]) -> dict[str, Callable[[], Figure]]:
    # Those of the package's page, drawn when they are called, by the names of their files.
    found: dict[str, Callable[[], Figure]] = {}
    for name, tables in every.items():
        start = f"{name_of(part)}-" + ("" if name == part else f"{name}-")
        drawn = comparison_figures(tables)
        if len(tables.loss):
            found[f"{start}loss.png"] = partial(loss_curves, tables.loss, tables.axis)
        groups = [*dict.fromkeys(group for _, group in drawn)]
        for (kind, group), draw in drawn.items():
            end = f"-{groups.index(group) + 1}" if len(groups) > 1 else ""
            found[f"{start}{kind}{end}.png"] = draw
    return found


def _written(part: str, every: Mapping[str, Told]) -> str:
    # How a page was made: the first sentence of each.
    cost = next(iter(every.values()))["cost"]
    files = [f"`{path.name}`" for name, path in files_of(part).items() if name in every]
    return (
        f"Written by `python -m validation.study {part}` ({cost['date']}, {cost['machine']}); "
        f"`lir campaign` runs {', '.join(files)} of `validation/study` as well."
    )


def _save(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI, metadata={"Software": None})


def _put(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
