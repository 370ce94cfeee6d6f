"""A bearing that fails and its backup: a stop, or the neighbours, carry on; energies close."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, moment_frame, peaks, time_histories, time_history
from frames.demo import bearing_for
from frames.risk import Intensity, IntensityRuns, LimitState
from lir_element import AnalysisError, BackupSupport, Element, RunStatus
from lir_element.units import STANDARD_GRAVITY
from tests.refusals import refused
from tests.scenes import small_bearing

LOAD = 150e3
BEARING = small_bearing(
    capacity=0.12, friction=0.05, interface_friction=0.12, slip_capacity=0.03, design_load=LOAD
)
DROP, FRICTION = 0.02, 0.3
BACKED = replace(BEARING, backup=BackupSupport(drop=DROP, friction=FRICTION))
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


def pulse(size=6.0, axis="x", tail=1.5):
    t = np.arange(0.0, 1.2, 0.005)
    wave = np.concatenate([size * np.sin(2.0 * np.pi * t / 1.2), np.zeros(int(tail / 0.005))])
    return GroundMotion(**{axis: wave}, dt=0.005, name="pulse")


def mass_on(bearing, **options):
    model = lumped_mass(bearing, mass=LOAD / STANDARD_GRAVITY)
    return time_history(model, pulse(), dt=0.002, **options)


@pytest.fixture(scope="module")
def landed():
    return mass_on(BACKED)


def test_the_run_goes_on_and_says_so(landed):
    alone = mass_on(BEARING)
    assert alone.attrs["status"] == "slip_exceeded"
    assert landed.attrs["status"] == "bearing_lost"
    assert "1 of 1 bearings failed" in landed.attrs["message"]
    assert "slip_exceeded" in landed.attrs["message"]
    failed = landed["bearing_failed"].to_numpy()[:, 0]
    first = float(landed["time"].to_numpy()[failed > 0.0][0])
    assert first == pytest.approx(alone.attrs["failed_at"], abs=0.003)
    assert (np.diff(failed) >= 0.0).all()
    both = len(alone["time"]) - 1
    assert (
        "less than steps of 2 ms resolve: for its forces use dt = 0.0005 s"
        in (landed.attrs["message"])
    )
    np.testing.assert_array_equal(
        landed["bearing_displacement"].to_numpy()[:both],
        alone["bearing_displacement"].to_numpy()[:both],
    )
    assert math.isfinite(peaks(landed).loc["residual bearing displacement", "value"])


def test_energies_close(landed):
    assert landed.attrs["energy_error"] < 1e-4
    assert landed.attrs["numerical_share"] < 1e-4


def test_the_mass_falls_freely_and_rests_on_the_stop(landed):
    """Between bearing and stop it is in free fall; in the end the stop carries it, and rubs."""
    time = landed["time"].to_numpy()
    down = -landed["bearing_displacement"].sel(axis="z").to_numpy()[:, 0]
    load = landed["axial_force"].to_numpy()[:, 0]
    failed = landed["bearing_failed"].to_numpy()[:, 0] > 0.0
    aloft = np.flatnonzero(failed & (load == 0.0) & (down < DROP))
    first = np.split(aloft, np.flatnonzero(np.diff(aloft) > 1) + 1)[0][1:]
    assert len(first) > 10
    fall = np.polyfit(time[first], down[first], 2)[0]
    assert 2.0 * fall == pytest.approx(STANDARD_GRAVITY, rel=1e-3)
    assert load[-1] == pytest.approx(LOAD, rel=1e-3)
    assert down[-1] == pytest.approx(DROP + LOAD / BEARING.resolved()["axial_stiffness"], rel=1e-4)
    force = np.hypot(*landed["bearing_force"].sel(axis=["x", "y"]).to_numpy()[:, 0].T)
    assert force[failed].max() <= FRICTION * load[failed].max() * (1.0 + 1e-9)
    pressed = failed & (load > 0.0)
    assert (force[pressed][5:] <= FRICTION * load[pressed][5:] * (1.0 + 1e-9)).all()


def test_a_failed_bearing_does_not_lift_off(landed):
    table = peaks(landed)["value"]
    assert table["uplifts, all bearings"] == 0.0
    assert table["maximum uplift"] == 0.0


def test_what_a_batch_reaches_is_what_a_history_reaches(landed):
    model = lumped_mass(BACKED, mass=LOAD / STANDARD_GRAVITY)
    batch = time_histories(model, pulse(), dt=0.002)
    assert str(batch["status"].item()) == "bearing_lost"
    ours = batch["peak"].isel(run=0).to_series()
    whole = peaks(landed)["value"]
    for name in ours.index.difference(["seconds of the time loop"]):
        assert ours[name] == pytest.approx(whole[name], rel=1e-12, nan_ok=True), name


def test_at_the_level_with_bodies():
    data = mass_on(BACKED, level="contact")
    assert data.attrs["status"] == "bearing_lost"
    assert data.attrs["energy_error"] < 1e-3
    assert float(data["axial_force"][-1, 0]) == pytest.approx(LOAD, rel=1e-3)


def test_neighbours_carry():
    """The middle bearing of nine fails; its neighbours at the edges take what it carried."""
    strong = replace(bearing_for(400e3), backup=BackupSupport(drop=math.inf))
    own = {(i, j): strong for i in range(3) for j in range(3)}
    own[1, 1] = replace(strong, slip_capacity=0.002)
    data = time_history(moment_frame((2, 2), 1, bearing=own), pulse(2.8, tail=4.0), dt=0.002)
    assert data.attrs["status"] == "bearing_lost"
    assert data["bearing_failed"].to_numpy()[-1].tolist() == [0, 0, 0, 0, 1, 0, 0, 0, 0]
    assert data.attrs["energy_error"] < 1e-4
    loads = data["axial_force"].to_numpy()
    assert loads[-1, 4] == 0.0
    assert loads[-200:].sum(axis=1).mean() == pytest.approx(loads[0].sum(), rel=0.01)
    gained = loads[-200:].mean(axis=0) - loads[0]
    assert gained[[1, 3, 5, 7]].sum() == pytest.approx(loads[0, 4], rel=0.1)
    assert peaks(data).loc["uplifts, all bearings", "value"] == 0.0


def test_without_a_bearing_or_a_stop_the_run_ends():
    data = mass_on(replace(BEARING, backup=BackupSupport(drop=math.inf)))
    assert data.attrs["status"] == "slip_exceeded"


def test_the_tangent_is_the_derivative():
    element = Element(BACKED)
    u, time = np.zeros(12), 0.0
    u[8] = -1e-4
    while not element.response("failed"):
        u[6] += 0.002
        time += 0.01
        element.set_trial(u, np.zeros(12), time)
        element.commit()
    own = element.resisting_force()  # of its last state, which it was in equilibrium with
    assert element.response("axial_force") > 0.9 * -own[8] > 0.0
    assert element.response("failed") == -int(RunStatus.SLIP_EXCEEDED)
    u[8], u[7], u[3:6], u[9:] = -DROP - 3e-4, -0.002, (0.01, 0.02, 0.005), (0.01, -0.01, 0.003)
    element.set_trial(u, np.zeros(12), time + 0.01)
    element.commit()
    force = element.resisting_force()
    assert force[8] < 0.0
    np.testing.assert_allclose(force[:3], -force[6:9])
    arm = u[6:9] - u[:3] + (0.0, 0.0, BACKED.height)
    np.testing.assert_allclose(force[3:6], -np.cross(arm, force[6:9]), rtol=1e-12)
    for more in ((1e-5, -2e-5, -1e-5), (1e-3, 2e-3, -1e-4)):  # sticks; slips
        there = u.copy()
        there[6:9] += more
        element.set_trial(there, np.zeros(12), time + 0.02)
        tangent, by_steps = element.tangent_stiffness(), np.zeros((12, 12))
        for j in range(12):
            ends = []
            for way in (1e-8, -1e-8):
                moved = there.copy()
                moved[j] += way
                element.set_trial(moved, np.zeros(12), time + 0.02)
                ends.append(element.resisting_force())
            by_steps[:, j] = (ends[0] - ends[1]) / 2e-8
        assert np.abs(tangent - by_steps).max() < 1e-7 * np.abs(by_steps).max()


def test_a_bearing_that_opens_too_far_fails():
    bearing = replace(BEARING, uplift_capacity=0.01)
    jerk = GroundMotion(z=-30.0 * np.sin(np.linspace(0.0, np.pi, 41)), dt=0.01, name="jerk")
    model = lumped_mass(bearing, mass=LOAD / STANDARD_GRAVITY)
    data = time_history(model, jerk, dt=0.001)
    assert data.attrs["status"] == "uplift_exceeded"
    assert "uplift_capacity 0.01" in data.attrs["message"]
    held = time_history(lumped_mass(BEARING, mass=LOAD / STANDARD_GRAVITY), jerk, dt=0.001)
    assert peaks(held).loc["maximum uplift", "value"] > 0.01
    assert peaks(data).loc["maximum uplift", "value"] == pytest.approx(0.01, rel=0.05)


def test_fragility_takes_a_lost_bearing_for_a_failure_alone():
    model = lumped_mass(BACKED, mass=LOAD / STANDARD_GRAVITY)
    motion = pulse()
    data = time_histories(model, motion, dt=0.002)
    runs = IntensityRuns.from_dataset(data, motion, Intensity(kind="PGA", measure="x"))
    assert runs.exceeded(LimitState.bearing_failure()).tolist() == [1.0]
    reached = float(runs.demand("bearing displacement")[0])
    assert math.isfinite(reached)
    assert runs.exceeded(LimitState.displacement(1.1 * reached)).tolist() == [0.0]


def test_refused_where_it_is_not_known():
    refused(ValueError, r"rigid_body.*backup", mass_on, BACKED, level="rigid_body")
    for wrong, match in (
        (-0.01, "drop"),
        (50.0, r"50 mm are 0.05 m.*math.inf"),
        ("5 cm", "number"),
    ):
        refused((TypeError, ValueError), match, BackupSupport, drop=wrong)
    refused(TypeError, r"backup.*BackupSupport", replace, BEARING, backup=0.05)
    refused(ValueError, "uplift_capacity", replace, BEARING, uplift_capacity=0.0)


def test_a_run_that_has_to_raise_does_not_for_a_lost_bearing():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        mass_on(BACKED, on_failure="raise")
    assert any("continued without it" in str(each.message) for each in told)
    with pytest.raises(AnalysisError):
        mass_on(BEARING, on_failure="raise")


@pytest.mark.parametrize("seed", range(12))
def test_random_bearings_that_fail(seed):
    """Whatever fails, carries and lands: runs end as they may, and energies close."""
    rng = np.random.default_rng(seed)
    load = 10.0 ** rng.uniform(5.0, 6.3)
    bearing = bearing_for(load)
    backup = BackupSupport(
        drop=float(rng.choice([0.0, 0.005, 0.02, 0.1, math.inf])),
        friction=float(rng.choice([0.0, 0.1, 0.3, 0.8])),
    )
    bearing = replace(
        bearing,
        interface_friction=rng.uniform(0.1, 0.2),
        capacity=rng.uniform(0.1, 0.3),
        slip_capacity=bearing.slider_radius * rng.uniform(0.05, 1.0),
        uplift_capacity=float(rng.choice([0.005, 0.05, math.inf])),
        backup=backup,
    )
    if rng.random() < 0.3:
        strength = load * rng.uniform(0.2, 1.0)
        bearing = replace(bearing.as_dcfp(), rim_yield_force=strength, rim_overrun=0.01)
    t, still = np.arange(0.0, 3.0, 0.01), np.zeros(100)
    x, y, z = (
        size * np.sin(2.0 * np.pi * t / rng.uniform(0.8, 3.0)) * np.sin(np.pi * t / 3.0)
        + 0.3 * size * rng.standard_normal(len(t))
        for size in rng.uniform((4.0, 0.0, 0.0), (9.0, 6.0, 6.0))
    )
    motion = GroundMotion(
        **{a: np.append(w, still) for a, w in zip("xyz", (x, y, z), strict=True)}, dt=0.01
    )
    if rng.random() < 0.5:
        model = lumped_mass(bearing, mass=load / STANDARD_GRAVITY * rng.uniform(0.3, 1.0))
    else:
        model = moment_frame((2, 1), 1, bearing=bearing)
    data = time_history(model, motion, dt=float(rng.choice([0.002, 0.005, 0.01])))
    assert RunStatus[data.attrs["status"].upper()] in {
        RunStatus.OK,
        RunStatus.BEARING_LOST,
        RunStatus.SLIP_EXCEEDED,
        RunStatus.RIM_OVERRUN,
        RunStatus.UPLIFT_EXCEEDED,
    }, data.attrs["message"]
    assert data.attrs.get("energy_error", 0.0) < 1e-3
    lost = data["bearing_failed"].to_numpy() > 0.0  # from when on nothing but its stop carries
    force = np.hypot(*np.moveaxis(data["bearing_force"].to_numpy(), -1, 0)[:2])
    held = backup.friction * data["axial_force"].to_numpy()
    assert (force <= held * (1.0 + 1e-9) + 1e-9 * load)[lost].all()
