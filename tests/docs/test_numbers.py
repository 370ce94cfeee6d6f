"""Numbers in prose are those of the generated pages."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
VALIDATION = "validation/{}".format
DEMO = ("base shear over weight [-]", "floor acceleration in plan, mean [g]")


def text_of(page: str) -> str:
    return (DOCS / f"{page}.md").read_text(encoding="utf-8")


def rows(page: str, first: str) -> list[list[str]]:
    """Return the cells of the rows whose first cells fit a pattern, without the first."""
    found = re.findall(rf"^\| (?:{first}) \| (.*?) ?\|$", text_of(page), re.MULTILINE)
    assert found, (page, first)
    return [line.split(" | ") for line in found]


def number(cell: str) -> float:
    return float(re.match(r"[-+\d.e]+", cell)[0])


def ends(cells: Iterator[str], form: str = ".0f") -> str:
    """Return the least and the largest of some cells."""
    values = [number(cell) for cell in cells]
    return f"{min(values):{form}} to {max(values):{form}}"


def of_the_readme() -> Iterator[tuple[str, str]]:
    table = text_of("how_it_works")
    cells = (re.search(rf"{re.escape(name)} +(.*)", table)[1].split() for name in DEMO)
    shear, floor = ([f"{float(cell):.2f}" for cell in line] for line in cells)
    yield "../README", f"{shear[0]} times the weight and the peak floor acceleration {floor[0]} g."
    yield "../README", f"same rims gives {shear[1]} and {floor[1]} g. A DCFP without rims"
    yield "../README", f"gives {shear[2]} and {floor[2]} g."
    ((_, _, force, _),) = rows(VALIDATION("static_test"), r"largest force \(contact\)")
    yield "../README", f"the LIR-DCFP {number(force) / 150.0:.2f} times."


def of_opensees() -> Iterator[tuple[str, str]]:
    frames = text_of(VALIDATION("opensees_cost")).split("## Plain Newton")[0]
    lines = re.findall(r"^\| LIR.*?, (in|out-of)-process .*? \|(.*)\|$", frames, re.MULTILINE)
    within, outside = (
        ends((cell for one, line in lines if one == way for cell in line.split("| ")[-3:]), ".1f")
        for way in ("in", "out-of")
    )
    yield "../README", f"{within} times as long as on `singleFPBearing`, out of process {outside}"
    yield "choices_opensees", f"{within} times in buildings ([measured]"
    yield "choices_opensees", f"| {outside} times, most"
    found = r"([\d.]+ %) with hinges; ductilities within ([\d.]+ %), energies within ([\d.]+ %)"
    agreed = re.search(found, text_of(VALIDATION("README")))
    yield "verification", f"(largest {', '.join(agreed.groups())})"


def of_levels() -> Iterator[tuple[str, str]]:
    page = VALIDATION("level_doubts")
    met = rows(page, "rims met, e/a[^|]*")[:3]
    rim, force, shear = (ends(line[k] for line in met) for k in (5, 2, 6))
    yield "accuracy", f"rim force {rim} %, force of the bearing {force} %, base shear {shear} %."
    short = rows(page, "unlike friction[^|]*short[^|]*")
    worst = -number(short[0][1].partition("(")[2])
    yield "accuracy", f"{ends(line[1] for line in short)} % too little, the worst {worst:.0f} %."
    yield "limits", f"underestimates displacements by up to {worst:.0f} %"
    assert max(number(cell) for cell in rows(page, "rims not met, no uplift")[0][1:]) < 0.5
    ratio = re.search(r"Time of the loops: ([\d.]+) times", text_of(page))[1]
    yield "accuracy", f"{ratio} times in [random buildings]"
    times = {}
    for motion in ("three components[^|]*", "the horizontal ones"):
        for level, *cells in rows("example_buildings", motion):
            times.setdefault(level, []).append(number(cells[-3]))
    pairs = zip(times["contact"], times["pendulum"], strict=True)
    yield "accuracy", f"{ends((str(a / b) for a, b in pairs), '.1f')} times in a [building of 20"


def of_slip() -> Iterator[tuple[str, str]]:
    page = VALIDATION("slip")
    equal = rows(page, r"equal rims, no uplift \(\d+\)")
    within = {(level, of): number(cells[-2]) for level, of, *cells in equal}
    slip, left = (within["`pendulum`", of] for of in (equal[0][1], equal[1][1]))
    count = re.search(r"no uplift \((\d+)\)", text_of(page))[1]
    yield "limits", f"In {count} random test cases that meet equal rims, the largest slip"
    yield "limits", f"in {slip:.0f} %, the residual slip in {left:.0f} %."
    all_of = [within["`contact`", equal[k][1]] for k in (0, 1, 3)]
    rims = [within["`contact`", equal[k][1]] for k in (5, 6)]
    words = f"in {min(all_of):.0f} of 100 test cases, each rim's force in {min(rims):.0f}"
    yield "accuracy", words


def of_features() -> Iterator[tuple[str, str]]:
    page = VALIDATION("features")
    second, plates, everything = (
        rows(page, name)[1:] for name in ("second_dir.*?", "plate_rot.*?", "rims, interface.*?")
    )
    yield "accuracy", f"{ends((line[4] for line in second), '.2f')} times as long"
    yield "accuracy", f"without plate rotation {ends((line[4] for line in plates), '.2f')} times"
    yield "accuracy", f"peak changes by {ends(line[5].lstrip('-') for line in second)} %"
    saved = [1.0 - number(line[4]) for line in (*second, *plates)]
    yield (
        "choices_bearing",
        f"saves {100 * min(saved):.0f} to {100 * max(saved):.0f} % in a building",
    )
    assert [round(1.0 - number(line[4]), 1) for line in everything] == [0.2, 0.3]  # "a quarter"


def of_random_scenes() -> Iterator[tuple[str, str]]:
    page = VALIDATION("robustness")
    keys = ("without uplift", "without uplift, not `inaccurate`", "with uplift")
    calm, sound, lifted = (rows(page, key)[0] for key in keys)
    yield (
        "limits",
        f"Of {int(calm[1]):,} random test cases at all levels without uplift {calm[-1][:4]} %",
    )
    yield (
        "limits",
        f"({sound[-1][:4]} % of those whose status is not `inaccurate`; worst {calm[-2]} %)",
    )
    yield "limits", f"Of {lifted[1]} with uplift, {lifted[-1][:4]} % are within 3 %"


def of_performance() -> Iterator[tuple[str, str]]:
    for count in ("100", "256"):
        direct, reduced = (line[4] for line in rows(VALIDATION("performance"), count))
        yield "benchmark_goals", f"| {direct} ms ({reduced}), [performance.md]"


SOURCES = [value for name, value in list(globals().items()) if name.startswith("of_")]


@pytest.mark.parametrize("source", SOURCES)
def test_prose_has_the_numbers_of_generated_pages(source) -> None:
    quoted = list(source())
    wrong = [each for each in quoted if each[1] not in " ".join(text_of(each[0]).split())]
    assert wrong == []
