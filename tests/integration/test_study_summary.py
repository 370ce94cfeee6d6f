"""The study's page for readers is that of the numbers of its parts, and its table is theirs."""

import re

import pytest

from validation.page import FOLDER
from validation.study import __main__ as whole
from validation.study import device, runner
from validation.study.records_runs import considered
from validation.study.summary import NAME, ROWS, page, pair, parts_of


@pytest.fixture(scope="module")
def parts():
    return parts_of()


def test_the_page_is_that_of_the_numbers_of_the_parts(parts):
    text = (FOLDER / f"{NAME}.md").read_text(encoding="utf-8")
    assert text == page(parts)
    for target in re.findall(r"\]\(([^)#]+)", text):
        assert (FOLDER / target).is_file(), target
    assert len(text.split()) < 1500  # two pages and the tables


def test_intensities_are_over_the_same_earthquake(parts):
    told = runner.told_of(parts["device"])["contact"]
    assert told["considered"] == pytest.approx(considered(), rel=1e-4)
    assert parts["own"]["considered"] == pytest.approx(told["considered"], rel=1e-4)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("limit", device.LIMITS)
def test_a_cell_is_of_the_records_of_its_pair(parts, row, limit):
    """Counts and interval belong together; margins of the tables give the ratio of collapse."""
    one = pair(parts, row, limit)
    assert one["less"] + one["more"] <= one["records"] == 22
    if one["ratio"] is None:
        return
    value, low, high = one["ratio"]
    assert low <= value <= high
    if limit == device.COLLAPSE:
        margins = runner.told_of(parts["device"])["contact"]["tables"]["margins"]
        known = margins.set_index("device")["margin [-]"]
        assert value == pytest.approx(known[one["own"]] / known[one["other"]], rel=1e-3)


def test_all_parts_are_read_or_named_as_not_read(parts):
    text = page(parts)
    for part in set(whole.PARTS) - {"summary"}:
        assert f"({runner.name_of(part)}.md)" in text
