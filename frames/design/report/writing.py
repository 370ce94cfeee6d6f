"""A run as one HTML file: what was asked, what came out, every check with its calculation."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from typing import TYPE_CHECKING, NamedTuple

import pandas as pd
from markupsafe import Markup

from frames.design.calculation.check import TO_BE_CONFIRMED
from frames.design.histories.demand_table import headed, said, void_said
from frames.design.histories.suite import suite_of
from frames.design.report.figures import pictures
from frames.design.report.page import Table, page_table, page_template
from frames.design.report.tables import in_mm_and_kn
from lir_element.results.dataset import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.design.calculation.check import Check
    from frames.design.project.design_run import ProjectRun


class Judged(NamedTuple):
    """A check as the report shows it."""

    check: Check
    demand: str
    limit: str
    ratio: str
    steps: list[tuple[Markup, str]]


def report_html(
    run: ProjectRun, source: str, tables: Mapping[str, pd.DataFrame], *, figures: bool = True
) -> str:
    """Return a run as a self-contained HTML page.

    Parameters
    ----------
    run : ProjectRun
        The run.
    source : str
        Text of the project's file.
    tables : mapping of str to pandas.DataFrame
        Of `run_tables`.
    figures : bool
        Whether with figures, which take half of the time of a small project.

    Returns
    -------
    str
        The page: styles and pictures are in it, nothing is fetched.
    """
    device = next(iter(run.frame.bearings.values())).bearing
    return page_template("report.html.j2").render(
        name=run.frame.name,
        code=run.equivalent.code,
        device="plain DCFP" if device.is_dcfp else "LIR-DCFP",
        case=run.governing_case,
        failed=[_judged(check) for check in run.checks.failed],
        doubts=run.doubts,
        checks=[_judged(check) for check in run.checks],
        limits=[_judged(check) for check in run.equivalent.checks if check not in run.checks],
        model=Markup(run.model._repr_html_()),  # noqa: S704  (escaped where it is made)
        bearing=Markup(device._repr_html_()),  # noqa: S704
        schedule=page_table(in_mm_and_kn(tables["bearings"]), "bearing"),
        friction=page_table(tables["friction"], "friction coefficient"),
        modes=page_table(tables["modes"], "mode"),
        members=page_table(tables.get("member-groups", pd.DataFrame()), "members"),
        members_said=_members_said(run),
        programme=_programme(tables["programme"]),
        motions=page_table(run.motions.table(), "motion"),
        equivalent=Table(run.equivalent.head(), run.equivalent.rows()),
        demands=page_table(headed(run.demands), "quantity"),
        void=void_said(run.demands),
        levels=_levels(run),
        level=f"the level {run.rules.levels[0].name!r}",
        audit=run.governing.attrs["audit"].splitlines(),
        pictures=pictures(run) if figures else {},
        source=source,
        facts=_facts(run),
    )


def _levels(run: ProjectRun) -> str:
    # What is judged at which level of the seismic action, where there are several.
    levels = run.rules.levels
    if len(levels) < 2:
        return ""
    words = {
        "all": "bearings and structure",
        "isolation": "the bearings",
        "superstructure": "what stands on the bearings",
    }
    said = (
        f"{words[one.judges]} at the level {one.name!r}, motions times {one.factor:g}"
        for one in levels
    )
    return f"{run.equivalent.code} judges {'; '.join(said)}. The table has both levels."


def _members_said(run: ProjectRun) -> str:
    # What the table of member forces is of.
    level = next(level.name for level in run.rules.levels if level.judges_structure)
    bounds = ", ".join(bound for bound in run.runs[level])
    statistics = dict.fromkeys(said(suite_of(data, run.rules)) for data in run.runs[level].values())
    return (
        f"Level {level}: {'; '.join(statistics)} ({run.rules.cited}), farthest out over bounds "
        f"({bounds}) and over both ends and the middle of each member, with the permanent loads of "
        "the model as they act in the time histories. Local axes, tension positive. members.csv "
        "has every member with its permanent part, for other combinations of loads, and what acts "
        "at the same instant."
    )


def _judged(check: Check) -> Judged:
    return Judged(
        check=check,
        demand=check.said[0],
        limit=check.said[1],
        ratio=check.said[2],
        steps=[(Markup(step.mathml()), step.said) for step in check.trace],  # noqa: S704
    )


def _programme(tests: pd.DataFrame) -> Table:
    # Clauses with a star where they are to be confirmed; kinds of bearings where there are several.
    starred = tests["clause"].where(tests["standing"] != TO_BE_CONFIRMED, tests["clause"] + " *")
    named = pd.Index([f"{k} {name}" for k, name in tests["what"].items()])
    shown = (
        tests.assign(clause=starred).drop(columns=["standing", "what", "shows"]).set_index(named)
    )
    if shown["bearings"].nunique() == 1:
        shown = shown.drop(columns="bearings")
    return page_table(in_mm_and_kn(shown), "test")


def _facts(run: ProjectRun) -> dict[str, str]:
    attrs = run.governing.attrs
    return {
        "written": datetime.now(tz=UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "lir-dcfp": package_version(),
        "Python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "level, integrator, step control": (
            f"{attrs['level']}, {attrs['integrator']}, {attrs['step_control']}"
        ),
    }
