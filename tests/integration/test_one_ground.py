"""The ground that acts is the ground that is recorded, and the energy balance shows it."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import AuditWarning, GroundMotion, lumped_mass, shear_building, time_history
from lir_element import AnalysisWarning
from tests.scenes import plain_pendulum as device

MASS = 1e5
G = 9.80665


def shocks(dt: float = 0.002) -> GroundMotion:
    """Shocks shorter than a step of 20 ms, the first sample one of them."""
    rng = np.random.default_rng(3)
    waves = rng.normal(size=(3, 1000)) * np.array([[4.0], [3.0], [2.0]])
    waves[:, 0] = (6.0, -5.0, 4.0)
    return GroundMotion(*waves, dt=dt)


@pytest.mark.parametrize("dt", [0.001, 0.002, 0.02, 0.035])
def test_recorded_ground_balances_recorded_forces(run, dt):
    data = run(lumped_mass(device(), MASS), shocks(), dt=dt)
    total = data["node_acceleration"].sel(node="mass", dof=["ux", "uy", "uz"]).to_numpy()
    force = data["bearing_force"][:, 0].to_numpy() + np.array([0.0, 0.0, MASS * G])
    assert_allclose(MASS * total[1:], -force[1:], rtol=0.0, atol=2e-6 * MASS * G)
    ground = data["ground_acceleration"].to_numpy()
    assert_allclose(total[0], 0.0, rtol=0.0, atol=1e-9)  # nothing but the ground acts at first
    assert np.abs(ground[0]).max() > 1.0
    assert data.attrs["numerical_share"] < 5e-4  # what friction owes where it turns in a long step


@pytest.mark.parametrize("dt", [0.005, 0.02])
def test_building_is_in_equilibrium(run, dt):
    model = shear_building(device(), [4e4, 3e4], [5e7, 4e7], base_mass=3e4)
    data = run(model, shocks(), dt=dt)
    masses = {"base": 3e4, "floor-1": 4e4, "floor-2": 3e4}
    inertia = sum(
        m * data["node_acceleration"].sel(node=node, dof=["ux", "uy"]) for node, m in masses.items()
    )
    shear = data["base_shear"].sel(axis=["x", "y"]).to_numpy()
    assert_allclose(inertia[1:], -shear[1:], rtol=0.0, atol=2e-6 * float(data["weight"]))


def test_doubtful_run_says_so():
    """Every mode rings at a step of 0.1 s, and the method takes out what rings."""
    model = shear_building(device(), [4e4, 3e4], [5e7, 4e7], base_mass=3e4)
    with pytest.warns(AnalysisWarning, match="results are doubtful.*time integration dissipates"):
        data = time_history(
            model, shocks(), dt=0.02, integrator="generalised-alpha", spectral_radius=0.0
        )
    assert data.attrs["status"] == "inaccurate"
    assert data.attrs["numerical_share"] > 1e-2
    assert "inaccurate" in data.attrs["audit"]
    assert float(data["time"][-1]) == pytest.approx(2.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", AnalysisWarning)
        warnings.simplefilter("ignore", AuditWarning)  # of the step, which is large for shocks
        assert time_history(model, shocks(), dt=0.02).attrs["status"] == "ok"


@pytest.mark.parametrize(("radius", "said"), [(0.0, True), (0.8, False)])
def test_numerical_damping_that_was_asked_for_is_named(radius, said):
    model = shear_building(device(), [4e4, 3e4], [5e7, 4e7], base_mass=3e4)
    t = np.arange(0.0, 2.0, 0.01)
    motion = GroundMotion(x=3.0 * np.sin(2.0 * np.pi * t) * np.sin(0.5 * np.pi * t) ** 2, dt=0.01)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AnalysisWarning)
        data = time_history(
            model, motion, dt=0.01, integrator="generalised-alpha", spectral_radius=radius
        )
    share = data.attrs["numerical_share"]
    words = [str(entry.message) for entry in caught]
    assert data.attrs["status"] == "ok"
    assert (1e-3 < share < 1e-2) is said
    if said:
        assert len(words) == 1
        assert f"dissipated {100.0 * share:.3g} % of the input energy" in words[0]
        assert caught[0].filename == __file__
        assert data.attrs["message"] == f"completed: {words[0]}"
        assert words[0] in data.attrs["audit"]
    else:
        assert words == []
        assert data.attrs["message"] == "completed"


def test_nothing_moves_and_nothing_warns():
    motion = GroundMotion(x=np.zeros(100), dt=0.005)
    with warnings.catch_warnings():
        warnings.simplefilter("error", AnalysisWarning)
        data = time_history(lumped_mass(device(), MASS), motion)
    assert data.attrs["status"] == "ok"
