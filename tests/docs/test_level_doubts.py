"""docs/validation/level_doubts.md: the assumption check promises what was measured."""

from pathlib import Path

import pytest

from frames.results.level_doubts import CLASSES, DOUBTED

TEXT = (Path(__file__).parents[2] / "docs/validation/level_doubts.md").read_text(encoding="utf-8")


def rows() -> dict[str, dict[str, float]]:
    """Errors below which nine bearings in ten of a class stay [-], by class and quantity."""
    lines = [line.strip("| ").split(" | ") for line in TEXT.splitlines() if line.startswith("| ")]
    head = lines[0]
    return {
        cells[0]: {
            name: 0.01 * float(cell.split(" (")[0])
            for name, cell in zip(head[2:], cells[2:], strict=True)
        }
        for cells in lines[2:]
    }


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.name)
def test_classes_say_what_was_measured(kind) -> None:
    known = rows()[kind.name]
    for name, error in zip(DOUBTED, kind.errors, strict=True):
        assert error == pytest.approx(known[name], rel=0.3, abs=0.01)


def test_runs_without_rims_and_uplift_are_right() -> None:
    calm = rows()["rims not met, no uplift"]
    assert all(error < 0.01 for error in calm.values())
    assert "Of these 0 are more than 5 % off" in TEXT
