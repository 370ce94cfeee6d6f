"""Numbers that others published of friction pendulums and isolated buildings, found again.

A number is held to the last digit that was printed; what a source leaves open is said.
"""

import math

import pytest

from frames.design import (
    ASCE7,
    FrictionPendulum,
    IsolationSystem,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    Superstructure,
    equivalent_linear,
)
from lir_element import CoulombFriction, LIRBearing

KIP, INCH = 4.4482216152605e3, 0.0254
NOMINAL = PropertyBounds(PropertyModificationFactors(1.0, 1.0))


def alike(found: float, printed: float) -> None:
    """Hold a number to the digits of one that was printed, half a unit of the last."""
    digits = len(f"{printed:.10g}".partition(".")[2])
    assert found == pytest.approx(printed, abs=0.5000001 * 10.0**-digits)


def on_pendulums(spectrum, radius, friction, weight, above=None, code=None):
    """Return the analysis of a building on 30 like pendulums, six by five."""
    places = tuple((6.0 * i - 15.0, 6.0 * j - 12.0) for i in range(6) for j in range(5))
    system = IsolationSystem(
        bearings=(FrictionPendulum((radius,), (friction,)),) * 30,
        positions=places,
        loads=(weight / 30.0,) * 30,
        plan=(30.0, 24.0),
    )
    found = equivalent_linear(system, spectrum, bounds=NOMINAL, superstructure=above, code=code)
    return found["lower"]


def test_one_friction_pendulum_of_an_exercise() -> None:
    """Exercise of a course: 1500 kN on R = 2.5 m, friction 0.06, at 0.3 m; 3.17 s sliding."""
    system = IsolationSystem(
        bearings=(FrictionPendulum((2.5,), (0.06,)),),
        positions=((0.0, 0.0),),
        loads=(1500e3,),
        plan=(20.0, 20.0),
    )
    moved = 0.30
    stiffness = (system.force(moved) - system.force(0.5 * moved)) / (0.5 * moved)
    alike(1e-3 * stiffness, 600.0)
    alike(1e-3 * system.strength, 90.0)
    alike(1e-3 * system.force(moved), 270.0)
    alike(1e-3 * system.force(moved) / moved, 900.0)
    alike(2.0 * math.pi * math.sqrt(1500e3 / (stiffness * system.gravity)), 3.17)


def test_stiffness_and_strength_of_a_lecture() -> None:
    """UC Berkeley, lecture CE 223, friction pendulum under 1.470e6 kg: R = 1 m, friction 0.03.

    Printed are K_p = 14.416 MN/m and Q = 0.432 MN, both by g = 9.80665 m/s2.
    """
    bearing = LIRBearing(
        radius=0.6,
        slider_height=0.2,  # effective radius 1 m
        slider_radius=0.15,
        capacity=0.3,
        friction=CoulombFriction(0.03 / 1.2),  # over the load 0.03
        interface_friction=0.2,
    )
    system = IsolationSystem(
        bearings=(bearing,), positions=((0.0, 0.0),), loads=(1.470e6 * 9.80665,), plan=(10.0, 10.0)
    )
    alike(1e-6 * (system.force(0.2) - system.force(0.1)) / 0.1, 14.416)
    alike(1e-6 * system.strength, 0.432)


def test_restoring_force_of_an_open_calculation() -> None:
    """Documentation of the public program mjamiv/isolation: 450 kip, R = 152 in, D = 7.13 in.

    It prints W (D / 2) / R = 10.55 kip.
    """
    system = IsolationSystem(
        bearings=(FrictionPendulum((152.0 * INCH,), (0.06,)),),
        positions=((0.0, 0.0),),
        loads=(450.0 * KIP,),
        plan=(20.0, 20.0),
    )
    moved = 7.13 * INCH
    alike((system.force(moved) - system.force(0.5 * moved)) / KIP, 10.55)


def test_parameters_of_a_site_of_the_usgs() -> None:
    """USGS example of ASCE 7-22, UCSF Parnassus: S_MS = S_M1 = 2.052, S_DS = S_D1 = 1.368.

    The multi-period spectrum of the site is not at hand: two thirds alone are compared.
    """
    above = Superstructure(
        fixed_base_period=0.4, storey_weights=(3e7,), storey_heights=(3.0,), R=8.0
    )
    found = on_pendulums(Spectrum.asce7(s_ms=2.052, s_m1=2.052), 1.6, 0.055, 4e7, above)
    alike(found.trace.value("S_DS"), 1.368)
    alike(found.trace.value("S_D1"), 1.368)


PERU = Spectrum.asce7(s_ms=1.5 * 0.45 * 2.5, s_m1=1.5 * 0.45 * 2.5 * 0.4)
"""Zone 4 (Z = 0.45) on soil S1 (S = 1, T_P = 0.4 s) by E.030, times 1.5 for the maximum level."""


def test_a_template_of_the_peruvian_standard() -> None:
    """Public calculation sheet by E.031 (DS 030-2019-VIVIENDA): 30 pendulums, R 1.6 m, 0.055.

    E.031 is in these formulas ASCE 7-16, chapter 17. The sheet's weights are not printed: the
    seismic weight follows from V_b, that above the base from V_st, T_fb from the exponent k; the
    forces that then follow are the sheet's. Its exponent of damping is that of gradual sliding.
    """
    unit = on_pendulums(PERU, 1.6, 0.055, 1.0)
    alike(unit.displacement, 0.26977)
    alike(unit.period, 2.2038)
    alike(unit.damping, 0.15659)
    weight = 8990.6e3 / unit.base_shear
    share = (7732.0 / 8990.6) ** (1.0 / (1.0 - 2.5 * unit.damping))
    above = Superstructure(
        fixed_base_period=0.927 / (14.0 * unit.damping),
        storey_weights=(share * weight,),
        storey_heights=(3.0,),
        R=8.0,
    )
    t = on_pendulums(PERU, 1.6, 0.055, weight, above, ASCE7(exponent=2.5)).trace
    alike(1e-3 * t.value("V_b"), 8990.6)
    alike(1e-3 * t.value("V_st"), 7732.0)
    alike(t.value("k_v"), 0.927)
    assert 1e-3 * t.value("F_1") == pytest.approx(629.3, abs=0.051)  # of two rounded shears


def test_the_same_pendulums_by_the_european_and_the_chilean_standard() -> None:
    """R 1.6 m, friction 0.055, typed from the formulas apart: EN 1998-1 10.9.3, NCh2745 7.3.

    Ground C with a_g = 2.5 m/s2; soil II in zone 3.
    """
    europe = on_pendulums(Spectrum.en1998(a_g=2.5, ground_type="C"), 1.6, 0.055, 4e7)
    alike(europe.displacement, 0.11606)
    alike(europe.damping, 0.27454)
    alike(europe.period, 1.9140)
    chile = on_pendulums(Spectrum.nch2745("II", 3), 1.6, 0.055, 4e7)
    alike(chile.trace.value("D_D"), 0.19404)
    alike(chile.trace.value("D_M"), 0.26035)
