"""Checks at the door: what passes unchanged, and that refusals name value, bound and remedy."""

import math
from collections.abc import Callable
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
    with pytest.raises(TypeError, match=r"length = .* is not a number: give one number in m$"):
        require_positive("length", value, "m", error=OwnError)


@pytest.mark.parametrize(
    ("check", "good", "bad"),
    [
        (require_finite, (-1.0, 0.0), (math.nan, math.inf, -math.inf)),
        (require_positive, (1e-300, 1.0), (0.0, -1.0, math.nan, math.inf)),
        (require_non_negative, (0.0, 1.0), (-1e-300, math.nan, math.inf)),
    ],
)
def test_bounds(check, good, bad):
    for value in good:
        assert check("length", value) == value
    for value in bad:
        with pytest.raises(OwnError, match=rf"length = {value:g} \[m\] must be .*: measure it$"):
            check("length", value, "m", remedy="measure it", error=OwnError)


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
    with pytest.raises(OwnError, match=r"axis = 'q': choose one of \('x', 'y'\)"):
        require_choice("axis", "q", ("x", "y"), error=OwnError)


def test_results_and_devices_of_another_kind_are_told() -> None:
    """What a user tries first: a list of results, one result, an array as motion, an element."""
    bearing = small_bearing(friction=0.05, interface_friction=0.15)
    model = lumped_mass(bearing, 15e3)
    data = time_history(model, GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1))
    refused(TypeError, r"for several, summary\(\{name: data", peaks, [data])
    refused(TypeError, "results is a Dataset: give Datasets by name", summary, data)
    refused(TypeError, "results is a list", summary, [data])
    with pytest.raises(TypeError, match=r"an array of shape \(3,\) must be a GroundMotion"):
        time_history(model, np.zeros(3))
    for wrong in (Element, Element(bearing)):
        refused(TypeError, "must be an LIRBearing, the device itself", lumped_mass, wrong, 15e3)
    with pytest.raises(ValueError, match=r"reaches 150 m, .* 0.75 m: give metres, 150 mm as 0.15"):
        cyclic_test(bearing, [0.0, 150.0, 0.0], 150e3)
    with pytest.warns(
        UserWarning, match=r"1000 N is .* times the design load.*1000 kN are 1e\+06 N"
    ):
        cyclic_test(bearing, [0.0, 0.001], 1e3)


def test_messages_are_short_whatever_was_given(tmp_path: Path) -> None:
    """A swapped argument does not print all of its numbers, and no attribute is missed."""
    bearing = small_bearing(friction=0.05, interface_friction=0.15)
    model, many = lumped_mass(bearing, 15e3), np.linspace(0.0, 1.0, 600)
    data = time_history(model, GroundMotion(x=[0.0, 1.0, 0.0], dt=0.1))
    tries: dict[str, Callable[[], object]] = {
        "data = a list of 1 must be a Dataset": lambda: audit([data]),  # type: ignore[arg-type]
        "data = a list of 1 must be": lambda: peaks([data]),  # type: ignore[arg-type]
        r"array of shape \(600,\) must be a Ground": lambda: time_histories(model, many),
        "dt = a list of 600 is not a number": lambda: GroundMotion(x=0.01, dt=many.tolist()),  # type: ignore[arg-type]
        "frame = a Dataset must be a Frame": lambda: modes(data),  # type: ignore[arg-type]
        "frame = GroundMotion.* must be a Frame": lambda: gravity(GroundMotion(x=many, dt=0.1)),  # type: ignore[arg-type]
        "bearing = an Element must be": lambda: moment_frame(bearing=Element(bearing)),  # type: ignore[arg-type]
        "bearing = 5.0 must be": lambda: shear_building(5.0, 1e4, 1e7, storeys=1),  # type: ignore[arg-type]
    }
    for words, attempt in tries.items():
        with pytest.raises(TypeError, match=words) as told:
            attempt()
        assert len(str(told.value)) < 200
    (tmp_path / "notes.nc").write_text("no results")
    with pytest.raises(OSError, match=r"notes\.nc holds no results .*: give a file that save"):
        load(tmp_path / "notes.nc")


@pytest.mark.parametrize("size", [1e-320, 1e-300])
def test_a_slider_without_area_is_refused(size: float) -> None:
    with pytest.raises(ValueError, match="check slider_radius"):
        small_bearing(slider_radius=size, axial_stiffness=1e9, design_load=1e5)
