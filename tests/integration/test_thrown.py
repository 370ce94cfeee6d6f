"""Bearings that a vertical pulse throws up: a rigid slider leaves its rims, or tumbles."""

import math

import numpy as np
import pytest

from frames import GroundMotion, energy_error, lumped_mass, time_history
from lir_element import AnalysisWarning
from tests.scenes import paper_bearing

ONE_PIECE = paper_bearing(friction=0.05, interface_friction=math.inf)
TIME = np.arange(0.0, 4.0, 0.005)


def toss(up: float, lateral: float = 6.0) -> GroundMotion:
    """Shake sideways; from 1 s on up for 0.1 s, then down for 0.1 s [m/s2]."""
    z = np.where(TIME < 1.0, 0.0, np.where(TIME < 1.1, up, np.where(TIME < 1.2, -up, 0.0)))
    return GroundMotion(x=lateral * np.sin(2 * np.pi * TIME / 1.5) * (TIME < 3.0), z=z, dt=0.005)


@pytest.mark.parametrize("dt", [0.002, None])
@pytest.mark.parametrize(
    ("up", "lift", "status"),
    [(20.0, 0.05, "ok"), (60.0, 1.2, "rim_overrun"), (120.0, 1.9, "sphere_exceeded")],
)
def test_rims_act_where_the_slider_is(up, lift, status, dt):
    """Thrown up by more than its height it is beyond the rims: the energy balance closes."""
    model = lumped_mass(ONE_PIECE, 3e4)
    if status == "ok":
        data = time_history(model, toss(up), dt=dt)
    else:
        with pytest.warns(AnalysisWarning):
            data = time_history(model, toss(up), dt=dt)
    assert data.attrs["status"] == status
    rise = data["node_displacement"].sel(dof="uz").to_numpy()
    assert rise.max() > lift
    assert energy_error(data) < 1e-3


def test_a_slider_that_tumbles_is_not_ok() -> None:
    """At level contact it rocks to 40 degrees and lands somewhere: a little more topples it."""
    model = lumped_mass(ONE_PIECE, 3e4)
    with pytest.warns(AnalysisWarning, match="overturned"):
        data = time_history(model, toss(15.8), tolerance=1e-3, level="contact")
    assert data.attrs["status"] == "inaccurate"
    assert "degrees (at rim contact 6)" in data.attrs["audit"]
    assert energy_error(data) < 1e-3
    friction = data["energy"].sel(term=["low_friction_bottom", "low_friction_top"]).sum("term")
    assert (np.diff(friction) >= 0.0).all()


def test_a_slider_that_rocks_is_ok() -> None:
    data = time_history(lumped_mass(ONE_PIECE, 3e4), toss(18.0, 4.0), dt=None, level="contact")
    assert data.attrs["status"] == "ok"
    turn = data["body_rotation"].sel(body="bottom_slider").to_numpy()[:, 0]
    assert np.hypot(turn[:, 0], turn[:, 1]).max() > 0.13  # beyond its rim, 0.111
