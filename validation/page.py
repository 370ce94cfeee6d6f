"""What all claims share: checks, the page a claim writes, and the index of all pages.

A claim is a module with `CLAIM` and a function `page`, which hands back a `Page`. `run` writes it
to docs/validation/<name>.md with its figures, and builds docs/validation/README.md anew from the
summaries of the pages that are there.
"""

from __future__ import annotations

import builtins
import csv
import os
import re
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jinja2

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from matplotlib.figure import Figure

FOLDER = Path(__file__).parents[1] / "docs" / "validation"
ROBUSTNESS = FOLDER / "robustness.md"
"""Sections of several scripts."""
DPI = 120
CLAIMS = (
    "static_test",
    "newhall",
    "multibody",
    "convergence",
    "shake_table",
    "double_pendulum",
    "opensees_pendulum",
    "bouc_wen_drift",
    "opensees_element",
    "opensees_macro_model",
    "opensees_superstructure",
    "opensees_yielding",
)
"""The modules of the claims, in the order of the index."""

TEMPLATES = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)  # noqa: S701  (Markdown)
TEMPLATES.globals |= vars(builtins)
SUMMARY_HEAD = ("claim", "source", "result", "holds")
CHECK_HEAD = ("statement", "source", "expected", "got", "holds")


@dataclass(frozen=True)
class Claim:
    """What a script claims."""

    name: str
    """Its module in this package, and its page."""
    title: str
    """Heading of the page."""
    statement: str
    """The claim in one sentence."""
    source: str
    """Where it comes from."""
    record: str = ""
    """File of a recorded ground motion that it needs; empty if none."""
    package: str = ""
    """Package of an extra that it needs; empty if none."""


@dataclass(frozen=True)
class Check:
    """One statement: what, from where, the expected value and what came out."""

    what: str
    source: str
    expected: str
    got: str
    holds: bool


@dataclass(frozen=True)
class Page:
    """What a claim hands back."""

    claim: Claim
    """What it claims."""
    result: str
    """The numbers that matter, in one sentence."""
    checks: Sequence[Check]
    """The statements one by one."""
    body: str
    """The text of the page in Markdown."""
    figures: dict[str, Figure]
    """By name; the text refers to them as `figure`."""
    files: dict[str, Callable[[Path], None]] = field(default_factory=dict)
    """Other files in the folder of figures: by name, a function that writes to a path."""

    @property
    def holds(self) -> str:
        """Whether all checks hold: "yes", or how many of them do."""
        good = sum(check.holds for check in self.checks)
        count = len(self.checks)
        return "yes" if good == count else f"**{good} of {count}**"

    def text(self) -> str:
        """Return the page in Markdown."""
        claim = self.claim
        summary = (claim.statement, claim.source, self.result, self.holds)
        rows = [
            (c.what, c.source, c.expected, c.got, "yes" if c.holds else "**no**")
            for c in self.checks
        ]
        needs = f", which reads the record `{claim.record}`" if claim.record else ""
        parts = [
            f"# {claim.title}",
            f"Written by `python -m validation.claims.{claim.name}`{needs}. "
            "All claims: [README.md](README.md).",
            table(SUMMARY_HEAD, [summary]),
            table(CHECK_HEAD, rows),
            self.body,
        ]
        return "\n\n".join(parts)


_EXPECTED = re.compile(r"([<>] )?(\S+)( [^\s±]+)?(?: ± (\S+) %)?")


def stated(lines: str) -> list[Check]:
    """Return checks from lines "statement | source | expected | got".

    Expected is a bound, "< 3 mm" or "> 3 mm", or a value, "175 mm ± 0.5 %".
    """
    checks = []
    for line in lines.strip().splitlines():
        what, source, expected, number = line.strip().split(" | ")
        found = _EXPECTED.fullmatch(expected)
        if found is None:
            msg = f'"{expected}" is no bound and no value: write "< 3 mm" or "175 mm ± 0.5 %"'
            raise ValueError(msg)
        way, unit, got, limit = found[1] or "", found[3] or "", float(number), float(found[2])
        within = float(found[4] or 0.0)
        holds = abs(got - limit) <= 0.01 * within * abs(limit)
        if way:
            holds = got < limit if way == "< " else got > limit
        text = f"{way}{limit:.4g}{unit}" + ("" if way else f" ± {within:.2g} %")
        checks.append(Check(what, source, text, f"{got:.4g}{unit}", holds))
    return checks


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    return rows([head, ["---"] * len(head), *lines])


def rows(lines: Iterable[Sequence[str]]) -> str:
    """Return rows of a table in Markdown."""
    return "\n".join(
        "| " + " | ".join(c.replace("|", "\\|") for c in line) + " |" for line in lines
    )


def number(value: Any, form: str = "") -> str:
    """Return a number in a format; a dash if it is not known."""
    return "-" if value != value else format(value, form)


def render(script: dict[str, Any], name: str = "", **values: Any) -> str:
    """Return the template beside a script, filled with the script's names and these values.

    A template is a page with its numbers left out; `name` is that of its script unless given.
    """
    place = Path(script["__file__"])
    template = TEMPLATES.from_string(
        place.with_name(f"{name or place.stem}.md.j2").read_text(encoding="utf-8")
    )
    return re.sub(r"\n{3,}", "\n\n", template.render({**script, **values})).strip("\n") + "\n"


TEMPLATES.globals["table"] = table
TEMPLATES.filters |= {"f": number, "rows": rows}


def as_csv(name: str, caller: Callable[[], str]) -> str:
    """Keep a table of a template as CSV, docs/validation/tables/<name>.csv; return a link to it."""
    lines = [re.split(r"(?<!\\)\|", line)[1:-1] for line in caller().strip().splitlines()]
    cells = [[cell.strip(" *`").replace("\\|", "|") for cell in line] for line in lines]
    path = FOLDER / "tables" / f"{name}.csv"
    path.parent.mkdir(exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([cells[0], *cells[2:]])
    return f"[{path.name}](tables/{path.name}) ({len(cells) - 2} rows)"


TEMPLATES.globals["as_csv"] = as_csv


def put(page: Path, part: str, text: str) -> None:
    """Replace a script's part of a page, between its marks."""
    begin, end = (f"<!-- {part}: {word} -->" for word in ("begin", "end"))
    before, rest = page.read_text(encoding="utf-8").split(begin)
    after = rest.split(end)[1]
    page.write_text(f"{before}{begin}\n\n{text.strip()}\n\n{end}{after}", encoding="utf-8")


def figure(claim: Claim, name: str, caption: str, suffix: str = "png") -> str:
    """Return the reference to a figure of a claim."""
    return f"![{caption}](figures/{claim.name}-{name}.{suffix})"


def records(claim: Claim) -> Path | None:
    """Return the folder of records, None where it does not hold what the claim needs."""
    folder = Path(os.environ.get("LIR_RECORDS", ""))
    return folder if os.environ.get("LIR_RECORDS") and (folder / claim.record).is_file() else None


def run(claim: Claim, make: Callable[[Path | None], Page]) -> Page | None:
    """Make the page of a claim and write it, or print why it is skipped."""
    folder = records(claim)
    if claim.record and folder is None:
        print(f"{claim.name}: skipped, for LIR_RECORDS names no folder that holds {claim.record}")
        return None
    if claim.package and find_spec(claim.package) is None:
        print(f"{claim.name}: skipped, for {claim.package} is not installed")
        return None
    page = make(folder)
    write(page)
    print(f"{claim.name}: holds: {page.holds.strip('*')}; {page.result}")
    for check in page.checks:
        mark = " " if check.holds else "!"
        print(f"  {mark} {check.what}: expected {check.expected}, got {check.got}")
    return page


def write(page: Page, folder: Path = FOLDER) -> None:
    """Write a page, its figures and the index to a folder."""
    name, pictures = page.claim.name, folder / "figures"
    pictures.mkdir(parents=True, exist_ok=True)
    for key, drawn in page.figures.items():
        drawn.savefig(pictures / f"{name}-{key}.png", dpi=DPI, metadata={"Software": None})
    for key, save in page.files.items():
        save(pictures / f"{name}-{key}")
    (folder / f"{name}.md").write_text(page.text(), encoding="utf-8")
    (folder / "README.md").write_text(index(folder), encoding="utf-8")


def index(folder: Path = FOLDER) -> str:
    """Return the index, from the summaries of the pages in a folder."""
    head = table(SUMMARY_HEAD, [])
    lines = []
    for name in CLAIMS:
        path = folder / f"{name}.md"
        if path.is_file():
            text = path.read_text(encoding="utf-8")
            summary = text.split(head + "\n")[1].splitlines()[0]
            statement, rest = summary.removeprefix("| ").split(" | ", 1)
            lines.append(f"| [{statement}]({name}.md) | {rest}")
    return render(globals(), "README", head=head, lines=lines)
