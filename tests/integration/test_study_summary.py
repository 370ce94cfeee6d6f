"""The study's pages are those of their numbers; its parts, which agree, in one paper."""

import json

import pytest

from validation.page import FOLDER
from validation.study import __main__ as whole
from validation.study import runner
from validation.study.records_runs import considered
from validation.study.summary import LIMITS, NAME, READ, comparisons, page, parts_of

PAGES = {
    "study_near_fault": lambda numbers: runner.page("near_fault", numbers),
}


def text_of(name):
    return (FOLDER / name).read_text(encoding="utf-8")


def stored(name):
    return json.loads(text_of(f"{name}.json"))


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_that_of_its_numbers(name):
    numbers = stored(name)
    assert text_of(f"{name}.md") == PAGES[name](numbers)
    assert numbers.get("considered", considered()) == pytest.approx(considered(), rel=1e-4)


def test_the_page_is_that_of_the_numbers_of_the_parts():
    assert text_of(f"{NAME}.md") == page(parts_of())
    assert set(READ) - {"rims"} | {"near_fault", "records", "summary"} == set(whole.PARTS)


def test_parts_agree_where_they_have_the_same_devices():
    """The best LIR-DCFP and the DCFP of one plan, by campaigns of their own."""
    parts = parts_of()
    plan = parts["device"]["plans"][1]["devices"]
    after, rims = parts["after"]["margins"], parts["rims"]["margins"]
    same = (
        (plan["LIR-DCFP"]["margin"], after["LIR-DCFP: ends"]),
        (plan["rims of 1 W"]["margin"], after["DCFP, rims of 1 W: ends"]),
        (plan["rims of 1 W"]["margin"], rims["DCFP, larger plan, rims of 1 W"]),
        (plan["rims of 0.5 W"]["margin"], rims["DCFP, larger plan, rims of 0.5 W"]),
    )
    for one, other in same:  # other stripes, and a hair of friction
        assert one[0] == pytest.approx(other[0], rel=0.03)


def test_every_comparison_has_its_interval():
    rows = comparisons(parts_of())
    assert len({name for name, _ in rows}) == len(rows)
    for _, ratios in rows:
        assert set(ratios) <= set(LIMITS)
        assert all(low <= value <= high for value, low, high in ratios.values())
