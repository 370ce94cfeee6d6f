"""Spectra of codes: hand calculations, continuity at the corners, damping, errors at the door."""

import math
import pickle  # noqa: S403

import numpy as np
import pytest

from frames import MotionError
from frames.design import Spectrum
from frames.design.hazard.code_rules import damping_factor, known_names
from lir_element.units import STANDARD_GRAVITY as G
from tests.refusals import refused

ALL = [
    Spectrum.asce7(1.5, 0.9),
    Spectrum.asce7_multi_period([0.0, 0.2, 1.0, 5.0, 10.0], [0.6, 1.5, 0.9, 0.2, 0.07]),
    *(Spectrum.en1998(2.5, ground, kind) for ground in "ABCDE" for kind in (1, 2)),
    *(Spectrum.nch2745(soil, zone) for soil in ("I", "II", "III") for zone in (1, 2, 3)),
    *(Spectrum.nch433(soil, 3) for soil in "ABCDE"),
]
everywhere = pytest.mark.parametrize("spectrum", ALL, ids=lambda s: s.name)


def test_two_parameters_of_asce7() -> None:
    """By hand, at a period of each branch; T_S = 0.6 s, T_0 = 0.12 s."""
    spectrum = Spectrum.asce7(s_ms=1.5, s_m1=0.9, t_l=8.0)
    periods = [0.0, 0.06, 0.12, 0.6, 1.0, 3.0, 8.0, 16.0]
    by_hand = [0.6, 1.05, 1.5, 1.5, 0.9, 0.3, 0.1125, 0.028125]
    np.testing.assert_allclose(spectrum.acceleration(periods), np.multiply(by_hand, G), rtol=1e-12)
    assert spectrum.parameters["S_M1"] == 0.9
    assert dict(spectrum.corner_periods) == pytest.approx({"T_0": 0.12, "T_S": 0.6, "T_L": 8.0})
    # Equation of the isolation displacement: D = g S_M1 T / (4 pi^2 B)
    assert spectrum.displacement(2.7419, 0.1609) == pytest.approx(
        G * 0.9 * 2.7419 / (4.0 * math.pi**2 * (1.2 + 0.3 * 0.609)), rel=1e-12
    )


def test_multi_period_gives_the_two_parameters() -> None:
    """Points of a two-parameter spectrum: 90 % of its plateau, and S_M1 of T x Sa."""
    two = Spectrum.asce7(1.5, 0.9, t_l=8.0)
    periods = np.concatenate([[0.0, 0.12], np.arange(0.2, 10.01, 0.1)])
    many = Spectrum.asce7_multi_period(periods, two.acceleration(periods) / G, t_l=8.0)
    assert many.parameters["S_MS"] == pytest.approx(1.35)
    assert many.parameters["S_M1"] == pytest.approx(0.9)  # not below the acceleration at 1 s
    late = [10.0, 12.0, 20.0]
    np.testing.assert_allclose(many.acceleration(late), two.acceleration(late), rtol=1e-12)
    soft = Spectrum.asce7_multi_period(
        [0.0, 0.5, 1.0, 2.0, 4.0, 8.0], [0.5, 1.2, 0.6, 0.5, 0.3, 0.1]
    )
    assert soft.parameters["S_M1"] == pytest.approx(0.9 * 1.2)  # 4 s x 0.3 g
    stiff = Spectrum.asce7_multi_period(
        [0.0, 0.5, 1.0, 2.0, 4.0, 8.0], [0.5, 1.2, 0.6, 0.5, 0.3, 0.1], v_s30=760.0
    )
    assert stiff.parameters["S_M1"] == pytest.approx(0.9 * 1.0)  # 2 s x 0.5 g
    long = Spectrum.asce7_multi_period([0.0, 1.0, 4.0], [0.5, 0.8, 0.2], s_m1=0.7, t_l=8.0)
    assert long.parameters["S_M1"] == 0.7
    np.testing.assert_allclose(long.acceleration([8.0, 16.0]), [0.1 * G, 0.025 * G], rtol=1e-12)


def test_en1998_on_ground_b() -> None:
    """By hand: S = 1.2, T_B = 0.15 s, T_C = 0.5 s, T_D = 2 s, a_g = 1.2 x 2.5 m/s2."""
    spectrum = Spectrum.en1998(2.5, "B", importance=1.2)
    peak = 1.2 * 2.5 * 1.2
    by_hand = [peak, 2.5 * peak, 2.5 * peak, 1.25 * peak, 0.625 * peak, 2.5 * peak / 16.0]
    np.testing.assert_allclose(spectrum.acceleration([0.0, 0.15, 0.5, 1, 2, 4]), by_hand)
    # 0.025 a_g S T_C T_D is the ground's displacement, 2.5 times it the spectrum's plateau
    assert spectrum.displacement(4.0) == pytest.approx(0.0625 * peak, rel=0.02)
    eta = math.sqrt(10.0 / 26.22)
    assert spectrum.acceleration(1.0, 0.2122) == pytest.approx(eta * 1.25 * peak)
    assert spectrum.acceleration(0.0, 0.2122) == pytest.approx(peak)


def test_nch2745_of_the_published_code() -> None:
    """Soil II, Z = 1: cm/s2 and cm."""
    spectrum = Spectrum.nch2745("II", zone=2)
    found = 100.0 * spectrum.acceleration([0.5, 1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(found, [1100.0, 590.6, 296.1, 131.6, 74.0], atol=0.05)
    late = [2.0, 3.0, 10.0]
    np.testing.assert_allclose(spectrum.displacement(late), 0.30, rtol=1e-12)
    zone_3 = Spectrum.nch2745("II", zone=3)
    assert zone_3.displacement(3.0, 0.20) == pytest.approx(0.19330, abs=5e-6)
    assert zone_3.scaled(1.2).displacement(3.0, 0.20) == pytest.approx(0.23196, abs=5e-6)
    assert Spectrum.nch2745("I").displacement(3.0, 0.20) == pytest.approx(0.12887, abs=5e-6)


def test_nch433_by_hand() -> None:
    """Soil D, p = 1: alpha(T_0) = 5.5 / 2; the ground's acceleration is I S A_0."""
    spectrum = Spectrum.nch433("D", zone=2, importance=1.2)
    ground = 1.2 * 1.2 * 0.30 * G
    np.testing.assert_allclose(spectrum.acceleration([0.0, 0.75]), [ground, 2.75 * ground])
    assert spectrum.acceleration(1.5, 0.10) == pytest.approx(ground * 10.0 / 9.0 / 1.37)


def test_damping_factors() -> None:
    assert damping_factor("ASCE 7-22", 0.2122) == pytest.approx(1.5244)
    assert [damping_factor("ASCE 7-22", xi) for xi in (0.0, 0.02, 0.5, 0.9)] == [0.8, 0.8, 2.0, 2.0]
    assert 1.0 / damping_factor("EN 1998", 0.2122) == pytest.approx(0.6175, abs=1e-4)
    assert damping_factor("EN 1998", 0.6) == pytest.approx(1.0 / 0.55)
    assert damping_factor("NCh2745", 0.125) == pytest.approx(1.52)
    for code in known_names():
        factors = [damping_factor(code, xi) for xi in np.linspace(0.0, 0.99, 100)]
        assert (np.diff(factors) >= 0.0).all()


@everywhere
def test_spectra_are_continuous_and_damped(spectrum: Spectrum) -> None:
    for corner in spectrum.corner_periods.values():
        before, after = spectrum.acceleration([corner * (1 - 1e-9), corner * (1 + 1e-9)])
        # the published constants of NCh2745 are rounded
        assert before == pytest.approx(after, rel=7e-3 if spectrum.code == "NCh2745" else 1e-6)
    periods = np.linspace(0.0, 12.0, 200)
    plain = spectrum.acceleration(periods)
    assert (plain > 0.0).all()
    assert spectrum.damping_factor(0.05) == 1.0
    later = periods[periods > 0.6]
    np.testing.assert_allclose(
        spectrum.acceleration(later, 0.2) * spectrum.damping_factor(0.2),
        spectrum.acceleration(later),
        rtol=1e-12,
    )
    np.testing.assert_allclose(
        spectrum.displacement(periods), plain * periods**2 / (4.0 * np.pi**2), rtol=1e-12
    )
    twice = spectrum.scaled(2.0)
    np.testing.assert_allclose(twice.acceleration(periods), 2.0 * plain, rtol=1e-12)
    assert pickle.loads(pickle.dumps(spectrum)) == spectrum  # noqa: S301
    assert spectrum.name in repr(spectrum)
    assert f"{spectrum.source}; {spectrum.standing}" in spectrum._repr_html_()


def test_scaling_scales_the_parameters() -> None:
    design = Spectrum.asce7(1.5, 0.9).scaled(2.0 / 3.0)
    assert design.parameters["S_MS"] == pytest.approx(1.0)
    assert design.parameters["T_S"] == pytest.approx(0.6)
    assert Spectrum.en1998(2.5).scaled(1.5).parameters["a_g"] == pytest.approx(3.75)


def test_given_points() -> None:
    spectrum = Spectrum.given([0.0, 1.0, 3.0], [4.0, 10.0, 2.0], name="site")
    assert spectrum.acceleration(2.0) == 6.0
    assert isinstance(spectrum.acceleration(2.0), float)
    refused(MotionError, "code=", spectrum.acceleration, 2.0, damping=0.10)
    refused(MotionError, "from 0 s to 3 s", spectrum.acceleration, 3.5)
    damped = Spectrum.given([0.0, 3.0], [4.0, 2.0], code="EN 1998")
    assert damped.acceleration(0.0, 0.10) == pytest.approx(4.0 * math.sqrt(10.0 / 15.0))
    table = spectrum.table([1.0, 2.0])
    assert table["Sa [g]"].to_list() == pytest.approx([10.0 / G, 6.0 / G])
    with pytest.raises(TypeError):
        spectrum.parameters["S"] = 1.0  # type: ignore[index]


ASCE, POINTS, GIVEN = Spectrum.asce7, Spectrum.asce7_multi_period, Spectrum.given


@pytest.mark.parametrize(
    ("words", "make", "given"),
    [
        ("1.5 g", ASCE, (14.7, 8.8)),
        ("s_ms", ASCE, (0.0, 0.9)),
        ("T_S", ASCE, (0.1, 0.9)),
        ("period = -1", ALL[0].acceleration, (-1.0,)),
        ("period = nan", ALL[0].acceleration, (math.nan,)),
        ("0.05", ALL[0].acceleration, (1.0, 5.0)),
        ("factor", ALL[0].scaled, (-1.0,)),
        ("begin at 0", POINTS, ([0.5, 1.0, 3.0], [1.0, 0.5, 0.2])),
        ("unit", POINTS, ([0.0, 1.0, 3.0], [9.8, 14.7, 2.0])),
        ("m/s2", Spectrum.en1998, (250.0,)),
        ("ground_type", Spectrum.en1998, (2.5, "F")),
        ("kind", Spectrum.en1998, (2.5, "A", 3)),
        ("soil", Spectrum.nch2745, ("IV",)),
        ("zone", Spectrum.nch2745, ("II", 4)),
        ("soil", Spectrum.nch433, ("F",)),
        ("one length", GIVEN, ([0.0, 1.0], [1.0])),
        ("rising", GIVEN, ([1.0, 0.0], [1.0, 2.0])),
        ("positive", GIVEN, ([0.0, 1.0], [1.0, -2.0])),
        ("code", damping_factor, ("UBC", 0.1)),
    ],
)
def test_what_makes_no_sense_is_refused(words, make, given):
    refused(MotionError, words, make, *given)
    refused(MotionError, "code", GIVEN, [0.0, 1.0], [1.0, 2.0], code="UBC")


def test_a_spectrum_keeps_the_site_that_it_was_made_for() -> None:
    """Zone 1 times 4/3 has the numbers of zone 2, and is no spectrum of a zone."""
    made = Spectrum.nch2745("III", zone=1)
    assert dict(made.site) == {"soil": "III", "zone": 1}
    assert "soil = III, zone = 1" in repr(made)
    assert made.scaled(1.0).site == made.site
    raised = made.scaled(4.0 / 3.0)
    assert raised.parameters == pytest.approx(Spectrum.nch2745("III", zone=2).parameters)
    assert raised.site == ()
    assert dict(Spectrum.en1998(a_g=2.0, ground_type="C").site) == {"ground_type": "C", "kind": 1}
    assert dict(Spectrum.nch433("B", zone=2).site) == {"soil": "B", "zone": 2}
    assert Spectrum.asce7(s_ms=1.0, s_m1=0.6).site == ()
