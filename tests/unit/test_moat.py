"""The clear distance to the moat wall: which displacements it is held against."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")

from frames import GroundMotion, shear_building, time_histories
from frames.design import CheckError, DesignLimits, code_named
from frames.design.devices.limits import PROJECT_LIMIT
from frames.design.project.moat_checks import of_the_moat
from lir_element import LIRBearing

BEARING = LIRBearing(
    radius=1.5,
    slider_height=0.2,
    slider_radius=0.2,
    capacity=0.3,
    friction=0.05,
    interface_friction=0.2,
)


def checked(gap: float | None, code: str) -> list:
    frame = shear_building(BEARING, 9e4, 4e8, storeys=1, plan=((1, 1), (6.0, 6.0)))
    pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 41))
    motions = {
        name: GroundMotion(x=size * pulse, dt=0.02) for name, size in (("weak", 1.0), ("hard", 1.6))
    }
    data = time_histories(frame, motions, workers=1)
    rules = code_named(code).histories
    bound = SimpleNamespace(bound="lower", allowed_displacement=0.25)
    run = SimpleNamespace(
        code=code_named(code),
        limits=DesignLimits(moat_gap=gap),
        equivalent=SimpleNamespace(bounds={"lower": bound}),
        rules=rules,
        runs={rules.bearing_level: {"lower": data}},
        moved={},
    )
    reached = data["reached_displacement"].to_numpy().max(axis=1)
    return [reached, *of_the_moat(run)]


def test_displacements_are_held_against_the_gap() -> None:
    reached, linear, histories, single = checked(0.2, "EN 1998")
    assert (linear.demand, linear.passed) == (0.25, False)
    assert linear.clause == "EN 1998-1 10.5.4"  # the code's displacement; gaps are the project's
    assert histories.clause == single.clause == PROJECT_LIMIT
    assert histories.demand == pytest.approx(1.2 * reached.max(), rel=1e-12)  # two motions: largest
    assert single.demand == pytest.approx(reached.max(), rel=1e-12)
    assert single.trace["D_max"].note == "hard"
    assert single.passed == (reached.max() <= 0.2)
    wide = checked(reached.max() * 1.01, "ASCE 7-22")[1:]
    assert [check.passed for check in wide[1:]] == [True, True]
    tight = checked(reached.max() * 0.99, "ASCE 7-22")[1:]
    assert [check.passed for check in tight[1:]] == [False, False]
    assert all(check.level == "MCE_R" for check in tight)


def test_without_a_gap_nothing_is_checked_and_odd_gaps_are_refused(tmp_path: Path) -> None:
    assert checked(None, "ASCE 7-22")[1:] == []
    with pytest.raises(CheckError, match="moat_gap = 600"):
        DesignLimits(moat_gap=600.0)
