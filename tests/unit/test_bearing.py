"""What an engineer may specify, what is refused and how, and what follows from it."""

import dataclasses
import itertools
import math
import re
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from lir_element import (
    BackupSupport,
    CoulombFriction,
    DesignWarning,
    FrictionHeating,
    LIRBearing,
    PressureDependence,
    VelocityFriction,
)
from lir_element.device.sliders import face_records, slider_record
from lir_element.layout import FRICTION_TABLE, PROPS_FIELDS
from tests import refusals
from tests.scenes import small_bearing
from tests.scenes import small_bearing as bearing

PAPER = small_bearing.keywords
UNEQUAL: dict[str, Any] = PAPER | {
    "radius": (0.75, 1.1),
    "friction": (CoulombFriction(0.05), CoulombFriction(0.08)),
    "rims": (0.07, 0.12),
    "capacity": None,
}


def refused(error: type[Exception], *words: str, **changes: object) -> None:
    """Check that the message holds all `words`: name, value, bound, remedy."""
    with pytest.raises(error) as caught:
        bearing(**changes)
    for word in words:
        assert word in str(caught.value), f"{word!r} is not in {caught.value}"


Refusal = tuple[type[Exception], tuple[str, ...], dict[str, Any]]
POSITIVE = [
    "slider_height",
    "slider_radius",
    "interface_friction",
    "capacity",
    "axial_stiffness",
    "rim_stiffness",
    "rim_overrun",
    "slip_capacity",
    "design_load",
    "yield_displacement",
    "interface_yield_displacement",
]
NOT_NEGATIVE = ["axial_damping", "rim_damping", "plate_thickness", "interface_hold"]
LEAST = dict.fromkeys(NOT_NEGATIVE, 0.0) | {"bouc_wen_exponent": 1.0}
MAY_BE_INFINITE = {"interface_friction", "capacity"}
UNITS = {
    "axial_stiffness": "N/m",
    "rim_stiffness": "N/m",
    "axial_damping": "N s/m",
    "rim_damping": "N s/m",
    "design_load": "N",
}


@pytest.mark.parametrize("value", [-1.0, -1e-12, 0.0, math.nan, -math.inf, math.inf])
@pytest.mark.parametrize("name", POSITIVE)
def test_positive_numbers(name: str, value: float) -> None:
    if value == math.inf and name in MAY_BE_INFINITE:
        assert getattr(bearing(**{name: value}), name) == math.inf
        return
    refused(ValueError, f"{name} = {value:g}", "must be positive", **{name: value})


@pytest.mark.parametrize("value", [-1.0, -1e-12, math.nan, -math.inf, math.inf])
@pytest.mark.parametrize("name", LEAST)
def test_numbers_with_a_least_value(name: str, value: float) -> None:
    least = LEAST[name]
    value += least
    refused(ValueError, f"{name} = {value:g}", f"at least {least:g}", "give", **{name: value})
    assert getattr(bearing(**{name: least}), name) == least


@pytest.mark.parametrize("value", [-1.0, 0.0, math.nan, -math.inf, math.inf])
@pytest.mark.parametrize("place", [0, 1])
def test_pairs_are_checked_on_both_surfaces(place: int, value: float) -> None:
    for name in ("radius", "rims"):
        pair = [0.75, 0.75] if name == "radius" else [0.08, 0.08]
        pair[place] = value
        if name == "rims" and value == math.inf:
            continue
        where = f"{name} ({('bottom', 'top')[place]})"
        changes = {name: tuple(pair)} | ({"capacity": None} if name == "rims" else {})
        refused(ValueError, f"{where} = {value:g}", "[m]", "positive", **changes)
    thick, at = [0.0, 0.0], ("bottom", "top")[place]
    thick[place] = value
    if value != 0.0:
        refused(ValueError, f"plate_thickness ({at}) = {value:g}", plate_thickness=tuple(thick))


@pytest.mark.parametrize("value", ["0.1", None, 1j, b"1", {}, True, False])
@pytest.mark.parametrize("name", ["radius", "bouc_wen_exponent", *POSITIVE, *NOT_NEGATIVE])
def test_not_a_number(name: str, value: object) -> None:
    defaults = {f.name: f.default for f in dataclasses.fields(LIRBearing)}
    if value is None and name == "capacity":
        refused(ValueError, "capacity is missing", "math.inf", "rims=(bottom, top)", capacity=None)
    elif value is None and defaults[name] is None:
        assert bearing(**{name: None}) == bearing()  # None asks for the default
    else:
        words = (name, f"{value!r} is not a number", UNITS.get(name, ""))
        refused(TypeError, *words, **{name: value})


def pairs() -> Iterator[Refusal]:
    law = PAPER["friction"]
    for name, one in {"radius": 0.75, "friction": law, "plate_thickness": 0.75}.items():
        for count in (0, 1, 3):
            words = f"{name} has {count} entries", "(bottom, top)"
            yield ValueError, words, {name: (one,) * count}
    for count in (1, 3):
        yield (TypeError, ValueError), ("rims",), {"rims": (0.09,) * count, "capacity": None}
    for one in (True, "coulomb", None, CoulombFriction):
        for friction in (one, (law, one), (one, law)):
            words = f"friction = {one!r}", "CoulombFriction(mu)"
            yield TypeError, words, {"friction": friction}


def sizes() -> Iterator[Refusal]:
    for radius, edge in itertools.product((0.75, (0.75, 2.0), (2.0, 0.75)), (0.75, 0.8)):
        words = f"slider_radius = {edge:g} m", "does not fit", "0.75 m", "smaller slider"
        yield ValueError, words, {"radius": radius, "slider_radius": edge}
    for height in (1.5, 1.6):
        least = "below the sum of the radii, 1.5 m", "R1 + R2 - h"
        yield ValueError, (f"slider_height = {height:g} m", *least), {"slider_height": height}
    for capacity in (0.95 * 1.415 * 1.0001, 1.415, 7.0, 175.0):
        words = f"capacity = {capacity:g} m", "beyond the spheres", "0.95 L", "larger radii"
        yield ValueError, words, {"capacity": capacity}
    for law in ("law", "", 3, None):
        words = f"friction_law = {law!r}", "'elastic-plastic'", "'bouc-wen'"
        yield ValueError, words, {"friction_law": law}


@pytest.mark.parametrize(("error", "words", "changes"), [*pairs(), *sizes()])
def test_refusals(error: type[Exception], words: tuple[str, ...], changes: dict[str, Any]) -> None:
    refused(error, *words, **changes)
    with pytest.raises(error, match=re.escape(words[0])):
        dataclasses.replace(bearing(), **changes)


LAWS: dict[str, Callable[[Any], object]] = {
    "coefficient": CoulombFriction,
    "f_max": lambda value: VelocityFriction(value, 0.0, 1.0),
    "f_min": lambda value: VelocityFriction(0.9, value, 1.0),
    "rate": lambda value: VelocityFriction(0.9, 0.1, value),
}


@pytest.mark.parametrize("name", LAWS)
def test_bounds_of_friction_laws(name: str) -> None:
    bound, more = (r"\[s/m\].*at least 0", ()) if name == "rate" else ("below 1", (1.0, 2.0))
    for value in (-0.01, math.nan, math.inf, -math.inf, *more):
        words = rf"{name} = {re.escape(f'{value:g}')}.*{bound}"
        refusals.refused(ValueError, words, LAWS[name], value)
    for value in ("0.1", None, True):
        refusals.refused(TypeError, f"{name} = {value!r} is not a number", LAWS[name], value)
    words = r"f_min = 0\.07 exceeds f_max = 0\.06.*swap"
    refusals.refused(ValueError, words, VelocityFriction, 0.06, 0.07, 1.0)
    assert VelocityFriction(0.06, 0.06, 1.0).at_speed(0.3) == 0.06


@given(
    f_max=st.floats(0.01, 0.99),
    share=st.floats(0.0, 1.0),
    rate=st.floats(0.0, 100.0),
    speed=st.floats(-2.0, 2.0),
)
def test_velocity_friction(f_max: float, share: float, rate: float, speed: float) -> None:
    """Eq. (1) of the paper with |v|."""
    law = VelocityFriction(f_max, share * f_max, rate)
    expected = f_max - (f_max - share * f_max) * math.exp(-rate * abs(speed))
    assert_allclose(law.at_speed(speed), expected, rtol=1e-15, atol=0.0)
    assert law.at_speed(speed) == law.at_speed(-speed)
    assert (law.f_max, law.f_min, law.rate) == (f_max, share * f_max, rate)


def test_coulomb_friction() -> None:
    law = CoulombFriction(0.066)
    assert [law.at_speed(v) for v in (0.0, -0.5, 2.0)] == [0.066] * 3
    assert (law.f_max, law.f_min, law.rate) == (0.066, 0.066, 0.0)


@pytest.mark.parametrize("rims", [None, (0.09, 0.12), (0.12, 0.09), (0.09, math.inf)])
def test_plates_that_overlap_at_rest(rims: tuple[float, float] | None) -> None:
    """One above the other they come closest at the edge of the smaller one: a slider at its rim.

    Without rims the slider's two caps meet, of height R - sqrt(R^2 - r^2).
    """
    radii, edge = (0.75, 1.1), 0.08 + (0.09 if rims else 0.0)
    rise = sum(r - math.sqrt(r**2 - edge**2) for r in radii)
    options = {"radius": radii, "rims": rims, "capacity": None if rims else math.inf}
    words = ("rise of both concave", "reduce capacity") if rims else ("slimmer slider", "0.08 m")
    low = {"slider_height": rise * 0.9999}
    refused(ValueError, "slider_height", f"{rise:.4g} m", *words, **low, **options)
    made = bearing(slider_height=rise * 1.0001, **options)
    assert made.rim_displacement == (rims or (math.inf, math.inf))


@pytest.mark.parametrize("surface", ["bottom", "top"])
def test_slider_beyond_the_edge_of_a_plate(surface: str) -> None:
    """At the rim the slider's edge must still lie over the sphere: d_max + r < R."""
    rims = (0.68, 0.3) if surface == "bottom" else (0.3, 0.68)
    words = (f"does not fit the {surface} plate", "0.68", "slider_radius 0.08", "reduce capacity")
    refused(ValueError, *words, capacity=None, rims=rims, slider_height=0.25)
    good = tuple(min(r, 0.6699) for r in rims)
    assert bearing(capacity=None, rims=good, slider_height=0.25).rim_displacement == good


@pytest.mark.parametrize("mu_h", [0.01, 0.0659, 0.066])
def test_interface_must_be_rougher_than_the_surfaces(mu_h: float) -> None:
    """mu_h > mu_d on both surfaces and at all speeds: the message says how to override."""
    words = (f"interface_friction = {mu_h:g}", "0.066", "mu_h > mu_d", "allow_weak_interface=True")
    slippery = CoulombFriction(0.005)
    fast = VelocityFriction(0.066, 0.001, 20.0)
    for law in (PAPER["friction"], fast):
        for friction in (law, (law, slippery), (slippery, law)):
            refused(ValueError, *words, friction=friction, interface_friction=mu_h)
            weak = bearing(friction=friction, interface_friction=mu_h, allow_weak_interface=True)
            assert weak.interface_friction == mu_h


@pytest.mark.parametrize("unequal", [False, True])
def test_warning_below_the_effective_friction(unequal: bool) -> None:
    """mu_h between max mu_d and (mu1 R1 + mu2 R2) / L: it slips before the rim is met."""
    base = UNEQUAL if unequal else PAPER
    level = (0.05 * 0.75 + 0.08 * 1.1) / 1.765 if unequal else 0.066 * 1.5 / 1.415
    low = max(0.08 if unequal else 0.066, level * 0.9999)
    if low < level:
        with pytest.warns(DesignWarning, match=rf"interface_friction = {low:g}.*{level:.4g}"):
            LIRBearing(**(base | {"interface_friction": low}))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*slip_stability")  # that it hardly holds any
        LIRBearing(**(base | {"interface_friction": max(level, low) * 1.0001}))
        LIRBearing(**(base | {"interface_friction": 0.01, "allow_weak_interface": True}))
    assert_allclose(LIRBearing(**base).effective_friction, level, rtol=1e-14, atol=0.0)


@pytest.mark.parametrize(("mu_h", "warns"), [(0.115, True), (0.126, False)])
def test_warning_where_less_slip_holds_than_overlaps(mu_h: float, warns: bool) -> None:
    """L mu_h - mu1 R1 - mu2 R2 is 64 mm and 79 mm, the overlap 80 mm: below 0.9 it warns."""
    holds = 1.415 * mu_h - 0.066 * 1.5
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert_allclose(bearing(interface_friction=mu_h).slip_stability, holds, rtol=1e-12)
        bearing(interface_friction=mu_h, capacity=math.inf)  # no rims, no slip
        bearing(interface_friction=mu_h, allow_weak_interface=True)
    assert len(caught) == int(warns)
    for warning in caught:
        assert warning.category is DesignWarning
        needed = (0.08 + 0.066 * 1.5) / 1.415
        for words in (
            f"up to {1e3 * holds:.3g} mm of slip",
            "overlap of 80 mm",
            f"to {needed:.3g}, or",
        ):
            assert words in str(warning.message)


def test_contradicting_rims_and_capacity() -> None:
    rims = (0.07, 0.12)
    capacity = 1.765 * min(0.07 / 0.75, 0.12 / 1.1)
    wrong = UNEQUAL | {"rims": rims, "capacity": capacity * 1.001}
    with pytest.raises(ValueError, match=rf"contradicts rims = \(0\.07, 0\.12\).*{capacity:g} m"):
        LIRBearing(**wrong)
    with pytest.raises(ValueError, match="capacity = inf m contradicts"):
        LIRBearing(**(wrong | {"capacity": math.inf}))
    assert LIRBearing(**(wrong | {"capacity": capacity})).rim_displacement == rims


@pytest.mark.parametrize("pair", [[0.75, 0.75], np.array([0.75, 0.75])], ids=["list", "array"])
def test_other_sequences_serve_as_pairs(pair: object) -> None:
    """A frozen bearing must not hold something that can change, or refuse it by name."""
    assert hash(bearing(radius=pair)) == hash(bearing(radius=(0.75, 0.75)))


RADIUS = st.floats(0.3, 5.0)


@pytest.mark.meant(".")  # sizes are odd, whatever is said of them
@given(r_1=RADIUS, r_2=RADIUS, share_1=st.floats(0.05, 0.6), share_2=st.floats(0.05, 0.6))
def test_derived_values(r_1: float, r_2: float, share_1: float, share_2: float) -> None:
    """Closed forms with unequal radii and rims; high enough for the plates to clear each other."""
    edge = min(share_1 * r_1, share_2 * r_2) + 0.08
    rise = sum(r - math.sqrt(r**2 - edge**2) for r in (r_1, r_2))
    h, t = max(0.12, 1.1 * rise), (0.02, 0.05)
    rims = {"capacity": None, "rims": (share_1 * r_1, share_2 * r_2)}
    sizes = {"radius": (r_1, r_2), "slider_height": h, "interface_friction": 0.3}
    b = bearing(plate_thickness=t, **sizes, **rims)
    length = r_1 + r_2 - h
    assert_allclose(b.effective_radius, length, rtol=1e-14, atol=0.0)
    assert_allclose(b.lateral_capacity, length * min(share_1, share_2), rtol=1e-13, atol=0.0)
    assert_allclose(b.height, h + 0.07, rtol=1e-14, atol=0.0)
    assert_allclose(b.period**2 * 9.80665 / (4 * math.pi**2), length, rtol=1e-13, atol=0.0)
    assert_allclose(b.effective_friction, 0.066 * (r_1 + r_2) / length, rtol=1e-13, atol=0.0)
    angle = math.asin(min(share_1, share_2)) + math.atan(0.3)
    assert_allclose(b.force_limit(2.0), 2.0 * math.tan(angle), rtol=1e-12, atol=0.0)
    rims = [0.05 * r_1 / length, 0.05 * r_2 / length]
    assert_allclose(bearing(**sizes, capacity=0.05).rim_displacement, rims, rtol=1e-13, atol=0.0)


def test_force_without_limit() -> None:
    """Without rims or interface; with theta_max + atan(mu_h) above 90 degrees."""
    steep = bearing(slider_height=1.1, capacity=0.85 * 0.4, interface_friction=0.9)
    free = bearing(capacity=math.inf)
    for each in (steep, free, bearing().as_dcfp(), bearing().as_dcfp(rims=False)):
        assert each.force_limit(1.0) == math.inf


@pytest.mark.parametrize("base", [PAPER, UNEQUAL])
def test_as_dcfp(base: dict[str, Any]) -> None:
    """Everything but the interface, and on demand the rims, is kept."""
    b = LIRBearing(**(base | {"axial_stiffness": 3e8, "plate_thickness": 0.03}))
    with_rims, without = b.as_dcfp(), b.as_dcfp(rims=False)
    assert with_rims == dataclasses.replace(b, interface_friction=math.inf)
    assert (b.is_dcfp, with_rims.is_dcfp, without.is_dcfp) == (False, True, True)
    assert with_rims.rim_displacement == b.rim_displacement
    assert without.rim_displacement == (math.inf, math.inf)
    assert without.lateral_capacity == math.inf
    for field in dataclasses.fields(LIRBearing):
        if field.name not in {"interface_friction", "capacity", "rims"}:
            assert getattr(without, field.name) == getattr(b, field.name)
    assert with_rims.as_dcfp() == with_rims


def test_frozen() -> None:
    b = bearing()
    for name in ("radius", "friction", "interface_friction", "new"):
        with pytest.raises((dataclasses.FrozenInstanceError, TypeError, AttributeError)):
            setattr(b, name, 1.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        b.friction.coefficient = 0.5  # type: ignore[union-attr,misc]


HEATING = FrictionHeating(variant="third", initial_temperature=5.0)
OTHER: dict[str, Any] = {
    "radius": (0.75, 1.1),
    "slider_height": 0.09,
    "slider_radius": 0.07,
    "capacity": 0.18,
    "friction": (VelocityFriction(0.07, 0.03, 12.0), CoulombFriction(0.05)),
    "interface_friction": 0.127,
    "axial_stiffness": 3e8,
    "axial_damping": 2e5,
    "rim_stiffness": 4e7,
    "rim_damping": 5e4,
    "rim_overrun": 0.006,
    "rim_yield_force": 9e4,
    "rim_hardening": 0.02,
    "flange": 0.07,
    "uplift_capacity": 0.03,
    "backup": BackupSupport(drop=0.04, friction=0.25, damping=1e4),
    "slip_capacity": 0.05,
    "design_load": 2e5,
    "yield_displacement": 3e-4,
    "interface_yield_displacement": 2e-4,
    "interface_hold": 3e3,
    "friction_law": "bouc-wen",
    "bouc_wen_exponent": 3.0,
    "torsional_friction": False,
    "plate_thickness": (0.01, 0.04),
    "allow_weak_interface": True,
    "rims": (0.75 * 0.175 / 1.415,) * 2,
    "slider_density": 7000.0,
    "slider_mass": (3.0, 4.0),
    "contact_points": 12,
    "slider_inertia": ((0.1, 0.2), (0.1, 0.2)),
    "pressure_dependence": PressureDependence(reference_pressure=1e7, rate=2e-9),
    "friction_heating": HEATING,
}
"""Another value of each field."""
SIZES = {"radius", "slider_height", "slider_radius", "capacity", "interface_friction", "rims"}
SLIDERS = {"slider_density", "slider_mass", "contact_points", "slider_inertia"}


def test_equality_and_hash() -> None:
    assert bearing() == bearing()
    assert hash(bearing()) == hash(bearing())
    assert len({bearing(), bearing(), bearing(radius=0.8)}) == 2
    assert set(OTHER) == {f.name for f in dataclasses.fields(LIRBearing)}


@pytest.mark.meant(".")  # one of them alone is strange
@pytest.mark.parametrize("name", OTHER)
def test_every_field_makes_another_bearing(name: str) -> None:
    more = {"slider_height": 0.11, "capacity": 0.17} if name == "radius" else {}
    other, same = bearing(**more | {name: OTHER[name]}), bearing(**more)
    assert other != same
    if name not in {"allow_weak_interface", "rims"}:  # these do not change the device
        assert records(other) != records(same)


def records(b: LIRBearing) -> bytes:
    """Return the bits of all constants that kernels read."""
    return b.to_record().tobytes() + slider_record(b).tobytes() + face_records(b)[0].tobytes()


def test_record_is_complete() -> None:
    area = math.pi * 0.08**2
    left = {"allow_weak_interface", "torsional_friction", *SIZES, *SLIDERS}
    b = LIRBearing(**UNEQUAL | {name: OTHER[name] for name in OTHER.keys() - left})
    record = b.to_record()
    assert record.shape == (1,)
    assert record.dtype.names == tuple(f.name for f in PROPS_FIELDS)
    expected = {
        "radius": (0.75, 1.1),
        "lever": (0.76, 1.14),
        "length": 1.765,
        "friction_max": (0.07, 0.05),
        "friction_drop": (0.04, 0.0),
        "friction_rate": (12.0, 0.0),
        "friction_table": np.zeros((2, FRICTION_TABLE)),
        "interface_friction": 0.126,
        "fused": 0,
        "bouc_wen": 1,
        "exponent": 3.0,
        "yield_displacement": (3e-4, 3e-4),
        "interface_yield": 2e-4,
        "axial_stiffness": 3e8,
        "axial_damping": 2e5,
        "axial_floor": 200.0,
        "rim_displacement": (0.07, 0.12),
        "rim_stiffness": 4e7,
        "rim_damping": 5e4,
        "rim_overrun": 0.006,
        "rim_yield_force": 9e4,
        "rim_hardening": 4e7 * 0.02 / 0.98,
        "flange": 0.07,
        "uplift_capacity": 0.03,
        "goes_on": 1,
        "backup_drop": 0.04,
        "backup_friction": 0.25,
        "backup_stiffness": 3e8,
        "backup_damping": 1e4,
        "slip_capacity": 0.05,
        "torsion_lever": 2 / 3 * 0.08,
        "torsion_yield": 3e-4 / (2 / 3 * 0.08),
        "slider_radius": 0.08,
        "bilateral": 0,
        "fixed_load": 0.0,
        "pressure_rate": 2e-9 / area,
        "pressure_load": 1e7 * area,
        "softens": 1,
        "heats": 1,
        "softening_scale": 1.0 / (0.22 + 0.7**0.58),
        "softening_rate": -0.029 * math.log(0.7),
        "softening_rest": 0.22,
        "initial_temperature": 5.0,
        **dict(zip(("heat_rate", "heat_gain", "heat_skin"), HEATING.parts(), strict=True)),
        "interface_preload": 3e3 / 0.126,
    }
    assert set(expected) == set(record.dtype.names)
    for name, value in expected.items():
        assert_allclose(record[name][0], value, rtol=1e-14, atol=0.0, err_msg=name)


def test_record_of_the_neutral_values() -> None:
    record = bearing(
        interface_friction=math.inf, capacity=math.inf, torsional_friction=False
    ).to_record()
    assert record["fused"][0] == 1
    assert record["bouc_wen"][0] == 0
    assert record["torsion_lever"][0] == 0.0
    assert np.isinf(record["rim_displacement"]).all()


def test_defaults() -> None:
    """As the docstring states them: 20 GPa, 30 MPa, 5 % and 10 % of critical, tenths."""
    o = bearing().resolved()
    area = math.pi * 0.0064
    axial = 20e9 * area / 0.085
    mass = 30e6 * area / 9.80665
    expected = {
        "design_load": 30e6 * area,
        "axial_stiffness": axial,
        "rim_stiffness": 0.1 * axial,
        "axial_damping": 0.05 * 2 * math.sqrt(axial * mass),
        "rim_damping": 0.10 * 2 * math.sqrt(0.1 * axial * mass),
        "rim_overrun": 0.008,
        "slip_capacity": 0.08,
    }
    assert set(o) == set(expected)
    assert bearing(**expected).resolved() == expected  # explicit values are not overruled
    for name, value in expected.items():
        assert_allclose(o[name], value, rtol=1e-13, atol=0.0, err_msg=name)
    # "39 % of the area still overlaps" at a slip of one radius
    lens = (2 * math.pi / 3 - math.sqrt(3) / 2) / math.pi
    assert_allclose(lens, 0.39, rtol=0.0, atol=5e-3)


def test_numbers_may_be_of_any_kind() -> None:
    """Integers and numpy scalars are numbers."""
    one = bearing(radius=(1, np.float32(1.0)), capacity=np.float64(0.175), design_load=100_000)
    two = bearing(radius=1.0, capacity=0.175, design_load=1e5)
    assert one.to_record().tobytes() == two.to_record().tobytes()
