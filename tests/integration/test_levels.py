"""The three levels of fidelity against each other, in the rig and under a ground motion."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    energy_error,
    load,
    lumped_mass,
    moment_frame,
    save,
    shear_building,
    time_history,
)
from lir_element import (
    AnalysisError,
    AnalysisWarning,
    CoulombFriction,
    RunStatus,
    VelocityFriction,
    cyclic_test,
)
from lir_element.device.sliders import slider_record
from tests.scenes import small_bearing

W = 150e3
UNEQUAL: dict[str, Any] = {
    "radius": (0.75, 1.1),
    "slider_height": 0.11,
    "slider_radius": 0.12,
    "friction": (CoulombFriction(0.03), CoulombFriction(0.045)),
    "interface_friction": 0.09,
    "capacity": None,
    "rims": (0.07, 0.105),
    # at "rigid_body" the axial force rings where the interface slips, by a third; with these points
    # the ringing is over where the path turns
    "contact_points": 8,
}
LAW = (VelocityFriction(0.07, 0.03, 30.0), VelocityFriction(0.08, 0.05, 20.0))
TURN = np.linspace(0.0, 2.0 * math.pi, 25)
LINE = np.array([0.0, 0.1, 0.185, 0.1, 0.0, -0.1, -0.18, 0.0])
ORBIT = np.column_stack([0.185 * np.cos(TURN), 0.15 * np.sin(TURN)])
CASES: dict[str, tuple[dict[str, Any], np.ndarray]] = {
    "static test of the paper": ({}, LINE),
    "orbit": ({}, ORBIT),
    "unequal": (UNEQUAL, 1.02 * LINE),
    "bouc-wen": ({"friction_law": "bouc-wen", "bouc_wen_exponent": 3.0}, LINE),
    "velocity": ({"friction": LAW, "interface_friction": 0.14}, LINE),
    "held": ({"interface_hold": 0.05 * W}, LINE),
    "rigid slider": ({"interface_friction": math.inf}, 0.94 * LINE),
}


bearing = partial(small_bearing, yield_displacement=1e-3, interface_yield_displacement=5e-5)


def dissipated(data: xr.Dataset) -> np.ndarray:
    return (data["work_low_friction"].sum("surface") + data["work_high_friction"]).to_numpy()[:, 0]


# Slip along a rim depends on how both sliders rock against it: some 10 % of 1 cm on the orbit.
# Elsewhere by 0.04 mm: as the sliders rock, each point's way to slip follows its own force.
SLIP = {"orbit": 0.12, "unequal": 0.02}
# At "rigid_body" the top plate's mass is turned upward at once where the path turns: the axial
# force falls to two thirds, and friction turns round over a shorter way.
DISSIPATED = {"contact": 5e-3, "rigid_body": 1e-2}


@pytest.mark.parametrize("case", CASES)
def test_levels_agree_in_the_rig(case: str) -> None:
    """Force within 0.2 % of its peak (0.8 % along a rim), slip 0.5 %, dissipation 0.5 % or 1 %."""
    changes, path = CASES[case]
    b = bearing(**changes)
    one, *others = (
        cyclic_test(b, path, W, 0.05, level=level)
        for level in ("pendulum", "contact", "rigid_body")
    )
    force, slip = one["bearing_force"][:, 0, :2].to_numpy(), one["interface_slip"][:, 0].to_numpy()
    assert dissipated(one)[-1] > 0.05 * W * 0.3
    if case != "rigid slider":
        assert float(one["rim_force"].max()) > 5e3
        assert np.abs(slip).max() > 5e-3
    for level, two in zip(("contact", "rigid_body"), others, strict=True):
        assert two.attrs["status"] == "ok"
        assert two.attrs["level"] == level
        error = np.abs(two["bearing_force"][:, 0, :2].to_numpy() - force).max()
        assert error < (8e-3 if case == "orbit" else 2e-3) * np.abs(force).max()
        error = np.abs(two["interface_slip"][:, 0].to_numpy() - slip).max()
        assert error < SLIP.get(case, 5e-3) * max(np.abs(slip).max(), 1e-3)
        error = np.abs(dissipated(two) - dissipated(one)).max()
        assert error < DISSIPATED[level] * dissipated(one).max()
        # the actuator holds W on the top plate
        load = -two["bearing_force"][:, 0, 2].to_numpy()
        assert_allclose(load, W, rtol=1e-6 if level == "contact" else 5e-3)
        error = two["bearing_displacement"] - one["bearing_displacement"]
        assert float(np.abs(error).max()) < 5e-6
        for name in ("body_position", "body_rotation"):
            assert two[name].dims == ("step", "bearing", "body", "axis")
            assert name not in one
        top = two["body_position"].sel(body="top_plate", drop=True)
        assert_allclose(top, two["bearing_displacement"], rtol=0.0, atol=1e-12)


def test_sliders_in_the_rig_follow_the_string() -> None:
    """Without slip both turn by -U / L and move as rigid bodies on the bottom sphere."""
    b = bearing(capacity=math.inf)
    record = slider_record(b)[0]
    for level in ("contact", "rigid_body"):
        data = cyclic_test(b, ORBIT, W, 0.05, level=level)
        u = data["bearing_displacement"][:, 0].to_numpy()
        c = u - [0.0, 0.0, b.effective_radius]
        n = -c / np.linalg.norm(c, axis=1)[:, None]
        for k, body in enumerate(("bottom_slider", "top_slider")):
            turn = Rotation.from_rotvec(data["body_rotation"][:, 0].sel(body=body).to_numpy())
            axis = turn.apply([0.0, 0.0, 1.0])
            # relative rocking under friction: mu h / 2 of eccentricity over soft points
            assert_allclose(axis, n, rtol=0.0, atol=2e-4)
            centre = record["place"][k + 1]
            expected = centre[2] * axis - centre
            place = data["body_position"][:, 0].sel(body=body).to_numpy()
            # contacts give way by some 1e-5 m
            assert_allclose(place, expected, rtol=0.0, atol=6e-5)
        tilt = np.abs(data["body_rotation"][:, 0].sel(body="top_plate").to_numpy()).max()
        assert tilt == 0.0


@pytest.mark.parametrize("level", ["contact", "rigid_body"])
def test_varying_load_in_the_rig(level: str) -> None:
    loads = np.array([1.0, 1.4, 0.6, 1.0]) * W
    path = [0.05, 0.1, 0.05, 0.12]
    one = cyclic_test(bearing(), path, loads, 0.05)
    two = cyclic_test(bearing(), path, loads, 0.05, level=level)
    force = one["bearing_force"][:, 0].to_numpy()
    assert_allclose(-force[:, 2], loads, rtol=1e-6)
    error = np.abs(two["bearing_force"][:, 0].to_numpy() - force)
    assert error[:, 0].max() < 3e-3 * np.abs(force[:, 0]).max()
    assert error[:, 2].max() < 5e-3 * W


@pytest.mark.parametrize("level", ["contact", "rigid_body"])
def test_failure_in_the_rig(level: str) -> None:
    b = bearing(slip_capacity=0.005)
    with pytest.warns(AnalysisWarning, match="slip 0.005"):
        data = cyclic_test(b, LINE, W, 0.05, level=level)
    assert data.attrs["status"] == "slip_exceeded"
    assert 0 < data.sizes["step"] < len(LINE)
    assert 0.17 / 0.05 < data.attrs["failed_at"] < 0.185 / 0.05
    for name, values in data.items():
        assert np.isfinite(values.to_numpy()).all() if name != "body" else True
    with pytest.raises(AnalysisError) as caught:
        cyclic_test(b, LINE, W, 0.05, level=level, on_failure="raise")
    assert caught.value.status is RunStatus.SLIP_EXCEEDED
    assert_allclose(caught.value.data["bearing_force"], data["bearing_force"], rtol=0.0, atol=0.0)


MASS = 15e3
LEVELS = ("pendulum", "contact", "rigid_body")


@pytest.fixture(scope="module")
def shaken(pulse: Callable[..., np.ndarray]) -> dict[str, xr.Dataset]:
    """One pulse along x and y with rim contact, at three levels."""
    x = pulse(2.5, 1.5, cycles=1.0, rest=0.5)
    y = np.resize(pulse(1.0, 1.2, cycles=1.25, rest=0.5), len(x))
    motion = GroundMotion(x=x, y=y, dt=0.005)
    model = lumped_mass(bearing(), MASS)
    return {level: time_history(model, motion, level=level) for level in LEVELS}


def test_levels_agree_under_a_pulse(shaken: dict[str, xr.Dataset]) -> None:
    one = shaken["pendulum"]
    peak = np.linalg.norm(one["bearing_displacement"][:, 0, :2], axis=1).max()
    slip = float(one["interface_slip_size"].max())
    assert float(one["rim_force"].max()) > 3e3
    assert slip > 5e-3
    for level in ("contact", "rigid_body"):
        two = shaken[level]
        other = np.linalg.norm(two["bearing_displacement"][:, 0, :2], axis=1).max()
        # the sliders rock on the rim: 0.7 mm of 0.18 m
        assert_allclose(other, peak, rtol=5e-3)
        assert_allclose(two["interface_slip_size"].max(), slip, rtol=0.06)
        moves = np.abs(two["bearing_displacement"] - one["bearing_displacement"])[:, 0, :2]
        assert float(moves.max()) < 0.01 * peak
        assert two.attrs["level"] == level
        assert two.attrs["status"] == "ok"


@pytest.mark.parametrize("level", LEVELS)
def test_ledger_of_each_level(level: str, shaken: dict[str, xr.Dataset]) -> None:
    data = shaken[level]
    assert energy_error(data) < 1e-3
    scale = float(np.abs(data["energy"].sel(term="input")).max())
    assert float(np.abs(data["energy"].sel(term="numerical")).max()) < 1e-3 * scale
    for name in ("work_low_friction", "work_high_friction"):
        assert (np.diff(data[name], axis=0) >= -1e-12 * scale).all()
    friction = dissipated(data)[-1]
    assert friction > 0.5 * scale
    # the sliders' own share: small beside the mass of 15 t, and none where they have no mass
    own = np.abs(data["work_sliders"]).max()
    assert own < 0.01 * scale
    assert (own > 0.0) == (level != "pendulum")


@pytest.mark.parametrize("level", ["contact", "rigid_body"])
def test_bodies_of_a_time_history(level: str, shaken: dict[str, xr.Dataset]) -> None:
    data = shaken[level]
    for name in ("body_position", "body_rotation"):
        assert data[name].dims == ("time", "bearing", "body", "axis")
        assert np.isfinite(data[name]).all()
    assert data["body"].to_numpy().tolist() == ["bottom_slider", "top_slider", "top_plate"]
    node = data["node_displacement"].sel(node="mass")
    place = data["body_position"][:, 0].sel(body="top_plate")
    assert_allclose(place, node[:, :3], rtol=0.0, atol=1e-12)
    turn = data["body_rotation"][:, 0].sel(body="top_plate")
    assert_allclose(turn, node[:, 3:], rtol=0.0, atol=1e-12)
    # sliding on the bottom surface is what its slider's rotation says
    axis = Rotation.from_rotvec(
        data["body_rotation"][:, 0].sel(body="bottom_slider").to_numpy()
    ).apply([0.0, 0.0, 1.0])
    expected = -0.75 * (axis - [0.0, 0.0, 1.0])
    sliding = data["slider_displacement"][:, 0].sel(surface="bottom").to_numpy()
    assert_allclose(sliding, expected, rtol=0.0, atol=3e-4)  # it rocks on the rim
    record = slider_record(bearing())[0]
    rise = data["body_position"][:, 0].sel(body="bottom_slider", axis="z").to_numpy()
    on_sphere = record["place"][1, 2] * (axis[:, 2] - 1.0)
    assert rise.max() > 1e-3
    assert_allclose(rise, on_sphere, rtol=0.0, atol=5e-5)


def test_pendulum_runs_have_no_bodies(shaken: dict[str, xr.Dataset]) -> None:
    assert not {"body_position", "body_rotation", "body"} & set(shaken["pendulum"].variables)


def building() -> Frame:
    device = bearing(slider_radius=0.12, capacity=0.12)
    return moment_frame((1, 1), 1, bearing=device)


def test_levels_by_name_in_a_building(pulse: Callable[..., np.ndarray], tmp_path: Path) -> None:
    motion = GroundMotion(x=pulse(3.4, 1.2, cycles=1.0, rest=0.3), dt=0.005)
    chosen = {"bearing-0-0": "contact", "bearing-1-1": "contact", "bearing-0-1": "pendulum"}
    one = time_history(building(), motion)
    two = time_history(building(), motion, level=chosen)
    assert two.attrs["level"] == str(chosen)
    assert float(one["rim_force"].max()) > 1e4
    peak = float(np.abs(one["bearing_displacement"]).max())
    error = np.abs(two["bearing_displacement"] - one["bearing_displacement"])[..., :2]
    assert float(error.max()) < 0.01 * peak
    assert energy_error(two) < 1e-3
    # bodies only where the level has them
    for name in ("body_position", "body_rotation"):
        known = two[name].notnull().all(("time", "axis"))
        for bearing_, is_contact in (("0-0", True), ("1-1", True), ("0-1", False), ("1-0", False)):
            each = known.sel(bearing=f"bearing-{bearing_}").to_numpy().tolist()
            assert each == [is_contact, is_contact, True]
        sliders = two[name].sel(bearing="bearing-1-0").isel(body=slice(0, 2))
        assert bool(sliders.isnull().all())
    place = two["body_position"].sel(body="top_plate", bearing="bearing-1-0")
    node = two["node_displacement"].sel(node="base-1-0")
    assert_allclose(place, node[:, :3], rtol=0.0, atol=1e-12)
    assert (two["work_sliders"].sel(bearing="bearing-1-0") == 0.0).all()
    save(two, tmp_path / "run.nc")
    xr.testing.assert_equal(load(tmp_path / "run.nc"), two)


REST = GroundMotion(x=np.zeros(5), dt=0.005)
BAD: list[tuple[dict[str, Any], str]] = [
    ({"level": "atomic"}, r"level = 'atomic': choose one of \('pendulum', 'contact', 'rigid_body'"),
    ({"level": {"bearing": "atomic"}}, r"level of a bearing = 'atomic': choose one of"),
    ({"level": {"other": "contact"}}, 'level names "other": the model has the bearings bearing'),
    ({"level": {"bearing": "rigid_body"}}, r"level of a bearing = 'rigid_body': choose one of"),
    ({"integrator": "explicit"}, 'integrator = "explicit" belongs to level="rigid_body"'),
    ({"integrator": "explicit", "level": "contact"}, "belongs to level=.*not to 'contact'"),
    ({"integrator": "newmark", "level": "rigid_body"}, "integrator = 'newmark'.*explicit"),
    ({"integrator": "generalised-alpha", "level": "rigid_body"}, "integrator = 'generalised"),
    ({"tolerance": 0.0, "level": "rigid_body"}, "tolerance = 0 .*at least 1e-12"),
    ({"tolerance": 1.0}, "tolerance = 1 .*below 0.01"),
    ({"level": "rigid_body", "integrator": "explicit", "dt": 0.001}, "dt = 0.001 s is too large"),
]


@pytest.mark.parametrize(("options", "words"), BAD)
def test_bad_options(options: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        time_history(lumped_mass(bearing(), MASS), REST, **options)


def test_rigid_body_refuses_what_it_cannot_take() -> None:
    for model, reason in (
        (building(), "it has 4 bearings"),
        (shear_building(bearing(), MASS, 1e6), "it has members or springs"),
    ):
        with pytest.raises(ModelError, match=reason) as caught:
            time_history(model, REST, level="rigid_body")
        assert 'level="contact"' in str(caught.value)
        assert "lumped_mass(bearing, mass)" in str(caught.value)


@pytest.mark.parametrize("level", ["contact", "rigid_body"])
def test_failed_run_keeps_what_was_computed(level: str, pulse: Callable[..., np.ndarray]) -> None:
    motion = GroundMotion(x=pulse(2.6, 2.0, cycles=1.0, rest=0.5), dt=0.005)
    model = lumped_mass(bearing(slip_capacity=0.02), MASS)
    with pytest.warns(AnalysisWarning, match="slip 0.020.* slip_capacity 0.02 m") as caught:
        data = time_history(model, motion, level=level)
    assert caught[0].filename == __file__
    assert data.attrs["status"] == "slip_exceeded"
    assert data.attrs["failed_where"] == 'bearing "bearing"'
    time = data["time"].to_numpy()
    assert_allclose(time, 0.005 * np.arange(len(time)), rtol=1e-12)
    assert 0.0 < data.attrs["failed_at"] - time[-1] <= 0.005 * (1.0 + 1e-9)
    assert len(time) > 100
    assert float(data["interface_slip_size"].max()) <= 0.02
    assert float(np.abs(data["bearing_displacement"][-1, 0, 0])) > 0.15
    for name in ("bearing_force", "body_position", "energy", "node_acceleration"):
        assert np.isfinite(data[name]).all()
    assert energy_error(data) < 1e-3
    with pytest.raises(AnalysisError) as failure:
        time_history(model, motion, level=level, on_failure="raise")
    assert failure.value.status is RunStatus.SLIP_EXCEEDED
    assert failure.value.time == data.attrs["failed_at"]
    assert_allclose(failure.value.data["energy"], data["energy"], rtol=0.0, atol=0.0)
