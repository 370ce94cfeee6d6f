"""Floors' masses moved in plan: their centre, their weight, statics and periods by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    gravity,
    lumped_mass,
    modes,
    moment_frame,
    shear_building,
    time_histories,
)
from frames.assembly.assemble import assemble
from frames.library.moved_masses import with_moved_masses
from tests.scenes import wide_bearing

BEARING = wide_bearing()


def stick(**options: object) -> Frame:
    given: dict[str, object] = {"storey_mass": 9e4, "storey_stiffness": 4e8, "storeys": 2}
    return shear_building(BEARING, plan=((2, 1), (6.0, 8.0)), **(given | options))  # type: ignore[arg-type]


def steel() -> Frame:
    return moment_frame((2, 1), 2, bearing=BEARING, bay_width=(6.0, 8.0), floor_load=800.0)


def resultants(frame: Frame) -> tuple[float, float, float]:
    """Return mass, and moments about z of the inertia under unit accelerations along x and y."""
    system = assemble(frame)
    x, y, _ = system.coordinates.T
    turn = np.zeros((len(x), 6))
    turn[:, 0], turn[:, 1], turn[:, 5] = -y, x, 1.0
    above = np.diff(system.transform.indptr) > 0
    q = np.linalg.lstsq(system.transform.toarray()[above], turn.ravel()[above], rcond=None)[0]
    along = np.tile(np.eye(6)[:, 0], len(x))
    p = np.linalg.lstsq(system.transform.toarray()[above], along[above], rcond=None)[0]
    mass = float(p @ system.inertia_load[:, 0])
    return mass, float(q @ system.inertia_load[:, 0]), float(q @ system.inertia_load[:, 1])


@pytest.mark.parametrize("made", [stick, steel])
@pytest.mark.parametrize("shares", [(0.05, 0.0), (0.0, -0.05), (0.05, 0.02)])
def test_the_centre_of_mass_moves_and_the_weight_stays(made, shares) -> None:
    frame = made()
    moved = with_moved_masses(frame, shares)
    mass, about_x, about_y = resultants(frame)
    own, moved_x, moved_y = resultants(moved)
    assert_allclose(own, mass, rtol=1e-12)
    sides = (12.0, 8.0)
    assert_allclose(moved_y - about_y, mass * shares[0] * sides[0], rtol=1e-9, atol=1e-3)
    assert_allclose(moved_x - about_x, -mass * shares[1] * sides[1], rtol=1e-9, atol=1e-3)
    assert_allclose(gravity(moved).axial_forces, gravity(frame).axial_forces, rtol=1e-9)


def test_masses_that_stand_beside_the_floor_move_from_there() -> None:
    frame = stick(eccentricity=(0.1, 0.0))
    mass, _, about = resultants(frame)
    assert_allclose(about, 0.1 * 12.0 * mass, rtol=1e-9)
    assert_allclose(
        resultants(with_moved_masses(frame, (-0.05, 0.0)))[2], 0.05 * 12.0 * mass, rtol=1e-9
    )


def test_periods_are_those_of_a_rigid_floor_with_an_eccentric_mass() -> None:
    # Rigid storeys: one body on springs N / L, turning stiffness sum(k r^2); along y and about z
    # det [[k - w m, -w m c], [-w m c, k_t - w (J + m c^2)]] = 0.
    frame = stick(storey_stiffness=4e12)
    mass = 3.0 * 9e4
    k = mass * 9.80665 / BEARING.effective_radius
    points = [(6.0 * i, 8.0 * j) for i in (-1, 0, 1) for j in (-0.5, 0.5)]
    turning = k / 6.0 * sum(x**2 + y**2 for x, y in points)
    inertia, c = mass * (12.0**2 + 8.0**2) / 12.0, 0.05 * 12.0
    a = mass * (inertia + mass * c**2) - (mass * c) ** 2
    b = -(k * (inertia + mass * c**2) + turning * mass)
    roots = np.roots([a, b, k * turning])
    expected = sorted([*(2.0 * math.pi / np.sqrt(roots)), 2.0 * math.pi * math.sqrt(mass / k)])
    found = modes(with_moved_masses(frame, (0.05, 0.0)), 3).periods
    assert_allclose(sorted(found), expected, rtol=2e-4)


def test_a_symmetric_building_moved_each_way_answers_in_its_mirror() -> None:
    frame = stick()
    pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 81))
    motions = {
        axis: GroundMotion(**{axis: 2.2 * pulse}, dt=0.015, name=axis)  # type: ignore[arg-type]
        for axis in "xy"
    }
    models = {"": frame}
    for way, share in (("+", 0.05), ("-", -0.05)):
        models[f"{way}x"] = with_moved_masses(frame, (share, 0.0))
        models[f"{way}y"] = with_moved_masses(frame, (0.0, share))
    across = [(name, "y", 1.0) for name in ("", "+x", "-x")]
    cases = [*across, *((name, "x", 1.0) for name in ("", "+y", "-y"))]
    runs = time_histories(models, motions, cases=cases, workers=1)
    found = runs["peak_displacement"].to_numpy().reshape(-1, 3, 2)
    for centred, plus, minus, flip in ((0, 1, 2, 0), (3, 4, 5, 1)):
        assert_allclose(found[plus], np.flip(found[minus], axis=flip), rtol=1e-6)
        assert_allclose(found[centred], np.flip(found[centred], axis=flip), rtol=1e-6)
        assert found[plus].max() > 1.02 * found[centred].max()
        low, high = np.split(found[plus], [1], axis=flip)
        assert high.max() > low.max()  # the side to which the masses went moves most


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(ModelError, match=r'floor ".*" has no extent along x'):
        with_moved_masses(lumped_mass(BEARING, mass=2e5), (0.05, 0.0))
    with pytest.raises(ModelError, match=r"shares along y = 0.5 .*5 % of the side"):
        with_moved_masses(stick(), (0.0, 0.5))
    moved = with_moved_masses(stick(), (0.05, 0.0))
    with pytest.raises(ModelError, match="moved already"):
        with_moved_masses(moved, (0.05, 0.0))
    held = stick()
    held.fix("floor-1", "rz")
    with pytest.raises(ModelError, match=r'floor "floor-1" cannot rotate about the vertical'):
        with_moved_masses(held, (0.05, 0.0))
