"""The claims of `validation/` hold; what they need recorded motions for, with the records only."""

import math
from importlib.util import find_spec

import matplotlib.pyplot as plt
import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames.results.bearing_geometry import slider_axis
from validation.articulated import Articulated
from validation.body_motion import body_motion
from validation.claims import (
    bouc_wen_drift,
    double_pendulum,
    newhall,
    opensees_superstructure,
    opensees_yielding,
    shake_table,
    static_test,
)
from validation.page import records, run, write
from validation.scenes import LEVELS_HISTORY, LEVELS_STATIC, example_bearing


def assert_all_hold(checks):
    assert checks
    assert not [check for check in checks if not check.holds]


@pytest.fixture(scope="module")
def static():
    return static_test.page()


def test_static_test(static):
    assert_all_hold(static.checks)
    assert len(static.checks) >= 8 * len(LEVELS_STATIC)


def test_double_pendulum():
    cases = double_pendulum.CASES
    assert_all_hold(double_pendulum.checks({c.name: double_pendulum.loops(c) for c in cases}))


@pytest.mark.nightly  # by day test_from_opensees.py has a building wholly in OpenSees
@pytest.mark.skipif(find_spec("openseespy") is None, reason="openseespy is not installed")
def test_opensees_superstructure(monkeypatch):
    """Twice the finest step and a part of the motion."""
    for name, value in {"FINE": 0.002, "DURATION": 4.0}.items():
        monkeypatch.setattr(opensees_superstructure, name, value)
    page = opensees_superstructure.page(None)
    assert_all_hold(page.checks)
    plt.close(page.figures["histories"])


@pytest.mark.nightly  # by day test_yielding_step.py steps beside OpenSees
@pytest.mark.skipif(find_spec("openseespy") is None, reason="openseespy is not installed")
def test_opensees_yielding(monkeypatch):
    """Twice the steps, and no more than 4 s: the page has all of it."""
    short = [
        one._replace(dt=2.0 * one.dt, duration=min(one.duration, 4.0))
        for one in opensees_yielding.CASES
    ]
    monkeypatch.setattr(opensees_yielding, "CASES", tuple(short))
    page = opensees_yielding.page(None)
    assert_all_hold(page.checks)
    for drawn in page.figures.values():
        plt.close(drawn)


def test_shake_table():
    found, without, impact = shake_table.search()
    plain = shake_table.respond(shake_table.bearing().as_dcfp(), without)
    assert_all_hold(shake_table.checks(found[without], plain, found[impact]))


def test_drift_of_bouc_wen_under_a_made_input():
    assert_all_hold(bouc_wen_drift.held_checks(bouc_wen_drift.held_runs()))


@pytest.fixture(scope="module")
def example(records):
    return newhall.histories(newhall.motion(records))


@pytest.mark.records
@pytest.mark.parametrize("level", LEVELS_HISTORY)
def test_numerical_example(example, level):
    assert_all_hold(newhall.checks(example[level], level))


@pytest.mark.records
def test_rise_of_the_force_at_the_impact(example, records):
    checks, _, _ = newhall.comparison(next(iter(example.values())), newhall.motion(records))
    assert_all_hold(checks)


@pytest.mark.records
def test_motion_of_the_bodies(example):
    """The sliders turn from the vertical to the recorded axis, and keep their distances."""
    data, bearing = example["pendulum"], example_bearing()
    motion = body_motion(data, bearing, "bearing")
    turn = motion["rotation"].sel(body="top_slider").to_numpy()
    angle = np.linalg.norm(turn, axis=1)
    axis = slider_axis(data, bearing, "bearing")
    assert_allclose(np.cos(angle), axis[:, 2], atol=1e-6)
    assert_allclose(np.sin(angle), np.linalg.norm(axis[:, :2], axis=1), atol=1e-6)
    assert_allclose(turn[:, 1], axis[:, 0], rtol=0.003, atol=1e-9)
    at_rest = np.array([0.0, 0.0, 0.5 * bearing.slider_height])
    between = motion["position"].sel(body="top_slider") - motion["position"].sel(
        body="bottom_slider"
    )
    size = np.linalg.norm(between.to_numpy() + at_rest, axis=1)
    slip = data["interface_slip_size"][:, 0].to_numpy()
    assert_allclose(size, np.hypot(slip, 0.5 * bearing.slider_height), atol=1e-5)


def test_articulated_slider_in_its_regimes():
    """One surface, both, the other alone after a rim: forces and stiffnesses by hand."""
    model = Articulated((1.0, 0.5), (0.02, 0.08), (0.1, math.inf))
    path = np.array([0.0, 0.03, 0.06, 0.09, 0.12, 0.20, 0.199, 0.17])
    out = [0.0, 0.02 + 0.03, 0.08, 0.08 + 0.03 / 1.5, 0.08 + 0.06 / 1.5, 0.08 + 0.10 / 0.5]
    # back: surface 2 alone by 1 mm, then both
    back = [0.099 / 0.5 - 0.08, (0.17 - 0.02 - 0.08 * 0.5) / 1.5]
    assert_allclose(model.force(path), [*out, *back], atol=1e-9)
    assert model.second_starts == pytest.approx(0.06)
    assert model.at_zero == pytest.approx(0.04)


def test_a_page_is_written_and_indexed(static, tmp_path):
    write(static, tmp_path)
    text = (tmp_path / "static_test.md").read_text(encoding="utf-8")
    assert "| displacement at the first high-friction sliding (pendulum) | paper 2.2 |" in text
    assert (tmp_path / "figures" / "static_test-loops.png").stat().st_size > 10_000
    assert "(static_test.md)" in (tmp_path / "README.md").read_text(encoding="utf-8")


def test_without_its_record_a_claim_is_skipped_and_says_so(monkeypatch, capsys):
    monkeypatch.delenv("LIR_RECORDS", raising=False)
    assert records(newhall.CLAIM) is None
    assert run(newhall.CLAIM, newhall.page) is None
    assert newhall.CLAIM.record in capsys.readouterr().out
