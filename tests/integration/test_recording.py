"""What a run records against the whole record: the same numbers, less memory."""

import dataclasses
import gc
import signal
import tracemalloc
import warnings

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    AuditWarning,
    GroundMotion,
    ModelError,
    Recording,
    audit,
    audit_report,
    drift_by_line,
    ductility,
    energy_error,
    envelope,
    floor_acceleration,
    floor_spectrum,
    force_tables,
    load,
    lumped_mass,
    member_forces,
    moment_frame,
    peaks,
    save,
    storey_drift,
    storey_forces,
    summary,
    support_reactions,
    time_history,
    uplift_gap,
)
from frames.laws import Bilinear, Gap, PlasticHinge, ViscousDamper
from frames.plots import (
    bearing_plan,
    bearing_sections,
    hysteresis,
    model_view,
    orbits,
    worst_bearing,
)
from frames.recording.reduction import Reduction, reduced
from frames.results.recorded import is_of_all_steps
from frames.solve import recorder
from lir_element import (
    AnalysisError,
    AnalysisInterrupted,
    AnalysisWarning,
    Features,
    VelocityFriction,
)
from tests.scenes import simple_bearing as device

DT = 0.005
TIME = np.arange(0.0, 4.0, DT)
BELL = np.exp(-(((TIME - 1.5) / 0.9) ** 2))
WAVE = 1.7 * BELL * np.sin(2 * np.pi * TIME / 1.4)
SIDE = BELL * np.sin(2 * np.pi * TIME / 0.8)
UP = 6.0 * np.exp(-((TIME - 2.0) ** 2)) * np.sin(12.0 * TIME)


def building():
    """Return a building with a heavy corner, whose rims are met."""
    frame = moment_frame((2, 1), 2, bearing=device(friction=VelocityFriction(0.05, 0.03, 20.0)))
    frame.add_mass("floor-2-2-1", 4e4)
    return frame


def yielding():
    """Return a building with hinges, a damper, a brace and walls that are met."""
    hinge = PlasticHinge(moment_y=1.5e5, moment_z=1.5e5)
    frame = moment_frame((1, 1), 1, bearing=device(), hinges={"column": hinge})
    brace = Bilinear(stiffness=1e7, yield_force=2e4, hardening=0.02)
    frame.add_link("brace", "base-0-0", "floor-1-1-0", brace)
    frame.add_link("damper", "base-0-1", "floor-1-1-1", ViscousDamper(coefficient=1e4))
    frame.add_moat("moat", ["base-0-0"], Gap(gap=0.08, stiffness=1e8, damping=1e5))
    return frame


SHAKEN = GroundMotion(x=WAVE, y=SIDE, dt=DT)
THROWN = GroundMotion(x=WAVE, z=2.0 * UP, dt=DT)
SCENES = {
    "impacts": (building(), SHAKEN, {}),
    "yielding": (yielding(), SHAKEN.scaled(1.5), {}),
    "uplift": (lumped_mass(device(), 3e4), THROWN, {}),
    "left out": (
        lumped_mass(device(), 3e4),
        SHAKEN,
        {"features": Features(vertical_coupling=False, uplift=False, second_direction=False)},
    ),
    "failure": (lumped_mass(device(slip_capacity=0.004), 3e4), SHAKEN, {}),
    "contact": (lumped_mass(device(), 3e4), SHAKEN, {"level": "contact", "duration": 2.5}),
    "auto": (lumped_mass(device(), 3e4), THROWN, {"level": "auto", "duration": 2.5}),
    "rigid": (lumped_mass(device(), 3e4), SHAKEN, {"level": "rigid_body", "duration": 2.5}),
}
RECORDINGS = {
    "every": Recording(every=7),
    "impacts": Recording.impacts(0.05, 0.1, every=11),
    "windows": Recording(every=None, around_impacts=(0.3, 0.0)),
    "peaks": Recording.peaks(),
}


def analyse(scene: str, **options) -> xr.Dataset:
    model, motion, own = SCENES[scene]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", AuditWarning)
        return time_history(model, motion, **own, **options)


@pytest.fixture(scope="module")
def whole():
    """Return the whole record of a test case, made once."""
    made: dict[str, xr.Dataset] = {}

    def of(scene: str) -> xr.Dataset:
        if scene not in made:
            made[scene] = analyse(scene)
        return made[scene]

    return of


@pytest.fixture(params=[64])
def small_buffer(request, monkeypatch):
    """Have the buffer emptied many times; the run has 800 steps."""
    monkeypatch.setattr(recorder, "BUFFER", 0.0)
    monkeypatch.setattr(recorder, "LEAST_ROWS", request.param)


def table_of(data: xr.Dataset) -> pd.DataFrame:
    return peaks(data).drop("seconds of the time loop")


def steps_of(data: xr.Dataset, recording: Recording) -> np.ndarray:
    """Return which steps of a whole record are asked for: by comparison of all with all."""
    time, step = data["time"].to_numpy(), np.arange(data.sizes["time"])
    ends = np.isin(step, [0, step[-1]])
    wanted = step % recording.every == 0 if recording.every else ends
    if recording.around_impacts is None:
        return wanted
    before, after = recording.around_impacts
    met = (data["rim_force"] > 0.0).any(["bearing", "surface"]).to_numpy()
    since = time[:, None] - time[met][None]
    return wanted | ((since >= -before - 1e-9) & (since <= after + 1e-9)).any(axis=1)


PAIRS = [("impacts", kind, 64) for kind in RECORDINGS]
PAIRS += [("impacts", kind, 150) for kind in ("impacts", "peaks")]  # rows that divide no steps
PAIRS += [  # each other scene with one kind, each kind with one or two: all that differ in loops
    (scene, kind, 64)
    for scene, kind in zip(list(SCENES)[1:], 2 * list(RECORDINGS), strict=False)
    if scene != "rigid"
]
PAIRS += [("rigid", "windows", 64)]  # takes its steps further apart: no `every`


@pytest.mark.parametrize(("scene", "kind", "small_buffer"), PAIRS, indirect=["small_buffer"])
def test_the_same_numbers_as_in_the_whole_record(scene, kind, whole, small_buffer):
    recording, full = RECORDINGS[kind], whole(scene)
    data = analyse(scene, recording=recording)
    wanted = steps_of(full, recording)
    assert 2 <= wanted.sum() < len(wanted)
    assert_array_equal(data["time"], full["time"][wanted])
    for name in full.data_vars:
        expected = full[name].isel(time=wanted) if "time" in full[name].dims else full[name]
        assert_array_equal(data[name], expected, err_msg=str(name))
    # what is judged is the whole run
    assert data.attrs["audit"] == full.attrs["audit"]
    assert audit_report(data) == audit_report(full)
    for one, other in zip(audit(data), audit(full), strict=True):
        assert_allclose(one.number, other.number, rtol=1e-12)  # sums in another order
        assert dataclasses.replace(one, number=0.0) == dataclasses.replace(other, number=0.0)
    for name in ("status", "message", "energy_error", "numerical_share", "failed_at", "steps"):
        assert data.attrs.get(name) == full.attrs.get(name), name
    assert energy_error(data) == energy_error(full)
    mine, theirs = table_of(data), table_of(full)
    assert_allclose(mine["value"], theirs["value"], rtol=1e-12)
    assert_array_equal(mine["time"], theirs["time"])
    assert mine["where"].tolist() == theirs["where"].tolist()
    assert summary({"a": data}).shape == summary({"a": full}).shape
    assert ductility(data).equals(ductility(full))
    assert data.attrs["recording"] == str(recording)


def test_the_scenes_are_what_they_are_for(whole):
    assert float(whole("impacts")["rim_force"].max()) > 0.0
    assert peaks(whole("uplift")).loc["uplifts, all bearings", "value"] > 3.0
    rows = peaks(whole("yielding"))["value"]
    assert rows["link ductility"] > 1.0
    assert rows["plastic rotation of hinges"] > 1e-4
    assert rows["force of a wall"] > 1e5
    assert whole("failure").attrs["status"] == "slip_exceeded"
    assert "vertical coupling left out" in whole("left out").attrs["audit"]
    assert "body_rotation" in whole("contact")
    assert "run 2" in whole("auto").attrs["auto_runs"]


@pytest.mark.parametrize("kind", RECORDINGS)
@pytest.mark.parametrize(
    "cuts",
    [[(0, 300), (298, 800)], [(0, 300), (120, 500), (120, 800)], [(0, 300), (0, 800), (0, 800)]],
    ids=["overlap of two", "interrupted while emptied", "nothing new at the end"],
)
def test_pieces_may_overlap(cuts, kind, whole):
    full, reduction = whole("impacts"), Reduction(RECORDINGS[kind])
    for k, (first, end) in enumerate(cuts, start=1):
        piece = full.isel(time=slice(first, end))
        reduction.take(piece, first, final=k == len(cuts))
    data = reduction.recorded(reduction.without_histories().assign_attrs(full.attrs))
    at_once = reduced(full, RECORDINGS[kind])
    assert data.sizes == at_once.sizes
    for name in data.variables:
        if data[name].dtype.kind == "f":
            assert_allclose(data[name], at_once[name], rtol=1e-12, err_msg=str(name))


@pytest.mark.parametrize("scene", ["impacts", "contact", "failure"])
def test_extremes_are_the_envelopes_of_the_whole_record(scene, whole, small_buffer):
    full, data = whole(scene), analyse(scene, recording=Recording.peaks())
    assert data.sizes["time"] == 2
    histories = [name for name in full.data_vars if "time" in full[name].dims]
    assert len(histories) > 20
    for name in histories:
        xr.testing.assert_identical(envelope(data, name), envelope(full[name]))
        xr.testing.assert_identical(envelope(full, name), envelope(full[name]))


def test_parts_go_together(whole, small_buffer):
    full = whole("impacts")
    recording = Recording(
        every=25, around_impacts=(0.0, 0.02), channels=("energy", "bearing_force"), extremes=True
    )
    data = analyse("impacts", recording=recording)
    wanted = steps_of(full, recording)
    assert {n for n in data.data_vars if "time" in data[n].dims} == {"energy", "bearing_force"}
    assert_array_equal(data["energy"], full["energy"][wanted])
    found = envelope(data, "bearing_force")
    assert_array_equal(found["largest"], full["bearing_force"].max("time"))
    with pytest.raises(ValueError, match="envelope: data has no axial_force; its recording is"):
        envelope(data, "axial_force")


def test_chosen_bearings_and_nodes(whole, small_buffer):
    full = whole("impacts")
    recording = Recording(
        bearings=["bearing-1-1", "bearing-0-0"], nodes=["base-0-0"], levels=["floor-1"], every=10
    )
    data = analyse("impacts", recording=recording)
    nodes = ["base-0-0", *(str(n) for n in full["node"].to_numpy() if "floor-1" in str(n))]
    assert sorted(data["node"].to_numpy()) == sorted(nodes)
    part = full.sel(bearing=data["bearing"], node=data["node"])
    for name in ("bearing_force", "node_displacement", "static_axial_force", "node_position"):
        expected = part[name][::10] if "time" in part[name].dims else part[name]
        assert_array_equal(data[name], expected)
    assert data.attrs["audit"] == full.attrs["audit"]  # of all bearings
    own = peaks(data).loc["axial force"]
    assert own["value"] == float(part["axial_force"].max())
    place = data["bearing_node"].sel(bearing="bearing-0-0", end="j")
    assert str(data["node"][int(place)].item()) == "base-0-0"
    assert int(data["bearing_node"].sel(bearing="bearing-1-1", end="j")) == -1
    with pytest.raises(ValueError, match='data holds 1 of the 6 nodes of level "base"'):
        storey_drift(data)
    with pytest.raises(ValueError, match="nodes of a bearing were not recorded"):
        uplift_gap(data)
    with pytest.raises(ModelError, match="data holds 7 of 24 nodes"):
        member_forces(SCENES["impacts"][0], data)
    with pytest.raises(ValueError, match="nodes under bearings were not recorded"):
        bearing_plan(data)


def test_some_bearings_only(whole):
    frame = SCENES["impacts"][0]
    data = analyse("impacts", recording=Recording(bearings=("bearing-1-1",)))
    full = whole("impacts")
    assert_array_equal(member_forces(frame, data), member_forces(frame, full))
    with pytest.raises(ModelError, match="data holds 1 of 6 bearings"):
        storey_forces(frame, data)


def test_functions_of_results_on_a_thinned_record(whole):
    frame = SCENES["impacts"][0]
    thin, full = analyse("impacts", recording=Recording(every=4)), whole("impacts")
    for function in (storey_drift, floor_acceleration, drift_by_line, uplift_gap):
        assert_array_equal(function(thin), function(full)[::4])
        assert function(thin).attrs["recording"] == "every 4th step"
    for function in (member_forces, storey_forces, support_reactions):
        assert_allclose(function(frame, thin), function(frame, full)[::4], rtol=1e-10, atol=1e-5)
    assert floor_spectrum(thin, [0.5]).sizes["level"] == 3
    assert bearing_plan(thin).axes


ENDS_ONLY = {
    "envelope": lambda frame, data: envelope(data["axial_force"]),
    "envelope of forces": lambda frame, data: envelope(member_forces(frame, data)),
    "force_tables": force_tables,
    "floor_spectrum": lambda frame, data: floor_spectrum(data, [1.0]),
    "hysteresis": lambda frame, data: hysteresis(data),
    "model_view": model_view,
}


@pytest.fixture(scope="module")
def ends() -> xr.Dataset:
    """What is left of a run of which peaks are recorded."""
    return analyse("impacts", recording=Recording.peaks())


@pytest.mark.parametrize("name", ENDS_ONLY)
def test_what_needs_steps_says_so(name, ends):
    with pytest.raises(
        ValueError, match=r"only the first and last step was recorded: run with recording="
    ):
        ENDS_ONLY[name](SCENES["impacts"][0], ends)


def test_what_lacks_a_variable_says_so():
    data = analyse("impacts", recording=Recording(channels=("bearing_displacement",)))
    frame = SCENES["impacts"][0]
    for function in (storey_drift, floor_acceleration, drift_by_line, uplift_gap):
        with pytest.raises(ValueError, match=r"data has no .*add it to the channels"):
            function(data)
    with pytest.raises(ModelError, match="data has no node_displacement"):
        member_forces(frame, data)
    with pytest.raises(ValueError, match="the Dataset has no slider_displacement"):
        bearing_sections(data)
    assert orbits(data).axes  # has what it draws, and knows the worst bearing


def test_both_ends_are_enough_for_what_is_left(ends, whole):
    frame, data, full = SCENES["impacts"][0], ends, whole("impacts")
    last = member_forces(frame, data)[-1]
    assert_allclose(last, member_forces(frame, full)[-1], rtol=1e-10, atol=1e-5)
    assert len(bearing_plan(data).axes) == len(bearing_plan(full).axes)
    for variable in ("interface_slip_size", "bearing_displacement"):
        assert worst_bearing(data, variable) == worst_bearing(full, variable)


@pytest.mark.parametrize("kind", ["impacts", "peaks"])
def test_saved_and_loaded(kind, tmp_path, whole):
    data = analyse("impacts", recording=RECORDINGS[kind])
    save(data, tmp_path / "thin.nc")
    again = load(tmp_path / "thin.nc")
    xr.testing.assert_identical(again, data)
    assert audit_report(again) == whole("impacts").attrs["audit"]
    pd.testing.assert_frame_equal(peaks(again), peaks(data))
    save(data, tmp_path / "small.nc", compress=True)
    assert audit_report(load(tmp_path / "small.nc")) == whole("impacts").attrs["audit"]


UNKNOWN = [
    ({"channels": ("bearing_forces",)}, 'channels: "bearing_forces".*did you mean "bearing_force"'),
    ({"channels": ("weight",)}, 'channels: "weight" is always recorded'),
    ({"bearings": ("bearing-9-9",)}, 'bearings: "bearing-9-9" is not among.*did you mean'),
    ({"nodes": ("attic",)}, 'nodes: "attic" is not among the nodes.*24 exist'),
    ({"levels": ("roof",)}, 'levels: "roof" is not among the levels.*3 exist'),
]


@pytest.mark.parametrize(("options", "message"), UNKNOWN, ids=[str(u[0]) for u in UNKNOWN])
def test_unknown_names_are_refused_before_the_run(options, message):
    seen: list[float] = []
    with pytest.raises(ValueError, match=message):
        analyse("impacts", recording=Recording(**options), progress=seen.append)
    with pytest.raises(ValueError, match=message.partition(".*")[0]):
        analyse("rigid", recording=Recording(**options), progress=seen.append)
    assert not seen


def test_what_would_not_fit_is_refused_and_what_fits_is_not(monkeypatch):
    monkeypatch.setattr("frames.recording.recording.memory", lambda: 80e6)
    monkeypatch.setattr(recorder, "memory", lambda: 80e6)
    model, motion, _ = SCENES["uplift"]
    with pytest.raises(ValueError, match=r"recorded steps take about .* GB.*frames.Recording"):
        time_history(model, motion, duration=1500.0)
    with pytest.raises(ValueError, match="recorded steps take about"):
        time_history(model, motion, duration=1500.0, recording=Recording(every=2))
    few = Recording(every=2, channels=("axial_force",))
    data = time_history(model, motion, duration=1500.0, recording=few)
    assert data.sizes["time"] == 150001


def test_raised_failure_holds_what_was_recorded(whole):
    model, motion, _ = SCENES["failure"]
    with pytest.raises(AnalysisError) as caught:
        time_history(model, motion, on_failure="raise", recording=Recording.impacts(0.1, 0.1))
    data = caught.value.data
    full = whole("failure")
    assert float(data["time"][-1]) == float(full["time"][-1])
    assert table_of(data).loc["interface slip"].equals(table_of(full).loc["interface slip"])


@pytest.fixture
def interruptible():
    """Ctrl-C interrupts, also where a shell has started the tests without it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_interrupted_run_keeps_what_was_recorded(monkeypatch):
    monkeypatch.setattr(recorder, "BUFFER", 1e6)
    model, motion, _ = SCENES["uplift"]
    time_history(model, motion, duration=0.1, recording=Recording(every=50))

    def stop(share):
        if share > 0.0:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(AnalysisInterrupted) as caught:
        time_history(
            model, motion, dt=1e-5, duration=5.0, recording=Recording(every=50), progress=stop
        )
    data = caught.value.data
    count = data.sizes["time"]
    assert count > 10
    assert_allclose(data["time"], 5e-4 * np.arange(count), rtol=1e-12)
    end = peaks(data).loc["duration computed", "value"]
    assert 0.0 <= end - float(data["time"][-1]) < 5e-4
    short = time_history(model, motion, dt=1e-5, duration=end)
    for name in ("axial_force", "energy"):
        assert_array_equal(data[name], short[name][::50])


def peak_memory(duration: float, recording: Recording) -> float:
    model, motion, _ = SCENES["uplift"]
    gc.collect()  # so that what Python looks for at some time is not looked for within one of them
    tracemalloc.start()
    time_history(model, motion, dt=2e-4, duration=duration, recording=recording)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most


def test_memory_is_what_is_recorded(monkeypatch):
    monkeypatch.setattr(recorder, "BUFFER", 1e6)
    everything = peak_memory(0.6, Recording())
    short, long = (peak_memory(length, Recording.peaks()) for length in (0.6, 1.2))
    assert long < 1.05 * short + 1e5  # twice the steps
    assert short < 0.25 * everything
    tenth = peak_memory(1.2, Recording(every=50))
    assert tenth < long + 0.9e6  # 120 steps of 0.7 kB, and the parts they are put together from


def test_everything_is_as_if_nothing_were_asked(whole):
    data = analyse("impacts", recording=Recording.everything())
    full = whole("impacts")
    assert data.equals(full)
    assert data.attrs["recording"] == "every step"
    assert not [name for name in data.variables if is_of_all_steps(name)]
