"""Features: what they are called, what they refuse, and what they do to a bearing's properties."""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lir_element import CoulombFriction, Element, Features
from lir_element.device.features import apply
from lir_element.layout import PROPS_FIELDS
from tests.refusals import refused
from tests.scenes import uneven_bearing

device = partial(uneven_bearing, slider_radius=0.1, capacity=0.1, interface_friction=0.12)


def changed(features: Features, **options) -> set[str]:
    """Return the names of the properties that differ."""
    plain = device().to_record()
    other = apply(features, plain, **options)
    return {f.name for f in PROPS_FIELDS if (plain[f.name] != other[f.name]).any()}


def test_nothing_is_left_out_unless_asked():
    assert Features() == Features.all()
    assert Features().left_out == ()
    assert changed(Features.all(), static_load=1e5) == set()


def test_names_and_switches():
    assert Features.names()[0] == "rims"
    out = Features(rims=False).without("interface")
    assert out.left_out == ("rims", "interface")
    assert out.including("rims").left_out == ("interface",)
    assert Features(rims=np.False_) == Features(rims=False)


def test_without_vertical_coupling_there_is_no_uplift():
    out = Features(vertical_coupling=False)
    assert not out.uplift
    assert out.including("uplift") == Features.all()
    assert out.including("vertical_coupling").left_out == ("uplift",)


@pytest.mark.parametrize("value", [0, None, "no"])
def test_only_bools_are_taken(value):
    refused(TypeError, r"rims = .* must be True", Features, rims=value)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match=r"'heating' does not exist: choose from rims, interface"):
        Features().without("heating")


@pytest.mark.parametrize(
    ("name", "properties"),
    [
        ("rims", {"rim_displacement"}),
        ("interface", {"fused", "interface_friction"}),
        ("uplift", {"bilateral"}),
        ("velocity_dependence", {"friction_drop"}),
        ("vertical_coupling", {"bilateral", "fixed_load"}),
        ("plate_rotation", set()),
        ("second_direction", set()),
    ],
)
def test_what_each_changes(name, properties):
    assert changed(Features().without(name), static_load=1e5) == properties


def test_properties_are_those_of_the_device_without():
    plain = device().to_record()
    for features, other in (
        (Features(interface=False), device().as_dcfp()),
        (Features(interface=False, rims=False), device().as_dcfp(rims=False)),
        (Features(velocity_dependence=False), device(friction=CoulombFriction(0.06))),
    ):
        left, right = apply(features, plain), other.to_record()
        names = [f.name for f in PROPS_FIELDS if f.name != "friction_rate"]  # of no drop
        assert all((left[name] == right[name]).all() for name in names), features.left_out


def test_a_load_that_pulls_is_refused():
    with pytest.raises(ValueError, match=r"static load -10 N: .* keep vertical_coupling=True"):
        apply(Features(vertical_coupling=False), device().to_record(), -10.0)


@pytest.mark.parametrize("name", ["plate_rotation", "second_direction"])
def test_an_element_refuses_what_is_not_its_own(name):
    with pytest.raises(ValueError, match=f"{name} = False"):
        Element(device(), features=Features().without(name))


def test_pendulum_without_vertical_coupling():
    """H = W U / sqrt(l^2 - U^2), whatever the height; the spring answers the height alone."""
    free = dict.fromkeys(("interface_friction", "capacity"), math.inf)
    bearing = device(friction=0.0, design_load=2e5, **free)
    element = Element(bearing, features=Features(vertical_coupling=False))
    k = bearing.resolved()["axial_stiffness"]
    for lateral, down in ((0.05, 1e-4), (0.2, 1e-4), (0.2, -3e-4)):
        u = np.zeros(12)
        u[6], u[8] = lateral, -down
        element.set_trial(u, np.zeros(12), 0.0)
        force = element.resisting_force()
        length = bearing.effective_radius + 2e5 / k
        assert_allclose(force[6], 2e5 * lateral / math.sqrt(length**2 - lateral**2), rtol=1e-12)
        assert_allclose(force[8], -k * down, rtol=1e-9)  # round-off of L + uz - L
