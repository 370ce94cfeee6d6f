"""The command ``lir``: new, check, design, run, report, view, compare, bench, campaign, schema.

Each command imports its modules itself: ``lir --help`` and errors of the command line wait for
none.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.markup import escape

from frames.command.campaigns import campaign, campaign_archive, campaign_status
from frames.command.console import FAILED_CHECKS, err, exit_codes, out, project_in, say, trust
from frames.command.designing import propose
from frames.command.viewing import compare, export, view

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pandas as pd

    from frames.design.calculation.check import Checks
    from frames.design.codes.code_values import ProvisionState
    from frames.design.project.design_run import ProjectRun
    from frames.design.project.speed import Way

app = typer.Typer(
    name="lir",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Analyse and design buildings on LIR-DCFP bearings, from a project file to its report. "
    "Exit codes: 0 no check fails, 1 a check fails, 2 the input cannot be used, 3 an analysis "
    "fails, 4 a file cannot be read or written, 130 interrupted.",
    epilog="Example: lir new office && cd office && lir run",
)
HERE, FILE, RESULTS = Path(), Path("project.toml"), Path("results")
BENCH = Path("bench.csv")

File = Annotated[Path, typer.Argument(help="Path of the project file.")]


def _version(asked: bool) -> None:
    if asked:
        from lir_element._version import package_version

        say(f"lir-dcfp {package_version()}")
        raise typer.Exit


@app.callback()
def lir(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
    scripts_from_anywhere: Annotated[
        bool,
        typer.Option(
            "--scripts-from-anywhere",
            help="Run Python files outside of the project folder, too.",
        ),
    ] = False,
) -> None:
    """Set the options of all commands."""
    trust(scripts_from_anywhere)


@app.command(epilog="Example: lir new tower --code 'EN 1998'")
def new(
    folder: Annotated[Path, typer.Argument(help="Folder for the project.")] = HERE,
    code: Annotated[
        str | None, typer.Option(help="Design code: ASCE 7-22 (default), EN 1998 or NCh2745.")
    ] = None,
    example: Annotated[
        str | None,
        typer.Option(help="Copy a whole building: hospital, imported, near-fault or office."),
    ] = None,
    model: Annotated[
        Path | None,
        typer.Option("--from", help="Use a text model of SAP2000 or ETABS as the structure."),
    ] = None,
) -> None:
    """Write an example project: a commented file and artificial ground motions."""
    from frames.design._errors import ProjectError
    from frames.design.project.example import write_example

    with exit_codes():
        try:
            written = write_example(folder, code, example, model)
        except FileExistsError as cause:
            msg = f"{cause} exists: name another folder"
            raise ProjectError(msg) from cause
    has_bearing = "\n[bearing]" in written[0].read_text(encoding="utf-8")
    then = "check" if has_bearing else "design"
    say(
        f"{written[0]} and {len(written) - 1} other files are written; next: lir {then} "
        f"{written[0]}"
    )


@app.command(epilog="Example: lir check tower.toml")
def check(file: File = FILE) -> None:
    """Check a project file, its model and motions, and run the equivalent-linear analysis."""
    from frames.design.histories.motions import motion_checks
    from frames.design.project.design_run import from_memory, provisions_of
    from frames.design.project.level_runs import said_of_runs
    from frames.design.project.moat_and_dampers import columns_by_type
    from frames.design.project.preliminary import preliminary
    from frames.design.project.structure_statement import structure_rows
    from lir_element.texts import text_table

    with exit_codes():
        parts = project_in(file)
        ground = preliminary(parts)
        say(parts.code().cited)
        say(text_table(structure_rows(parts.file, ground.frame, ground.spectrum), left=2))
        for kind, columns in columns_by_type(ground.kinds).items():
            say(f"type {kind}: {', '.join(columns)}")
        say(str(ground.frame.check()))
        _frame_table("Motions", ground.motions.table())
        for each in motion_checks(ground.motions, ground.spectrum, ground.equivalent):
            if not each.passed:
                say(f"`lir run` will report: {each.statement} fails [{each.clause}]")
        say(repr(ground.equivalent))
        _checks("Equivalent-linear analysis, rims left out", ground.checks)
        _provisions(provisions_of(parts, ground, (), is_run=False))
        _say_each(from_memory(parts.code()))
        say(f"the file can be run: lir run {file} ({said_of_runs(parts, ground.motions)})")
        if not ground.checks.passed:
            raise typer.Exit(FAILED_CHECKS)


app.command(name="design", epilog="Example: lir design --objective cost --write")(propose)


@app.command(epilog="Example: lir run tower.toml --results tower-1")
def run(
    file: File = FILE,
    results: Annotated[Path, typer.Option(help="Folder for the results.")] = RESULTS,
    figures: Annotated[bool, typer.Option(help="Draw the figures of the report.")] = True,
) -> None:
    """Run the time histories of a project, check the design, and write results and report."""
    from frames.design.project.design_run import run_project
    from frames.design.project.level_runs import said_of_runs
    from frames.design.report.files import UNFINISHED, write_run  # with figures
    from frames.results.storage import make_folder

    with exit_codes():
        try:
            parts = project_in(file)
            make_folder(results)
            say(parts.code().cited)
            say(said_of_runs(parts, parts.motions()))
            found = run_project(parts, progress=True, resume=results / UNFINISHED)
            err.print("writing results and report", highlight=False)
            written = write_run(found, results, parts.sources.text, figures=figures)
        except (OSError, KeyboardInterrupt):
            _said_to_be_kept(results / UNFINISHED)
            raise
        _told_of(found, written, results)


@app.command(epilog="Example: lir report --language es --pdf")
def report(
    file: File = FILE,
    results: Annotated[Path, typer.Option(help="Folder with the results.")] = RESULTS,
    figures: Annotated[bool, typer.Option(help="Draw the figures of the report.")] = True,
    language: Annotated[
        str, typer.Option(help="Language of the report: en or es (default: that of the file).")
    ] = "",
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Print report.pdf, too (needs Chromium).")
    ] = False,
) -> None:
    """Check a run again with the present limits of its file, and rewrite the report."""
    from frames.design.project.design_run import evaluate_run
    from frames.design.project.preliminary import inputs_of, preliminary
    from frames.design.report.files import UNFINISHED, print_report, read_histories, write_judgement
    from frames.results.storage import refuse_links

    with exit_codes():
        refuse_links(results)
        parts = project_in(file)
        known = preliminary(parts)
        found = evaluate_run(parts, known, *read_histories(results, inputs_of(parts, known)))
        if (results / UNFINISHED).is_dir():
            text = (
                "warning: the report shows the last complete run, because a later run was "
                f"interrupted ({results / UNFINISHED})"
            )
            err.print(text, markup=False, highlight=False, soft_wrap=True)
        source = parts.sources.text
        old = [name for name in ("view.html", "report.pdf") if (results / name).is_file()]
        if old:
            err.print(f"earlier results removed: {', '.join(old)}", highlight=False)
        written = write_judgement(found, results, source, figures=figures, language=language)
        if pdf:
            written.append(print_report(results / "report.html", results / "report.pdf"))
        _told_of(found, written, results)


app.command(epilog="Example: lir view --size 10")(view)


def _said_to_be_kept(unfinished: Path) -> None:
    # After an error of the disk, or an interruption.
    count = sum(1 for _ in unfinished.rglob("*.npz"))
    if count:
        err.print(
            f"{count} complete runs are kept in {escape(str(unfinished))}: repeat the command to "
            "continue",
            highlight=False,
            soft_wrap=True,
        )
        if (unfinished.parent / "run.json").is_file():
            err.print("the other files there belong to the earlier run", highlight=False)


def _told_of(found: ProjectRun, written: list[Path], results: Path) -> None:
    from frames.design.histories.demand_table import tables_of_levels

    for level, statistics, table in tables_of_levels(found.demands):
        _frame_table(f"Demands, level {level}" if level else "Demands", table)
        words = (f"{bound}: {said}" if bound else said for bound, said in statistics)
        say(f"values: {'; '.join(words)}")
    if found.failures:
        out.print("[bold]Runs that failed[/]: their largest values are not valid for design")
        for cause in dict.fromkeys(one.cause for one in found.failures):
            say(cause)
            _say_each(f"  {one}" for one in found.failures if one.cause == cause)
    if len(moved := found.runs.moved):
        seconds = float(moved.parts[0].attrs["seconds"])  # of all of them: one batch
        say(
            f"demands are raised by {len(moved)} time histories with moved masses ({seconds:.3g} s)"
        )
    _checks("Checks", found.checks)
    _provisions(found.provisions)
    say(f"{len(written)} files in {results}, including report.html")
    if not found.checks.passed:
        raise typer.Exit(FAILED_CHECKS)


app.command(epilog="Example: lir compare tower.toml")(compare)
app.command(epilog="Example: lir export --to sap2000")(export)


@app.command(epilog="Example: lir bench --error 0.005 --contact")
def bench(
    file: File = FILE,
    error: Annotated[float, typer.Option(help="Allowed error of the peaks [-].")] = 0.01,
    contact: Annotated[bool, typer.Option(help="Include the level contact.")] = False,
    table: Annotated[Path, typer.Option(help="File for the table [CSV].")] = BENCH,
) -> None:
    """Measure speed and error of several time steps with the first motion."""
    import pandas as pd

    from frames.design.project.preliminary import preliminary
    from frames.design.project.speed import recommended, ways_to_run
    from frames.results.storage import csv_of, write_whole

    ways: list[Way] = []
    with exit_codes():
        ground = preliminary(project_in(file))
        name, motion = next(iter(ground.motions.items()))
        say(
            f"{name}, {motion.duration:g} s; differences relative to the first line, at nominal "
            "friction"
        )
        say(_LINE.format("step", "level", "steps", "us/step", "s", "real time", *_PEAKS, ""))
        try:
            for way in ways_to_run(ground.frame, motion, levels=_levels(contact)):
                ways.append(way)
                say(_line_of(way))
        finally:
            if ways:
                write_whole(table, csv_of(pd.DataFrame(ways), index=False))
        best = recommended(ways[1:], error)
        if best is None:
            say(f"every step exceeds the error of {100.0 * error:.3g} % in the peaks")
        else:
            step = "leave dt out" if math.isnan(best.dt) else f'dt = "{1e3 * best.dt:g} ms"'
            say(f'error below {error:.3g} in the peaks: [analysis] {step}, level = "{best.level}"')
        say(f"the table is in {table}")


_LINE = "{:>9} {:>9} {:>8} {:>8} {:>8} {:>10} {:>8} {:>8} {:>8}  {}"
_PEAKS = ("u", "shear", "accel.")


def _levels(contact: bool) -> tuple[Literal["pendulum", "contact"], ...]:
    return ("pendulum", "contact") if contact else ("pendulum",)


def _line_of(way: Way) -> str:
    errors = (
        "-" if math.isnan(e) else f"{100.0 * e:.3f} %"
        for e in (way.displacement, way.base_shear, way.acceleration)
    )
    return _LINE.format(
        "chosen" if math.isnan(way.dt) else f"{1e3 * way.dt:g} ms",
        way.level,
        way.steps,
        f"{1e6 * way.seconds / max(way.steps, 1):.1f}",
        f"{way.seconds:.3f}",
        f"{way.share:.4f}",
        *errors,
        way.status,
    )


app.command(epilog="Example: lir campaign fragility.toml --workers 8")(campaign)
app.command(epilog="Example: lir campaign-status fragility-results")(campaign_status)
app.command(epilog="Example: lir campaign-archive fragility-results data.zip")(campaign_archive)


@app.command(name="schema", epilog="Example: lir schema > project.schema.json")
def print_schema() -> None:
    """Print the JSON schema of the project file, for editors."""
    from frames.design.project.reading import schema

    sys.stdout.write(schema() + "\n")


def _checks(title: str, checks: Checks) -> None:
    # A line each, those that fail in red, limits of a procedure that are exceeded in yellow;
    # those without a valid value in two lines: checks.csv has each.
    from frames.design.calculation.standing import LEGEND

    out.print(f"\n[bold]{title}[/]: {checks.tally}", soft_wrap=True)
    width = max((len(each.verdict) for each in checks), default=0)
    for each in checks:
        if each.verdict == "no value":
            continue
        style = {"ok": "green", "FAILS": "red"}.get(each.verdict, "yellow")
        out.print(f"[{style}]{each.verdict:{width}}[/] ", end="")
        star = each.cited.removeprefix(each.clause)
        say(f"{each.brief} [{each.clause}]{star}")
    beyond, within = checks.without_value.beyond_and_within
    for which, titles in (("beyond", beyond), ("not beyond", within)):
        if titles:
            out.print(f"[red]no value[/], {which} the limit before the failure: ", end="")
            say("; ".join(titles))
    if any(each.standing.starred for each in checks):
        say(LEGEND)


def _provisions(states: Iterable[ProvisionState]) -> None:
    # Provisions that are not checked with their reasons, a line each; the engineer's in one.
    from frames.design.codes.code_values import RUN, left_to_the_engineer, not_checked

    every = tuple(states)
    checked, left, own = len(every), not_checked(every), left_to_the_engineer(every)
    checked -= len(left) + len(own)
    later = f" here or by {RUN}" if any(one.how == RUN for one in every) else ""
    title = f"{checked} of {len(every)} provisions are checked{later}, {len(left)} are not"
    out.print(f"\n[bold]Provisions[/]: {title}, {len(own)} are yours", soft_wrap=True)
    _say_each(left)
    say(f"yours: {'; '.join(own)}")


def _say_each(sentences: Iterable[str]) -> None:
    for sentence in sentences:
        say(sentence)


def _frame_table(title: str, frame: pd.DataFrame) -> None:
    from frames.design.report.tables import rows_of
    from lir_element.texts import text_table

    out.print(f"\n[bold]{title}[/]")
    say(text_table(rows_of(frame), ("", *map(str, frame.columns))))
