"""What all claims share: checks, the page a claim writes, and the index of all pages.

A claim is a module with `CLAIM` and a function `page`, which hands back a `Page`. `run` writes it
to docs/validation/<name>.md with its figures, and builds docs/validation/README.md anew from the
summaries of the pages that are there.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from matplotlib.figure import Figure

FOLDER = Path(__file__).parents[1] / "docs" / "validation"
DPI = 120
CLAIMS = (
    "static_test",
    "newhall",
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

SUMMARY_HEAD = ("claim", "source", "result", "holds")
CHECK_HEAD = ("statement", "source", "expected", "got", "holds")


@dataclass(frozen=True)
class Claim:
    """What a script claims.

    Attributes
    ----------
    name : str
        Its module in this package, and its page.
    title : str
        Heading of the page.
    statement : str
        The claim in one sentence.
    source : str
        Where it comes from.
    record : str
        File of a recorded ground motion that it needs; empty if none.
    """

    name: str
    title: str
    statement: str
    source: str
    record: str = ""


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
    """What a claim hands back.

    Attributes
    ----------
    claim : Claim
        What it claims.
    result : str
        The numbers that matter, in one sentence.
    checks : sequence of Check
        The statements one by one.
    parts : sequence of str
        The text of the page, paragraphs in Markdown.
    figures : dict of str to Figure
        By name; the text refers to them as `figure`.
    files : dict of str to callable
        Other files in the folder of figures: by name, a function that writes to a path.
    """

    claim: Claim
    result: str
    checks: Sequence[Check]
    parts: Sequence[str]
    figures: dict[str, Figure]
    files: dict[str, Callable[[Path], None]] = field(default_factory=dict)

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
            *self.parts,
        ]
        return "\n\n".join(parts) + "\n"


def near(what: str, source: str, expected: float, got: float, within: float, unit: str) -> Check:
    """Return the check that `got` agrees with `expected` within a share `within`."""
    holds = bool(abs(got - expected) <= within * abs(expected))
    text = f"{expected:.4g}{_of(unit)} ± {100.0 * within:.2g} %"
    return Check(what, source, text, f"{got:.4g}{_of(unit)}", holds)


def below(what: str, source: str, limit: float, got: float, unit: str) -> Check:
    """Return the check that `got` stays below a limit."""
    return Check(
        what, source, f"< {limit:.4g}{_of(unit)}", f"{got:.4g}{_of(unit)}", bool(got < limit)
    )


def above(what: str, source: str, limit: float, got: float, unit: str) -> Check:
    """Return the check that `got` exceeds a limit."""
    return Check(
        what, source, f"> {limit:.4g}{_of(unit)}", f"{got:.4g}{_of(unit)}", bool(got > limit)
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines
    )


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
    rows = []
    for name in CLAIMS:
        path = folder / f"{name}.md"
        if not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        summary = text.split(head + "\n")[1].splitlines()[0]
        statement, rest = summary.removeprefix("| ").split(" | ", 1)
        rows.append(f"| [{statement}]({name}.md) | {rest}")
    return (
        "\n\n".join(
            [
                "# Validation: one script a claim",
                "Written by `python -m validation`, which runs all of them; each runs alone, too "
                "(`python -m validation.claims.static_test`). Claims that need a recorded ground motion "
                "are "
                "skipped where `LIR_RECORDS` names no folder that holds it: the record is not part of "
                "this repository.",
                head + "\n" + "\n".join(rows),
                "Besides: [benchmark.md](benchmark.md), cost for the same accuracy, beside OpenSees "
                "(`python -m validation.measurements.benchmark`), "
                "[speed_error.md](speed_error.md), error over cost of every level and step in "
                "nine test cases (`python -m validation.measurements.speed_error`), "
                "[hard_cases.md](hard_cases.md), "
                "what is hard to compute (`python -m validation.measurements.hard_cases`), "
                "[opensees_hard_cases.md](opensees_hard_cases.md), the same with the elements of OpenSees "
                "(`python -m validation.measurements.opensees_hard_cases`), "
                "[opensees_cost.md](opensees_cost.md), "
                "what a bearing costs inside OpenSees (`python -m validation.measurements.opensees_cost`), "
                "[opensees_public_models.md](opensees_public_models.md), public models on bearings in "
                "both programs (`python -m validation.measurements.opensees_public_models`), "
                "[slip.md](slip.md), the slip of the interface where rims are met "
                "(`python -m validation.measurements.slip`), "
                "[level_doubts.md](level_doubts.md), what the level `pendulum` has wrong in "
                "buildings (`python -m validation.measurements.level_doubts`), "
                "[random_scenes.md](random_scenes.md), test cases by the thousand with everything unequal "
                "(`python -m validation.random_scenes`), "
                "[yielding.md](yielding.md), random buildings that yield, each at two steps "
                "(`python -m validation.measurements.yielding`), "
                "[worked_building.md](worked_building.md), the design guide's building under three codes "
                "(`python -m validation.measurements.worked_building`), "
                "[yielding_comparison.md](yielding_comparison.md), buildings that yield on four "
                "systems (`python -m validation.measurements.yielding_comparison`), "
                "**[study_summary.md](study_summary.md), when the LIR-DCFP does better than a DCFP, when "
                "not, and what it costs** (`python -m validation.study.summary`), from its parts: "
                "[study.md](study.md), the records of FEMA P695 on four devices "
                "(`python -m validation.study.records`), "
                "[study_rims.md](study_rims.md), the same on devices of equal plan whose rims yield "
                "and break (`python -m validation.study.rims`), "
                "[study_device.md](study_device.md), the best LIR-DCFP of a plan and its cost "
                "(`python -m validation.study.device`), "
                "[study_buildings.md](study_buildings.md), buildings of frames and of walls on them "
                "(`python -m validation.study.buildings`), "
                "[study_motions.md](study_motions.md), records turned, with a vertical component, one "
                "after another, and pulses (`python -m validation.study.motions`), "
                "[study_after.md](study_after.md), a stop that carries on after a bearing's failure "
                "(`python -m validation.study.after`), "
                "[study_uncertainty.md](study_uncertainty.md), which properties decide "
                "(`python -m validation.study.uncertainty`), "
                "and [study_loss.md](study_loss.md), expected loss, annual rates at three sites, spectral "
                "shape and floor spectra (`python -m validation.study.loss`).",
                '"Paper" is the paper of COMPDYN 2023 ([how to cite](../../README.md#how-to-cite)). '
                "It prints its results as figures; no data of them is published, so the claims check what "
                "its text states, and closed forms. What the tests demand besides is listed in the "
                "[verification.md](../verification.md); speed in "
                "[performance.md](../performance.md).",
            ]
        )
        + "\n"
    )


def _of(unit: str) -> str:
    return f" {unit}" if unit else ""
