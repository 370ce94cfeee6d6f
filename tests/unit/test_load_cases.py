"""Load cases, their combinations, and loads that are masses."""

import copy
import pickle  # noqa: S403

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from frames import Frame, ModelError, Section
from frames.assembly.assemble import assemble
from frames.design import isolator_combinations
from frames.model.sanity_checks import sanity_warnings
from tests.refusals import refused
from tests.scenes import simple_bearing

SECTION = Section.box(0.3, 0.3, 0.02)
CASES = {"D": 1.2, "L": 0.5, "S": 0.0}


BEARING = simple_bearing()


def table(loaded=("D", "L", "S")):
    """Return a table of four legs with loads of every kind in each of the cases."""
    frame = Frame("table")
    corners = {"a": (0, 0), "b": (6, 0), "c": (6, 4), "d": (0, 4)}
    for name, (x, y) in corners.items():
        frame.add_node(f"foot-{name}", x, y, 0.0)
        frame.add_node(name, x, y, 3.0)
        frame.fix(f"foot-{name}", "all")
        frame.add_member(f"leg-{name}", f"foot-{name}", name, SECTION)
    for i, j in zip("abcd", "bcda", strict=True):
        frame.add_member(i + j, i, j, SECTION)
    frame.add_mass("a", 700.0, (1.0, 2.0, 3.0))
    for k, case in enumerate(("D", "L", "S"), start=1):
        if case in loaded:
            frame.add_load("b", (10.0 * k, 0.0, -2e3 * k, 0.0, 3.0 * k, 0.0), case=case)
            frame.add_uniform_load("ab", (0.0, 7.0 * k, -3e3 * k), case=case)
            frame.add_tapered_load("bc", (0, 0, -1e3 * k), (0, 0, -5e3 * k), 0.5, 2.0, case=case)
            frame.add_floor_load(f"slab-{case}", list("abcd"), 1e3 * k, case=case)
    return frame


def test_a_combination_is_the_sum_of_its_cases():
    load = assemble(table().combined(CASES)).node_load
    weights = assemble(table(())).node_load
    parts = {case: assemble(table((case,))).node_load - weights for case in CASES}
    expected = 1.2 * weights + sum(factor * parts[case] for case, factor in CASES.items())
    assert_allclose(load, expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())
    assert_array_equal(assemble(table().combined(CASES)).node_mass, assemble(table(())).node_mass)


def test_loads_without_a_case_are_dead_loads():
    given, plain = table(("D",)), Frame("none")
    plain.add_node("n", 0.0, 0.0, 0.0)
    plain.add_load("n", (0.0, 0.0, -1.0, 0.0, 0.0, 0.0))
    assert given.load_cases == plain.load_cases == ("D",)
    assert_array_equal(assemble(given.combined({"D": 1.0})).node_load, assemble(given).node_load)
    assert table().load_cases == ("D", "L", "S")


def test_the_frame_stays_and_a_combination_can_be_combined():
    frame = table()
    before = assemble(frame).node_load
    twice = frame.combined(CASES, "first").combined({"D": 0.5, "L": 2.0, "S": 1.0})
    assert_array_equal(assemble(frame).node_load, before)
    assert twice.name == "first"
    assert twice.weight_factor == pytest.approx(0.6)
    direct = assemble(frame.combined({"D": 0.6, "L": 1.0, "S": 0.0})).node_load
    assert_allclose(assemble(twice).node_load, direct, atol=1e-12 * np.abs(before).max())


def test_weights_may_belong_to_another_case():
    frame = table(("L",))
    own = assemble(table(())).node_load
    light = frame.combined({"own": 0.9, "L": 0.0}, weight="own")
    assert_allclose(assemble(light).node_load, 0.9 * own, rtol=1e-12)


@pytest.mark.parametrize(
    ("factors", "words"),
    [
        ({"D": 1.0, "L": 1.0}, 'load case "S".*has no factor'),
        ({"L": 1.0}, 'load case "D".*weigh'),
        ({"D": float("inf"), "L": 1.0, "S": 1.0}, 'factor of load case "D"'),
    ],
)
def test_combinations_that_leave_something_open(factors, words):
    refused(ModelError, words, table().combined, factors)
    refused(ValueError, "s_ms", isolator_combinations, -1.0)


def test_a_mass_source_makes_mass_that_weighs_once():
    frame, bare = table(), assemble(table())
    frame.set_mass_source({"D": 1.0, "L": 0.25})
    system = assemble(frame)
    assert_array_equal(system.node_load, bare.node_load)
    made = (system.node_mass - bare.node_mass)[:, :3]
    assert_array_equal(made[:, 0], made[:, 2])
    case = 2e3 + 3e3 * 6.0 + 0.5 * (1e3 + 5e3) * 1.5 + 1e3 * 24.0
    assert made[:, 0].sum() == pytest.approx((case + 0.25 * 2.0 * case) / frame.gravity)
    assert not (system.node_mass - bare.node_mass)[:, 3:].any()
    share = 1.5 * (2e3 + 9e3 + 12e3 / 2)  # node b: its load, half of ab and of a fourth of the slab
    lever = 1.5 * ((0.5 + 0.75) * 1e3 * 1.5 + (0.5 + 1.0) * 4e3 * 0.75) / 4.0  # by hand, of bc
    whole = 1.5 * 4.5e3
    at_b = made[system.node_names.index("b"), 0] * frame.gravity
    assert at_b == pytest.approx(share + whole - lever)
    frame.set_mass_source(None)
    assert_array_equal(assemble(frame).node_mass, bare.node_mass)


def test_a_load_at_a_node_as_mass_or_as_mass_that_does_not_weigh():
    by_source, by_hand = table(("D",)), table(("D",))
    for frame in (by_source, by_hand):
        frame.remove("floor load", "slab-D")
        for member in ("ab", "bc"):
            frame.remove("member", member)
    by_source.set_mass_source({"D": 0.5})
    by_hand.add_mass("b", 0.5 * 2e3 / by_hand.gravity, weighs=False)
    ours, theirs = assemble(by_source), assemble(by_hand)
    assert_allclose(ours.node_mass, theirs.node_mass, rtol=1e-12)
    assert_allclose(ours.node_load, theirs.node_load, rtol=1e-12)
    by_hand.remove("mass", "b")
    assert not by_hand.weightless_masses


def test_masses_of_loads_stay_in_a_combination_or_follow_it():
    frame = table()
    frame.set_mass_source({"D": 1.0, "L": 0.25})
    kept = assemble(frame.combined(isolator_combinations()["minimum"]))
    assert_allclose(kept.node_mass, assemble(frame).node_mass, rtol=1e-12)
    followed = assemble(frame.combined(CASES, masses=True))
    down = assemble(frame.combined(CASES)).node_load[2::6].sum()
    assert -followed.node_load[2::6].sum() == pytest.approx(-down)
    assert followed.node_mass[:, 2].sum() * frame.gravity == pytest.approx(-down)
    frame.add_mass("a", 1.0, weighs=False)
    refused(ModelError, "masses that do not weigh", frame.combined, CASES, masses=True)
    with pytest.raises(ModelError, match="must be positive"):
        table().combined({"D": 0.0, "L": 1.0, "S": 1.0}, masses=True)


def test_what_cannot_be_mass():
    frame = table()
    refused(TypeError, r'write {"D": 1.0', frame.set_mass_source, 0.25)
    refused(TypeError, r'write {"D": 1.2', frame.combined, 1.2)
    refused(ModelError, 'share of case "L"', frame.set_mass_source, {"L": -0.1})
    frame.add_load("d", (0.0, 0.0, 9e9, 0.0, 0.0, 0.0), case="wind")
    frame.set_mass_source({"wind": 1.0})
    refused(ModelError, 'node "d" is negative', assemble, frame)
    floating = Frame("space", gravity=0.0)
    refused(ModelError, "0 m/s2 cannot convert loads", floating.set_mass_source, {"D": 1.0})


def test_a_mass_source_without_loads_is_a_doubt():
    frame = table(("D", "L"))
    frame.set_mass_source({"D": 1.0, "LL": 0.25, "S": 0.0})
    (doubt,) = [note for note in sanity_warnings(frame) if "set_mass_source" in note]
    assert '"LL"' in doubt
    assert "the cases are D, L" in doubt
    frame.set_mass_source({"D": 1.0, "L": 0.25})
    assert not [note for note in sanity_warnings(frame) if "set_mass_source" in note]


def test_superelements_count_as_weight():
    frame = table(())
    load = np.zeros(6)
    load[2] = -4e3
    frame.add_superelement("machine", ["a"], np.zeros((6, 6)), np.diag([400.0] * 6), load=load)
    ours, plain = assemble(frame.combined({"D": 0.9})), assemble(frame)
    assert_allclose(ours.node_load, 0.9 * plain.node_load, rtol=1e-12)
    assert_array_equal(ours.node_mass, plain.node_mass)


def pickled(frame):
    return pickle.loads(pickle.dumps(frame))  # noqa: S301


@pytest.mark.parametrize("how", [Frame.copy, copy.deepcopy, pickled])
def test_copies_carry_everything_and_are_apart(how):
    frame = table()
    frame.set_mass_source({"D": 1.0})
    frame.add_mass("c", 5.0, weighs=False)
    frame.add_member("diagonal", "a", "c", SECTION, offsets={"i": (0.2, 0.1, 0.0)})
    other = how(frame)
    for name in ("node_load", "node_mass"):
        assert_array_equal(getattr(assemble(other), name), getattr(assemble(frame), name))
    before = assemble(frame).node_load
    other.add_load("b", (0.0, 0.0, -1.0, 0.0, 0.0, 0.0), case="L")
    other.add_uniform_load("ab", (0.0, 0.0, -1.0), case="new")
    other.add_tapered_load("ab", (0.0, 0.0, -1.0), (0.0, 0.0, -1.0))
    other.remove("floor load", "slab-D")
    other.set_mass_source({"L": 1.0})
    assert_array_equal(assemble(frame).node_load, before)
    assert frame.load_cases == ("D", "L", "S")
    assert not other.loads["b"].flags.writeable
