"""The study in one paper: its page is that of the numbers of the parts, which agree."""

import pytest

from validation.page import FOLDER
from validation.study import __main__ as whole
from validation.study.summary import LIMITS, NAME, READ, comparisons, page, parts_of


def test_the_page_is_that_of_the_numbers_of_the_parts():
    parts = parts_of()
    assert (FOLDER / f"{NAME}.md").read_text(encoding="utf-8") == page(parts)
    assert set(READ) | {"records", "summary"} == set(whole.PARTS)


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
