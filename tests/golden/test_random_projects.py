"""Random projects, most with an error put into them: a message that helps, or confirmed numbers."""

import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")
pytest.importorskip("typer")

from validation.random_projects import FINDINGS, perform, random_project

SEED = 3
DAILY, ALL = {0, 2, 3, 4, 5}, 20
"""Projects by day, and the number with those that `make nightly` adds."""


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # the command prints warnings
@pytest.mark.parametrize(
    "number",
    [
        *DAILY,
        *(pytest.param(one, marks=pytest.mark.nightly) for one in range(ALL) if one not in DAILY),
    ],
)
def test_a_random_project(number: int) -> None:
    found = perform(number, seed=SEED)
    assert found.outcome not in FINDINGS, f"{found.wrong}: {found.words}"


def test_the_series_has_sound_and_spoilt_projects() -> None:
    wrong = [random_project(SEED, number)[1] for number in range(ALL)]
    assert 0 < wrong.count("") < 10
    assert len(set(wrong)) > 10
    assert random_project(SEED, 7) == random_project(SEED, 7)
