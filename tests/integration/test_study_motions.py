"""The study of motions: what is run and counted is as stated."""

import math
import warnings

import numpy as np
import pandas as pd
import pytest

from frames import GroundMotion, time_histories
from frames.risk import Intensity
from lir_element.errors import AnalysisWarning
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_runs import BUILDINGS, building
from validation.study.motions import first_over, of_seconds
from validation.study.motions_runs import (
    PULSES,
    SECONDS,
    After,
    Pulse,
    followed,
    isolated_period,
    pulses,
    turned,
    velocities,
    vertical_over_horizontal,
    without_vertical,
)
from validation.study.paired import on_devices
from validation.study.records_runs import INTENSITY


def motion(dt, count, seed, name):
    values = np.random.default_rng(seed).normal(size=(2, count))
    return GroundMotion(x=values[0], y=values[1], dt=dt, name=name)


@pytest.mark.parametrize("after", SECONDS, ids=lambda after: after.name)
def test_a_second_shock_comes_behind_the_first(after):
    both = {"a": motion(0.02, 40, 1, "a"), "b": motion(0.01, 60, 2, "b")}
    for name, found in followed(both, after).items():
        first, second = both[name], both["ab".replace(name, "") if after.other else name]
        dt = min(first.dt, second.dt)
        fine = [each if each.dt == dt else each.resampled(dt) for each in (first, second)]
        assert found.dt == dt
        assert found.n_steps == sum(each.n_steps for each in fine)
        start = fine[0].n_steps
        for axis in ("x", "y"):
            got = getattr(found, axis)
            np.testing.assert_allclose(got[:start], getattr(fine[0], axis))
            np.testing.assert_allclose(got[start:], after.share * getattr(fine[1], axis))


def test_a_building_does_not_know_a_quarter_turn():
    """Why angles of 90, 120 and 150 degrees are not run: peaks are those of 0, 30 and 60."""
    pulse = Pulse(0.65, "antisymmetric").motion()
    pair = GroundMotion(x=pulse.x, y=0.4 * np.roll(pulse.x, 40), dt=pulse.dt, name="pair")
    frame = on_devices(building(BUILDINGS[0]))[LIR]
    motions = {str(angle): turned({"": pair}, angle)[""] for angle in (20, 110)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        data = time_histories(frame, motions, dt=0.01)
    assert data["status"].to_numpy().tolist() == ["ok", "ok"]
    for quantity in ("bearing displacement", "interface slip", "storey drift, mean"):
        one, other = data["peak"].sel(quantity=quantity).to_numpy()
        assert one > 0.0
        assert other == pytest.approx(one, rel=1e-6), quantity
    assert INTENSITY.of(motions["20"]) == pytest.approx(INTENSITY.of(pair), rel=1e-3)


def test_pulses_are_of_their_period_and_intensity():
    along = Intensity(kind="Sa", period=3.0, measure="x")
    assert isolated_period() == pytest.approx(2.0 * math.pi * math.sqrt(2.25 / 9.80665))
    for name, scaled in pulses().items():
        assert along.of(scaled) == pytest.approx(1.0)
        velocity = np.abs(np.cumsum(scaled.x) * scaled.dt).max()
        each = next(pulse for pulse in PULSES if pulse.name == name)
        assert scaled.duration == pytest.approx(
            2.0 * each.ratio * isolated_period() + 6.0, abs=0.03
        )
        amplitude = velocities()[name]
        if each.kind == "symmetric":  # its velocity is largest in the middle of the envelope
            assert velocity == pytest.approx(amplitude, rel=0.01)
        else:
            assert 0.6 * amplitude < velocity < amplitude


def test_the_vertical_component_alone_is_taken_off():
    x = np.sin(np.linspace(0.0, 9.0, 90))
    whole = GroundMotion(x=x, y=4.0 * x, z=3.0 * x, dt=0.01, name="a")
    assert vertical_over_horizontal(whole) == pytest.approx(1.5)
    flat = without_vertical({"a": whole})["a"]
    np.testing.assert_array_equal(flat.x, whole.x)
    assert np.abs(flat.z).max() == 0.0


def test_where_collapse_begins():
    im = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    over = np.array([0.0, np.nan, 1.0, 0.0, 1.0])
    found = first_over(im, over, ["ok", "?", "slip_exceeded", "ok", "ok"])
    assert found == {"low": 1.0, "high": 3.0, "status": "slip_exceeded", "again": 1}
    assert first_over(im, np.zeros(5), ["ok"] * 5)["high"] is None


def runs_of(rows):
    columns = ("motion", "scale", "outcome", "ductility", "slip")
    table = pd.DataFrame(rows, columns=columns)
    table["residual interface slip"] = table["slip"]
    table["residual bearing displacement"] = 2.0 * table["slip"]
    return table


def test_only_survivors_of_the_first_shock_count():
    """Of a (fails at once), b (collapses in the second), c (holds), d (analysis of both failed)."""
    ok, fails, unknown = "complete", "bearing failure", "numerical failure"
    alone = runs_of(
        [("a", 2.0, fails, 1.0, 0.0), ("b", 2.0, ok, 3.0, 0.01), ("c", 2.0, ok, 1.0, 0.02),
         ("d", 2.0, ok, 1.0, 0.03)]
    )  # fmt: skip
    both = runs_of(
        [("a", 2.0, fails, 1.0, 0.0), ("b", 2.0, ok, 9.5, 0.05), ("c", 2.0, ok, 2.0, 0.06),
         ("d", 2.0, unknown, 1.0, 0.0)]
    )  # fmt: skip
    (row,) = of_seconds({LIR: alone}, {"next": {LIR: both}}, {"next": After(True, 1.0)})["next"][
        LIR
    ]
    assert (row["motions"], row["survived"], row["known"], row["collapsed"]) == (4, 3, 2, 1)
    assert row["bearing"] == 0
    assert row["intact"] == [0, 2]  # of b and c the next records, c and d, are survived alone
    assert row["residual interface slip"] == pytest.approx([0.015, 0.055])
    assert row["residual bearing displacement"] == pytest.approx([0.03, 0.11])
