"""What compiled code takes up of a run is what its histories say."""

import warnings
from typing import Any

import pytest

from frames import (
    AuditWarning,
    GroundMotion,
    audit_report,
    gravity,
    lumped_mass,
    moment_frame,
    time_history,
)
from frames.recording.peak_tracking import can_track
from lir_element import AnalysisWarning, Features


@pytest.fixture(scope="module")
def scenes(newhall_bearing, pulse):
    x, y = pulse(4.5, 1.4, rest=0.1), pulse(2.0, 1.4, rest=0.1)
    thrown = GroundMotion(x=x, z=3.0 * y, dt=0.005)
    building = moment_frame((1, 1), 1, bearing=newhall_bearing)
    return {
        "building": (building, GroundMotion(x=x, y=y, dt=0.005)),
        "thrown": (lumped_mass(newhall_bearing, 2e5), thrown.scaled([1.0, 1.0, 3.0])),
        "failing": (building, GroundMotion(x=2.5 * x, dt=0.005)),
    }


@pytest.mark.parametrize("scene", ["building", "thrown", "failing"])
@pytest.mark.parametrize("left_out", ["", *Features.names()])
def test_the_audit_is_that_of_the_histories(scenes, scene, left_out):
    model, motion = scenes[scene]
    options: dict[str, Any] = {}
    if left_out:
        options["features"] = Features(**{left_out: False})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AuditWarning)
        warnings.simplefilter("ignore", AnalysisWarning)
        data = time_history(model, motion, **options)
    lines = data.attrs["audit"].splitlines()
    judged = [line for line in lines if not line.startswith("  inaccurate")]
    assert judged == audit_report(data).splitlines()


def test_what_is_not_in_the_states_is_read_off_histories(scenes):
    model, _ = scenes["building"]
    assert can_track(gravity(model))
    for features in (Features(plate_rotation=False), Features(vertical_coupling=False)):
        assert not can_track(gravity(model, features))
    assert not can_track(gravity(model, level="contact"))
