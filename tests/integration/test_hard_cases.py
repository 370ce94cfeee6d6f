"""The fast ones of the hard cases: they complete or name the bearing's failure, energy in order."""

import warnings

import pytest

from frames import time_history
from lir_element.errors import AnalysisWarning
from validation.measurements.hard_cases import compare, outcome
from validation.measurements.hard_scenes import (
    creeping,
    impact,
    pulsed,
    scaled,
    stiffness,
    tilting,
    vertical,
    weak,
)

STEP = 5e-3
LEVELS = ("pendulum", "contact")
CASES = {
    "impact 0.3 m/s": impact(0.3, oblique=False),
    "impact 3 m/s, oblique": impact(3.0, oblique=True),
    "beyond all limits": impact(3.0, oblique=False, wide=True),
    "axial load to zero": vertical("zero", 9.9, 0.5, 6.0),
    "weak interface": pulsed("weak", weak(0.066), 2.0),
    "creep": creeping(),
    "soft contacts": stiffness(0.01),
    "hard contacts": stiffness(100.0),
    "tilting plate": tilting(10.0),
    "model scale": scaled("small", 0.05),
    "bridge scale": scaled("large", 5.0),
}
STOPS = {
    "impact 3 m/s, oblique": {"slip_exceeded"},
    "beyond all limits": {"slip_unstable", "sphere_exceeded", "slip_exceeded"},
    "weak interface": {"slip_exceeded"},
}


def run(case, level, dt=STEP, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        return time_history(case.model, case.motion, case.duration, level=level, dt=dt, **options)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", CASES)
def test_ends_as_it_must_with_its_energy_in_order(name, level):
    found = outcome(name, level, STEP, run(CASES[name], level))
    assert found.sound
    assert found.status in STOPS.get(name, {"ok"})


@pytest.mark.parametrize(("level", "percent"), [("pendulum", 1.0), ("contact", 0.5)])
@pytest.mark.parametrize("name", ["impact 0.3 m/s", "axial load to zero", "soft contacts"])
def test_peak_is_that_of_rigid_bodies(name, level, percent):
    case = CASES[name]
    reference = run(case, "rigid_body", 1e-3)
    assert compare(run(case, level, 2e-3), reference) < percent


def test_friction_that_gave_energy_back_would_be_seen():
    data = run(CASES["impact 0.3 m/s"], "pendulum").copy(deep=True)
    data["work_low_friction"][100:] *= 0.5
    assert not outcome("spoilt", "pendulum", STEP, data).sound


def test_an_open_ledger_would_be_seen():
    data = run(CASES["impact 0.3 m/s"], "pendulum").copy(deep=True)
    data["energy"].loc[{"term": "kinetic"}] *= 1.1
    assert not outcome("spoilt", "pendulum", STEP, data).sound
