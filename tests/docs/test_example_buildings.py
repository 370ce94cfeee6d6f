"""docs/example_buildings.md: its tables are those of the kept numbers, its figures are there."""

from __future__ import annotations

import copy
import json
import re
from typing import Any

import pytest

pytest.importorskip("pydantic")

from frames.design.project.example import BUILDINGS
from validation.measurements.example_buildings import FIGURES, KEPT, PAGE, rebuilt


@pytest.fixture(scope="module")
def kept() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(KEPT.read_text(encoding="utf-8"))
    return found


def test_tables_are_those_of_the_kept_numbers(kept: dict[str, Any]) -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert set(kept) == set(BUILDINGS)
    assert rebuilt(page, kept) == page, (
        "run: python -m validation.measurements.example_buildings --page"
    )
    other = copy.deepcopy(kept)
    other["office"]["demands"]["design"]["isolator displacement"] += 0.01
    assert rebuilt(page, other) != page


def test_what_was_run_is_said_of_each_building(kept: dict[str, Any]) -> None:
    page = PAGE.read_text(encoding="utf-8")
    for own in kept.values():
        assert own["device_level"] in page
        assert all(f"{title} {ratio:.2f}" in page for title, ratio, _ in own["ratios"])
        assert len(own["failed"]) == 0 or all(line.split(" (")[0] in page for line in own["failed"])
    for name in re.findall(r"\(figures/([^)]*)\)", page):
        assert (FIGURES / name).is_file(), name
