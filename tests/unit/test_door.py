"""Checks at the door: what passes unchanged, and that refusals name value, bound and remedy."""

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from frames import (
    GroundMotion,
    audit,
    gravity,
    load,
    lumped_mass,
    modes,
    moment_frame,
    peaks,
    shear_building,
    summary,
    time_histories,
    time_history,
)
from lir_element import Element, cyclic_test
from lir_element.argument_checks import (
    as_number,
    require_between,
    require_choice,
    require_finite,
    require_non_negative,
    require_positive,
    require_type,
    require_vector,
)
from tests.refusals import refused
from tests.scenes import small_bearing


class OwnError(ValueError):
    """What a caller raises."""


@pytest.mark.parametrize("value", [2, 2.0, np.int64(2), np.float32(2), Fraction(2), np.array(2.0)])
def test_every_kind_of_number(value: object) -> None:
    number = as_number("length", value, "m")
    assert number == 2.0
    assert type(number) is float


@pytest.mark.parametrize(
    "value", [True, np.bool_(True), "2", None, 2j, np.complex64(2), [2.0], np.array([2.0])]
)
def test_what_is_no_number(value: object) -> None:
    words = r"length = .* is not a number: give one number in m$"
    refused(TypeError, words, require_positive, "length", value, "m", error=OwnError)


@pytest.mark.parametrize(
    ("check", "good", "bad"),
    [
        (require_finite, (-1.0, 0.0), (math.nan, math.inf, -math.inf)),
        (require_positive, (1e-300, 1.0), (0.0, -1.0, math.nan, math.inf)),
        (require_non_negative, (0.0, 1.0), (-1e-300, math.nan, math.inf)),
    ],
)
def test_bounds(check, good, bad):
    told = {"remedy": "measure it", "error": OwnError}
    for value in good:
        assert check("length", value) == value
    for value in bad:
        words = rf"length = {value:g} \[m\] must be .*: measure it$"
        refused(OwnError, words, check, "length", value, "m", **told)


def test_infinity_where_it_is_meant() -> None:
    assert require_positive("radius", math.inf, "m", infinite=True) == math.inf
    with pytest.raises(ValueError, match="must be positive: give it in m"):
        require_positive("radius", math.nan, "m", infinite=True)


@pytest.mark.parametrize("value", [-0.01, 1.0, math.nan])
def test_between(value: float) -> None:
    assert require_between("share", 0.0, 0.0, 1.0) == 0.0
    with pytest.raises(OwnError, match=f"share = {value:g} .* at least 0 and below 1: give a pure"):
        require_between("share", value, 0.0, 1.0, "-", error=OwnError)


def test_vectors_are_copies() -> None:
    given = np.arange(3.0)
    assert require_vector("point [m]", given, 3) is not given
    bad: list[tuple[object, str]] = [
        ([1.0, 2.0], r"shape \(2,\), it must be \(3,\)"),
        ([1.0, 2.0, math.inf], r"\[1.0, 2.0, inf\] must be finite"),
        (["a", "b", "c"], "must be 3 real numbers"),
    ]
    for values, message in bad:
        refused(OwnError, message, require_vector, "point [m]", values, 3, error=OwnError)


def test_kinds_and_choices() -> None:
    require_type("name", "a", str, "a string")
    refused(TypeError, "name = 7 must be a string", require_type, "name", 7, str, "a string")
    require_choice("axis", "x", ("x", "y"))
    words = r"axis = 'q': choose one of \('x', 'y'\)"
    refused(OwnError, words, require_choice, "axis", "q", ("x", "y"), error=OwnError)


def test_results_and_devices_of_another_kind_are_told() -> None:
    """What a user tries first: a list of results, one result, an array as motion, an element."""
    bearing = small_bearing(friction=0.05, interface_friction=0.15)
    model = lumped_mass(bearing, 15e3)
    data = time_history(model, GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1))
    device = "must be an LIRBearing"
    for words, call, *given in (
        (r"for several, summary\(\{name: data", peaks, [data]),
        ("results is a Dataset: give Datasets by name", summary, data),
        ("results is a list", summary, [data]),
        (r"an array of shape \(3,\) must be a GroundMotion", time_history, model, np.zeros(3)),
        (device, lumped_mass, Element, 15e3),
        (device, lumped_mass, Element(bearing), 15e3),
    ):
        refused(TypeError, words, call, *given)
    words = r"reaches 150 m, .* 0.75 m: give metres, 150 mm as 0.15"
    refused(ValueError, words, cyclic_test, bearing, [0.0, 150.0, 0.0], 150e3)
    words = r"1000 N is .* times the design load.*1000 kN are 1e\+06 N"
    with pytest.warns(UserWarning, match=words):
        cyclic_test(bearing, [0.0, 0.001], 1e3)


def test_messages_are_short_whatever_was_given(tmp_path: Path) -> None:
    """A swapped argument does not print all of its numbers, and no attribute is missed."""
    bearing = small_bearing(friction=0.05, interface_friction=0.15)
    model, many = lumped_mass(bearing, 15e3), np.linspace(0.0, 1.0, 600)
    data = time_history(model, GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1))
    for words, attempt in {
        "data = a list of 1 must be a Dataset": lambda: audit([data]),
        "data = a list of 1 must be": lambda: peaks([data]),
        r"array of shape \(600,\) must be a Ground": lambda: time_histories(model, many),
        "dt = a list of 600 is not a number": lambda: GroundMotion(x=0.01, dt=many.tolist()),
        "frame = a Dataset must be a Frame": lambda: modes(data),
        "frame = GroundMotion.* must be a Frame": lambda: gravity(GroundMotion(x=many, dt=0.1)),
        "bearing = an Element must be": lambda: moment_frame(bearing=Element(bearing)),
        "bearing = 5.0 must be": lambda: shear_building(5.0, 1e4, 1e7, storeys=1),
    }.items():
        assert len(str(refused(TypeError, words, attempt))) < 200
    (tmp_path / "notes.nc").write_text("no results")
    words = r"notes\.nc has no results .*: use a file that save"
    refused(OSError, words, load, tmp_path / "notes.nc")


@pytest.mark.parametrize("size", [1e-320, 1e-300])
def test_a_slider_without_area_is_refused(size: float) -> None:
    with pytest.raises(ValueError, match="check slider_radius"):
        small_bearing(slider_radius=size, axial_stiffness=1e9, design_load=1e5)
