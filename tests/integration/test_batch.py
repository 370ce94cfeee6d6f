"""Many histories at once are the single ones: the same numbers, for any number of workers."""

import pickle  # of what this test has made  # noqa: S403
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import (
    BatchProgress,
    Frame,
    GroundMotion,
    ModelWarning,
    Recording,
    floor_acceleration,
    lumped_mass,
    moment_frame,
    peaks,
    shear_building,
    time_histories,
    time_history,
)
from frames.batch import processes
from frames.batch.runs import Runs, tagged
from frames.laws import Bilinear, PlasticHinge
from frames.results.findings import findings_by_run, findings_of
from frames.results.recorded import is_of_all_steps
from lir_element import AnalysisInterrupted, AnalysisWarning, Features, FrictionLaw, LIRBearing
from tests.scenes import quietly

ROUND_OFF = 1e-9  # sums in another order; of accelerations, parts of modes cancel
pytestmark = pytest.mark.filterwarnings("ignore::frames.ModelWarning")
TIMED = ("seconds_loop", "seconds of the time loop")


def untimed(data: xr.Dataset) -> xr.Dataset:
    data = data.drop_vars(TIMED[0]).drop_sel(quantity=TIMED[1])
    return data.assign_attrs(seconds=0.0)


def agree(many: xr.Dataset, one: xr.Dataset) -> None:
    """Hold a row to the result of the single run, recorded by its peaks."""
    for name in ("status", "message"):
        assert str(many[name].values) == one.attrs[name]
    assert str(many["audit"].values) == one.attrs["audit"]
    rows = findings_of(many), findings_by_run(many.expand_dims("run"))[0]
    for found in (*rows, findings_of(many.drop_vars("findings"))):  # and of files from before
        assert found.lines() == findings_of(one).lines()
        assert found.missing() == findings_of(one).missing()
    np.testing.assert_equal(float(many["failed_at"]), one.attrs.get("failed_at", np.nan))
    names = [n for n in one.data_vars if is_of_all_steps(n) and one[n].dtype == float]
    assert len(names) > 50
    for name in names:
        own = many[name].sel({d: one[d].to_numpy() for d in one[name].dims}).to_numpy()
        expected = one[name].to_numpy()
        scale = np.nanmax(np.abs(expected), initial=1e-300)
        np.testing.assert_allclose(own, expected, rtol=0.0, atol=ROUND_OFF * scale, err_msg=name)
    table = peaks(one).drop(TIMED[1])
    row = many.sel(quantity=list(table.index))
    np.testing.assert_allclose(
        row["peak"].to_numpy(), table["value"].to_numpy(float), rtol=ROUND_OFF, atol=1e-12
    )
    np.testing.assert_array_equal(row["peak_where"].to_numpy(), table["where"].to_numpy())
    np.testing.assert_array_equal(row["peak_time"].to_numpy(), table["time"].to_numpy(float))
    np.testing.assert_array_equal(many["energy"], one["energy"].isel(time=-1))


@pytest.fixture(scope="module")
def device(newhall_bearing: LIRBearing) -> LIRBearing:
    return newhall_bearing


@pytest.fixture(scope="module")
def motions(pulse: Callable[..., np.ndarray]) -> dict[str, GroundMotion]:
    x = pulse(3.0, 1.2, dt=0.01, rest=0.4)
    y = 0.4 * pulse(3.0, 0.9, dt=0.01, rest=0.4)
    near = GroundMotion(x=x, y=np.resize(y, len(x)), z=0.3 * np.resize(y, len(x)), dt=0.01)
    far = GroundMotion(x=pulse(2.0, 0.8, dt=0.004, rest=0.2), dt=0.004)
    return {"near": near, "far": far}


@pytest.fixture(scope="module")
def building(device: LIRBearing) -> Frame:
    return moment_frame(bays=(1, 1), storeys=2, bearing=device, name="frame")


SCALES = (0.4, 1.0, 3.5)


@pytest.fixture(scope="module")
def grid(building, device, motions):
    models = {"frame": building, "mass": lumped_mass(device, 2e5)}
    return models, quietly(time_histories, models, motions, scales=SCALES, workers=2)


def test_rows_are_the_single_runs(grid, motions):
    models, data = grid
    cases = [(m, g, s) for m in models for g in motions for s in SCALES]
    rows = zip(*(data[c].to_numpy() for c in ("model", "motion", "scale")), strict=True)
    assert list(rows) == cases
    assert data.attrs["status"] == "ok"
    for k, (model, motion, scale) in enumerate(cases):
        one = quietly(
            time_history, models[model], motions[motion].scaled(scale), recording=Recording.peaks()
        )
        agree(data.sel(run=k), one)
    assert len(set(data["status"].to_numpy())) > 1  # some of them fail
    assert float(data["peak_uplifts"].max()) > 0.0
    assert float(data["peak_rims_met"].max()) > 0.0


def test_rows_are_selected_by_tags(grid):
    """Of batches that do not share their steps; those of a group stay where they are."""
    _, data = grid
    far = tagged(data.isel(run=[4, 0, 2]), mass_shift=["+x", "-x", "+x"], bound="lower")
    runs = Runs(tagged(data, bound=["lower", "upper"] * 6)) + Runs(far)
    assert (len(runs), len(runs.moved), len(runs.centred)) == (15, 3, 12)
    groups = runs.by("mass_shift", "bound")
    assert list(groups) == [("", "lower"), ("", "upper"), ("+x", "lower"), ("-x", "lower")]
    assert groups["+x", "lower"].of("run").tolist() == [4, 2]
    assert groups["", "upper"].of("scale").tolist() == data["scale"].to_numpy()[1::2].tolist()
    upper = runs.where(model="mass", bound="upper")
    assert (
        upper.of("peak_displacement")[:, -1].max()
        == runs.of("peak_displacement")[
            (runs.of("model") == "mass") & (runs.of("bound") == "upper")
        ][:, -1].max()
    )
    mass = runs.where(model="mass", mass_shift="").data
    assert np.shares_memory(mass["peak_slip"], data["peak_slip"])  # no copy
    assert runs.where(device="none").parts == ()
    assert runs.data.sizes["run"] == 15
    assert set(runs.data["mass_shift"].to_numpy()[-3:]) == {"+x", "-x"}


def test_what_a_structure_does_not_have_is_nan(grid):
    _, data = grid
    masses = data["model"].to_numpy() == "mass"
    drift = data["peak"].sel(quantity="storey drift, mean").to_numpy()
    assert np.isnan(drift[masses]).all()
    assert np.isfinite(drift[~masses]).all()
    assert np.isnan(data["peak_slip"].isel(run=masses).sel(bearing="bearing-0-0")).all()
    assert np.isnan(data["peak_slip"].isel(run=~masses).sel(bearing="bearing")).all()


@pytest.mark.parametrize("workers", [1, 3])
def test_any_number_of_workers_gives_the_same_bits(grid, motions, workers):
    models, data = grid
    again = quietly(time_histories, models, motions, scales=SCALES, workers=workers)
    assert untimed(again).identical(untimed(data))


@pytest.fixture
def in_processes(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Have processes do all runs, whether it pays or not; return the places that they did."""
    done: list[int] = []
    ready, row = processes.ChildProcess.is_ready, processes.ChildProcess.row

    def waited(child: Any) -> bool:
        if child.serves is None:
            child.pipe.poll(60.0)
        return ready(child)

    def counted(child: Any, place: int, *given: Any) -> Any:
        found = row(child, place, *given)
        done.extend([place] if found else [])
        return found

    monkeypatch.setattr(processes.Crew, "pays", True)
    monkeypatch.setattr(processes.ChildProcess, "is_ready", waited)
    monkeypatch.setattr(processes.ChildProcess, "row", counted)
    return done


def test_processes_give_the_same_bits(device, grid, motions, request):
    models, _ = grid
    lifted = lumped_mass(device, 2e5)
    lifted.add_load("mass", (0.0, 0.0, 3e6, 0.0, 0.0, 0.0))
    models = models | {"lifted": lifted, "other": models["frame"].with_bearings(device)}
    told: list[BatchProgress] = []
    run = {"scales": [0.4, 3.5], "workers": 2, "duration": 1.0, "progress": told.append}
    both, said = [], []
    for fixture in ("motions", "in_processes"):
        places = request.getfixturevalue(fixture)
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            both.append(untimed(time_histories(models, motions["near"], **run)))
        said.append({str(each.message) for each in heard})
    assert both[0].identical(both[1])
    assert said[0] == said[1] != set()
    assert sorted(places) == [*range(8)]
    assert [each.done for each in told] == 2 * [*range(1, 9)]


@pytest.mark.parametrize("how", ["no other process knows the class", "the process was killed"])
def test_what_processes_cannot_do_is_done_here(building, motions, in_processes, monkeypatch, how):
    run = {"scales": [0.4, 0.5], "workers": 1, "duration": 0.2}
    if "class" in how:

        @dataclass(frozen=True)
        class LawOfNotebook(FrictionLaw):
            f_max: float = 0.05

            def at_speed(self, speed: float) -> float:
                return self.f_max

        device = replace(next(iter(building.bearings.values())).bearing, friction=LawOfNotebook())
        building = building.with_bearings(device)
    else:
        start = processes.start

        def killed(*given: Any, **options: Any) -> Any:
            found = start(*given, **options)
            found[0].kill()
            return found

        monkeypatch.setattr(processes, "start", killed)
    data = quietly(time_histories, building, motions["near"], **run)
    assert set(data["status"].to_numpy()) == {"ok"}
    assert in_processes == []


@pytest.mark.parametrize(
    ("workers", "beside", "runs", "pays"),
    [(2, 5e-3, 1000, True), (2, 5e-3, 100, False), (1, 5e-3, 1000, False), (2, 0.0, 1000, False)],
)
def test_processes_are_started_where_they_save_time(workers, beside, runs, pays):
    """A thousand runs that two threads need 5 ms each for besides their loops: 2.5 s."""
    crew = processes.Crew(workers, runs)
    for _ in range(processes.TRIED):
        assert not crew.pays
        crew.note(beside)
    assert crew.pays is pays


def test_a_row_does_not_depend_on_those_before(building, motions):
    # steps of other sizes, failures: arrays that are used again keep nothing of them
    cases = [("frame", name, s) for name, s in (("near", 3.5), ("far", 1.0), ("near", 1.0))]
    run = {"models": building, "motions": motions, "workers": 1}
    many = quietly(time_histories, **run, cases=cases)
    for k, case in enumerate(cases):
        alone = quietly(time_histories, **run, cases=[case])
        assert untimed(many.sel(run=[k])).drop_vars("run").equals(untimed(alone).drop_vars("run"))


@pytest.mark.parametrize(
    "options",
    [
        {"features": Features(vertical_coupling=False)},
        {"features": Features(plate_rotation=False, rims=False)},
        {"features": Features(uplift=False, velocity_dependence=False)},
        {"features": Features(second_direction=False, rims=False, interface=False)},
        {"dt": 0.005, "integrator": "generalised-alpha", "spectral_radius": 0.7},
        {"level": {"bearing-0-0": "contact"}, "duration": 0.4},
        {"duration": 3.0, "tolerance": 1e-3},
    ],
)
def test_options_are_those_of_the_single_run(building, motions, options):
    many = quietly(time_histories, building, motions["near"], workers=2, **options)
    one = quietly(time_history, building, motions["near"], recording=Recording.peaks(), **options)
    agree(many.sel(run=0), one)


def test_structures_that_yield(device: LIRBearing, motions: dict[str, GroundMotion]) -> None:
    stick = shear_building(
        device,
        storey_mass=6e4,
        storey_stiffness=6e7,
        storeys=2,
        storey_law=lambda k: Bilinear(stiffness=k, yield_force=1.5e5, hardening=0.03),
    )
    hinge = PlasticHinge(moment_y=1.5e4, moment_z=1.5e4, hardening=0.02)
    hinged = moment_frame((1, 1), 1, bearing=device, hinges={"column": hinge})
    models = {"stick": stick, "hinged": hinged}
    many = quietly(time_histories, models, motions["near"], scales=[0.5, 1.0], workers=2)
    for k, (name, scale) in enumerate((m, s) for m in models for s in (0.5, 1.0)):
        motion = motions["near"].scaled(scale)
        one = quietly(time_history, models[name], motion, recording=Recording.peaks())
        agree(many.sel(run=k), one)
    peak = many["peak"]
    assert float(peak.sel(run=1, quantity="link ductility")) > 1.0
    assert float(peak.sel(run=3, quantity="plastic rotation of hinges")) > 0.0


def test_histories_are_stacked(building: Frame, motions: dict[str, GroundMotion]) -> None:
    chosen = Recording(channels=("bearing_displacement", "axial_force"), every=2)
    scales = (0.4, 3.5)
    run = {"dt": 0.005, "duration": 2.0}
    many = quietly(time_histories, building, motions, scales=scales, record=chosen, **run)
    assert many["bearing_displacement"].dims == ("run", "time", "bearing", "axis")
    for k, (name, scale) in enumerate((m, s) for m in motions for s in scales):
        motion = motions[name].scaled(scale)
        one = quietly(time_history, building, motion, recording=chosen, **run)
        own = many["axial_force"].sel(run=k)
        there = own.isel(time=slice(one.sizes["time"]))
        np.testing.assert_array_equal(there, one["axial_force"])
        assert np.isnan(own.isel(time=slice(one.sizes["time"], None))).all()
    ended = many["peak_until"]
    assert float(ended.min()) < float(ended.max())  # one stops early, and is filled up


def test_histories_of_some_levels_and_bearings(building, motions):
    """Of what is not recorded nothing is kept, as in a single history; peaks are of all."""
    recording = Recording(levels=("base",), bearings=tuple(building.bearings)[:1])
    motion = motions["near"]
    many = quietly(time_histories, building, motion, record=recording, scales=[0.4, 0.5])
    whole = quietly(time_histories, building, motion, scales=[0.4, 0.5])
    one = quietly(time_history, building, motion.scaled(0.5), recording=recording)
    assert many["node"].to_numpy().tolist() == one["node"].to_numpy().tolist()
    for name in ("node_displacement", "axial_force", "peak_displacement", "peak_node_plan"):
        np.testing.assert_array_equal(many[name].isel(run=1), one[name])
    there = [name for name in whole["quantity"].to_numpy() if name not in TIMED]
    of_all = (data["peak"].sel(quantity=there) for data in (many, whole))
    np.testing.assert_allclose(*of_all, rtol=1e-10)
    with pytest.raises(ValueError, match=r"no level_node.*time_history"):
        floor_acceleration(many.isel(run=0))


def test_histories_on_other_grids_have_steps(building, motions):
    many = quietly(time_histories, building, motions, record=Recording(), scales=0.5)
    assert "step" in many["node_displacement"].dims
    for k, motion in enumerate(motions.values()):
        one = quietly(time_history, building, motion.scaled(0.5))
        count = one.sizes["time"]
        np.testing.assert_array_equal(many["time"].sel(run=k)[:count], one["time"])
        own = many["node_displacement"].sel(run=k)
        np.testing.assert_array_equal(own[:count], one["node_displacement"])
        assert np.isnan(own[count:]).all()


@pytest.mark.parametrize("fixture", ["motions", "in_processes"])
def test_interruption_keeps_what_is_done(building, motions, request, fixture):
    request.getfixturevalue(fixture)
    told: list[BatchProgress] = []

    def stop(progress: BatchProgress) -> None:
        told.append(progress)
        if progress.done == 2:
            raise KeyboardInterrupt

    scales = [0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    with pytest.raises(AnalysisInterrupted, match="of 6 runs") as caught:
        quietly(time_histories, building, motions["near"], scales=scales, progress=stop, workers=2)
    data = caught.value.data
    assert 2 <= data.sizes["run"] < 6
    assert data.attrs["status"] == "interrupted"
    assert set(data["status"].to_numpy()) == {"ok"}
    assert [progress.done for progress in told] == [1, 2]
    assert pickle.loads(pickle.dumps(caught.value)).data.identical(data)  # noqa: S301


def test_progress_tells_rate_and_time_left() -> None:
    half = BatchProgress(done=50, total=100, elapsed=25.0, failed=3)
    assert (half.rate, half.remaining) == (2.0, 25.0)
    assert str(half) == "50 of 100 runs, 2 runs/s, 25 s left, 3 stopped early"
    assert str(BatchProgress(7, 7, 14.0, 0)) == "7 of 7 runs, 0.5 runs/s"
    assert "min left" in str(BatchProgress(1, 100, 10.0, 0))


def test_progress_is_written(building, motions, capsys):
    quietly(time_histories, building, motions["near"], progress=True, duration=0.2)
    assert capsys.readouterr().err.startswith("1 of 1 runs, ")


def test_what_is_told_of_runs_that_stop(building: Frame, motions: dict[str, GroundMotion]) -> None:
    with pytest.warns(AnalysisWarning, match="1 of 2 runs stopped early") as told:
        data = time_histories(building, motions["near"], scales=[0.4, 3.5])
    assert "slip_exceeded" in str(told[0].message) or "rim" in str(told[0].message)
    assert list(np.isfinite(data["failed_at"])) == [False, True]


def test_a_structure_without_equilibrium_is_a_row(building, device, motions):
    lifted = lumped_mass(device, 2e5)
    lifted.add_load("mass", (0.0, 0.0, 3e6, 0.0, 0.0, 0.0))
    models = {"lifted": lifted, "frame": building}
    data = quietly(time_histories, models, motions["near"], duration=0.2)
    assert list(data["status"].to_numpy()) == ["uplifted", "ok"]
    assert float(data["failed_at"][0]) == 0.0
    assert np.isnan(data["peak"].isel(run=0)).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"scales": [0.5, 0.5]}, "scales: 0.5 occurs twice"),
        ({"scales": []}, "scales is empty"),
        ({"scales": 0.0}, "scale of a motion must not be 0"),
        ({"scales": 1.0, "cases": [("frame", "near", 1.0)]}, "leave scales out"),
        ({"cases": [("house", "near", 1.0)]}, "no model 'house'; there are 'frame'"),
        ({"cases": [("frame", "near", 1.0)] * 2}, "occurs twice"),
        ({"cases": [("frame", "near")]}, "name of model, name of motion, scale"),
        ({"level": "auto"}, 'does not support level="auto"'),
        ({"level": "rigid_body"}, 'does not support level="rigid_body"'),
        ({"method": "modal"}, "method = 'modal': choose one of"),
        ({"record": Recording(nodes=("attic",))}, '"attic" is not among the nodes'),
        ({"record": "all"}, "record = 'all' must be None"),
        ({"workers": 0}, "workers = 0"),
        ({"progress": 3}, "progress = 3 must be True"),
        ({"dt": -0.1}, "dt"),
        ({"integrator": "explicit"}, "rigid_body"),
        ({"motions": []}, "motions is empty"),
        ({"models": {}}, "models is empty"),
        ({"models": 3}, "models = 3 must be a Frame"),
        ({"models": {1: None}}, "a name: a string"),
    ],
)
def test_what_cannot_be_is_refused(building, motions, options, message):
    with pytest.raises((ValueError, TypeError), match=message):
        time_histories(**({"models": building, "motions": motions} | options))


def test_more_than_the_memory_holds_is_refused(building, motions, monkeypatch):
    monkeypatch.setattr("frames.recording.recording.memory", lambda: 1e6)
    quietly(time_histories, building, motions["near"], scales=[0.4, 0.5], duration=0.2)
    with pytest.raises(ValueError, match="results of 2 of 2 runs need about"):
        time_histories(building, motions["near"], scales=[0.4, 0.5], record=Recording())


def test_names_have_to_be_unique(building: Frame, motions: dict[str, GroundMotion]) -> None:
    with pytest.raises(ValueError, match='two have the name "frame": pass a mapping'):
        time_histories([building, building.copy("frame")], motions)


def test_a_motion_in_other_units_is_named_once(building, motions):
    with pytest.warns(ModelWarning, match=r"and 1 more of the 2 runs") as told:
        time_histories(building, motions["near"], scales=[1e-3, 2e-3], duration=0.2)
    assert len(told) == 1
