"""Random valid bearings, motions and steps: a run completes or says when and why it stopped.

Nothing else is allowed: no NaN, no silent failure, no bearing computed on beyond its limits, no
energy from nowhere.
"""

import math
import warnings

import numpy as np
import pytest

from frames import GroundMotion, energy_error, lumped_mass, shear_building, time_history
from lir_element import CoulombFriction, LIRBearing, RunStatus, VelocityFriction
from lir_element.errors import AnalysisWarning

CASES = 300
FAILURES = {status.name.lower() for status in RunStatus} - {"ok"}


def random_bearing(rng: np.random.Generator) -> LIRBearing:
    """From model scale to bridge scale, with everything that an engineer can choose."""
    size = 10.0 ** rng.uniform(-1.0, 0.7)
    radii = size * rng.uniform(0.5, 2.0, 2)
    height = rng.uniform(0.05, 0.25) * radii.min()
    slider = rng.uniform(0.3, 0.9) * min(height, 0.4 * radii.min())
    mu = 10.0 ** rng.uniform(-2.0, -0.8, 2)
    length = radii.sum() - height
    laws = [
        CoulombFriction(m)
        if rng.random() < 0.3
        else VelocityFriction(m, rng.uniform(0.2, 1.0) * m, 10.0 ** rng.uniform(0.0, 2.3))
        for m in mu
    ]
    threshold = max((mu * radii).sum() / length, mu.max())
    kind = rng.choice(["lir", "dcfp", "free"], p=[0.6, 0.25, 0.15])
    return LIRBearing(
        radius=tuple(radii),
        slider_height=height,
        slider_radius=slider,
        capacity=math.inf if kind == "free" else rng.uniform(0.03, 0.25) * length,
        friction=tuple(laws),
        interface_friction=math.inf if kind == "dcfp" else threshold * rng.uniform(1.02, 4.0),
        friction_law="bouc-wen" if rng.random() < 0.2 else "elastic-plastic",
        yield_displacement=10.0 ** rng.uniform(-4.5, -3.0),
        rim_damping=None if rng.random() < 0.7 else 0.0,
    )


def random_motion(rng: np.random.Generator, scale: float) -> GroundMotion:
    """A pulse and noise in three directions; the vertical one may lift the mass."""
    dt = 10.0 ** rng.uniform(-2.6, -1.5)
    n = int(rng.uniform(2.0, 4.0) / dt)
    t = np.arange(n) * dt
    waves = []
    for limit in (6.0, 5.0, 9.0):
        strength = limit * rng.random() ** 2
        period = rng.uniform(0.2, 1.2) * math.sqrt(scale)
        wave = np.sin(2 * np.pi * t / period + rng.uniform(0.0, 6.0)) + 0.3 * rng.normal(size=n)
        waves.append(strength * wave * np.minimum(t / 0.3, 1.0))
    return GroundMotion(*waves, dt=dt)


def random_model(rng: np.random.Generator, bearing: LIRBearing):
    mass = bearing.resolved()["design_load"] / 9.80665 * rng.uniform(0.05, 2.0)
    if rng.random() < 0.7:
        return lumped_mass(bearing, mass)
    storeys = int(rng.integers(1, 4))
    stiffness = mass / storeys * (2 * np.pi / rng.uniform(0.1, 0.5)) ** 2
    return shear_building(bearing, mass / storeys, stiffness, storeys=storeys, base_mass=0.3 * mass)


@pytest.mark.parametrize("seed", range(CASES))
def test_completes_or_reports(seed):
    rng = np.random.default_rng(seed)
    bearing = random_bearing(rng)
    motion = random_motion(rng, bearing.effective_radius)
    dt = None if rng.random() < 0.2 else 10.0 ** rng.uniform(-3.3, -1.3)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        data = time_history(random_model(rng, bearing), motion, dt=dt)
    for name, values in data.items():
        if name in {"rim_displacement", "interface_friction"}:  # without rims, in one piece
            assert not np.isnan(values.to_numpy()).any(), name
            continue
        assert np.isfinite(values.to_numpy()).all(), name
    axial = data["axial_force"]
    assert float(axial.min()) >= 0.0
    status = data.attrs["status"]
    if status == "ok":
        assert float(data["time"][-1]) >= motion.duration - 1e-9
        limits = bearing.resolved()
        pressed = data["interface_slip_size"].where(axial > 0.0, 0.0)
        assert float(pressed.max()) <= limits["slip_capacity"]
        assert float(data["rim_closure"].max()) <= limits["rim_overrun"]
    else:
        assert status in FAILURES
        assert any(issubclass(entry.category, AnalysisWarning) for entry in caught)
        assert f"{data.attrs['failed_at']:.6g}" in data.attrs["message"]
        assert "What to try" in data.attrs["message"]
    if float(np.abs(data["energy"].sel(term="input")).max()) > 1.0:
        assert energy_error(data) < 1e-3
    dissipated = data["energy"].sel(
        term=["low_friction_bottom", "low_friction_top", "high_friction"]
    )
    assert float(dissipated.diff("time").min()) >= 0.0
