"""Random test cases: the same from the same numbers; every check sees what it is there for."""

import json
import os
import time

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import gravity, moment_frame
from lir_element import AnalysisError, LIRBearing, RunStatus
from tests.scenes import paper_bearing
from validation.fuzzing import trial
from validation.fuzzing.buildings import try_building
from validation.fuzzing.checks import (
    LATE,
    Report,
    check_gravity,
    check_result,
    forces_on_springs,
    left_over,
    same,
    same_end,
)
from validation.fuzzing.motions import mirrored, turned
from validation.fuzzing.page import KINDS, write
from validation.fuzzing.pool import in_children
from validation.fuzzing.scenes import random_scene
from validation.fuzzing.trial import (
    change,
    compare_features,
    compare_runs,
    compare_steps,
    run,
    sensitivity,
)
from validation.random_scenes import arguments, lost, main, tasks

SEED, CALM = 1, 26  # a mass in vertical motion, Newmark, a given step
"""A series and a test case of it that has nothing to find."""
MIXED = 342
"""A test case of it with one bearing of a grid at the level "contact"."""


@pytest.fixture(scope="module")
def result():
    scene = next(
        s
        for s in (random_scene(SEED, n) for n in range(CALM, 400))
        if s.model == "mass"
        and s.level == "pendulum"
        and s.is_newmark
        and s.options["dt"] is not None
        and s.options["dt"] <= s.motion.dt
        and s.motion.z is None
        and "x" in s.describe().split("motion ")[1][:3]
    )
    model, data, _ = run(scene, scene.motion)
    assert data.attrs["halvings"] == 0
    return scene, model, data


def kinds(result, data: xr.Dataset) -> set[str]:
    scene, model, _ = result
    report = Report(0, "", scene.model, scene.level)
    if data.attrs["status"] != "ok":
        report.warnings = [data.attrs["message"]]
    check_result(report, scene, model, data)
    return {kind for kind, _, _ in report.findings}


def test_a_sound_result_has_no_findings(result):
    assert kinds(result, result[2]) == set()


def spoil(name: str, place: int, factor: float):
    def change_values(data: xr.Dataset) -> None:
        data[name].to_numpy()[place] *= factor

    return change_values


def energy(term: str, share: float):
    def change_values(data: xr.Dataset) -> None:
        most = float(np.abs(data["energy"].sel(term="input")).max())
        data["energy"].loc[{"term": term}] += share * most

    return change_values


def shifted(one: str, other: str, share: float):
    def change_values(data: xr.Dataset) -> None:
        energy(one, share)(data)
        energy(other, -share)(data)

    return change_values


def attributes(**values):
    return lambda data: data.attrs.update(values)


def cut(data: xr.Dataset) -> xr.Dataset:
    return data.isel(time=slice(0, -2))


MESSAGE = "at t = 9 s, here: it failed. What to try: something."
FAILED = {"status": "newton_failed", "message": MESSAGE, "failed_at": 9.0, "failed_where": "here"}
EARLY = {**FAILED, "message": MESSAGE.replace("9 s", "0 s"), "failed_at": 0.0}
SPOILT = [
    ("end", cut),
    ("end", attributes(status="odd")),
    ("end", attributes(**{**FAILED, "message": "it failed"})),
    ("end", attributes(**{**FAILED, "failed_where": ""})),
    ("end", attributes(**EARLY)),
    ("not finite", spoil("node_acceleration", 5, np.nan)),
    ("limits", spoil("axial_force", 7, -1.0)),
    ("limits", lambda data: data["rim_closure"].to_numpy().__setitem__(7, 10.0)),
    ("ledger", energy("kinetic", 2e-3)),
    ("numerical", shifted("numerical", "kinetic", 2e-3)),
    ("given back", spoil("work_low_friction", -1, 0.5)),
    ("store", lambda data: data["work_friction_elastic"].to_numpy().__setitem__(3, -1e9)),
    ("balance", spoil("node_acceleration", -9, 1.5)),
    ("works", shifted("contact", "kinetic", 5e-3)),
]


@pytest.mark.parametrize(("kind", "spoilt"), SPOILT)
def test_each_check_sees_what_it_is_there_for(result, kind, spoilt):
    data = result[2].copy(deep=True)
    data.attrs = dict(data.attrs)
    changed = spoilt(data)
    assert kind in kinds(result, data if changed is None else changed)
    assert kind in KINDS


def test_a_run_that_calls_itself_inaccurate_may_have_an_open_ledger(result):
    data = result[2].copy(deep=True)
    shifted("numerical", "kinetic", 2e-3)(data)
    data.attrs = {
        **data.attrs,
        **FAILED,
        "status": "inaccurate",
        "failed_at": float(data["time"][-1]),
    }
    data.attrs["message"] = f"at t = {data.attrs['failed_at']:.6g} s: so. What to try: less."
    assert "numerical" not in kinds(result, data)


def test_a_run_may_say_what_its_damping_took_out(result):
    data = result[2].copy(deep=True)
    shifted("numerical", "kinetic", 2e-3)(data)
    share = float(np.abs(data["energy"].sel(term="numerical")).max())
    share /= float(np.abs(data["energy"].sel(term="input")).max())
    data.attrs["message"] = f"completed: it took out {100.0 * share:.3g} % of the energy"
    assert "numerical" not in kinds(result, data)
    assert "end" in kinds(result, data)  # for it did not warn


def test_work_that_friction_owes_is_work_of_the_forces(result):
    data = result[2].copy(deep=True)
    shifted("numerical", "low_friction_bottom", -5e-3)(data)
    assert "works" not in kinds(result, data)


def test_a_bit_makes_a_difference(result):
    data = result[2]
    other = data.copy(deep=True)
    other["bearing_force"].to_numpy()[4] = np.nextafter(other["bearing_force"].to_numpy()[4], 1e9)
    assert same(data, data.copy(deep=True)) == ""
    assert same(data, other) == "bearing_force"
    assert same(data, data.assign_attrs(steps=1)) == "steps"
    assert same(data, data.assign_attrs(seconds_loop=-1.0)) == ""


def test_changes_are_measured_over_the_peak(result):
    data = result[2]
    other = data.copy(deep=True)
    moved = data["bearing_displacement"].copy()
    other["bearing_displacement"] *= 1.01
    assert change(data, other) == pytest.approx(0.01)
    report = Report(0, "", "mass", "pendulum")
    assert compare_steps(report, result[1], other, data)
    assert report.peak_error == pytest.approx(0.01)
    assert not compare_steps(report, result[1], other.assign_attrs(status="newton_failed"), data)
    compare_features(report, data, data)
    assert report.findings == []
    larger = data.assign(bearing_displacement=1.2 * moved)
    report.sensitivity = 0.02  # 0.2 / 1.2 is less than ten times that
    compare_features(report, data, larger)
    assert report.findings == []
    report.sensitivity = 0.01
    compare_features(report, data, larger)
    assert report.findings[-1][0] == "auto"


def failing(data: xr.Dataset, status: str, time: float) -> xr.Dataset:
    return data.assign_attrs(status=status, failed_at=time)


def test_a_bearing_fails_at_both_steps_or_at_none(result):
    _, model, data = result
    failed = failing(data, "slip_exceeded", 1.0)
    assert same_end(model, failed, failing(data, "sphere_exceeded", 1.0 + 0.9 * LATE), 0.0)
    assert not same_end(model, failed, failing(data, "sphere_exceeded", 1.0 + 1.1 * LATE), 0.0)
    assert not same_end(model, failed, failing(data, "newton_failed", 1.0), np.inf)
    assert same_end(model, data, data.assign_attrs(status="inaccurate"), 0.0)


@pytest.mark.parametrize(
    "status", ["slip_exceeded", "rim_overrun", "slip_unstable", "sphere_exceeded"]
)
def test_a_run_that_completes_may_have_missed_a_limit_by_its_error(result, status):
    _, model, data = result
    half = float(data["time"][-1]) / 2.0
    limited = near(model, data, status)
    failed = failing(data, status, half)
    assert left_over(model, limited, status) == pytest.approx(1e-3, rel=1e-6)
    assert same_end(model, limited, failed, 1.001e-3)
    assert same_end(model, failed, limited, 1.001e-3)
    assert not same_end(model, limited, failed, 0.999e-3)
    early = failing(data, status, 0.5 * half)  # what happens long after is another thing
    assert not same_end(model, limited, early, 1.001e-3)


def near(model, data: xr.Dataset, status: str) -> xr.Dataset:
    """Return a result in which the bearing comes within a millimetre of a limit, half through."""
    data = data.copy(deep=True)
    ((name, link),) = model.bearings.items()
    limits, length = link.bearing.resolved(), link.bearing.effective_radius
    place = len(data["time"]) // 2
    own = data.sel(bearing=name)
    for quiet in ("interface_slip_size", "rim_closure", "bearing_displacement"):
        data[quiet] *= 0.0
    data["axial_force"] += 2.0 * abs(float(data["axial_force"].min()))
    if status == "rim_overrun":
        data["rim_closure"][{"time": place}] = limits["rim_overrun"] - 1e-3
    elif status == "sphere_exceeded":
        data["bearing_displacement"].loc[{"axis": "y"}][{"time": place}] = (
            length * np.sin(np.radians(72.0)) - 1e-3
        )
    else:
        data["interface_friction"] = xr.full_like(data["interface_friction"], 0.2)
        friction = (own["friction_coefficient"] * own["radius"]).sum("surface")
        most = 0.2 * length + float(friction[place])
        largest = limits["slip_capacity"] if status == "slip_exceeded" else most
        data["interface_slip_size"][{"time": place}] = largest - 1e-3
    return data


def test_another_end_at_a_finer_step_is_found(monkeypatch):
    """The reference is made to say that its bearing failed."""
    scene = next(s for s in (random_scene(SEED, n) for n in range(99)) if chooses(s))
    report = Report(0, "", scene.model, scene.level, controlled=True)
    model, data, _ = run(scene, scene.motion)
    failed = run(scene, scene.motion)[1].assign_attrs(status="slip_exceeded", failed_at=0.1)

    def pretend(scene, motion, **changes):
        return (model, failed, []) if "dt" in changes else run(scene, motion, **changes)

    monkeypatch.setattr(trial, "run", pretend)
    compare_runs(report, scene, model, data, finer=True)
    assert [kind for kind, _, _ in report.findings] == ["finer ends differently"]


def chooses(scene) -> bool:
    """Return whether it is a mass at a step that the program chooses."""
    return scene.model == "mass" and scene.level == "pendulum" and scene.options["dt"] is None


def test_a_calm_scene_is_not_sensitive(result):
    scene, _, data = result
    changed, ends = sensitivity(scene, data)
    assert 0.0 < changed < 1e-6
    assert ends == {"ok"}


def test_a_scene_is_the_same_from_the_same_numbers():
    for number in (0, 7, 13):
        one, other = random_scene(SEED, number), random_scene(SEED, number)
        assert one.describe() == other.describe()
        assert one.options == other.options
        assert np.array_equal(one.motion.components, other.motion.components)
    assert random_scene(SEED, 0).describe() != random_scene(SEED + 1, 0).describe()


def test_scenes_have_everything_in_them():
    scenes = [random_scene(SEED, number) for number in range(300)]
    bearings = [link.bearing for s in scenes for link in s.build(False).bearings.values()]
    assert {s.model for s in scenes} == {
        "mass",
        "tilting mass",
        "stick",
        "stick on a grid",
        "frame",
    }
    assert {s.level for s in scenes} == {"pendulum", "contact", "rigid_body", "auto", "mixed"}
    assert {s.options["integrator"] for s in scenes} == {None, "newmark", "generalised-alpha"}
    assert {s.options["dt"] is None for s in scenes} == {True, False}
    assert any(s.options["dt"] and s.options["dt"] > 2.0 * s.motion.dt for s in scenes)
    assert any(s.motion.z is not None and s.motion.peak["z"] > 9.80665 for s in scenes)
    assert min(s.length for s in scenes) < 0.12
    assert max(s.length for s in scenes) > 7.0
    assert {b.friction_law for b in bearings} == {"elastic-plastic", "bouc-wen"}
    assert {type(law).__name__ for b in bearings for law in b.frictions} == {
        "CoulombFriction",
        "VelocityFriction",
    }
    assert any(b.is_dcfp for b in bearings)
    assert any(np.isinf(b.lateral_capacity) for b in bearings)
    assert any(not np.isclose(*np.divide(b.rim_displacement, b.radii)) for b in bearings)
    assert all(isinstance(b, LIRBearing) for b in bearings)


@pytest.mark.parametrize(("lift", "is_found"), [(0.5, True), (1.5, False)])
def test_uplift_is_believed_where_springs_pull(lift, is_found):
    bearing = paper_bearing(slider_radius=0.1, friction=0.05, interface_friction=0.1)
    model = moment_frame(bays=(1, 1), storeys=1, bearing=bearing)
    own = forces_on_springs(model)
    assert_allclose(own, own.mean(), rtol=1e-9)  # four corners alike
    assert_allclose(own, gravity(model).axial_forces, rtol=1e-6)
    model.add_load("base-0-0", (0.0, 0.0, lift * own[0], 0.0, 0.0, 0.0))
    report = Report(0, "", "frame", "contact")
    check_gravity(report, model, AnalysisError(RunStatus.UPLIFTED, 0.0, "gravity"))
    assert report.outcome == "uplifted"
    assert bool(report.findings) is is_found
    check_gravity(report, model, AnalysisError(RunStatus.NO_REST, 0.0, "gravity"))
    assert report.findings


@pytest.mark.parametrize("number", [225, 309])
def test_buildings_on_stiff_friction_rest_on_their_sliders(number):
    report = try_building(SEED, number)
    assert (report.level, report.outcome, report.findings) == ("contact", "ok", [])


def test_turns_and_mirrors():
    motion = random_scene(SEED, 0).motion
    x, y, z = turned(motion, 0.5 * np.pi).components.T
    assert np.array_equal(x, -motion.components[:, 1])
    assert np.array_equal(y, motion.components[:, 0])
    assert np.array_equal(z, motion.components[:, 2])
    assert np.array_equal(mirrored(motion).components, motion.components * [1.0, -1.0, 1.0])


def test_what_is_said_of_a_bearing_holds_for_its_image_in_the_mirror():
    scene = random_scene(SEED, MIXED)
    level, seen = scene.options["level"], scene.options_of(True)["level"]
    (name,) = level
    assert seen == {scene.images()[name]: "contact"} != level
    assert scene.options_of(False) is scene.options
    there, back = scene.images(), scene.images()
    assert [back[there[name]] for name in there] == list(there)
    places = [scene.build(False).bearings[name].bearing for name in there]
    assert [scene.build(True).bearings[image].bearing for image in there.values()] == places


def test_the_mirror_image_of_a_mixed_scene_moves_alike():
    report = Report(0, "", "stick on a grid", "mixed")
    scene = random_scene(SEED, MIXED)
    model, data, _ = run(scene, scene.motion)
    compare_runs(report, scene, model, data, finer=False)
    assert report.findings == []
    assert report.mirror < 1e-8  # contacts amplify round-off, by the processor


def test_what_hangs_or_dies_does_not_take_the_rest_along():
    slept = list(in_children(time.sleep, [0.0, 60.0, 0.01], workers=1, limit=1.0))
    assert slept == [(0.0, None, ""), (60.0, None, "hang"), (0.01, None, "")]
    died = list(in_children(os._exit, [3], workers=2, limit=5.0))
    assert died == [(3, None, "crash")]


def test_tasks_are_scenes_with_buildings_in_between():
    given = list(tasks(25, 4, float("inf")))
    assert [n for kind, n in given if kind == "scene"] == list(range(25))
    assert [n for kind, n in given if kind == "building"] == list(range(4))
    assert list(tasks(25, 4, -1.0)) == []


def test_the_page_lists_what_was_found(tmp_path, monkeypatch):
    monkeypatch.setattr("validation.page.FOLDER", tmp_path)
    entries = [lost(("scene", n), how, SEED) for n, how in ((3, "hang"), (4, "crash"))]
    building = lost(("building", 0), "crash", SEED)
    assert "2 test cases and 1 buildings" in write(entries, [building], "the command", "no time")
    kinds, found = (
        (tmp_path / f"tables/random_scenes-{name}.csv").read_text()
        for name in ("checks", "findings")
    )
    assert found.count(",hang,no report: hang,") == 1
    assert found.count(",crash,no report: crash,") == 2
    assert "no end within the limit of time,2,1\n" in kinds
    assert 'the peak differs by more than 0.01",1,0\n' in kinds  # test case 4
    json.dumps(entries)


@pytest.mark.nightly
def test_the_command(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("validation.page.FOLDER", tmp_path)
    kept, target = tmp_path / "kept.jsonl", tmp_path / "page.md"
    target.write_text("# Robustness\n<!-- random_scenes: begin --><!-- random_scenes: end -->")
    call = ["--count", "1", "--buildings", "1", "--page", str(target), "--keep", str(kept)]
    main(call)
    assert len(kept.read_text(encoding="utf-8").splitlines()) == 2
    assert "## Random test cases\n" in target.read_text(encoding="utf-8")
    main(["--only", "26"])
    assert "number: 26" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        arguments(["--count", "0"])
