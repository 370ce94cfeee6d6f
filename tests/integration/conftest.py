"""Runs shared by tests of time histories; each one's energy balance is checked as it is made."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import Frame, GroundMotion, energy_error, time_history
from lir_element import LIRBearing
from lir_element.opensees import bearing_tags, opensees
from lir_element.opensees.in_process.selftest import why_not_fast
from tests.integration.stand import Stand
from tests.scenes import paper_bearing

LEDGER = 1e-3  # of the input


@pytest.fixture(scope="session")
def run() -> Callable[..., xr.Dataset]:
    """Run a time history and check that its energy balance closes within 0.1 %."""

    def analyse(model: Frame, motion: GroundMotion, **options: Any) -> xr.Dataset:
        data = time_history(model, motion, **options)
        assert np.isfinite(data["node_displacement"]).all()
        assert energy_error(data) < LEDGER
        return data

    return analyse


@pytest.fixture(scope="session")
def newhall_bearing() -> LIRBearing:
    """The bearing of the paper's numerical example (section 3.1)."""
    return paper_bearing()


@pytest.fixture(scope="session")
def pulse() -> Callable[..., np.ndarray]:
    """Make a sine that grows and fades smoothly, then rest; (n,) [m/s2]."""

    def make(peak, period, dt=0.005, cycles=2.0, rest=1.0):
        length = cycles * period
        t = np.arange(0.0, length + dt, dt)
        window = np.sin(np.pi * np.minimum(t / length, 1.0))
        wave = peak * np.sin(2.0 * np.pi * t / period) * window
        return np.concatenate([wave, np.zeros(round(rest / dt))])

    return make


@pytest.fixture(params=["fast", "portable"])
def stand(request: pytest.FixtureRequest) -> Iterator[Stand]:
    """An empty model in OpenSees for each route, and an empty one after the test."""
    pytest.importorskip("openseespy")
    ops = opensees()
    if request.param == "fast" and why_not_fast():
        pytest.skip(f"the in-process coupling is not possible: {why_not_fast()}")
    ops.wipe()
    yield Stand(ops, request.param)
    ops.wipe()
    assert bearing_tags() == ()
