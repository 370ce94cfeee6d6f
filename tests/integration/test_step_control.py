"""Steps that the program chooses: accurate, the same under any turn, hardly troubled by modes."""

import math
from functools import partial

import numpy as np
import pytest

from frames import Frame, GroundMotion, lumped_mass, shear_building, time_history
from lir_element import AnalysisWarning, CoulombFriction, VelocityFriction
from tests.scenes import simple_bearing

bearing = partial(
    simple_bearing,
    friction=VelocityFriction(0.06, 0.03, 20.0),
    interface_friction=0.12,
    yield_displacement=1e-4,
)


def motion(seed: int, strength: float, turn: float = 0.0, vertical: float = 1.0) -> GroundMotion:
    """Pulses with noise; the horizontal ones turned by `turn` [degrees]."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 5.0, 0.01)
    window = np.minimum(t / 0.5, 1.0) * np.minimum((5.0 - t) / 1.5, 1.0)
    x, y, z = (
        window * (np.sin(2.0 * np.pi * t / p + f) + 0.3 * rng.normal(size=len(t)))
        for p, f in zip(rng.uniform(0.6, 2.0, 3), rng.uniform(0.0, 6.0, 3), strict=True)
    )
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    y *= 0.3
    return GroundMotion(
        x=strength * (c * x - s * y), y=strength * (s * x + c * y), z=vertical * z, dt=0.01
    )


def peak(data) -> float:
    moves = data["bearing_displacement"].sel(axis=["x", "y"])
    return float(np.sqrt((moves**2).sum("axis")).max())


SCENES = [
    (bearing(), 1.8),
    (bearing(interface_friction=math.inf), 1.8),
    (bearing(yield_displacement=2e-5), 0.9),
    (bearing(friction=CoulombFriction(0.1), interface_friction=0.2), 1.0),  # barely slides
]


@pytest.mark.parametrize("scene", range(len(SCENES)))
@pytest.mark.parametrize("seed", [1, 2])
def test_chosen_steps_are_accurate_and_turn(run, scene, seed):
    device, strength = SCENES[scene]
    model = lumped_mass(device, 1e5)
    fine = run(model, motion(seed, strength), dt=2e-4, record_every=25)
    chosen = run(model, motion(seed, strength))
    turned = run(model, motion(seed, strength, 37.0))
    assert chosen.attrs["steps"] < 0.6 * fine.attrs["steps"]  # what barely slides turns often
    assert peak(chosen) == pytest.approx(peak(fine), rel=5e-3)
    assert peak(turned) == pytest.approx(peak(chosen), rel=1e-3)


BARELY = {"friction": CoulombFriction(0.1), "interface_friction": 0.2, "yield_displacement": 3e-4}
BOUC_WEN = {"friction_law": "bouc-wen", "bouc_wen_exponent": 1.0}


@pytest.mark.parametrize(
    ("law", "scheme"),
    [(BOUC_WEN, {}), ({}, {"integrator": "generalised-alpha", "spectral_radius": 0.0})],
    ids=["bouc-wen", "generalised-alpha"],
)
@pytest.mark.meant("the generalised-alpha method dissipated")
def test_laws_and_schemes_with_larger_errors(run, law, scheme):
    """Implicit steps of Bouc and Wen's law are of first order; a scheme that damps errs more."""
    model, moves = lumped_mass(bearing(**BARELY, **law), 1e5), motion(1, 0.7, vertical=0.0)
    fine = run(model, moves, dt=2e-4, record_every=25, **scheme)
    assert peak(run(model, moves, **scheme)) == pytest.approx(peak(fine), rel=0.01)


def test_samples_of_the_motion_are_ends_of_steps(run):
    """A single sample every 6 ms: steps of 5 ms would see another impulse."""
    spikes = np.zeros(200)
    spikes[60], spikes[90] = 4.0, -3.0
    moves, model = GroundMotion(x=spikes, dt=0.006), lumped_mass(bearing(), 1e5)
    chosen, fine = run(model, moves), run(model, moves, dt=1.2e-4, record_every=25)
    assert chosen.attrs["dt"] == pytest.approx(0.003)
    assert peak(chosen) == pytest.approx(peak(fine), rel=5e-3)


def test_vertical_ringing_on_a_stiff_substructure_costs_little(run):
    frame = Frame("on a stiff spring")
    for name, z, mass in (("ground", -1.0, 0.0), ("head", 0.0, 3e3), ("base", 0.1, 1e5)):
        frame.add_node(name, 0.0, 0.0, z)
        frame.fix(name, *(["all"] if mass == 0.0 else ["rx", "ry", "rz"]))
        if mass > 0.0:
            frame.add_mass(name, mass)
    frame.add_spring("spring", "ground", "head", [1e10, 1e10, 1e10, 0.0, 0.0, 0.0])
    frame.add_bearing("bearing", "head", "base", bearing())
    chosen, fixed, fine = (run(frame, motion(4, 0.9), dt=dt) for dt in (None, 0.005, 5e-4))
    assert chosen.attrs["steps"] < 2.0 * fixed.attrs["steps"]
    assert abs(peak(chosen) - peak(fine)) < 0.3 * abs(peak(fixed) - peak(fine))


def test_stiff_modes_of_the_structure_cost_little(run):
    model = shear_building(bearing(), [4e4, 3e4], [9e8, 8e8], base_mass=3e4)
    chosen, fixed = (run(model, motion(4, 0.9), dt=dt) for dt in (None, 0.005))
    assert chosen.attrs["steps"] < 1.8 * fixed.attrs["steps"]


def test_landing_on_a_ringing_structure(run):
    """Thrown up, the structure rings: where it lands depends on that, though no force acts."""
    t = np.arange(0.0, 2.0, 0.005)
    up = GroundMotion(x=1.5 * np.sin(5.0 * t), z=14.0 * np.sin(20.0 * t) * (t < 0.5), dt=0.005)
    model = shear_building(bearing(capacity=math.inf), [4e4, 3e4], [5e7, 4e7], base_mass=3e4)
    fine, chosen = run(model, up, dt=1e-4, record_every=50), run(model, up)
    assert float(fine["axial_force"].min()) == 0.0
    assert peak(chosen) == pytest.approx(peak(fine), rel=0.03)


def test_halvings_at_a_limit_count():
    """A smooth push over the rim: halved for nothing but the limit."""
    device = bearing(interface_friction=math.inf, rim_overrun=1e-3, capacity=0.1)
    shove = GroundMotion(x=np.full(400, 1.5), dt=0.005)
    with pytest.warns(AnalysisWarning, match="overran"):
        data = time_history(lumped_mass(device, 1e5), shove, dt=0.005)
    assert data.attrs["status"] == "rim_overrun"
    assert data.attrs["halvings"] >= 4
