"""Friction that depends on pressure and temperature: factors, heating, and what runs make of it."""

import copy
import math
import pickle  # noqa: S403
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    GroundMotion,
    Recording,
    audit,
    load,
    lumped_mass,
    moment_frame,
    peaks,
    save,
    time_histories,
    time_history,
)
from lir_element import (
    CoulombFriction,
    Element,
    Features,
    FrictionHeating,
    LIRBearing,
    PressureDependence,
    cyclic_test,
)
from lir_element.bundles.contact_data import heat_parts, initial_state
from lir_element.kernels.friction_law import covered, heat_up
from tests.refusals import refused
from tests.scenes import plain_pendulum

LOAD = 3e6
MU = 0.06
STEEL = {"conductivity": 18.0, "diffusivity": 4.44e-6}
DT = 0.005


device = partial(plain_pendulum, slider_radius=0.2, friction=CoulombFriction(MU), design_load=LOAD)


HEATED = {"friction_heating": FrictionHeating()}
BOTH = HEATED | {"pressure_dependence": PressureDependence()}


# Factors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("variant", "scale", "rate", "rest", "left"),
    [
        ("half", 0.79, 0.02, 0.40, 1.0 / 2.0),
        ("third", 0.97, 0.029, 0.22, 1.0 / 3.0),
        ("two-thirds", 0.84, 0.0085, 0.25, 2.0 / 3.0),
    ],
)
def test_temperature_factors(variant: Any, scale: float, rate: float, rest: float, left: float):
    """The published factors, within their own rounding: they are not quite one at 20 C."""
    law = FrictionHeating(variant=variant)
    for temperature in (-20.0, 20.0, 90.0, 200.0, 400.0):
        published = scale * (0.7 ** (rate * temperature) + rest)
        assert_allclose(law.factor(temperature), published, rtol=3e-3)
    assert law.factor(20.0) == 1.0
    assert_allclose(law.factor(200.0), left, rtol=0.015)
    cold = replace(law, reference_temperature=0.0)
    assert_allclose(cold.factor(90.0), law.factor(90.0) / law.factor(0.0), rtol=1e-14)


def test_pressure_factor():
    """By hand: 0.7^(0.02 * 50) = 0.7, 0.7^(0.02 * -10) = 1.0739."""
    law = PressureDependence(reference_pressure=20e6)
    assert_allclose([law.factor(70e6), law.factor(10e6)], [0.7, 1.0739], rtol=1e-4)
    assert_allclose(PressureDependence().factor(70e6, reference=20e6), 0.7, rtol=1e-12)
    refused(ValueError, "reference_pressure is not set", lambda: PressureDependence().factor(70e6))


@pytest.mark.parametrize(
    ("kind", "given", "words"),
    [
        (FrictionHeating, {"diffusivity": 4.44}, r"diffusivity = 4.44 .*4.44e-6 m2/s"),
        (FrictionHeating, {"thickness": 50.0}, r"thickness = 50 .*\(50 mm are 0.05 m"),
        (FrictionHeating, {"initial_temperature": 2931.5}, "initial_temperature = 2931.5"),
        (FrictionHeating, {"variant": "quarter"}, r"choose one of \('half', 'third'"),
        (FrictionHeating, {"conductivity": 0.0}, "conductivity = 0 "),
        (FrictionHeating, {"share": 1.5}, "share = 1.5"),
        (PressureDependence, {"reference_pressure": 30.0}, r"\(30 MPa are 3e\+07 Pa\)"),
        (PressureDependence, {"rate": 0.0071}, r"rate = 0.0071 .*1/Pa"),
    ],
)
def test_bad_numbers_are_refused(kind: Any, given: dict[str, Any], words: str):
    refused(ValueError, words, kind, **given)


@pytest.mark.parametrize("name", BOTH)
def test_a_bearing_takes_nothing_else(name: str):
    refused(TypeError, rf"{name} = 0.5 must be a .*\(\)", device, **{name: 0.5})


def test_a_bearing_describes_them():
    words = device(**BOTH).describe()
    assert "half at 200 C, half-space, from 20 C on" in words
    assert "0.713 % less a MPa, from the design load on" in words
    thin = FrictionHeating(thickness=0.05, initial_temperature=-5.0)
    assert str(thin) == "half at 200 C, 50 mm, from -5 C on"
    assert str(PressureDependence(reference_pressure=3e7)).endswith("from 30 MPa on")


# Heating ---------------------------------------------------------------------------------------


def heated(law: FrictionHeating, times: np.ndarray, flux: np.ndarray) -> np.ndarray:
    """Return the bottom surface's temperatures at `times` (n + 1,) under fluxes between (n,)."""
    bearing = device(friction_heating=law)
    props = bearing.to_record()
    old, new = initial_state(props), initial_state(props)
    heat, area = heat_parts(props), math.pi * bearing.slider_radius**2
    found = [float(old["temperature"][0, 0])]
    for k, q in enumerate(flux):
        old["time"], new["time"] = times[k], times[k + 1]
        new["work_friction"][0, 0] = q * area * (times[k + 1] - times[k])
        heat_up(props[0], heat[0], old[0], new[0])
        found.append(float(new["temperature"][0, 0]))
    return np.array(found)


@pytest.mark.plain
def test_constant_flux_on_a_half_space():
    """T = 2 q / k sqrt(D t / pi), whatever the steps; and cooling once the flux ends."""
    q, k, d = 2e6, STEEL["conductivity"], STEEL["diffusivity"]
    times = np.concatenate([[0.0], np.geomspace(1e-3, 40.0, 60), np.linspace(42.0, 200.0, 40)])
    flux = np.where(times[1:] <= 40.0, q, 0.0)
    found = heated(FrictionHeating(**STEEL), times, flux)
    rise = 2.0 * q / k * np.sqrt(d * times / math.pi)
    after = np.sqrt(np.maximum(times - 40.0, 0.0) * d / math.pi) * 2.0 * q / k
    assert_allclose(found[1:] - 20.0, (rise - after)[1:], rtol=1e-3)
    finer = np.unique(np.concatenate([times, np.linspace(0.0, 40.0, 700)]))
    q_finer = np.where(finer[1:] <= 40.0, q, 0.0)
    again = heated(FrictionHeating(**STEEL), finer, q_finer)
    assert_allclose(again[np.searchsorted(finer, times)][2:], found[2:], rtol=1e-3)


@pytest.mark.plain
@pytest.mark.parametrize("thickness", [0.005, 0.02, 0.05, 0.1, 0.2])
def test_constant_flux_on_a_plate(thickness: float):
    """Against the series of a slab insulated behind (Carslaw and Jaeger 1959, 3.8)."""
    q, k, d = 1e6, STEEL["conductivity"], STEEL["diffusivity"]
    times = np.concatenate([[0.0], np.geomspace(1e-3, 200.0, 300)])
    found = heated(FrictionHeating(thickness=thickness, **STEEL), times, np.full(300, q))
    n = np.arange(1, 20000)[:, None]
    fo = d * times[1:] / thickness**2
    series = sum(
        (np.exp(-np.minimum(part**2 * math.pi**2 * fo, 700.0)) / part**2).sum(axis=0)
        for part in np.array_split(n, 20)
    )
    expected = q * thickness / k * (fo + 1.0 / 3.0 - 2.0 / math.pi**2 * series)
    assert_allclose(found[1:] - 20.0, expected, rtol=4e-3)


@pytest.mark.parametrize("path", [math.inf, 1000.0, 300.0, 100.0, 20.0, 5.0, 1.0])
def test_the_sum_of_exponentials_keeps_to_its_bound(path: float):
    """0.5 % over 1 ms to 200 s; here on a plate's answer to a unit of heat, by images alone."""
    from lir_element.device.heating import _exponentials, response

    time = np.geomspace(1e-3, 200.0, 4001)
    rate, weight, _ = _exponentials(path)
    images = np.arange(1, 200)[:, None] ** 2
    plate = 1.0 / np.sqrt(time)
    if math.isfinite(path):
        plate *= 1.0 + 2.0 * np.exp(-np.minimum(images * path / time, 700.0)).sum(axis=0)
    assert_allclose(response(time, path), plate, rtol=1e-9)
    assert_allclose(np.exp(-np.outer(time, rate)) @ weight, plate, rtol=5e-3)
    assert (weight >= 0.0).all()


@pytest.mark.plain
def test_cover_of_the_middle():
    assert covered(0.05, 0.09, 0.1) == 1.0
    assert covered(0.3, 0.11, 0.1) == 0.0
    assert_allclose([covered(0.08, 0.12, 0.1), covered(0.16, 0.06, 0.1)], [0.5, 0.4])


TOLD = ("temperature", "friction_coefficient", "friction_force", "work_friction", "eccentricity")


def taken(element: Element, x: np.ndarray) -> dict[str, np.ndarray]:
    """Take an element along x (n,) in steps of `DT` at the height that carries the load."""
    bearing, u = element.bearing, np.zeros(12)
    length = bearing.effective_radius + LOAD / bearing.resolved()["axial_stiffness"]
    kept: dict[str, list[Any]] = {name: [] for name in (*TOLD, "axial_force", "force")}
    for k, place in enumerate(x):
        u[6], u[8] = place, bearing.effective_radius - math.sqrt(length**2 - place**2)
        element.set_trial(u, np.zeros(12), DT * k)
        element.commit()
        for name, values in kept.items():
            values.append(np.array(element.response(name)))
    return {name: np.array(values) for name, values in kept.items()}


def held(bearing: LIRBearing, x: np.ndarray, level: Any = "pendulum", **options: Any) -> Any:
    """Return a new element that was taken along x, and what it told."""
    element = Element(bearing, level, **options)
    return element, taken(element, x)


def sine(reach: float, count: int, period: float = 2.0) -> np.ndarray:
    return reach * np.sin(2.0 * np.pi * DT * np.arange(count) / period)


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_temperature_is_that_of_the_flux(level: Any):
    """The integral over the recorded flux, exact for a flux that is constant in each step.

    The slider leaves the middle of its surfaces and comes back.
    """
    bearing = device(slider_radius=0.12, **HEATED)
    _, r = held(bearing, sine(0.5, 500 if level == "pendulum" else 300), level)
    work, far = r["work_friction"][:, 0], r["eccentricity"][:, 0]
    assert far.max() > 1.5 * 0.12
    share = np.array([covered(a, b, 0.12) for a, b in pairwise(far)])
    assert 0.3 < share.mean() < 0.8
    flux = np.diff(work) / DT / (math.pi * 0.12**2) * share
    t = DT * np.arange(len(work))
    root = np.sqrt(np.maximum(t[:, None] - t[None, :], 0.0))
    scale = 2.0 * math.sqrt(STEEL["diffusivity"] / math.pi) / STEEL["conductivity"]
    expected = 20.0 + scale * (root[:, :-1] - root[:, 1:]) @ flux
    assert expected.max() > 60.0
    gap = np.abs(r["temperature"][:, 0] - expected)
    assert gap.max() < 2e-3 * (expected.max() - 20.0)


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_friction_follows_the_temperature_at_the_start_of_a_step(level: Any):
    bearing = device(**HEATED)
    _, r = held(bearing, sine(0.15, 300), level)
    law = FrictionHeating()
    warm = np.vectorize(law.factor)(r["temperature"][:-1, :2])
    assert warm.min() < 0.9
    assert_allclose(r["friction_coefficient"][2:], MU * warm[1:], rtol=1e-9)


def test_the_friction_force_is_that_by_hand():
    """Under a held load: F = mu k_p k_T N on each surface, N / A being 23.87 MPa."""
    press = PressureDependence(reference_pressure=10e6)
    bearing = device(pressure_dependence=press, **HEATED)
    _, r = held(bearing, np.linspace(0.0, 0.1, 100))
    pressure = LOAD / (math.pi * 0.2**2) * 1e-6
    k_p = 0.7 ** (0.02 * (pressure - 10.0))
    k_t = FrictionHeating().factor(r["temperature"][-2, 0])
    force = np.hypot(*r["friction_force"][-1, 0])
    assert_allclose(r["axial_force"][-1], LOAD, rtol=1e-9)
    assert k_t < 0.97
    assert_allclose(force, MU * k_p * k_t * LOAD, rtol=1e-9)


def test_levels_agree():
    """Friction of points is that of the surface; the points take N of the step before.

    At a held height bodies carry 0.4 % less than the string.
    """
    x = sine(0.2, 320)
    bearing = device(**BOTH)
    (_, a), (_, b) = (held(bearing, x, level) for level in ("pendulum", "contact"))
    assert a["temperature"][-1, 0] > 50.0
    rise = a["temperature"].max() - 20.0
    assert_allclose(b["temperature"][:, :2], a["temperature"][:, :2], rtol=0.0, atol=0.015 * rise)
    mu, expected = b["friction_coefficient"][1:], a["friction_coefficient"][1:]
    assert_allclose(mu, expected, rtol=4e-3)
    assert expected.min() < 0.9 * MU


def test_the_interface_is_heated_by_its_slip():
    """The dissipation of an impact's slip; its friction stays as it is."""
    bearing = device(slider_radius=0.15, capacity=0.15, interface_friction=0.12, **HEATED)
    path = np.concatenate([np.linspace(0.0, 0.2, 30), np.linspace(0.2, 0.1, 20)])
    data = cyclic_test(bearing, path, LOAD, velocity=0.5)
    assert data["temperature"].dims == ("step", "bearing", "contact")
    assert data["temperature"].attrs["units"] == "degC"
    assert data["contact"].to_numpy().tolist() == ["bottom", "top", "interface"]
    hot = data["temperature"].sel(contact="interface")[:, 0].to_numpy()
    assert hot[10] == pytest.approx(20.0, abs=0.01)
    assert hot.max() > 40.0
    assert float(data["interface_force"].max()) == pytest.approx(0.12 * LOAD, rel=0.02)


# Neutral, and what is left out ---------------------------------------------------------------


def test_left_out_is_the_bearing_without():
    """To the bit; temperatures are computed all the same."""
    x = sine(0.15, 200)
    out = Features(friction_heating=False, pressure_dependence=False)
    for level in ("pendulum", "contact"):
        _, a = held(device(**BOTH), x, level, features=out)
        _, b = held(device(), x, level)
        assert_array_equal(a["force"], b["force"])
        assert a["temperature"][-1, 0] > 40.0
        assert_array_equal(b["temperature"], 0.0)


def test_copies_and_restarts_keep_their_own_heat():
    x = sine(0.15, 120)
    element, r = held(device(**BOTH), x)
    others = copy.deepcopy(element), pickle.loads(pickle.dumps(element))  # noqa: S301
    u = np.array(element.response("displacement"))
    u[6] += 0.01
    for each in (element, *others):
        each.set_trial(u, np.zeros(12), DT * len(x))
        each.commit()
    for other in others:
        assert_array_equal(other.response("temperature"), element.response("temperature"))
    assert element.response("temperature")[0] > r["temperature"][-1, 0]
    element.revert_to_start()
    assert_array_equal(element.response("temperature"), 20.0)
    assert_array_equal(taken(element, x[:40])["temperature"], r["temperature"][:40])


@pytest.mark.parametrize("name", BOTH)
def test_the_level_rigid_body_refuses_them(name: str):
    bearing, level = device(**{name: BOTH[name]}), "rigid_body"
    words = rf'"rigid_body" does not support {name}: use level="co'
    refused(ValueError, words, cyclic_test, bearing, [0.0, 0.1], LOAD, level=level)
    frame = lumped_mass(bearing, 1e4)
    refused(ValueError, words, time_history, frame, motion(), level=level)


# Time histories --------------------------------------------------------------------------------


def motion(peak: float = 3.0, count: int = 800) -> GroundMotion:
    t = DT * np.arange(count)
    shake = peak * np.sin(2.0 * np.pi * t / 1.9) * np.sin(np.pi * t / t[-1])
    return GroundMotion(x=shake, y=0.4 * np.roll(shake, 50), z=0.3 * np.roll(shake, 9), dt=DT)


def run(bearing: LIRBearing, **options: Any) -> xr.Dataset:
    return time_history(lumped_mass(bearing, LOAD / 9.81), motion(), dt=DT, **options)


def finding(data: xr.Dataset, name: str) -> Any:
    return {each.feature: each for each in audit(data)}[name]


def test_a_time_history_tells_what_heat_did():
    data = run(device(**HEATED))
    assert data["temperature"].dims == ("time", "bearing", "contact")
    hottest = float(data["temperature"].max())
    found = finding(data, "friction_heating")
    assert hottest > 60.0
    assert found.mattered
    assert not found.left_out
    assert f"reached {hottest:.0f} C" in found.sentence
    cold = run(device())
    assert "temperature" not in cold
    assert finding(cold, "friction_heating").sentence.endswith("no friction depends on temperature")
    moved, less = (float(np.abs(d["bearing_displacement"][..., 0]).max()) for d in (data, cold))
    assert moved > 1.02 * less


@pytest.mark.parametrize("name", ["friction_heating", "pressure_dependence"])
def test_the_audit_judges_what_was_left_out(name: str):
    """By what the run itself reached: nearly what the run with it says."""
    bearing = device(
        **(BOTH | {"pressure_dependence": PressureDependence(reference_pressure=10e6)})
    )
    full, out = run(bearing), run(bearing, features=Features().without(name))
    a, b = finding(full, name), finding(out, name)
    assert b.left_out
    assert b.mattered
    assert a.number > 0.05
    assert b.number == pytest.approx(a.number, rel=0.35)
    assert f"! {name.replace('_', ' ')} left out" in out.attrs["audit"]
    none = run(device(), features=Features().without(name))
    assert not finding(none, name).mattered


def test_thinned_recordings_know_what_was_reached(tmp_path: Any):
    bearing = device(**BOTH)
    whole, thin = run(bearing), run(bearing, recording=Recording.peaks())
    save(thin, tmp_path / "run.nc")
    for data in (thin, load(tmp_path / "run.nc")):
        for name in ("friction_heating", "pressure_dependence"):
            one, other = finding(whole, name), finding(data, name)
            assert other.number == pytest.approx(one.number, rel=1e-9)
            assert other.sentence == one.sentence


def test_level_auto_has_them():
    data = run(device(**HEATED), level="auto")
    assert data.attrs["features_left_out"] == "rims, interface, velocity_dependence"
    assert_allclose(
        data["temperature"].max(), run(device(**HEATED))["temperature"].max(), rtol=1e-6
    )


def test_step_control_finds_the_same():
    """Friction lags by a step: what is left of that is within the tolerance that is stated."""
    frame = lumped_mass(device(**BOTH), LOAD / 9.81)
    a, b = (
        time_history(frame, motion(), dt=dt)["bearing_displacement"].isel(bearing=0)
        for dt in (None, 0.0005)
    )
    times = a["time"].to_numpy()
    fine = b.interp(time=times).to_numpy()
    assert_allclose(a.to_numpy()[:, :2], fine[:, :2], rtol=0.0, atol=0.005 * np.abs(fine).max())


def test_some_bearings_of_a_frame_may_be_heated():
    plain = device(design_load=1e6)
    frame = moment_frame(bays=(1, 1), storeys=1, bearing=plain)
    name = next(iter(frame.bearings))
    mixed = frame.with_bearings({name: replace(plain, **HEATED)})
    data = time_history(mixed, motion(count=200), dt=DT)
    hot = data["temperature"].isel(time=-1)
    assert float(hot.sel(bearing=name, contact="bottom")) > 20.0
    assert int(np.isnan(hot).any("contact").sum()) == 3
    table = peaks(data)
    assert table.loc["temperature of plates", "where"] == name
    assert table.loc["temperature of plates", "value"] == float(np.nanmax(data["temperature"]))
    assert table.loc["temperature of interfaces", "unit"] == "degC"
    chosen = Recording(bearings=tuple(n for n in frame.bearings if n != name))
    others = time_history(mixed, motion(count=200), dt=DT, recording=chosen)
    assert finding(others, "friction_heating").sentence.endswith("depends on temperature")
    assert "temperature of plates" not in peaks(others).index


def test_many_histories_know_it_too():
    frame = lumped_mass(device(**BOTH), LOAD / 9.81)
    shake = motion(count=300)
    one = time_history(frame, shake, dt=DT)
    data = time_histories(frame, shake, scales=(0.5, 1.0), dt=DT, workers=1)
    expected = one["temperature"].max("time").to_numpy()
    assert_allclose(data["peak_temperature"].isel(run=1), expected, rtol=1e-12)
    assert (data["peak_temperature"].isel(run=0) < expected)[:, :2].all()
    assert finding(one, "friction_heating").sentence in str(data["audit"].to_numpy()[1])
