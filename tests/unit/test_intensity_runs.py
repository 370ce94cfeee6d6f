"""Intensities, limit states and what runs say of them: by hand."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from frames import GroundMotion, MotionError, lumped_mass
from frames.demo import bearing_for
from frames.design import pair_spectrum
from frames.risk import (
    IDA,
    Campaign,
    CampaignError,
    FragilityError,
    HuntFill,
    Intensity,
    IntensityRuns,
    LimitState,
    cloud_analysis,
    fragility_of,
    ida,
    load_fragility,
    multiple_stripes,
    save_fragility,
)
from frames.risk.fragility.runs import outcome_of
from frames.risk.plots import fragility_curves, ida_curves, stripes
from lir_element import RunStatus
from lir_element.units import STANDARD_GRAVITY
from tests.refusals import refused

SCALE = Intensity(kind="scale")


def runs(rows: list[tuple[str, float, float | str]]) -> IntensityRuns:
    """Return runs by motion, intensity, and demand [m] or status."""
    statuses = [value if isinstance(value, str) else "ok" for *_, value in rows]
    table = pd.DataFrame(
        {
            "motion": [motion for motion, *_ in rows],
            "scale": [im for _, im, _ in rows],
            "im": [im for _, im, _ in rows],
            "outcome": [outcome_of(status) for status in statuses],
            "status": statuses,
            "message": "",
            "bearing displacement": [0.5 if isinstance(v, str) else v for *_, v in rows],
        }
    )
    return IntensityRuns(table, SCALE, {"bearing displacement": "m"})


TWO = runs(
    [
        *(("a", 1.0, 0.1), ("b", 1.0, 0.2), ("a", 2.0, 0.3), ("b", 2.0, "slip_exceeded")),
        *(("a", 4.0, "rim_overrun"), ("b", 4.0, "slip_exceeded"), ("a", 3.0, "newton_failed")),
    ]
)
TWO_IDA = IDA(TWO, LimitState.bearing_failure(), HuntFill(first=1.0))


def test_intensities_of_a_pair() -> None:
    time = 0.01 * np.arange(400)
    motion = GroundMotion(x=3.0 * np.sin(2.0 * np.pi * time), y=np.zeros(400), dt=0.01)
    assert Intensity(kind="PGA", measure="x").of(motion) == pytest.approx(3.0)
    # velocity of a sine from rest: A T / (2 pi) (1 - cos), at most A T / pi
    assert Intensity(kind="PGV", measure="x").of(motion) == pytest.approx(3.0 / np.pi, rel=1e-3)
    sa = Intensity(kind="Sa", period=0.8, damping=0.1, measure="RotD100")
    assert sa.of(motion) == pair_spectrum(motion, [0.8], 0.1, "RotD100")[0]
    for period in np.linspace(0.3, 3.0, 40):  # to the last bit: stores of campaigns rest on it
        each = Intensity(kind="Sa", period=float(period), measure="x")
        assert each.of(motion) == pair_spectrum(motion, [period], 0.05, "x")[0]
    assert sa.of(motion.scaled(2.5)) == pytest.approx(2.5 * sa.of(motion))
    assert (sa.unit, sa.label) == ("m/s2", "Sa(0.8 s, 10 %), RotD100")
    assert SCALE.of(motion) == 1.0


@pytest.mark.parametrize(
    ("kind", "unit", "power", "by_hand"),
    [  # of a = A sin(2 pi t / T), 0 <= t <= T, from rest: d(T) = A T^2 / (2 pi)
        ("PGD", "m", 1.0, 3.0 * 0.8**2 / (2.0 * math.pi)),
        ("CAV", "m/s", 1.0, 3.0 * 0.8 * 2.0 / math.pi),
        ("Arias", "m/s", 2.0, math.pi / (2.0 * STANDARD_GRAVITY) * 9.0 * 0.8 / 2.0),
    ],
)
def test_integrals_of_one_sine(kind: str, unit: str, power: float, by_hand: float) -> None:
    """Turned by 30 degrees: RotD100 is that of the sine, x its share by cosine, or its square."""
    sine = 3.0 * np.sin(2.0 * np.pi * np.linspace(0.0, 1.0, 801))
    angle = math.radians(30.0)
    pair = GroundMotion(x=math.cos(angle) * sine, y=math.sin(angle) * sine, dt=0.001)
    given: dict[str, Intensity] = {
        measure: Intensity(kind=kind, measure=measure)  # type: ignore[arg-type]
        for measure in ("RotD100", "RotD50", "x", "y", "geometric mean")
    }
    found = {measure: each.of(pair) for measure, each in given.items()}
    assert found["RotD100"] == pytest.approx(by_hand, rel=1e-5)
    assert found["x"] == pytest.approx(by_hand * math.cos(angle) ** power, rel=1e-5)
    assert found["geometric mean"] == pytest.approx(math.sqrt(found["x"] * found["y"]))
    assert found["RotD50"] == pytest.approx(by_hand * math.cos(math.pi / 4.0) ** power, rel=0.02)
    assert given["x"].of(pair.scaled(2.0)) == pytest.approx(2.0**power * found["x"])
    assert given["x"].unit == unit


class RootMeanSquare:
    """A measure of a user's own."""

    unit, label = "m/s2", "root mean square"

    def of(self, motion: GroundMotion) -> float:
        return float(np.sqrt(np.mean(np.square(motion.x))))


class Length:
    """One that no factor changes."""

    unit, label = "s", "duration"

    def of(self, motion: GroundMotion) -> float:
        return motion.dt * motion.n_steps


@pytest.mark.parametrize(
    "measure", [RootMeanSquare(), Intensity(kind="Arias", measure="x"), Length()]
)
def test_measures_of_ones_own_serve_where_an_intensity_does(measure, tmp_path):
    pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016, name="pulse")
    frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    cloud = cloud_analysis(frame, pulse, intensity=measure, scales=(0.5, 1.0))
    own = [measure.of(pulse.scaled(factor)) for factor in (0.5, 1.0)]
    assert cloud.table["im"].tolist() == pytest.approx(own, rel=1e-9)
    assert cloud.table["scale"].tolist() == [0.5, 1.0]
    save_fragility(cloud, tmp_path / "cloud.json")
    read = load_fragility(tmp_path / "cloud.json")
    assert len(read.joined(cloud).table) == 4
    if isinstance(measure, Length):
        with pytest.raises(FragilityError, match=r"no motion can be scaled to it\. Take cloud_ana"):
            multiple_stripes(frame, pulse, [1.0], intensity=measure)
        return
    runs = multiple_stripes(frame, pulse, own, intensity=measure)
    assert runs.table["scale"].tolist() == pytest.approx([0.5, 1.0])
    assert runs.table["base shear"].tolist() == pytest.approx(cloud.table["base shear"], rel=1e-6)
    campaign = Campaign(frame, pulse, store=tmp_path / "s", intensity=measure, intensities=own)
    again = IntensityRuns.from_dataset(campaign.run(workers=1), campaign.motions, measure)
    assert again.table["im"].tolist() == pytest.approx(own, rel=1e-9)
    assert again.table["base shear"].tolist() == pytest.approx(cloud.table["base shear"], rel=1e-6)
    found = ida(frame, pulse, intensity=measure, rules=HuntFill(first=own[0], runs=2))
    assert found.runs.table["im"][0] == pytest.approx(own[0], rel=1e-9)


@pytest.mark.parametrize("more", [{}, {"intensity": SCALE, "scales": 1.0}])
def test_intensities_of_a_campaign_have_their_measure(tmp_path: Path, more: Any) -> None:
    pulse, frame = GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1), lumped_mass(bearing_for(2e6), 1e5)
    with pytest.raises(CampaignError, match="go with their measure and without scales"):
        Campaign(frame, pulse, store=tmp_path / "s", intensities=[1.0], **more)


def test_the_average_of_a_spectrum_is_the_root_of_a_product() -> None:
    time = 0.01 * np.arange(400)
    x = np.sin(2.0 * np.pi * time)
    motion = GroundMotion(x=x, y=0.4 * x[::-1], dt=0.01)
    average = Intensity(kind="Sa_avg", periods=[0.5, 1.0, 2.0], damping=0.1)
    each = [Intensity(kind="Sa", period=t, damping=0.1).of(motion) for t in (0.5, 1.0, 2.0)]
    assert average.of(motion) == pytest.approx((each[0] * each[1] * each[2]) ** (1.0 / 3.0))
    assert average.of(motion.scaled(2.5)) == pytest.approx(2.5 * average.of(motion))
    assert average.unit == "m/s2"
    assert average.label == "Sa_avg(3 periods from 0.5 to 2 s, 10 %), RotD50"
    assert average.periods == (0.5, 1.0, 2.0)
    assert average == Intensity(kind="Sa_avg", periods=np.array([0.5, 1.0, 2.0]), damping=0.1)
    assert average != Intensity(kind="Sa_avg", periods=[0.5, 1.1, 2.0], damping=0.1)


@pytest.mark.parametrize(
    "periods", [(), [1.0], [2.0, 1.0], [0.0, 1.0], [1.0, math.nan], [[1.0, 2.0]], [1.0, 1.0]]
)
def test_periods_of_an_average_rise(periods: object) -> None:
    refused(FragilityError, "two or more that rise", Intensity, kind="Sa_avg", periods=periods)  # type: ignore[arg-type]


def test_intensities_that_make_no_sense_are_refused() -> None:
    silent = GroundMotion(x=[0.0, 1.0, 0.0], y=[0.0, 0.0, 0.0], dt=0.1)
    for words, given in (
        ("period", {"kind": "Sa"}),
        ("only kind", {"kind": "PGA", "period": 1.0}),
        ("only kind", {"kind": "Sa_avg", "periods": [1.0, 2.0], "period": 1.0}),
        ("leave them out", {"kind": "Sa", "period": 1.0, "periods": [1.0, 2.0]}),
        ("measure", {"kind": "PGA", "measure": "mean"}),
    ):
        refused(FragilityError, words, Intensity, **given)
    refused(FragilityError, "leave it out", Intensity(kind="PGA", measure="y").of, silent)
    one = GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1)
    refused(MotionError, "component", Intensity(kind="PGV").of, one)


@pytest.mark.parametrize("status", list(RunStatus))
def test_every_status_has_a_meaning(status: RunStatus) -> None:
    """Only what fails physically is collapse; what is doubtful went to its end."""
    failed = "bearing failure" if status.is_bearing_failure else "numerical failure"
    done = status in {RunStatus.OK, RunStatus.INACCURATE, RunStatus.BEARING_LOST}
    assert outcome_of(status.name.lower()) == ("complete" if done else failed)


def test_limit_states() -> None:
    bearing, state = bearing_for(1000e3), LimitState
    assert state.interface_slip(bearing).limit == bearing.slip_stability
    said = f"floor acceleration {3 / STANDARD_GRAVITY:.3g} g"
    assert state.floor_acceleration(3.0).name == said
    assert state.rim_contact().limit == 0.0
    refused(FragilityError, "is no limit", state.interface_slip, bearing.as_dcfp())
    refused(FragilityError, "or neither", state, "drift", "storey drift, mean")
    makers = state.drift, state.ductility, state.displacement, state.plastic_rotation
    for make in (*makers, state.residual_displacement):
        refused(FragilityError, "limit", make, -1.0)


def test_failures_exceed_all_and_numerical_ones_nothing() -> None:
    assert TWO.demand("bearing displacement")[:4].tolist() == [0.1, 0.2, 0.3, np.inf]
    over = TWO.exceeded(LimitState.displacement(0.25))
    np.testing.assert_array_equal(over, [0, 0, 1, 1, 1, 1, np.nan])
    over = TWO.exceeded(LimitState.bearing_failure())
    np.testing.assert_array_equal(over, [0, 0, 0, 1, 1, 1, np.nan])
    assert TWO.failed["status"].tolist() == ["newton_failed"]
    refused(FragilityError, "quantity", TWO.exceeded, LimitState.drift(0.01))


def test_capacities_by_hand() -> None:
    table = TWO_IDA.capacities()
    # a: holds at 2, fails at 4 (3 is not known); b: holds at 1, fails at 2
    assert table["capacity"].tolist() == pytest.approx([math.sqrt(8.0), math.sqrt(2.0)])
    assert table["failed"].tolist() == [1, 0]
    crossed = TWO_IDA.capacities(LimitState.displacement(0.15))
    assert crossed["capacity"].tolist() == pytest.approx([1.25, 0.75])  # on lines, from zero
    ends = TWO_IDA.capacities(LimitState.displacement(0.4))
    assert ends["capacity"].tolist() == pytest.approx([math.sqrt(8.0), math.sqrt(2.0)])


def test_capacities_that_are_not_reached_or_reached_twice() -> None:
    rows = [("a", 1.0, 0.1), ("a", 2.0, 0.2), ("b", 1.0, 0.3), ("b", 2.0, 0.1)]
    limit, rules = LimitState.displacement(0.25), HuntFill(first=1.0)
    found = IDA(runs([*rows, ("c", 2.0, "slip_exceeded")]), limit, rules).capacities()
    assert found["censored"].tolist() == [True, False, False]
    assert found["capacity"].tolist() == pytest.approx([2.0, 0.25 / 0.3, 1.0])
    assert found["resurrects"].tolist() == [False, True, False]
    lost = IDA(runs([("a", 1.0, "singular")]), LimitState.drift(0.1), rules)
    refused(FragilityError, "no run succeeded", lost.capacities, LimitState.bearing_failure())


def test_demands_between_runs_and_fractiles_by_hand() -> None:
    at = [0.5, 1.5, 2.0, 2.5, 3.0]
    found = TWO_IDA.demands_at(at, "bearing displacement")
    np.testing.assert_allclose(found[0], [0.05, 0.2, 0.3, 0.3, np.inf])
    np.testing.assert_allclose(found[1], [0.1, np.inf, np.inf, np.inf, np.inf])
    table = TWO_IDA.fractiles("bearing displacement", at, (0.0, 50.0, 100.0))
    np.testing.assert_allclose(table["0 %"], [0.05, 0.2, 0.3, 0.3, np.inf])
    np.testing.assert_allclose(table["50 %"], [0.075] + [np.inf] * 4)
    np.testing.assert_allclose(table["100 %"], [0.1] + [np.inf] * 4)
    short = IDA(runs([("a", 1.0, 0.1), ("b", 2.0, 0.2)]), LimitState.drift(1), HuntFill(first=1.0))
    assert np.isnan(short.fractiles("bearing displacement", [1.5])["50 %"]).all()


def test_runs_that_cannot_be_used_are_refused() -> None:
    refused(FragilityError, "no run", IntensityRuns, TWO.table.iloc[:0], SCALE, {})
    refused(FragilityError, "no column", IntensityRuns, TWO.table.drop(columns="im"), SCALE, {})
    other = IntensityRuns(TWO.table, Intensity(kind="PGA"), TWO.units)
    refused(FragilityError, "one measure", TWO.joined, other)
    assert len(TWO.joined(TWO).table) == 14
    for words, method in (("no demand", "cloud"), ("of an IDA", "capacities")):
        limit = LimitState.bearing_failure()
        refused(FragilityError, words, fragility_of, TWO, limit, method=method)


def test_figures_hold_what_they_show() -> None:
    limit = LimitState.displacement(0.25)
    panel = ida_curves(TWO_IDA, "bearing displacement", limit=limit).axes[0]
    x, y = panel.lines[0].get_data()
    np.testing.assert_allclose(x, [0.0, 100.0, 300.0])  # mm
    np.testing.assert_allclose(y, [0.0, 1.0, 2.0])
    assert panel.lines[1].get_ydata() == pytest.approx([math.sqrt(8.0)] * 2)  # flat
    assert panel.get_xlabel() == "bearing displacement [mm]"
    figure = stripes(TWO, "bearing displacement", limit=limit)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["complete", f"exceeds: {limit.name}", "failure of a bearing"]
    assert "1 failed numerically" in figure.legends[0].get_title().get_text()
    held, over, _, fell = (len(line.get_xdata()) for line in figure.axes[0].lines)
    assert (held, over, fell) == (2, 1, 3)


def test_figure_of_fragility() -> None:
    capacities = np.array([1.0, 2.0, 2.5, 3.0, 4.0])
    outcomes = ((0.99, 0.1), (1.01, "slip_exceeded"))
    rows = [(f"r{k}", c * f, v) for k, c in enumerate(capacities) for f, v in outcomes]
    found = IDA(runs(rows), LimitState.bearing_failure(), HuntFill(first=1.0))
    curve = fragility_of(found, LimitState.bearing_failure(), resamples=50)
    assert curve.median == pytest.approx(np.exp(np.log(capacities).mean()), rel=1e-4)
    figure = fragility_curves({"device": curve})
    panel = figure.axes[0]
    im, probability = panel.lines[0].get_data()
    np.testing.assert_allclose(probability, curve.probability(im))
    marks = panel.lines[1].get_data()
    np.testing.assert_allclose(marks[0], capacities, rtol=1e-3)
    np.testing.assert_allclose(marks[1], [0.1, 0.3, 0.5, 0.7, 0.9])
    assert figure.legends[0].get_texts()[0].get_text() == "device"
    refused(FragilityError, "0 curves", fragility_curves, [])
    refused(TypeError, "a fragility curve", fragility_curves, ["curve"])  # type: ignore[list-item]
