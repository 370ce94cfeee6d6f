"""Numbers of docs/choices_*.md on the example of the README, and their range in the README."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, time_history
from lir_element import LIRBearing
from tests.scenes import paper_bearing

ROOT = Path(__file__).parents[2]
CHOICES = " ".join(
    word
    for page in sorted((ROOT / "docs").glob("choices_*.md"))
    for word in page.read_text(encoding="utf-8").split()
)
README = (ROOT / "README.md").read_text(encoding="utf-8")
T = np.arange(0.0, 6.0, 0.005)
MOTION = GroundMotion(x=2.0 * np.sin(2.0 * np.pi * T / 1.6) * (T < 1.6), dt=0.005)
BEARING = paper_bearing()
RIMS = BEARING.resolved()["rim_stiffness"]
CHANGED = {
    "defaults": {},
    "`rim_stiffness` × 0.1": {"rim_stiffness": 0.1 * RIMS},
    "`rim_stiffness` × 10": {"rim_stiffness": 10.0 * RIMS},
    "`rim_damping` = 0": {"rim_damping": 0.0},
    "`axial_stiffness` × 0.1, same rims": {
        "axial_stiffness": 0.1 * BEARING.resolved()["axial_stiffness"],
        "rim_stiffness": RIMS,
        "rim_damping": BEARING.resolved()["rim_damping"],
    },
}


def peaks(bearing: LIRBearing, **options: object) -> tuple[float, float]:
    """Return peak displacement [mm] and largest base shear over weight; no warning is left."""
    data = time_history(lumped_mass(bearing, mass=204e3), MOTION, **options)
    assert data.attrs["status"] == "ok"
    assert "!" not in data.attrs["audit"]
    moved, shear = (data[name].sel(axis="x") for name in ("bearing_displacement", "base_shear"))
    return 1e3 * float(abs(moved).max()), float(abs(shear).max() / data["weight"])


def shown(pattern: str) -> list[float]:
    """Return the numbers in the groups of a pattern that the pages hold once."""
    (found,) = re.findall(pattern, CHOICES)
    return [float(number) for number in ([found] if isinstance(found, str) else found)]


@pytest.mark.parametrize("changed", CHANGED)
def test_table_of_contacts(changed: str) -> None:
    row = rf"\| {re.escape(changed)} \| (\d+) mm, ([\d.]+) \| (\d+) mm, ([\d.]+) \|"
    numbers = shown(row)
    device = replace(BEARING, **CHANGED[changed])
    for bearing, (moved, shear) in zip(
        (device, device.as_dcfp()), (numbers[:2], numbers[2:]), strict=True
    ):
        found = peaks(bearing, level="contact")
        assert found == (pytest.approx(moved, abs=0.6), pytest.approx(shear, abs=0.006))


def test_steps_and_yield_displacements() -> None:
    steps = shown(
        r"example: ([\d.]+) mm with `dt=None` and with 5 ms, ([\d.]+) mm with 20 ms, "
        r"([\d.]+) mm with 1 ms"
    )
    for dt, number in zip((None, 0.02, 0.001), steps, strict=True):
        assert peaks(BEARING, dt=dt)[0] == pytest.approx(number, abs=0.06)
    small = shown(r"matters less: ([\d.]+) mm with 0.001 mm, ([\d.]+) mm with 0.5 mm")
    for size, number in zip((1e-6, 5e-4), small, strict=True):
        device = replace(BEARING, interface_yield_displacement=size)
        assert peaks(device)[0] == pytest.approx(number, abs=0.06)
    row = shown(r"peak displacement, example \| (\d+) mm \| (\d+) mm \| (\d+) mm \| (\d+) mm")
    for size, number in zip((5e-5, 2.5e-4, 5e-4, 1e-3), row, strict=True):
        found = peaks(replace(BEARING, yield_displacement=size))[0]
        assert found == pytest.approx(number, abs=0.6)


def test_the_readme_gives_the_range_of_the_impact() -> None:
    (soft, hard) = re.search(
        r"a tenth of it gives ([\d.]+) W, ten times\n?\s*([\d.]+) W", README
    ).groups()
    for part, number in ((0.1, soft), (10.0, hard)):
        device = replace(BEARING.as_dcfp(), rim_stiffness=part * RIMS)
        assert peaks(device, level="contact")[1] == pytest.approx(float(number), abs=0.006)
