"""Parts of the study that are campaign files of the package: run, and written as a page each.

A part is `<part>.toml`, or several `<part>-<name>.toml`, and the template `<part>.md.j2`. The template
has `campaigns`, by the names of files (`only` is the first), each with "tables" (DataFrames by
`frames.risk.campaign.tables.FILES`), "plan", "cost", "digest", "considered" and "motions";
`written`, `figure_of(name)`, the functions of `shown` and those of `<part>.py`, if there is one.
That may have `numbers(every)`, of the `CampaignTables` by file, plain numbers, which the template has
as `own`; and `figures(campaigns, own)`, by name.
"""

from __future__ import annotations

import json
import math
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pandas as pd

from frames.design.project.inputs import bearing_of, motions_of
from frames.risk.campaign.file import campaign_file, read_campaign
from frames.risk.campaign.page import device_curves, loss_curves
from frames.risk.campaign.plot_response import response_by_factor
from frames.risk.campaign.tables import CONFIDENCE, CampaignTables
from validation.page import DPI, FOLDER, render
from validation.study import shown
from validation.study.part import performed, quietly

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from matplotlib.figure import Figure

    from frames.risk.campaign.file_schema import CampaignFile

    Told = Mapping[str, Any]
    """Of a campaign: its tables by name, "plan", "cost", "digest", "considered", "motions"."""

HERE = Path(__file__).parent
INFINITE = "inf"
TRIED_SECONDS = 10.0
"""Duration of a trial's histories [s]."""

DIGITS = 5
"""Significant digits of numbers in JSON."""

PULSES = "periods", "period_ratios", "velocities", "shapes"
"""Of pulses: what a trial has few of."""


class Work(NamedTuple):
    """Where a part is run and written."""

    store: Path  # a folder for the runs
    to: Path = FOLDER  # that of the pages
    workers: int | str = 1
    trial: int | None = None  # records of each set and intensities; None: all


def files_of(part: str) -> dict[str, Path]:
    """Return the campaign files of a part by name; empty if it has none."""
    found = [HERE / f"{part}.toml", *sorted(HERE.glob(f"{part}-*.toml"))]
    return {path.stem.removeprefix(f"{part}-"): path for path in found if path.is_file()}


def name_of(part: str) -> str:
    """Return the name of a part's page."""
    return "study" if part == "records" else f"study_{part}"


def run(part: str, work: Work) -> None:
    """Run a part, or go on with it, and write its page, numbers, tables and figures."""
    with quietly():
        _run(part, work)
    write(part, work.to)


def _run(part: str, work: Work) -> None:
    every: dict[str, CampaignTables] = {}
    told: dict[str, Told] = {}
    for name, path in files_of(part).items():
        file = campaign_file(path)
        if work.trial is not None:
            file = tried(file, work.trial)
        campaign = read_campaign(file, store=work.store / part / name)
        cost = performed(campaign, work.workers)
        every[name] = tables = CampaignTables(campaign, file)
        told[name] = _told(tables, cost)
    module = own_module(part)
    numbers = module.numbers(every) if hasattr(module, "numbers") else {}
    texts = {
        f"tables/{name_of(part)}-{name}-{kind}.csv": table.to_csv(index=False)
        for name, each in told.items()
        for kind, table in each["tables"].items()
    }
    kept = {name: _kept(each) for name, each in told.items()}
    texts[f"{name_of(part)}.json"] = json.dumps(rounded({"campaigns": kept, "own": numbers})) + "\n"
    for place, text in texts.items():
        _put(work.to / place, text)
    text = write(part, work.to)
    for target, drawn in _figures(part, every).items():
        if f"figures/{target}" in text:
            _save(drawn(), work.to / "figures" / target)


def write(part: str, folder: Path = FOLDER) -> str:
    """Write and return the page of a part, with its own figures, from the numbers in its folder."""
    given = json.loads((folder / f"{name_of(part)}.json").read_text(encoding="utf-8"))
    module = own_module(part)
    text = page(part, given)
    _put(folder / f"{name_of(part)}.md", text)
    if hasattr(module, "figures"):
        for name, figure in module.figures(told_of(given), given["own"]).items():
            _save(figure, folder / "figures" / f"{name_of(part)}-{name}.png")
    print(f"{name_of(part)}.md is written to {folder}")
    return text


def page(part: str, given: Mapping[str, Any]) -> str:
    """Return the page of a part from its numbers."""
    every, module = told_of(given), own_module(part)
    names = vars(module) if module is not None else {}
    script = vars(shown) | names | {"__file__": str(HERE / f"{part}.py")}
    return render(
        script,
        own=given["own"],
        campaigns=every,
        only=next(iter(every.values())),
        figure_of=lambda name: f"figures/{name_of(part)}-{name}.png",
        written=_written(part, every),
    )


def told_of(given: Mapping[str, Any]) -> dict[str, Told]:
    """Return what a template is told of each campaign: its numbers with tables as DataFrames."""
    return {
        name: dict(each) | {"tables": {n: _joined(table) for n, table in each["tables"].items()}}
        for name, each in given["campaigns"].items()
    }


def _joined(table: Mapping[str, Any]) -> pd.DataFrame:
    words = {INFINITE: math.inf, None: math.nan}
    data = [[words.get(cell, cell) for cell in row] for row in table["data"]]
    return pd.DataFrame(data, columns=table["columns"])


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
    values = getattr(given, key)
    names = tuple(name for each in read for name in list(each)[:few])
    changed["motions"] = given.model_copy(update={"only": names, key: _few(values, few)})
    if file.sample is not None:
        changed["sample"] = file.sample.model_copy(update={"size": 2 * few})
    return file.model_copy(update=changed)


def _few(values: tuple[Any, ...], few: int) -> tuple[Any, ...]:
    # So many of them, the first and the last among them.
    if not values:
        return ()
    last = len(values) - 1
    return tuple(values[k] for k in sorted({k * last // max(few - 1, 1) for k in range(few)}))


def _told(tables: CampaignTables, cost: Mapping[str, Any]) -> Told:
    found = {
        name: table.reset_index() if table.index.name else table
        for name, table in tables.all().items()
    }
    comparison = tables.comparison
    return {
        "tables": found,
        "plan": tables.plan["what was run"].to_dict(),
        "cost": {**cost, "loop": float(tables.data["seconds_loop"].sum())},
        "digest": tables.campaign.digest(),
        "considered": None if comparison is None else comparison.considered,
        "motions": len(tables.campaign.motions),
        "axis": tables.axis,
    }


def _kept(told: Told) -> dict[str, Any]:
    tables = {name: _split(table) for name, table in told["tables"].items()}
    return {**told, "tables": tables}


def rounded(value: Any) -> Any:
    """Return nested mappings and lists with all numbers rounded to significant digits."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(each) for each in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _split(table: pd.DataFrame) -> dict[str, Any]:
    # What is not known is null, and what is infinite a word, for which JSON has no number.
    found = table.astype(object).where(table.notna(), None).replace({math.inf: INFINITE})
    return {"columns": [str(name) for name in found], "data": found.to_numpy().tolist()}


def _figures(part: str, every: Mapping[str, CampaignTables]) -> dict[str, Callable[[], Figure]]:
    # Those of the package's page, drawn when they are called, by the names of their files.
    found: dict[str, Callable[[], Figure]] = {}
    for name, tables in every.items():
        comparison = tables.comparison
        groups = {"": list(tables.runs)} if comparison is None else comparison.groups
        start = _start(part, name)
        if len(tables.loss):
            found[f"{start}loss.png"] = partial(loss_curves, tables.loss, tables.axis)
        for k, devices in enumerate(groups.values(), start=1):
            end = ".png" if len(groups) == 1 else f"-{k}.png"
            found[f"{start}response{end}"] = partial(
                response_by_factor,
                {device: tables.by_factor[device] for device in devices},
                axis=tables.axis,
            )
            found[f"{start}fragility{end}"] = partial(
                device_curves,
                {device: tables.runs[device] for device in devices},
                tables.curves,
                tables.limits,
                confidence=CONFIDENCE,
                considered=None if comparison is None else comparison.considered,
            )
    return found


def _start(part: str, name: str) -> str:
    # Of the names of tables and figures of a campaign.
    return f"{name_of(part)}-" + ("" if name == part else f"{name}-")


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
