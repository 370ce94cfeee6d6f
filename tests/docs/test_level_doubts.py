"""docs/validation/level_doubts.md: the assumption check promises what was measured."""

from pathlib import Path

import pytest

from frames.results.level_doubts import CLASSES, DOUBTED

TEXT = (Path(__file__).parents[2] / "docs/validation/level_doubts.md").read_text(encoding="utf-8")


def rows() -> dict[str, dict[str, float]]:
    """Errors below which nine bearings in ten of a class stay [-], by class and quantity.

    Classes that are in both tables: of the first, whose surfaces are of one friction.
    """
    lines = [line.strip("| ").split(" | ") for line in TEXT.splitlines() if line.startswith("| ")]
    head, found = lines[0], dict[str, dict[str, float]]()
    for cells in lines:
        if cells[0] in ("class", "---") or cells[0] in found:
            continue
        found[cells[0]] = {
            name: 0.01 * float(cell.split(" (")[0])
            for name, cell in zip(head[2:], cells[2:], strict=True)
        }
    return found


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.name)
def test_classes_say_what_was_measured(kind) -> None:
    known = rows()[kind.name]
    for name, error in zip(DOUBTED.values(), kind.errors, strict=True):
        assert error == pytest.approx(known[name], rel=0.3, abs=0.01)


def test_runs_without_rims_and_uplift_are_right() -> None:
    calm = rows()["rims not met, no uplift"]
    assert all(error < 0.01 for error in calm.values())
    assert TEXT.count("Of these 0 are more than 5 % off") == 2
