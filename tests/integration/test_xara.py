"""Bearings in models of xara, another OpenSees, beside OpenSeesPy."""

import gc
import json
import weakref
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("openseespy", reason="openseespy is not installed")
pytest.importorskip("opensees", reason="xara is not installed")

from opensees import openseespy as rt  # of which xara.Model is made; xara itself needs Python 3.12

from lir_element.opensees import RouteWarning, bearing_response, bearing_tags, opensees
from lir_element.opensees import record_bearings as record
from lir_element.opensees.in_process.symbols import NotPossibleError
from lir_element.opensees.library import commands_of
from tests.integration.stand import Stand


@pytest.fixture
def stands():
    """The same stand in OpenSeesPy, in the module of xara, and in a model of xara."""
    all_ops = opensees(), rt, rt.Model("basic", "-ndm", 3, "-ndf", 6)
    yield [Stand(ops, "portable", host=ops) for ops in all_ops]
    for ops in all_ops:
        ops.wipe()
        assert bearing_tags(ops) == ()


@pytest.mark.parametrize("level", ["pendulum", "contact"])
@pytest.mark.parametrize("integrator", [("Newmark", 0.5, 0.25), ("TRBDF2",)], ids=lambda i: i[0])
def test_a_mass_thrown_across_a_rim_moves_as_in_openseespy(stands, level, integrator):
    """With the same tag in three models at once."""
    device, seen = replace(Stand.DEVICE, capacity=0.02), []
    for stand in stands:
        stand.build(device, level=level)
        stand.gravity(steps=1)
        stand.ops.setNodeVel(2, 1, 0.9, "-commit")
        stand.solver()
        stand.ops.integrator(*integrator)
        stand.ops.analysis("Transient")
        recording = record(ops=stand.ops)
        stand.run(40, 1e-3)
        seen.append(recording.dataset())
    want, *others = seen
    assert want["rim_force"].max() > 0.05 * Stand.LOAD
    assert np.abs(want["interface_slip"]).max() > 0.01
    for got in others:
        for name in ("bearing_displacement", "interface_slip", "bearing_force", "rim_force"):
            size = np.abs(want[name]).max().item()
            assert_allclose(got[name], want[name], rtol=0.0, atol=1e-8 * size)


def test_an_integrator_that_does_not_serve_is_named(stands):
    stand = stands[2]
    stand.build()
    stand.gravity(steps=1)
    stand.shaking(integrator=("HHT", 0.7))
    stand.run(5)
    with pytest.warns(RouteWarning, match="element 1: .* Use the integrator Newmark or TRBDF2"):
        bearing_response(1, "slip", stand.ops)


def test_a_step_that_failed_is_done_in_halves(stands):
    ends = []
    for stand in (stands[0], stands[2]):
        stand.build()
        stand.gravity(steps=1)
        stand.shaking()
        stand.run(10)
        stand.ops.test("NormDispIncr", 1e-14, 1)
        assert stand.ops.analyze(1, 0.01) != 0
        stand.ops.test("NormDispIncr", 1e-9, 100)
        ends.append(stand.run(10, 0.005))
    assert_allclose(*ends, rtol=0.0, atol=1e-10)


def test_a_bearing_that_fails_or_is_removed(stands):
    _, other, stand = stands
    for each in (stand, other):
        each.build()
    stand.gravity(steps=1)
    stand.shaking(6.0)
    with pytest.raises(AssertionError, match="step"):
        stand.run()
    assert np.hypot(*bearing_response(1, "slip", stand.ops)) > 0.05
    commands_of(stand.ops).remove("element", 1)
    assert bearing_tags(stand.ops) == ()
    assert bearing_tags(other.ops) == (1,)
    stand.ops.wipe()
    stand.build()
    assert bearing_tags(stand.ops) == (1,)


def test_what_is_not_served_is_named(stands):
    stand = stands[2]
    stand.build()
    with pytest.raises(ValueError, match="element 1 is in the model already"):
        stand.put(1, 1, 2)
    stand.route = "fast"
    with pytest.raises(NotPossibleError, match=r'xara exports neither .*use route="portable"'):
        stand.put(2, 1, 2)
    for host in ("model", rt.Model, json):
        stand.host = host
        with pytest.raises(TypeError, match=r"ops = .* must be a model of xara, as xara\.Model\("):
            stand.put(2, 1, 2)
    assert bearing_tags(stand.ops) == (1,)


@pytest.mark.parametrize(("ndm", "ndf"), [(1, 1), (2, 2), (3, 3)])
def test_degrees_of_freedom_are_named(ndm, ndf):
    model = rt.Model(ndm=ndm, ndf=ndf)
    for node in (1, 2):
        model.node(node, *[0.0] * ndm)
    with pytest.raises(ValueError, match=f"has {ndm} coordinates and {ndf} degrees of freedom"):
        Stand(model, "portable", host=model).put(1, 1, 2)


def test_a_model_that_is_wiped_and_dropped_is_no_longer_kept():
    model = rt.Model(ndm=2, ndf=3)
    for node in (1, 2):
        model.node(node, 0.0, 0.0)
    Stand(model, "portable", host=model).put(1, 1, 2)
    model.wipe()
    assert bearing_tags(model) == ()
    kept = weakref.ref(model)
    del model
    gc.collect()
    assert kept() is None
