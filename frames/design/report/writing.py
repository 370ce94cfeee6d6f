"""A run as one HTML file: input, results, every check with its calculation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pandas as pd

from frames.design.calculation.standing import FROM_MEMORY, LEGEND, standing_of
from frames.design.codes.code_values import left_to_the_engineer
from frames.design.codes.registry import code_named
from frames.design.histories.demand_table import largest_of_links, tables_of_levels
from frames.design.report.cover import (
    cover_of,
    css_string,
    factor_steps,
    judged,
    verdict_of,
    what_governs,
)
from frames.design.report.page import Table, Words, page_table, page_template
from frames.design.report.result_tables import (
    BY_MOTION,
    COMBINED,
    ECCENTRICITY,
    LINKS,
    WITHOUT_FORCES,
    device_table,
    devices_by_type,
    loads_table,
    model_table,
)
from frames.design.report.tables import in_mm_and_kn, in_parts
from frames.design.report.tender import texts
from frames.design.testing.programme import OWN_RULES, OWN_SPECIMENS
from frames.results.findings import findings_of
from frames.results.quantities import JUDGED
from lir_element.texts import joined, keeping_texts, worded

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.design.codes.registry import DesignCode
    from frames.design.project.design_run import ProjectRun


SECTIONS = (
    ("summary", "What governs"),
    ("structure", "Structure"),
    ("bearings", "Bearings"),
    ("motions", "Motions"),
    ("equivalent-linear-analysis", "Equivalent-linear analysis"),
    ("time-histories", "Time histories"),
    ("checks", "Checks"),
    ("tender", "Bearings for tender"),
    ("test-programme", "Test programme"),
    ("specification", "Access, inspection, replacement"),
    ("calculations", "Calculations"),
    ("input", "Input"),
)
"""Anchors and headings of the report's sections."""


def report_html(
    run: ProjectRun,
    source: str,
    tables: Mapping[str, pd.DataFrame],
    *,
    figures: bool = True,
    language: str = "",
) -> str:
    """Return a run as a self-contained HTML page."""
    return report_in(_words(run, language), run, source, tables, figures=figures)


@keeping_texts
def report_in(
    words: Words,
    run: ProjectRun,
    source: str,
    tables: Mapping[str, pd.DataFrame],
    *,
    figures: bool = True,
) -> str:
    """Return the page of `report_html` in a language; `words` then lists missing texts."""
    device = next(iter(run.frame.bearings.values())).bearing
    attrs, drawn = run.governing.attrs, {}
    if figures:
        from frames.design.report.figures import pictures  # with matplotlib

        drawn = pictures(run, words)

    return page_template("report.html.j2", words=words).render(
        **_tables(words, run, tables),
        language=words.language,
        run=run,
        device="DCFP" if device.is_dcfp else "LIR-DCFP",
        cover=cover_of(run, source),
        css_string=css_string,
        sections=SECTIONS,
        failed=len(run.checks.failed),
        least=[judged(check) for check in run.checks.raised],
        governing=what_governs(run.checks),
        judged=judged,
        legend=LEGEND,
        checks=[judged(check) for check in run.checks],
        unchecked=[one.what for one in run.provisions if one.state == "not checked"],
        own=left_to_the_engineer(run.provisions),
        limits=[judged(check) for check in run.equivalent.checks if check not in run.checks],
        notes=[*([run.model.failure] if run.model.failure else []), *run.model.doubts],
        factors=factor_steps(run.bounds),
        tender=texts(run),
        specimens=code_named(run.equivalent.code).values.get("number of specimens", OWN_SPECIMENS),
        of_tests=_notes(tables["programme"]),
        eccentricity=eccentricity_said(run),
        levels=_levels(run),
        level=run.rules.levels[0].name,
        audit=findings_of(run.governing).lines(),
        pictures=drawn,
        source=source,
        options=(attrs["level"], attrs["integrator"], attrs["step_control"]),
    )


def _tables(words: Words, run: ProjectRun, tables: Mapping[str, pd.DataFrame]) -> dict[str, object]:
    # The tables of the page, in parts that fit it.
    def fit(table: Table, keep: int = 1) -> list[Table]:
        return in_parts(words.table(table), keep=keep)

    def of(name: str, head: str, keep: int = 1, only: str = ".") -> list[Table]:
        shown = tables.get(name, pd.DataFrame()).filter(regex=only)
        return fit(page_table(in_mm_and_kn(_marked(shown)), head), keep)

    verdict = verdict_of(run)
    raised = raised_tables(tables.get(ECCENTRICITY, pd.DataFrame()))
    structure = Table(("of the structure", "as described"), run.structure, frozenset({0, 1}))
    accepted = _accepted(code_named(run.equivalent.code), tables["programme"])
    tables = {**tables, "programme": _programme(tables["programme"])}
    return {
        "failures": words.table(verdict.failures),
        "verdict": verdict,
        "provisions": words.table(_provisions(run)),
        "structure": words.table(structure),
        "model": words.table(model_table(run.model)),
        "loads": fit(loads_table(run.model)),
        "devices": [
            (kind, words.table(device_table(one))) for kind, one in devices_by_type(run).items()
        ],
        "reached": of("bearings", "bearing"),
        "friction": words.table(_friction(tables["friction"])),
        "modes": of("modes", "mode"),
        "centres": of("centres", "level"),
        "by_type": of("schedule", "of the bearings", 2),
        "places": of("bearings", "bearing", only="^(number|axes|type|[xy] |average)"),
        "rig": of("rig", "bearings to test"),
        "replacement": of("replacement", "type to replace"),
        "links": fit(_links(tables.get(LINKS, pd.DataFrame()))),
        "untold": of(WITHOUT_FORCES, "kind"),
        "members": of("member-groups", "members", 3),
        "foundation": fit(foundation_table(tables, run.rules.bearing_level), 2),
        "uplift": fit(_uplift(tables.get(COMBINED[2], pd.DataFrame()))),
        "programme": of("programme", "test", only="^(?!k_eff|EDC|friction)"),
        "loops": of("programme", "test", only="^(k_eff|EDC|friction)"),
        "accepted": words.table(accepted),
        "motions": fit(page_table(run.motions.table().rename(columns=_named), "motion")),
        "equivalent": fit(Table(run.equivalent.head(), run.equivalent.rows())),
        "demands": [
            (level, said, fit(page_table(part, "quantity")))
            for level, said, part in tables_of_levels(run.demands)
        ],
        "raised": list(map(words.table, raised)),
        "by_motion": list(map(words.table, motion_tables(tables[BY_MOTION]))),
    }


def _words(run: ProjectRun, language: str) -> Words:
    names = {run.frame.name, *run.frame.bearings, *run.frame.nodes, *run.frame.members}
    names |= {name for part in run.frame.superelements.values() for name in part.elements.names}
    names |= {*run.motions, *(level.name for level in run.frame.levels), *run.kinds.values()}
    return Words(language or run.about.language, run.about.decimal, names)


def _levels(run: ProjectRun) -> str:
    # Checked parts by level of the seismic action, if there are several.
    words = {
        "all": "bearings and structure",
        "isolation": "the bearings",
        "superstructure": "what stands on the bearings",
    }
    each = [
        worded(
            "{what} at the level '{level}', motions times {factor:g}",
            what=words[one.judges],
            level=one.name,
            factor=one.factor,
        )
        for one in run.rules.levels
    ]
    said = worded(
        "{code} judges {levels}. The table has both levels.",
        code=run.equivalent.code,
        levels=joined(*each),
    )
    return said if len(each) > 1 else ""


_FACTS = {"azimuth_x": "azimuth of x [°]", "azimuth_y": "azimuth of y [°]", "strike": "strike [°]"}


def _named(fact: str) -> str:
    # The head of a column of a table of motions, whose keys are names.
    return _FACTS.get(fact, fact.replace("_", " ").replace("m/s2", "m/s²"))


def _provisions(run: ProjectRun) -> Table:
    head = ("provision", "clause", "is", "by, or why not")
    rows = [(one.what, one.clause, one.state, one.how) for one in run.provisions]
    return Table(head, rows, frozenset({0, 1, 2, 3}))


def _friction(friction: pd.DataFrame) -> Table:
    # A rigid slider has no friction coefficient of its interface: a word in place of infinity.
    made = page_table(friction, "friction coefficient")
    rows = [["rigid slider" if cell == "inf" else cell for cell in row] for row in made.rows]
    return Table(made.head, rows, made.left)


def _links(links: pd.DataFrame) -> Table:
    # Each link at its largest force of all bounds.
    if links.empty:
        return page_table(links, "link")
    shown = _marked(largest_of_links(links).set_index("link"))
    for column in ("level", "statistic"):
        shown = _unless_alike(shown, column)
    return page_table(in_mm_and_kn(shown), "link")


def _marked(table: pd.DataFrame) -> pd.DataFrame:
    # Rows without a valid value are marked, if there are others; a sentence has the reason.
    if "void" not in table:
        return table
    is_void = table["void"].fillna("") != ""
    if is_void.all() or not is_void.any():
        return table.drop(columns="void")
    return table.assign(void=is_void.map({True: "not valid", False: ""}))


def _unless_alike(table: pd.DataFrame, column: str) -> pd.DataFrame:
    # A column stays if its rows differ.
    return table.drop(columns=column) if table[column].nunique() == 1 else table


def foundation_table(tables: Mapping[str, pd.DataFrame], level: str) -> Table:
    """Return the forces of each bearing on its foundation by combination: three rows a bearing."""
    table = tables.get(COMBINED[1], pd.DataFrame())
    if table.empty:
        return page_table(table, "foundation below")
    below = table[(table.index == level) & (table["side"] == "below")].reset_index(drop=True)
    load = below["value"].where(below["force"] == "N")
    chosen = {
        "largest N": load.where(below["extreme"] == "max"),
        "least N": -load.where(below["extreme"] == "min"),
        "largest M": below["value"].abs().where(below["force"].isin(["Mx", "My"])),
    }
    rows = []
    for name, own in below.groupby("bearing", sort=False):
        for title, out in chosen.items():
            worst = own.loc[out[own.index].idxmax()]
            forces = {f"{f} [{unit}]": worst[f"{f} then"] for f, unit in _FORCES.items()}
            of = {"combination": worst["combination"], "bound": worst["bound"]}
            rows.append({"bearing": name, "row": title} | forces | of)
    shown = pd.DataFrame(rows).set_index("bearing")
    return page_table(in_mm_and_kn(shown), "foundation below")


_FORCES = {"N": "N", "Vx": "N", "Vy": "N", "Mx": "N m", "My": "N m"}


def _uplift(table: pd.DataFrame) -> Table:
    # Uplift of bearings in a run, or under a combination.
    if table.empty:
        return page_table(table, "bearing that lifts")
    lifts = (table["tension if held [N]"] > 0.0) | (table["uplift in runs [m]"] > 0.0)
    shown = table[lifts].drop(columns=["void", "level", "bound"])
    return page_table(in_mm_and_kn(shown), "bearing that lifts")


def _programme(tests: pd.DataFrame) -> pd.DataFrame:
    # Clauses with a star if they are from memory; kinds of bearings if there are several.
    cited = [
        standing_of(said).cited(clause)
        for clause, said in zip(tests["clause"], tests["standing"], strict=True)
    ]
    names = [worded("{k} {name}", k=k, name=name) for k, name in tests["what"].items()]
    left_out = ["standing", "note", "what", "shows", "accepted if"]
    shown = tests.assign(clause=cited).drop(columns=left_out)
    return _unless_alike(shown, "bearings").set_index(pd.Index(names, dtype=object))


def _accepted(code: DesignCode, tests: pd.DataFrame) -> Table:
    # Acceptance rules, each with its tests.
    rows = []
    for rule in (*code.accepted, *OWN_RULES):
        numbers = [str(k) for k, name in tests["what"].items() if rule.holds_for(name)]
        clause = rule.value.standing.cited(rule.value.clause)
        if numbers:
            rows.append((rule.value.what, ", ".join(numbers), clause))
    return Table(("accepted if", "tests", "clause"), rows, frozenset({0, 1, 2}))


def _notes(tests: pd.DataFrame) -> list[tuple[str, str]]:
    # Notes of tests, each once, with the numbers of its tests.
    noted = tests[tests["note"].fillna("") != ""]
    return [
        (", ".join(map(str, group.index)), str(note))
        for note, group in noted.groupby("note", sort=False)
    ]


_TITLES = {name.replace("_", " "): quantity.heading for name, quantity in JUDGED.items()}
_TITLES |= {"axial tension": "maximum axial tension"}  # as the table has it, not its negative
"""Names of the quantities of ``eccentricity.csv`` in the table of demands."""


def raised_tables(table: pd.DataFrame) -> list[Table]:
    """Return the governing direction of moved masses of each quantity at each bound, if any."""
    if table.empty:
        return []
    size = table["factor"].fillna(0.0) + table["added"].fillna(0.0)
    worst = table.loc[size.groupby([table["level"], table["bound"], table["quantity"]]).idxmax()]
    worst["quantity"] = worst["quantity"].replace(_TITLES)
    worst = worst.sort_index().set_index("quantity")
    worst.loc[worst["void"] != "", ["factor", "added"]] = math.nan  # peaks of failed runs
    # a pure number, for any unit of its row
    worst["factor"] = worst["factor"].map("{:.4g}".format).replace("nan", "-")
    order = ["level", "bound", "masses", "unit", "centred", "moved", "factor", "added", "motions"]
    return in_parts(page_table(_unless_alike(worst[order], "level"), "largest"))


def eccentricity_said(run: ProjectRun) -> str:
    """Return accidental eccentricity in the demands, in words."""
    asked = code_named(run.equivalent.code).histories
    clause = FROM_MEMORY.cited(f"{asked.cited} {asked.eccentricity_clause}".strip())
    asked_for = asked.accidental_eccentricity > 0.0
    share = 100.0 * run.rules.accidental_eccentricity
    moved = run.runs.moved
    if not len(moved):
        if not asked_for:
            return "Accidental eccentricity is not in these demands."
        return worded(
            "Accidental eccentricity is not in these demands; {clause} requires {share:g} % of "
            "the plan's sides.",
            clause=clause,
            share=100.0 * asked.accidental_eccentricity,
        )
    return worded(
        "Accidental eccentricity ({clause}): the masses of all floors moved by {share:g} % of the "
        "plan's sides in each direction, {n} more time histories in {s:.3g} s. The factor of the "
        "most unfavourable direction multiplies the results of the suite. Slip, rim force, "
        "eccentricity of the sliders' resultant and lost axial force begin at a threshold, and "
        "grow by the difference.",
        clause=clause,
        share=share,
        n=len(moved),
        s=float(moved.parts[0].attrs["seconds"]),
    )


def motion_tables(table: pd.DataFrame) -> list[Table]:
    """Return the columns with a mean, a row a run, in parts that fit a page."""
    keys = ["motion", "bound"]
    for key, usual in (("level", None), ("masses moved", ""), ("scale", 1.0), ("failed", "no")):
        values = table[key]
        if values.nunique() > 1 or (usual is not None and (values != usual).any()):
            keys.append(key)
    values = [
        title for title in table.columns if "[" in title and not title.partition(", farthest")[1]
    ]
    shown = in_mm_and_kn(table[[*keys, *values]].set_index("motion"))
    return in_parts(page_table(shown, "motion"), keep=len(keys))
