"""Axial forces of a stick's bearings against those of a frame of the same storeys, bay by bay."""

import numpy as np
import pytest

from frames import Frame, GroundMotion, gravity, moment_frame, shear_building, time_history
from frames.design import Superstructure
from tests.scenes import large_bearing

BEARING = large_bearing()
HEIGHT, WIDTH = 3.5, 6.0


def waves(seed: int = 3) -> GroundMotion:
    """Return twelve seconds of many frequencies, which take the bearings to some 0.2 m."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, 12.0, 0.01)
    both = []
    for size in (2.0, 1.6):
        wave = np.zeros_like(time)
        for frequency in np.linspace(0.2, 4.0, 60):
            phase = rng.uniform(0.0, 2.0 * np.pi)
            wave += np.sin(2.0 * np.pi * frequency * time + phase) / np.hypot(1.0, frequency / 0.8)
        wave *= np.exp(-(((time - 6.0) / 3.5) ** 2))
        both.append(size * wave / np.abs(wave).max())
    return GroundMotion(x=both[0], y=both[1], dt=0.01, name="waves")


def alike(frame: Frame, **options: object) -> Frame:
    """Return the stick of a moment frame: its masses, and storeys that give its first period."""
    above = Superstructure.from_frame(frame, R=8.0)
    state = gravity(frame)
    floors = np.array(above.storey_weights) / frame.gravity
    base = state.axial_forces.sum() / frame.gravity - floors.sum()
    n = len(floors)
    chain = 2.0 * np.sin(np.pi / (4 * n + 2))
    stiffness = floors.mean() * (2.0 * np.pi / above.fixed_base_period / chain) ** 2
    return shear_building(
        BEARING,
        floors,
        stiffness,
        storey_height=HEIGHT,
        base_mass=float(base),
        plan=((2, 2), WIDTH),
        **options,  # type: ignore[arg-type]
    )


def swings(frame: Frame) -> tuple[np.ndarray, float]:
    """Return axial forces less those at rest at even times (n, n_bearings), and the twist [rad]."""
    data = time_history(frame, waves())
    assert data.attrs["status"] == "ok"
    even = np.arange(0.0, 12.0, 0.005)
    time, forces = data["time"].to_numpy(), data["axial_force"].to_numpy()
    columns = [np.interp(even, time, column) for column in forces.T]
    turned = np.abs(data["node_displacement"].sel(dof="rz")).max()
    return np.array(columns).T - gravity(frame).axial_forces, float(turned)


@pytest.mark.parametrize("share", [(0.0, 0.0), (0.05, 0.05)])
def test_axial_forces_swing_as_those_of_a_frame(share: tuple[float, float]) -> None:
    frame = moment_frame(
        (2, 2), 3, bearing=BEARING, bay_width=WIDTH, storey_height=HEIGHT, eccentricity=share
    )
    of_frame, frame_twist = swings(frame)
    of_stick, stick_twist = swings(alike(frame, eccentricity=share))
    # higher modes differ: a stick deforms by shear alone; beams of the frame pass on plate moments
    for place in range(9):
        if place == 4:  # the middle, where overturning changes nothing
            continue
        one, other = of_frame[:, place], of_stick[:, place]
        assert np.abs(other).max() == pytest.approx(np.abs(one).max(), rel=0.25)
        assert np.corrcoef(one, other)[0, 1] > 0.9
    least = np.abs(of_frame[:, [0, 2, 6, 8]]).max(axis=0).min()
    assert np.abs(of_stick[:, 4]).max() < 0.25 * least
    assert stick_twist < 2e-3
    assert frame_twist < 2e-3
