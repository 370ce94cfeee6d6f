"""Analyses kept from run to run: the same bits, forgotten with every change of the frame."""

import copy
import gc
import threading
import tracemalloc
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_array_equal

from frames import (
    Analysis,
    Frame,
    GroundMotion,
    ModalDamping,
    ModelError,
    ModelWarning,
    Section,
    lumped_mass,
    moment_frame,
    time_histories,
    time_history,
)
from frames import _fingerprint as digests
from frames.demo import bearing_for
from frames.solve import analysis
from frames.statics import gravity as gravity_module
from lir_element import CoulombFriction, Features, FrictionHeating
from tests.refusals import refused

MOTION = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.0, 41)), y=np.ones(41), dt=0.01)
STRUCTURE = ("node_displacement", "bearing_force", "storey_shear", "energy", "static_axial_force")


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch) -> list[int]:
    """Begin with nothing kept; return how often an equilibrium is found, an entry each."""
    monkeypatch.setattr(analysis, "_KEPT", [])
    found: list[int] = []

    def counted(*given: Any) -> Any:
        found.append(1)
        return original(*given)

    original = analysis.equilibrium_of
    monkeypatch.setattr(analysis, "equilibrium_of", counted)
    return found


def building() -> Frame:
    """Return a small building on four bearings."""
    return moment_frame((1, 1), 1, bearing=bearing_for(400e3))


def run(frame: Frame, **options: Any) -> xr.Dataset:
    """Run the motion."""
    return time_history(frame, MOTION, **options)


def same(one: xr.Dataset, other: xr.Dataset) -> bool:
    """Return whether all histories are the same to the bit."""
    return all(one[name].equals(other[name]) for name in one.variables)


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_a_second_run_is_the_first_to_the_bit(level: str, nothing_kept: list[int]) -> None:
    frame = building()
    first = run(frame, level=level)
    again = run(frame, level=level)
    assert len(nothing_kept) == 1
    assert same(first, again)
    assert same(first, run(building(), level=level))
    assert again.attrs["audit"] == first.attrs["audit"]
    assert again.attrs["seconds_gravity"] < first.attrs["seconds_gravity"]


@pytest.mark.parametrize("level", ["pendulum", {"bearing-0-0": "contact"}])
def test_runs_of_an_analysis_are_time_histories(level: Any, nothing_kept: list[int]) -> None:
    frame, features = building(), Features(rims=False)
    kept = Analysis(frame, level, features)
    first = kept.run(MOTION, dt=0.01)
    frame.add_mass("floor-1-0-0", 1e3)
    assert same(first, kept.run(MOTION, dt=0.01))
    assert len(nothing_kept) == 1
    alone = run(building(), level=level, features=features, dt=0.01)
    assert same(first, alone)
    timed = {"seconds_gravity", "seconds_loop", "date"}
    left = {name for name in alone.attrs if str(alone.attrs[name]) != str(first.attrs[name])}
    assert left <= timed


@pytest.mark.parametrize("level", ["auto", "rigid_body"])
def test_an_analysis_has_one_equilibrium(level: str) -> None:
    words = "does not share gravity states between runs: use time_history"
    refused(ValueError, words, Analysis, building(), level)
    refused(TypeError, "frame = None must be a Frame", Analysis, None)


def test_a_case_of_its_own_has_its_own(nothing_kept: list[int]) -> None:
    frame = building()
    name = next(iter(frame.bearings))
    cases: list[dict[str, Any]] = [
        {},
        {"features": Features.all().without("rims")},
        {"level": {name: "contact"}},
    ]
    for _ in range(2):
        runs = [run(frame, **case) for case in cases]
        assert len({data.attrs["features_left_out"] + data.attrs["level"] for data in runs}) == 3
    assert len(nothing_kept) == 3


CHANGES: dict[str, Callable[[Frame, str, str], None]] = {
    "mass": lambda frame, node, _: frame.add_mass(node, 5000.0),
    "load": lambda frame, node, _: frame.add_load(node, (0.0, 0.0, -9e3, 0.0, 0.0, 0.0)),
    "line load": lambda frame, _, member: frame.add_uniform_load(member, (0.0, 0.0, -2e3)),
    "damping": lambda frame, _, __: frame.set_damping(ModalDamping(0.2)),
    "support": lambda frame, node, _: frame.fix(node, "rz"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_changed_frame_is_found_anew(change: str, nothing_kept: list[int]) -> None:
    frame, fresh = building(), building()
    node, member = list(frame.nodes)[-1], list(frame.members)[-1]
    before = run(frame)
    CHANGES[change](frame, node, member)
    CHANGES[change](fresh, node, member)
    after = run(frame)
    assert len(nothing_kept) == 2
    assert not same(before, after)
    assert same(after, run(fresh))


def test_copies_share_until_one_is_changed(nothing_kept: list[int]) -> None:
    frame = building()
    first, other = run(frame), copy.copy(frame)
    assert same(first, run(other))
    assert len(nothing_kept) == 1
    other.add_mass(list(other.nodes)[-1], 9000.0)
    assert not same(first, run(other))
    assert same(first, run(frame))
    assert len(nothing_kept) == 2
    harder = frame.with_bearings(bearing_for(800e3))
    assert not same(first, run(harder))
    assert len(nothing_kept) == 3


def test_matrices_of_a_superelement_count_by_their_numbers(nothing_kept: list[int]) -> None:
    frame = building()
    top = list(frame.nodes)[-1]
    frame.add_superelement("tank", [top], np.zeros((6, 6)), np.diag([4e3] * 3 + [0.0] * 3))
    first = run(frame)
    frame.superelements["tank"].mass.data[:] *= 3.0
    assert not same(first, run(frame))
    assert len(nothing_kept) == 2


def test_what_is_done_to_a_result_stays_there() -> None:
    frame = building()
    first, untouched = run(frame), run(frame)
    for variable in first.data_vars.values():
        if variable.dtype.kind == "f" and variable.ndim:
            values = variable.values
            values[...] = 7.0
    assert same(untouched, run(frame))


def test_doubts_are_told_each_time() -> None:
    frame = Frame("on Mars", gravity=3.7)
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("plate", 0.0, 0.0, 0.0)
    frame.fix("ground", "all")
    frame.fix("plate", "rx", "ry", "rz")
    frame.add_mass("plate", 54e3)
    frame.add_bearing("bearing", "ground", "plate", bearing_for(2000e3))
    told = []
    for _ in range(3):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            analysis.analysis_of(frame, Features.all(), "pendulum")
        told.append([str(one.message) for one in caught if one.category is ModelWarning])
    assert "not the Earth" in told[0][0]
    assert told[0] == told[1] == told[2]


def test_memory_is_bounded(monkeypatch, nothing_kept: list[int]) -> None:
    frames = [building() for _ in range(3)]
    run(frames[0])
    size = analysis._KEPT[0].bytes
    monkeypatch.setattr(analysis, "MOST_BYTES", 2.2 * size)
    for frame in (*frames[1:], frames[2], frames[1], frames[0]):
        run(frame)
    assert len(nothing_kept) == 4  # the first had to make room for the last
    assert len(analysis._KEPT) == 2
    monkeypatch.setattr(analysis, "MOST_BYTES", 0.3 * size)  # its arrays alone are larger
    run(building())
    assert len(analysis._KEPT) == 2  # larger than all room: not kept, nothing given up


def test_threads_run_the_same_frame(nothing_kept: list[int]) -> None:
    frame, found = building(), {}
    first = run(frame)

    def some(k: int) -> None:
        found[k] = [run(frame) for _ in range(3)]

    threads = [threading.Thread(target=some, args=(k,)) for k in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(nothing_kept) == 1
    assert all(same(first, data) for k in range(3) for data in found[k])


def test_memory_stays_within_its_bound(monkeypatch) -> None:
    """All that is held counts, not arrays alone: of a mass on one bearing these are a seventh."""
    most = 8e5
    monkeypatch.setattr(analysis, "MOST_BYTES", most)
    frames = [lumped_mass(bearing_for(2e6), 2e5 + 1e3 * k) for k in range(16)]
    run(frames[0])
    analysis._KEPT.clear()
    gc.collect()
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        for frame in frames:
            run(frame)
        gc.collect()
        held = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert 2 <= len(analysis._KEPT) < len(frames)
    assert held < 1.5 * most  # what the last run formed is weighed when another one is kept


STIFFER = Section.rectangle(0.6, 0.6, elastic_modulus=33e9)
STRONGER = replace(bearing_for(400e3), friction=CoulombFriction(0.09))
OTHERS: dict[str, Callable[[Frame], Frame]] = {
    "friction": lambda f: f.with_bearings(STRONGER),
    "stiffness": lambda f: f.with_bearings(replace(STRONGER, axial_stiffness=3e9)),
    "one bearing": lambda f: f.with_bearings({next(iter(f.bearings)): STRONGER}),
    "rims that yield": lambda f: f.with_bearings(replace(STRONGER, rim_yield_force=1e5)),
    "heat": lambda f: f.with_bearings(replace(STRONGER, friction_heating=FrictionHeating())),
    "size": lambda f: f.with_bearings(bearing_for(500e3)),
    "floors": lambda _: moment_frame((1, 1), 1, bearing=STRONGER, floor_mass=15e3),
    "places": lambda _: moment_frame((1, 1), 1, bearing=STRONGER, bay_width=5.0),
    "columns": lambda _: moment_frame((1, 1), 1, bearing=STRONGER, column=STIFFER),
    "storeys": lambda _: moment_frame((1, 1), 2, bearing=STRONGER),
}


def test_what_sets_of_parameters_share_changes_no_bit(monkeypatch) -> None:
    assembled: list[Frame] = []

    def counted(frame: Frame, *given: Any) -> Any:
        assembled.append(frame)
        return original(frame, *given)

    original = gravity_module.assemble
    first = building()
    frames = {"first": first, **{name: other(first) for name, other in OTHERS.items()}}
    alone = {n: time_histories({n: f}, MOTION, workers=1) for n, f in frames.items()}
    single = {name: run(frame) for name, frame in frames.items()}
    monkeypatch.setattr(gravity_module, "assemble", counted)
    together = time_histories(frames, MOTION, workers=1)
    assert len(assembled) == 5  # the first, and other structures
    for k, (name, runs) in enumerate(alone.items()):
        own = runs.isel(run=0).drop_sel(quantity="seconds of the time loop")
        shared = together.isel(run=k)
        for key in {*own.data_vars} - {"seconds_loop"}:
            labels = {dim: own[dim] for dim in own[key].dims}
            assert_array_equal(own[key], shared[key].sel(labels), f"{name}: {key}")
        analysis._KEPT.clear()
        assert same(single[name], run(frames[name])), name


def test_a_mechanism_among_frames_of_one_geometry_is_refused() -> None:
    frames = {}
    for name, held in (("held", 1e6), ("loose", 0.0)):
        frames[name] = frame = building()
        frame.add_node("tank", 0.0, 0.0, 9.0)
        frame.add_mass("tank", 100.0)
        frame.add_spring("feet", next(iter(frame.members.values())).j, "tank", [1e6] + 5 * [held])
    refused(ModelError, "mechanism.*tank", time_histories, frames, MOTION, workers=1)
    frames["loose"] = frames["held"]
    assert (time_histories(frames, MOTION, workers=1)["status"] == "ok").all()


@pytest.mark.parametrize("most", [0, 5000])
def test_digests_of_frames_together_are_those_of_each(most: int, monkeypatch) -> None:
    monkeypatch.setattr(digests, "_MOST_KNOWN", most)
    first = building()
    frames = {"first": first, **{name: other(first) for name, other in OTHERS.items()}}
    found = digests.fingerprints(frames)
    assert found == {name: digests.fingerprint(frame) for name, frame in frames.items()}
    assert len({*found.values()}) == len(frames)
