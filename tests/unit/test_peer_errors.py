"""Errors that public programs make in the same formulas, each with the number that shows it."""

import math
from dataclasses import replace

import pytest

from frames.design import (
    ASCE7,
    FrictionPendulum,
    IsolationSystem,
    Spectrum,
    Superstructure,
    Trace,
    equivalent_linear,
    isolator_combinations,
)
from tests.scenes import tall_bearing

G = 9.81


SPECTRUM = Spectrum.asce7(s_ms=1.5, s_m1=0.9)
PENDULUM = FrictionPendulum((2.5,), (0.06,))
# 3 x 2 bearings on 20 m x 12 m
PLACES = ((-9.0, -5.0), (0.0, -5.0), (9.0, -5.0), (-9.0, 5.0), (0.0, 5.0), (9.0, 5.0))
SYSTEM = IsolationSystem(
    bearings=(PENDULUM,) * 6, positions=PLACES, loads=(1e6,) * 6, plan=(20.0, 12.0), gravity=G
)
ABOVE = Superstructure(fixed_base_period=0.5, storey_weights=(4.8e6,), storey_heights=(4.0,), R=6.0)


def calculation(system: IsolationSystem = SYSTEM, code: ASCE7 | None = None) -> Trace:
    found = equivalent_linear(system, SPECTRUM, bounds=None, superstructure=ABOVE, code=code)
    return found["nominal"].trace


def test_the_torsion_ratio_sums_all_bearings() -> None:
    """One program runs over range(N - 1) and overwrites the sum: P_T would be that of one."""
    # 4 (81 + 25) + 2 * 25 = 474; r_I^2 = (400 + 144) / 12 = 45.33
    assert calculation().value("P_T") == pytest.approx(math.sqrt(474.0 / 6.0 / (544.0 / 12.0)))
    # The last bearing counts as each does, be it moved in x or in y.
    for dx, dy in ((3.0, 0.0), (0.0, 2.0)):
        moved = (*PLACES[:5], (9.0 + dx, 5.0 + dy))
        x_m, y_m = dx / 6.0, dy / 6.0
        squares = sum((x - x_m) ** 2 + (y - y_m) ** 2 for x, y in moved)
        found = calculation(replace(SYSTEM, positions=moved)).value("P_T")
        assert found == pytest.approx(math.sqrt(squares / 6.0 / (544.0 / 12.0)), rel=1e-12)


def test_damping_has_no_factor_beyond_two_pi() -> None:
    """One program divides beta_M by another 16."""
    t = calculation()
    d = t.value("D_M")
    assert t.value("beta_M") == pytest.approx(2.0 / math.pi * 0.06 / (0.06 + d / 2.5), rel=1e-9)


def test_torsion_divides_by_the_product() -> None:
    """(y / P_T^2) (12 e / (b^2 + d^2)), not 12 e y / (P_T^2 + b^2 + d^2), nor without P_T."""
    t = calculation(code=ASCE7(least_torsion=1.0))
    ratio = t.values("D_Ty")[0] / t.value("D_M")
    squared = 474.0 / 6.0 / (544.0 / 12.0)  # P_T^2 = 1.743
    assert ratio == pytest.approx(1.0 + 9.0 / squared * 12.0 * 1.0 / 544.0, rel=1e-12)
    assert ratio < 1.0 + 9.0 * 12.0 * 1.0 / (squared + 544.0) - 0.05


def test_one_and_fifteen_per_cent_are_1_15() -> None:
    """One guide adds 1 + 0.150 to 1.125."""
    square = replace(
        SYSTEM,
        bearings=(PENDULUM,) * 4,
        loads=(1.5e6,) * 4,
        plan=(20.0, 20.0),
        positions=((0.0, -10.0), (0.0, 10.0), (-1.0, 0.0), (1.0, 0.0)),
    )
    t = calculation(square, ASCE7(least_torsion=1.0))
    assert t.value("D_TM") / t.value("D_M") == pytest.approx(1.15, rel=1e-12)


def test_shear_above_is_less_than_below() -> None:
    """One program lifts V_st to V_b at least."""
    t = calculation()
    expected = 0.8 ** (1.0 - 3.5 * t.value("beta_M"))
    assert t.value("V_st") / t.value("V_b") == pytest.approx(expected, rel=1e-12)
    assert expected < 0.95


def test_the_damping_factor_is_not_rounded() -> None:
    """One program rounds B_M to a decimal, which moves D_M by several per cent."""
    t = calculation()
    assert t.value("B_M") == pytest.approx(1.2 + 3.0 * (t.value("beta_M") - 0.10), rel=1e-12)
    assert abs(t.value("B_M") - round(t.value("B_M"), 1)) > 0.01
    d, k = t.value("D_M"), t.value("k_M")
    period = 2.0 * math.pi * math.sqrt(6e6 / (k * G))
    assert d == pytest.approx(G * 0.9 * period / (4.0 * math.pi**2 * t.value("B_M")), rel=1e-10)


def test_vertical_earthquake_goes_by_s_ms_and_base_shear_by_s_ds() -> None:
    """One program takes S_DS for S_MS: E_v would be 0.2 D, not 0.3 D."""
    assert isolator_combinations()["maximum"]["S"] == 0.15  # ASCE 7-22, 2.3.6; 7-16 has 0.2
    assert isolator_combinations(1.5)["maximum"]["D"] == pytest.approx(1.2 + 0.3)
    assert isolator_combinations(1.5)["minimum"]["D"] == pytest.approx(0.9 - 0.3)
    t = calculation()
    assert t.value("S_DS") == pytest.approx(1.0)
    # 0.6 / T_M / 6 is below 0.044 S_DS, and that below 0.5 S_1 / R with S_1 of at least 0.6 g
    assert t.value("C_s") == pytest.approx(0.5 * 0.9 / 6.0)


def test_stiffness_has_no_factor_of_units() -> None:
    """Two programs are off by powers of ten: a thousandfold weight changes forces alone."""
    t = calculation()
    heavy = replace(SYSTEM, loads=(1e9,) * 6)
    found = equivalent_linear(heavy, SPECTRUM, bounds=None)["nominal"]
    assert found.displacement == pytest.approx(t.value("D_M"), rel=1e-12)
    assert found.period == pytest.approx(t.value("T_M"), rel=1e-12)
    assert found.stiffness == pytest.approx(1e3 * t.value("k_M"), rel=1e-12)
    d = t.value("D_M")
    assert t.value("k_M") == pytest.approx(6e6 / 2.5 + 0.06 * 6e6 / d, rel=1e-9)


def test_a_double_pendulum_is_shorter_than_both_radii() -> None:
    """The same programs take 2 R: the slider's height goes off, and friction acts on R, not L."""
    bearing = tall_bearing()
    p = FrictionPendulum.of(bearing)
    assert p.effective_radius == pytest.approx(2.7)
    assert p.effective_friction == pytest.approx(0.06 * 3.0 / 2.7)
    assert p.force(0.3, 1e6) == pytest.approx(1e6 * (0.3 + 0.06 * 3.0) / 2.7)
