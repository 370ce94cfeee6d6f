"""The step under hinges that turn: towards a fine run, and beside OpenSees at the same step."""

import math

import numpy as np
import pytest

from frames import GroundMotion, moment_frame, time_history
from frames.kernels.missed_impulse import missed_mean
from frames.laws import Bilinear, PlasticHinge, Tie
from lir_element.kernels.slip import return_map
from tests.scenes import heavy_bearing

HINGES = {
    "beam": PlasticHinge(moment_y=1.3e5, hardening=0.02),
    "column": PlasticHinge(moment_y=2e5, moment_z=2e5, axial=9e6, axial_exponent=1.5),
}


def hinged_frame():
    """Return a frame of two storeys with hinges, on bearings without rims."""
    on = heavy_bearing(capacity=math.inf, friction=0.1)
    return moment_frame((1, 1), 2, bearing=on, hinges=HINGES, floor_load=3000.0)


def histories(dt):
    """Return bearing displacements and plastic rotations of a damped frame every 10 ms."""
    frame = hinged_frame()
    t = np.arange(0.0, 3.0, 0.01)
    shape = 2.2 * np.exp(-(((t - 2.2) / 1.5) ** 2))
    motion = GroundMotion(
        x=shape * np.sin(np.pi * t), y=0.7 * shape * np.sin(1.6 * np.pi * t), dt=0.01
    )
    data = time_history(frame, motion, dt=dt, record_every=round(0.01 / dt))
    assert data.attrs["status"] == "ok"
    return data["bearing_displacement"].to_numpy()[..., :2], data["hinge_rotation"].to_numpy()


def test_hinges_turn_as_in_a_fine_run():
    """At a step that follows the modes: the forces of hinges are those of the end of the step."""
    fine = histories(6.25e-4)
    assert np.abs(fine[1]).max() > 3e-3
    found = histories(5e-3)
    off = [
        np.abs(one - true).max() / np.abs(true).max() for one, true in zip(found, fine, strict=True)
    ]
    assert off[0] < 1e-3
    assert off[1] < 0.01


def test_a_tiny_step_finds_its_equilibrium():
    """Deformations of 0.3 m are known to 1e-16 m: over 20 us that is all that ties can lack.

    Their own flexibility at such a step is 1e-13 m/N, so round-off looks like a lack of 1 mN.
    """
    frame = hinged_frame()
    ends = frame.levels[0].nodes[0], frame.levels[1].nodes[-1]
    for way in (1.0, -1.0):
        law = Tie(stiffness=2e7, yield_force=5e4, hardening=0.01)
        frame.add_link(f"tie {way}", *ends, law, (way, 0.0, 0.3))
    t = np.arange(0.0, 0.4, 0.005)
    push = np.where(t < 0.25, -9.0, 6.0 * np.sin(60.0 * t))
    motion = GroundMotion(x=push, dt=0.005)
    usual, tiny = (
        time_history(frame, motion, dt=dt, duration=0.32, record_every=round(1e-3 / dt))
        for dt in (1e-3, 2e-5)
    )
    assert tiny.attrs["status"] == "ok"
    assert tiny.attrs["halvings"] == 0
    for name in ("bearing_displacement", "hinge_rotation"):
        most = float(abs(usual[name]).max())
        assert float(abs(tiny[name] - usual[name]).max()) < 2e-3 * most, name


def test_a_step_errs_no_more_than_in_opensees():
    """The same undamped frame, bearing and scheme: the errors of a step have the same size."""
    pytest.importorskip("openseespy")
    from validation.claims.opensees_yielding_runs import bearing, hinged, pulse, run_both

    frame, motion = hinged(bearing(math.inf, 0.1)), pulse(1.0)
    coarse, fine = (run_both(frame, motion, dt, 3.0) for dt in (0.01, 0.0025))
    for name in ("moves", "deformation"):
        here, there = (
            np.abs(one - true[::4]).max() / np.abs(true).max()
            for one, true in zip(getattr(coarse, name), getattr(fine, name), strict=True)
        )
        assert there > 1e-3
        assert 0.5 * there < here < 1.3 * there, name


@pytest.mark.parametrize(
    ("before", "way", "bend"), [(-1.0, 2.3, 0.4), (0.2, 1.5, -0.7), (0.9, 0.5, 0.0)]
)
def test_friction_that_slips_within_a_step_has_the_mean_of_its_path(before, way, bend):
    """Against the return map along the path, in 20,000 parts."""
    t = np.linspace(0.0, 1.0, 20_001)
    path = way * (t + bend * (t**2 - t))
    z = np.array([return_map(0, 1.0, before, 0.0, d, 0.0, 1.0)[0] for d in path])
    missed = np.trapezoid(z, t) - 0.5 * (z[0] + z[-1])
    found, across = missed_mean(before, 0.0, z[-1], 0.0, way, 0.0, bend * way, 0.0)
    assert across == 0.0
    assert found == pytest.approx(missed, abs=1e-7)


def test_corrected_steps_err_less():
    """Of an undamped frame whose bearings turn round and whose hinges turn: of second order."""
    pytest.importorskip("openseespy")
    from validation.claims.opensees_yielding_runs import bearing, hinged, pulse

    frame, motion = hinged(bearing(math.inf, 0.1)), pulse(1.0)

    def run(dt, integrator="corrected-newmark"):
        data = time_history(
            frame, motion, 3.0, dt, integrator=integrator, record_every=round(0.01 / dt)
        )
        assert data.attrs["status"] == "ok"
        return data["bearing_displacement"].to_numpy()[..., :2], data["hinge_rotation"].to_numpy()

    fine = run(6.25e-4)
    plain, coarse, half = (
        [np.abs(a - b).max() / np.abs(b).max() for a, b in zip(found, fine, strict=True)]
        for found in (run(0.01, "newmark"), run(0.01), run(0.005))
    )
    assert coarse[0] < 0.7 * plain[0]  # friction, and the phase of what rings
    assert coarse[1] < 0.3 * plain[1]
    assert half[0] < 0.3 * coarse[0]
    assert half[0] < 3e-4


@pytest.mark.parametrize(
    ("scene", "scale", "dt"),
    [
        ("rings on bearings that stick", 0.15, 0.02),  # 0.16 % with what springs lend left out
        ("rims turn the sliding round", 0.6, 0.01),  # 0.19 % without the work of friction
        ("slides and rocks", 1.0, 0.01),  # 0.12 % without friction by axial force
    ],
)
def test_corrected_impulses_are_in_the_energy_balance(scene, scale, dt):
    pytest.importorskip("openseespy")
    from validation.claims.opensees_yielding_runs import bearing, hinged, pulse, stick

    if scene == "slides and rocks":
        frame = hinged(bearing(math.inf, 0.1))
    else:
        frame = stick(3, lambda k: Bilinear(stiffness=k, yield_force=6e5, hardening=0.05))
    data = time_history(frame, pulse(scale), 3.0, dt, integrator="corrected-newmark")
    assert data.attrs["status"] == "ok"
    assert data.attrs["numerical_share"] < 5e-4


def test_steps_of_a_structure_without_links_or_hinges_are_not_corrected():
    frame = moment_frame((1, 1), 2, bearing=heavy_bearing(capacity=math.inf, friction=0.1))
    motion = GroundMotion(x=np.array([0.0, 1.0, 0.0]), dt=0.01)
    with pytest.raises(ValueError, match='use integrator="newmark" with a smaller dt'):
        time_history(frame, motion, dt=0.01, integrator="corrected-newmark")
    assert time_history(frame, motion, dt=0.005, integrator="newmark").attrs["status"] == "ok"
