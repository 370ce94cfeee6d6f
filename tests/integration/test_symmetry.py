"""Symmetries of space, and free fall: what must hold whatever the numbers."""

import math

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    GroundMotion,
    ModalDamping,
    Recording,
    drift_by_line,
    lumped_mass,
    moment_frame,
    peaks,
    storey_drift,
)
from tests.irregular import Building
from tests.scenes import uneven_bearing

DT = 0.004
N = 1  # bays a side
G = 9.80665


DEVICE = uneven_bearing()


def ground(pulse) -> np.ndarray:
    x, y = pulse(1.9, 1.2, DT), np.roll(pulse(1.3, 1.2, DT), 80)
    return np.column_stack([x, y, 0.3 * np.roll(x, 40)])


def turned(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def record(run, model, waves: np.ndarray):
    return run(model, GroundMotion(*waves.T, dt=DT), dt=DT)


def building():
    frame = moment_frame(bays=(N, N), storeys=2, bearing=DEVICE, bay_width=5.0)
    frame.set_damping(ModalDamping(0.03))
    return frame


def test_symmetric_building_does_not_twist(run, pulse):
    waves = ground(pulse)
    waves[:, 1] = 0.0
    data = record(run, building(), waves)
    size = float(np.abs(data["node_displacement"].sel(dof="ux")).max())
    assert float(data["rim_force"].max()) > 0.0
    # Newton's tolerance
    assert float(np.abs(data["node_displacement"].sel(dof="rz")).max()) < 1e-6 * size
    assert float(np.abs(data["bearing_displacement"].sel(axis="y")).max()) < 1e-5 * size
    force = data["axial_force"]
    pair = force.sel(bearing="bearing-0-0") - force.sel(bearing="bearing-0-1")
    assert float(np.abs(pair).max()) < 1e-5 * float(force.max())


@pytest.mark.parametrize("strong_x", [0.0, 2.0])
def test_strong_vertical_motion_lifts_and_lands(run, pulse, strong_x):
    dt, mass = 0.001, 1e5
    waves = np.column_stack(
        [pulse(strong_x, 1.0, dt), np.zeros(3001), pulse(1.5 * G, 0.5, dt, cycles=4.0)]
    )
    data = run(lumped_mass(DEVICE, mass), GroundMotion(*waves.T, dt=dt), dt=dt)
    axial = data["axial_force"][:, 0].to_numpy()
    weight = mass * G
    assert axial.min() == 0.0
    assert axial.max() > 2.0 * weight
    assert_allclose(axial[-200:], weight, rtol=2e-2)  # at rest, but for the last vibration
    lifted = axial == 0.0
    assert 0.05 < lifted.mean() < 0.8
    total = data["node_acceleration"].sel(node="mass").to_numpy()
    assert_allclose(total[lifted, 2], -G, rtol=0.0, atol=1e-5 * G)  # Newton's tolerance
    assert_allclose(total[lifted, :2], 0.0, rtol=0.0, atol=1e-5 * G)
    assert float(np.abs(data["bearing_force"].to_numpy()[lifted]).max()) == 0.0
    # relative to the ground: -g - a_g, in steps all of which are in the air
    flying = lifted[:-2] & lifted[1:-1] & lifted[2:]
    u = data["node_displacement"].sel(node="mass", dof="uz").to_numpy()
    fall = (u[2:] - 2.0 * u[1:-1] + u[:-2]) / dt**2
    a_g = data["ground_acceleration"].sel(axis="z").to_numpy()
    mean = 0.25 * (a_g[2:] + 2.0 * a_g[1:-1] + a_g[:-2])  # average acceleration
    assert flying.sum() > 100
    assert_allclose(fall[flying], (-G - mean)[flying], rtol=0.0, atol=1e-3 * G)
    gap = u[lifted]
    assert gap.max() > 0.01


SEEDS = (2, 3)  # rigid floors with two setbacks; floors of beams alone that end at three columns
TORSION = "torsion: maximum at any column line over mean drift"
LINES = "storey drift, maximum at any column line"


@pytest.fixture(scope="module")
def irregular(run, pulse):
    """Runs of buildings with setbacks, by seed."""
    return {seed: shaken(run, Building(seed), ground(pulse)) for seed in SEEDS}


def shaken(run, building: Building, waves: np.ndarray, **options) -> xr.Dataset:
    return run(building.frame(), GroundMotion(*waves.T, dt=DT), dt=DT, **options)


def moved_rigidly(data: xr.Dataset) -> xr.Dataset:
    """Return a result whose model goes aside, up, and turns in plan."""
    place = data["node_position"].transpose("node", "axis").to_numpy()
    moves = np.zeros(data["node_displacement"].shape)
    angle = np.linspace(0.0, 5e-3, data.sizes["time"])[:, None]
    moves[..., 0] = 0.3 - angle * place[:, 1]
    moves[..., 1] = -0.2 + angle * place[:, 0]
    moves[..., 2], moves[..., 5] = 0.05, angle
    return data.assign(node_displacement=data["node_displacement"].copy(data=moves))


def offset_stick(offset: float) -> xr.Dataset:
    """Return the variables of two floors, the upper node beside the lower one."""
    place = np.array([[1.0, 2.0, 0.0], [1.0 + offset, 2.0 - offset, 3.0]])
    return xr.Dataset(
        {
            "node_displacement": (("time", "node", "dof"), np.zeros((2, 2, 6))),
            "node_position": (("node", "axis"), place),
            "level_node": ("node", [0, 1]),
            "level_height": ("level", [0.0, 3.0]),
        },
        {
            "dof": ["ux", "uy", "uz", "rx", "ry", "rz"],
            "time": [0.0, 1.0],
            "node": ["a", "b"],
            "level": ["base", "floor"],
        },
    )


@pytest.mark.parametrize("kind", [*SEEDS, "stick"])
def test_rigid_motions_in_plan_are_no_drift(irregular, kind):
    data = moved_rigidly(offset_stick(0.7) if kind == "stick" else irregular[kind])
    for drift in (storey_drift(data), drift_by_line(data)):
        assert drift.size > 0
        assert float(np.abs(drift).max()) < 1e-15
    if kind != "stick":
        assert peaks(data).loc[TORSION, "value"] == 1.0


@pytest.mark.parametrize("seed", SEEDS)
def test_a_storey_drifts_by_the_mean_of_its_lines(run, pulse, irregular, seed):
    """Of histories, and of what compiled code took up at every step."""
    data = irregular[seed]
    lines, means = drift_by_line(data), storey_drift(data)
    u = data["node_displacement"].sel(dof=["ux", "uy"])
    storeys = {str(name): own for name, own in lines.groupby("storey")}
    tops = {level.name: level.nodes for level in Building(seed).frame().levels}
    assert [len(own["line"]) for own in storeys.values()] == [len(tops[name]) for name in storeys]
    assert len({len(nodes) for nodes in tops.values()}) > 2
    for name, own in storeys.items():
        below = [f"{int(str(node)[0]) - 1}{str(node)[1:]}" for node in own["line"].to_numpy()]
        up = u.sel(node=own["line"].to_numpy()).to_numpy()
        by_hand = (up - u.sel(node=below).to_numpy()).mean(axis=1) / 3.5
        assert_allclose(means.sel(storey=name), by_hand, rtol=0.0, atol=1e-15)
    worst = np.linalg.norm(lines, axis=-1).max(axis=0)
    mean = dict(zip(storeys, np.linalg.norm(means, axis=-1).max(axis=0), strict=True))
    for name in storeys:
        assert mean[name] <= worst[lines["storey"].to_numpy() == name].max()
    kept = shaken(run, Building(seed), ground(pulse), recording=Recording(every=50))
    rows = [LINES, TORSION, "storey drift, mean"]
    assert_allclose(peaks(kept).loc[rows, "value"], peaks(data).loc[rows, "value"], rtol=1e-9)
    assert list(peaks(kept).loc[rows, "where"]) == list(peaks(data).loc[rows, "where"])
    place = str(lines["storey"].to_numpy()[worst.argmax()])
    assert peaks(data).loc[LINES, "where"] in tops[place]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "change",
    [
        {"turn": 0.7},
        {"turn": math.pi, "shift": (120.0, -35.0)},
        {"mirror": True, "turn": -0.4},
        {"reordered": True},
    ],
    ids=["turned", "moved", "mirrored", "reordered"],
)
def test_an_irregular_building_answers_alike_wherever_it_stands(
    run, pulse, irregular, seed, change
):
    """Sizes in plan, forces and the places named do not change with axes, origin and order."""
    waves = ground(pulse)
    to = turned(change.get("turn", 0.0)) @ np.diag([-1.0 if "mirror" in change else 1.0, 1.0, 1.0])
    data, other = irregular[seed], shaken(run, Building(seed, **change), waves @ to.T)
    found, plain = peaks(other), peaks(data)
    rows = [
        name
        for name in plain.index
        if not name.startswith(("energy balance", "seconds", "residual", "torsion", "duration"))
    ]
    assert len(rows) > 15
    assert_allclose(found.loc[rows, "value"], plain.loc[rows, "value"], rtol=1e-4, atol=1e-7)
    assert list(found.loc[["storey drift, mean", LINES], "where"]) == list(
        plain.loc[["storey drift, mean", LINES], "where"]
    )
