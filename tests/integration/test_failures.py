"""Runs that fail: what is said, and what is handed back."""

import math
import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    energy_error,
    lumped_mass,
    moment_frame,
    shear_building,
    time_history,
)
from lir_element import (
    AnalysisWarning,
    Features,
    LIRBearing,
)
from tests.refusals import refused
from tests.scenes import simple_bearing, wide_bearing

MASS, DT = 1e5, 0.005
FUSED = {**simple_bearing.keywords, "interface_friction": math.inf}

CASES = {
    "rim_overrun": (
        {**FUSED, "capacity": 0.1, "rim_overrun": 0.002},
        3.0,
        [r"rim deformation 0\.002\d* m, rim_overrun 0\.002 m", "more lateral capacity"],
    ),
    "slip_exceeded": (
        {**FUSED, "capacity": 0.1, "interface_friction": 0.12, "slip_capacity": 0.015},
        3.0,
        [r"slip 0\.01\d* m, slip_capacity 0\.015 m", "use a larger slider"],
    ),
    "sphere_exceeded": (
        {**FUSED, "capacity": math.inf},
        25.0,
        ["tilted beyond 72 degrees", "use rims"],
    ),
    "slip_unstable": (
        {
            **FUSED,
            "capacity": 0.1,
            "interface_friction": 0.06,
            "allow_weak_interface": True,
            "slip_capacity": 10.0,
            "rim_overrun": 1.0,
        },
        6.0,
        [r"L mu_h \+ mu_1 R_1 \+ mu_2 R_2", "higher mu_h"],
    ),
}


def failing(case: str, **options):
    given, peak, _ = CASES[case]
    t = np.arange(800) * DT
    motion = GroundMotion(x=peak * np.sin(2.0 * np.pi * t / 2.0), dt=DT)
    return time_history(lumped_mass(LIRBearing(**given), MASS), motion, **options)


def check_rows(data, base: float, every: int = 1) -> None:
    """Assert that all rows are computed ones, up to the last before the failure."""
    time = data["time"].to_numpy()
    assert_allclose(time, np.arange(len(time)) * base * every, rtol=1e-12)
    left = data.attrs["failed_at"] - time[-1]
    assert 0.0 < left <= base * every * (1.0 + 1e-9)
    for name, values in data.items():
        if name in {"rim_displacement", "interface_friction"}:  # without rims, rigid slider
            assert not np.isnan(values.to_numpy()).any(), name
            continue
        assert np.isfinite(values.to_numpy()).all(), name
    size = np.abs(data["node_displacement"].sel(node="mass")).max("dof").to_numpy()
    assert (size > 0.0).all()  # no row left empty
    assert float(data["ground_acceleration"][-1, 0]) != 0.0
    assert energy_error(data) < 1e-3


@pytest.mark.parametrize("dt", [None, DT, 0.02])
@pytest.mark.parametrize("case", CASES)
def test_failure_is_reported_and_the_rows_before_it_are_kept(case, dt):
    with pytest.warns(AnalysisWarning, match="What to try") as caught:
        data = failing(case, dt=dt)
    assert len(caught) == 1
    attrs, message = data.attrs, data.attrs["message"]
    assert str(caught[0].message) == message
    assert attrs["status"] == case
    assert attrs["failed_where"] == 'bearing "bearing"'
    assert message.startswith(f'at t = {attrs["failed_at"]:.6g} s, bearing "bearing": ')
    assert "failed" in message or "left" in message
    for pattern in CASES[case][2]:
        assert re.search(pattern, message), message
    check_rows(data, dt or DT)
    for name, unit in (("rim_closure", "rim_overrun"), ("interface_slip_size", "slip_capacity")):
        limit = LIRBearing(**CASES[case][0]).resolved()[unit]
        assert float(data[name].max()) <= limit  # what failed is not in the rows


def test_rows_before_a_failure_are_those_of_a_run_that_goes_on():
    with pytest.warns(AnalysisWarning):
        short = failing("rim_overrun", dt=DT)
    given, peak, _ = CASES["rim_overrun"]
    whole = LIRBearing(**{**given, "rim_overrun": 1.0})
    t = np.arange(800) * DT
    motion = GroundMotion(x=peak * np.sin(2.0 * np.pi * t / 2.0), dt=DT)
    data = time_history(lumped_mass(whole, MASS), motion, dt=DT)
    count = short.sizes["time"]
    for name in ("node_displacement", "bearing_force", "energy", "axial_force"):
        assert_allclose(short[name], data[name][:count], rtol=0.0, atol=0.0)  # the same steps
    assert float(data["rim_closure"][:count].max()) < 0.002
    assert float(data["rim_closure"][count : count + 2].max()) > 0.002


def test_failure_exactly_on_a_base_step_keeps_no_empty_row():
    """Move the limit until the last part of a base step is the one that exceeds it."""
    given, peak, _ = CASES["rim_overrun"]
    t = np.arange(800) * DT
    motion = GroundMotion(x=peak * np.sin(2.0 * np.pi * t / 2.0), dt=DT)
    on_step = 0
    for limit in np.linspace(0.002, 0.0025, 40):
        device = LIRBearing(**{**given, "rim_overrun": float(limit)})
        with pytest.warns(AnalysisWarning):
            data = time_history(lumped_mass(device, MASS), motion, dt=DT)
        check_rows(data, DT)
        place = data.attrs["failed_at"] / DT
        on_step += abs(place - round(place)) < 1e-9
    assert on_step > 0


def test_failure_names_the_bearing_that_fails():
    given, peak, _ = CASES["rim_overrun"]
    weak, strong = LIRBearing(**given), LIRBearing(**{**given, "rim_overrun": 0.1})
    devices = {(0, 0): strong, (1, 0): strong, (0, 1): weak, (1, 1): strong}
    frame = shear_building(devices, 0.5 * MASS, 1e8, plan=((1, 1), 5.0))
    t = np.arange(800) * DT
    motion = GroundMotion(x=peak * np.sin(2.0 * np.pi * t / 2.0), dt=DT)
    with pytest.warns(AnalysisWarning, match='bearing "bearing-0-1"'):
        data = time_history(frame, motion)
    assert data.attrs["status"] == "rim_overrun"


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_not_finite_input_is_refused_at_the_door(value):
    refused(ValueError, "finite", GroundMotion, x=np.array([0.0, value, 0.0]), dt=DT)
    refused(ValueError, "dt", GroundMotion, x=np.zeros(3), dt=value)
    frame = Frame("x")
    refused(ValueError, "coordinates", frame.add_node, "a", value, 0.0, 0.0)
    frame.add_node("a", 0.0, 0.0, 0.0)
    refused(ValueError, "mass", frame.add_mass, "a", value)
    refused(ValueError, "forces", frame.add_load, "a", (value, 0.0, 0.0, 0.0, 0.0, 0.0))
    refused(ValueError, "radius", LIRBearing, **{**FUSED, "capacity": 0.1, "radius": value})


BAD = [
    ({"features": {"rims": False}}, TypeError, "features = .* must be a Features"),
    ({"features": Features(rims=False), "level": "auto"}, ValueError, "leave features out"),
    ({"method": "magic"}, ValueError, "method = 'magic': choose one of"),
    ({"integrator": "euler"}, ValueError, "integrator = 'euler': choose one of.*newmark"),
    ({"dt": 0.0}, ValueError, r"dt = 0 \[s\] must be positive"),
    ({"dt": -0.01}, ValueError, r"dt = -0.01 \[s\] must be positive"),
    ({"dt": math.nan}, ValueError, r"dt = nan \[s\] must be positive and finite"),
    ({"dt": math.inf}, ValueError, r"dt = inf \[s\] must be positive and finite"),
    ({"dt": "fine"}, TypeError, "dt = 'fine' is not a number"),
    ({"duration": 0.0}, ValueError, r"duration = 0 \[s\] must be positive"),
    ({"duration": math.inf}, ValueError, r"duration = inf \[s\] must be positive and finite"),
    ({"spectral_radius": -0.01}, ValueError, "spectral_radius = -0.01 .* at least 0"),
    ({"spectral_radius": 1.01}, ValueError, "spectral_radius = 1.01 .* below 1"),
    ({"spectral_radius": math.nan}, ValueError, "spectral_radius = nan"),
    ({"record_every": 0}, ValueError, "record_every = 0 must be a whole number of at least 1"),
    ({"record_every": -2}, ValueError, "record_every = -2 must be a whole number"),
    ({"record_every": 1.5}, ValueError, "record_every = 1.5 must be a whole number"),
    ({"on_failure": "ignore"}, ValueError, "on_failure = 'ignore': choose 'warn'.*'raise'"),
]


@pytest.mark.parametrize(("options", "kind", "message"), BAD, ids=[str(b[0]) for b in BAD])
def test_bad_options_are_refused_by_name(options, kind, message):
    refused(kind, message, failing, "rim_overrun", **options)


@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_bounds_of_the_spectral_radius_are_allowed(run, pulse, radius):
    device = LIRBearing(**{**FUSED, "capacity": 0.3})
    motion = GroundMotion(x=pulse(1.0, 1.0), dt=DT)
    data = run(
        lumped_mass(device, MASS), motion, integrator="generalised-alpha", spectral_radius=radius
    )
    assert data.attrs["spectral_radius"] == radius
    lost = data["energy"].sel(term="numerical")[-1]
    supplied = np.abs(data["energy"].sel(term="input")).max()
    assert abs(float(lost)) < 1e-2 * float(supplied)  # T / dt = 500: next to nothing


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"dt": 1000.0}, "dt = 1000 s is longer than the run of 0.495 s"),
        ({"dt": 1000.0, "level": "rigid_body"}, "dt = 1000 s is longer than the run of 0.495 s"),
        ({"duration": 1e308}, r"makes 2e\+310 steps \(at most 1e\+09\)|duration = 1e\+308 s"),
        ({"duration": 1e308, "level": "rigid_body"}, r"duration = 1e\+308 s"),
        ({"duration": 4e6}, "recorded steps take about .* GB.*record_every = "),
        ({"dt": 1e-12}, r"makes 4.95e\+11 steps \(at most 1e\+09\)"),
        ({"dt": math.nan}, "dt = nan"),
    ],
)
def test_runs_without_end_are_refused(options, words):
    motion = GroundMotion(x=np.ones(100), dt=DT)
    with pytest.raises(ValueError, match=words):
        time_history(lumped_mass(LIRBearing(**FUSED), MASS), motion, **options)


def test_plates_without_inertia_are_named_where_they_find_no_equilibrium():
    """Interface and rim let go together: with rotary inertia the same run goes on to its limit."""
    device = wide_bearing(capacity=0.25, interface_friction=0.16)
    t = np.arange(0.0, 3.6, 0.01)
    shape = np.exp(-(((t - 4.0) / 2.0) ** 2))
    motion = GroundMotion(
        x=4.2 * np.sin(2.0 * np.pi * 0.42 * t) * shape,
        y=2.0 * np.sin(2.0 * np.pi * 0.6 * t) * shape,
        dt=0.01,
    )
    frame = moment_frame((2, 1), 3, bearing=device, base_depth=0.0)
    with pytest.warns(AnalysisWarning, match=r"no rotational inertia.*add_mass\(node, 0.0, \(J, J"):
        data = time_history(frame, motion)
    assert data.attrs["status"] == "step_too_small"
    for name in frame.nodes:
        if name.startswith("base-"):
            frame.add_mass(name, 0.0, (10.0, 10.0, 0.0))
    with pytest.warns(AnalysisWarning, match="slipped further"):
        data = time_history(frame, motion)
    assert data.attrs["status"] == "slip_exceeded"
