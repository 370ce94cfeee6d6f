"""Beyond L mu_h - mu1 R1 - mu2 R2 the interface does not hold its slip, whatever the level."""

import pytest

from validation.held_slip import bearings, end

NAMES = tuple(bearings())


DAILY = {NAMES[0], "unequal radii", "unequal frictions"}
"""Bearings that are pushed with contact points, too; `make nightly` does so with all."""


@pytest.mark.parametrize(
    ("name", "level"),
    [
        *((name, "pendulum") for name in NAMES),
        *(
            pytest.param(name, "contact", marks=[] if name in DAILY else pytest.mark.nightly)
            for name in NAMES
        ),
    ],
)
def test_both_sides_of_the_limit(name, level):
    bearing = bearings()[name]
    for share, expected in ((0.95, "ok"), (1.05, "slip_exceeded")):
        status, slip = end(bearing, share, level)
        assert slip == pytest.approx(share * bearing.slip_stability, rel=0.012)
        assert status == expected


def test_sliders_with_mass_end_alike():
    bearing = bearings()[NAMES[0]]
    assert end(bearing, 0.95, "rigid_body")[0] == "ok"
    assert end(bearing, 1.05, "rigid_body")[0] == "slip_exceeded"


def test_far_beyond_the_limit_the_interface_slips_off_its_overlap():
    """The actuator finds no height there, and the load itself leads on."""
    assert end(bearings()["wide slider"], 1.5, "pendulum")[0] == "slip_exceeded"
