"""Tables for people: the numbers of a table as an engineer reads them."""

import math

import pandas as pd
import pytest

pytest.importorskip("jinja2")

from frames.design.report.tables import in_mm_and_kn, rows_of


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (10_400.0, "10400"),
        (-123_456.7, "-123457"),
        (1234.4, "1234"),
        (0.01234567, "0.01235"),
        (0.0, "0"),
        (1.04e7, "1.04·10⁷"),
        (2.5e-5, "2.5·10⁻⁵"),
        (math.nan, "-"),
        (math.inf, "inf"),
    ],
)
def test_numbers_have_four_digits_and_no_power_of_ten_below_a_million(value, said):
    assert rows_of(pd.DataFrame({"force": [value]}, index=["A"])) == [("A", said)]


def test_forces_are_in_kn_and_lengths_in_mm() -> None:
    frame = pd.DataFrame(
        {"unit": ["N", "m", "-"], "value": [1.04e7, 0.3561, 1.5]}, index=list("abc")
    )
    assert rows_of(frame) == [("a", "kN", "10400"), ("b", "mm", "356.1"), ("c", "-", "1.5")]
    columns = in_mm_and_kn(pd.DataFrame({"slip [m]": [0.2], "x [m]": [3.0], "load [N]": [1.04e7]}))
    assert list(columns) == ["slip [mm]", "x [m]", "load [kN]"]
    assert rows_of(columns) == [("0", "200", "3", "10400")]
