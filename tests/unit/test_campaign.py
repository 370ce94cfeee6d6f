"""Campaigns: samples, plan, results beside those of time_histories, failures, refusals."""

import json
import shutil
import subprocess  # this interpreter  # noqa: S404
import sys
import tarfile
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.stats import lognorm, uniform

from frames import (
    Frame,
    GroundMotion,
    ModalDamping,
    ModelError,
    Recording,
    lumped_mass,
    time_histories,
)
from frames._fingerprint import fingerprint
from frames._provenance import numerical_sources
from frames.results.chunks import load_chunk, marks_of, write_chunk
from frames.risk import (
    Campaign,
    CampaignError,
    FragilityError,
    Intensity,
    IntensityRuns,
    LimitState,
    ParameterSample,
    archive_campaign,
    convert_campaign,
    full_grid,
    latin_hypercube,
    open_campaign,
    saltelli_sample,
    sobol_indices,
    sobol_sample,
)
from frames.risk.campaign import batches, plan_description, store_writing
from frames.risk.campaign.campaign import usual_batch
from frames.risk.campaign.designs import with_parameters
from frames.risk.campaign.plan import Plan, differences
from frames.risk.campaign.plot_response import failure_table, response_table
from frames.risk.campaign.store_writing import locked
from lir_element import CoulombFriction, LIRBearing, VelocityFriction
from lir_element.errors import AnalysisWarning
from tests.refusals import refused
from tests.scenes import small_bearing
from validation.study import __main__ as whole

pytest.importorskip("filelock")

BEARING = small_bearing(interface_friction=0.16)
TIME = np.linspace(0.0, 1.0, 101)
PULSES = {
    name: GroundMotion(x=size * np.sin(2.0 * np.pi * TIME), dt=0.01, name=name)
    for name, size in (("small", 1.0), ("large", 2.0))
}
SETS = full_grid({"radius": [0.7, 0.9], "friction": [0.05, 0.07]})


def structure(bearing: LIRBearing = BEARING) -> Frame:
    return lumped_mass(bearing, 5e4)


def small(store: Path, batch: int | None = 3, motions: Any = PULSES, **other: Any) -> Campaign:
    given = {"sample": SETS, "scales": [0.5, 1.0]} | other
    return Campaign(given.pop("models", structure()), motions, store=store, batch=batch, **given)


@pytest.fixture
def store(tmp_path: Path, made_once: Callable[..., Path]) -> Path:
    """The results database of a campaign that is run once for all tests, which may damage it."""
    made_once("campaign", lambda part: small(part / "store").run(workers=1), tmp_path)
    return tmp_path / "store"


def test_a_grid_holds_all_combinations() -> None:
    grid = full_grid({"a": [1.0, 2.0, 3.0], "b": [0.1, 0.2]})
    assert len(grid) == 6
    assert grid[4] == {"a": 3.0, "b": 0.1}


@pytest.mark.parametrize("draw", [latin_hypercube, sobol_sample])
def test_a_seed_gives_its_sets_again(draw: object) -> None:
    given = {"a": uniform(1.0, 2.0), "b": lognorm(0.4, scale=0.06), "c": [5.0, 6.0]}
    first, again, other = (draw(given, 16, seed=seed) for seed in (3, 3, 4))  # type: ignore[operator]
    assert (first.values == again.values).all()
    assert (first.values != other.values).any()
    # each sixteenth of a's range and of b's probability holds one set; half of the sets take each c
    assert sorted(((first.values[:, 0] - 1.0) / 2.0 * 16.0).astype(int)) == list(range(16))
    shares = lognorm(0.4, scale=0.06).cdf(first.values[:, 1])
    assert sorted((shares * 16.0).astype(int)) == list(range(16))
    assert np.unique(first.values[:, 2], return_counts=True)[1].tolist() == [8, 8]


@pytest.mark.parametrize(
    ("words", "make", "given"),
    [
        ("size = 12 .* power of 2: 8 or 16", sobol_sample, ({"a": [1.0]}, 12)),
        ("size = 0 must be a whole number", latin_hypercube, ({"a": [1.0]}, 0)),
        ("a has a distribution", full_grid, ({"a": uniform()},)),
        ("a has no values", full_grid, ({"a": []},)),
        ("parameters is empty", full_grid, ({},)),
        ('"a b" must be a name', full_grid, ({"a b": [1.0]},)),
        ("a = 1.0: give values", full_grid, ({"a": 1.0},)),
        ("a of set 0 is no number", ParameterSample, (("a",), np.array([[np.nan]]))),
        (r"shape \(2, 1\) for 2 names", ParameterSample, (("a", "b"), np.ones((2, 1)))),
    ],
)
def test_what_is_no_sample_is_refused(words, make, given):
    refused(CampaignError, words, make, *given)
    refused(CampaignError, "seed = -1", latin_hypercube, {"a": [1.0]}, 2, seed=-1)


@pytest.mark.quick
def test_rows_are_those_of_the_plan() -> None:
    plan = Plan(("A", "B"), ("x", "y", "z"), (1.0, 2.0), SETS, 7)
    assert (plan.runs, plan.batches) == (48, 7)
    assert [row for k in range(7) for row in plan.rows(k)] == list(range(48))
    model, chosen, motion, scale = plan.places()
    for row in range(48):
        run = plan.run(row)
        assert run.model == plan.models[model[row]]
        assert run.parameters == chosen[row]
        assert run.motion == plan.motions[motion[row]]
        assert run.scale == plan.scales[scale[row]]


def test_parameters_become_those_of_all_bearings() -> None:
    def bearings(parameters: dict[str, float], own: LIRBearing = BEARING) -> set[LIRBearing]:
        frame = with_parameters(structure(own), parameters)
        return {link.bearing for link in frame.bearings.values()}

    (bearing,) = bearings({"radius": 0.9, "friction": 0.04, "capacity": 0.2})
    assert (bearing.radii, bearing.lateral_capacity) == ((0.9, 0.9), 0.2)
    assert bearing.frictions == (CoulombFriction(0.04),) * 2
    (plain,) = bearings({"interface_friction": 0.2}, BEARING.as_dcfp())
    assert plain.is_dcfp
    rubbed = replace(BEARING, friction=VelocityFriction(0.08, 0.04, 100.0))
    (changed,) = bearings({"f_max": 0.09}, rubbed)
    assert set(changed.frictions) == {VelocityFriction(0.09, 0.04, 100.0)}
    both = {"f_max": 0.09, "friction": 0.05}
    refused(CampaignError, "friction and f_max are given", bearings, both, rubbed)
    refused(CampaignError, "the bearing has Coulomb's friction", bearings, {"f_max": 0.1})
    words = r'"radios" is no parameter: choose one of .*radius'
    refused(CampaignError, words, bearings, {"radios": 1.0})


def test_factors_multiply_what_each_bearing_has() -> None:
    rubbed = replace(BEARING, friction=(VelocityFriction(0.08, 0.04, 50.0), CoulombFriction(0.05)))
    factors = {"friction_factor": 1.2, "rim_stiffness_factor": 0.1, "radius_factor": 2.0}
    frame = with_parameters(structure(rubbed), factors | {"modal_damping": 0.03})
    (found,) = {link.bearing for link in frame.bearings.values()}
    assert found.frictions == (VelocityFriction(0.096, 0.048, 50.0), CoulombFriction(0.06))
    assert found.radii == tuple(2.0 * each for each in BEARING.radii)
    nominal = BEARING.resolved()["rim_stiffness"]  # a default
    assert found.resolved()["rim_stiffness"] == pytest.approx(0.1 * nominal)
    assert frame._damping == ModalDamping(0.03)
    twice = {"friction_factor": 1.2, "f_max": 0.1}
    refused(CampaignError, "friction_factor and f_max are given", with_parameters, frame, twice)
    none = {"flange_factor": 2.0}
    words = "no flange to multiply: set flange"
    refused(CampaignError, words, with_parameters, frame, none)


def test_indices_of_a_campaign_are_those_of_its_results(tmp_path: Path) -> None:
    inputs, samples = {"friction": uniform(0.04, 0.04)}, 16
    sample = saltelli_sample(inputs, samples)
    refuse = float(np.sort(sample.values[samples : 2 * samples, 0])[-2])

    def model(parameters: dict[str, float]) -> Frame:
        if parameters["friction"] > refuse:
            msg = "no such friction"
            raise ValueError(msg)
        return with_parameters(structure(), parameters)

    runs = small(tmp_path / "runs", 96, sample=sample, models=model)
    with pytest.warns(AnalysisWarning, match="not_built"):
        runs.run(workers=1)
    given = {"samples": samples, "widest": 2.0}
    found = sobol_indices(runs, inputs, scale=1.0, **given)
    table = runs.to_dataframe()
    own = table[table["scale"] == 1.0].pivot_table(
        index="parameter_set", columns="motion", values="bearing displacement", dropna=False
    )
    again = sobol_indices(own[sorted(PULSES)].to_numpy(), inputs, **given)
    assert (again.table == found.table).all(axis=None)
    assert found.left_out == again.left_out > 0
    peaks = sobol_indices(
        open_campaign(tmp_path / "runs"),
        inputs,
        scale=1.0,
        quantity=lambda data: data["peak"].sel(quantity="bearing displacement"),
        **given,
    )
    assert (peaks.table == found.table).all(axis=None)
    for words, other in (
        ("2 factors on the motions: name one as scale=", {}),
        ("other values of friction", {"scale": 1.0, "seed": 2}),
        ("quantity = 'height': choose one of", {"scale": 1.0, "quantity": "height"}),
    ):
        refused(FragilityError, words, sobol_indices, runs, inputs, **{**given, **other})


def test_rows_hold_what_time_histories_gives(store: Path) -> None:
    data = small(store).run()
    assert data.sizes["run"] == 16
    assert data["done"].all()
    for k in (0, 5, 15):
        row = data.isel(run=k)
        design = {name: float(row[name]) for name in SETS.names}
        own = time_histories(
            with_parameters(structure(), design),
            PULSES[str(row["motion"].item())],
            scales=float(row["scale"]),
        ).isel(run=0)
        for name in own.data_vars:
            if name == "seconds_loop":
                continue
            expected = own[name].drop_sel(
                {"quantity": "seconds of the time loop"} if "quantity" in own[name].dims else {}
            )
            if expected.dtype.kind == "f":
                np.testing.assert_array_equal(row[name].to_numpy(), expected.to_numpy(), str(name))
            else:
                assert row[name].to_numpy().tolist() == expected.to_numpy().tolist(), name
        assert own["peak_displacement"].attrs == row["peak_displacement"].attrs


def test_the_digest_is_that_of_the_runs_alone(store: Path) -> None:
    """Neither the number of workers nor the size of batches is in it; the motions are."""
    batches = small(store / "5", 5)
    batches.run(workers=2)
    whole = small(store).digest()
    assert batches.digest() == whole
    other = small(store / "3", 16, scales=[0.5, 1.0 + 1e-12])
    other.run(workers=1)
    assert other.digest() != whole


def test_a_batch_that_was_damaged_is_found(store: Path) -> None:
    chunk = store / "runs/000002.npz"
    with np.load(chunk) as file:
        arrays = dict(file)
    arrays["of peak_displacement"][1] += 1e-12
    np.savez(chunk, **arrays)
    words = r"000002.npz is not as it was written: remove it"
    refused(CampaignError, words, small(store).digest)


def test_a_store_of_another_version_is_refused(store: Path) -> None:
    layout = store / "layout.npz"
    write_chunk(layout, load_chunk(layout).drop_vars("peak_slip"))
    next(store.rglob("000002.npz")).unlink()
    refused(CampaignError, "no room for peak_slip: another version", small(store).run)


def test_failed_runs_are_rows_with_their_reason(tmp_path: Path) -> None:
    def choosy(parameters: dict[str, float]) -> Frame:
        if parameters["radius"] > 0.8:
            msg = "no such radius in the catalogue"
            raise ValueError(msg)
        return with_parameters(structure(), parameters)

    campaign = Campaign(choosy, PULSES, store=tmp_path / "store", sample=SETS, batch=5)
    with pytest.warns(UserWarning, match="4 runs are not ok: 8 of 8 runs done: 4 ok, 4 not_built"):
        data = campaign.run(workers=1)
    failed = data["radius"] > 0.8
    assert set(data["status"].to_numpy()[failed].tolist()) == {"not_built"}
    assert set(data["message"].to_numpy()[failed].tolist()) == {"no such radius in the catalogue"}
    assert data["peak_displacement"].isnull().all("bearing").to_numpy().tolist() == list(failed)
    runs = IntensityRuns.from_dataset(
        data, PULSES, Intensity(kind="PGA", measure="x"), parameters="all"
    )
    assert runs.table["outcome"].to_numpy()[failed].tolist() == ["not built"] * 4
    assert len(runs.failed) == 0
    assert np.isnan(runs.exceeded(LimitState.bearing_failure())[failed]).all()
    assert np.isnan(runs.demand("bearing displacement")[failed]).all()
    table = response_table({"choosy": runs})
    assert (table["not built [-]"] == 0.5).all()
    assert (table["analysis failed [-]"] == 0.0).all()
    assert failure_table({"choosy": runs})["counts as"].tolist() == ["not built"]


def test_a_model_that_cannot_be_set_up_spoils_no_other(tmp_path: Path) -> None:
    def heavy(parameters: dict[str, float]) -> Frame:
        frame = structure()
        if parameters["x"] > 1.0:
            frame.add_node("alone", 5.0, 0.0, 1.0)
            frame.add_mass("alone", 1.0)
        return frame

    sample = full_grid({"x": [0.0, 2.0, 1.0]})
    with pytest.raises(ModelError) as refusal:
        time_histories(heavy({"x": 2.0}), PULSES)
    campaign = Campaign(heavy, PULSES, store=tmp_path / "store", sample=sample)
    with pytest.warns(UserWarning, match="2 runs are not ok"):
        data = campaign.run()
    assert data["status"].to_numpy().tolist() == ["ok"] * 2 + ["not_built"] * 2 + ["ok"] * 2
    assert str(refusal.value) in data["message"].to_numpy()[2]


def test_parameters_that_change_nothing_give_one_run(tmp_path: Path, monkeypatch) -> None:
    """Of a DCFP, whose sliders are one piece: each motion and scale is computed once."""

    def plain(parameters: dict[str, float]) -> Frame:
        return structure(replace(BEARING, interface_friction=parameters["hold"]).as_dcfp())

    computed: list[int] = []
    original = batches.time_histories

    def counted(models: object, motions: object, **options: Any) -> xr.Dataset:
        computed.append(len(options.get("cases") or ()))
        return original(models, motions, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(batches, "time_histories", counted)
    options = {"sample": full_grid({"hold": [0.14, 0.16, 0.2]}), "scales": [0.5, 1.0], "batch": 12}
    record = Recording(every=10)
    campaign = Campaign(plain, PULSES, store=tmp_path / "store", record=record, **options)
    assert "12 runs, none done" in campaign._repr_html_()
    data = campaign.run(workers=1)
    assert sum(computed) == 4
    assert "(4 computed, 8 taken over)" in campaign._repr_html_()
    assert campaign.status().reused == 8
    assert "12 of 12 runs done (4 computed, 8 taken over): 12 ok" in str(campaign.status())
    table = data["peak"].to_numpy().reshape(3, 4, -1)
    assert np.array_equal(table[0], table[1], equal_nan=True)
    assert np.array_equal(table[0], table[2], equal_nan=True)
    assert len(np.unique(data["peak_displacement"])) == 3  # small as it is is half of large
    one, other = (campaign.store.histories(k)["bearing_displacement"] for k in (3, 11))
    assert np.array_equal(one, other)
    pair = {"LIR": lambda p: structure(replace(BEARING, interface_friction=p["hold"]))}
    apart = Campaign(pair, PULSES, store=tmp_path / "other", **options)
    apart.run(workers=1)
    assert apart.status().reused == 0


def test_a_mistake_of_the_function_ends_the_campaign(tmp_path: Path) -> None:
    def mistaken(parameters: dict[str, float]) -> Frame:
        return lumped_mass(BEARING, parameters["mass"])

    for error, words, model, sample in (
        (KeyError, "mass", mistaken, SETS),
        (
            CampaignError,
            r'correct the models; the first: "x" is no param',
            structure(),
            full_grid({"x": [1.0]}),
        ),
    ):
        campaign = Campaign(model, PULSES, store=tmp_path / "store", sample=sample)
        refused(error, words, campaign.run)
    assert not (tmp_path / "store").exists()


def test_histories_are_kept_on_request(tmp_path: Path) -> None:
    campaign = small(tmp_path / "store", batch=None, record=Recording(every=5))
    campaign.run(workers=1)
    mine = campaign.store.histories(7)
    row = campaign.results().isel(run=7)
    own = time_histories(
        with_parameters(structure(), {n: float(row[n]) for n in SETS.names}),
        PULSES[str(row["motion"].item())],
        scales=float(row["scale"]),
        record=Recording(every=5),
    ).isel(run=0)
    np.testing.assert_array_equal(mine["bearing_displacement"], own["bearing_displacement"])
    for data in (mine, own, campaign.results()):  # what xarray's plots take
        assert {label.dtype.kind for label in data.coords.values()} <= set("Uifb")
    campaign.results()["peak"].isel(quantity=0).plot.scatter(x="motion")
    (part,) = (tmp_path / "store" / "histories").glob("000000-*.npz")
    part.write_bytes(part.read_bytes()[:5000])
    with pytest.raises(CampaignError, match=r"000000-0.npz is damaged .*remove it"):
        campaign.store.histories(7)
    refused(CampaignError, "run 99 has no histories", campaign.store.histories, 99)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"scales": [0.5, 1.1]}, r"scales was \[0.5, 1.0\], is \[0.5, 1.1\]"),
        ({"dt": 0.005}, r'options: "dt" was None, is 0.005'),
        (
            {"sample": full_grid({"radius": [0.7, 0.91], "friction": [0.05, 0.07]})},
            'parameters: "radius" was',
        ),
        ({"batch": 4}, "batch was 3, is 4"),
        ({"motions": PULSES | {"large": PULSES["large"].scaled(1.01)}}, 'motions: "large" was'),
    ],
)
def test_another_plan_is_refused_by_name(store: Path, change: dict[str, Any], line: str) -> None:
    refused(CampaignError, f"was planned otherwise(.|\n)*{line}", small(store, **change).run)
    small(store, batch=None).run()  # the same, its batch as it is


def test_differences_are_told() -> None:
    old = {"a": 1, "b": {"x": 1, "y": 2}}
    assert differences(old, dict(old)) == []
    told = differences(old, {"a": 2, "b": {"x": 1, "z": 3}})
    assert told == ["a was 1, is 2", 'b: "y" is missing', 'b: "z" is new']


def test_a_model_has_the_fingerprint_of_its_content() -> None:
    heavier = structure()
    heavier.add_mass(next(iter(heavier.bearings.values())).j, 1.0)
    assert fingerprint(structure()) == fingerprint(structure().copy()) != fingerprint(heavier)
    assert fingerprint([1.0]) != fingerprint([1])


def test_two_campaigns_at_once_are_refused(store: Path) -> None:
    with locked(store / "lock"):
        refused(CampaignError, r"is in use by process \d+ on .+ since", small(store).run)
    small(store).run()


HOLDER = """
import sys, time
from pathlib import Path
from frames.risk.campaign.store_writing import locked

with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600.0)
"""


def test_the_lock_of_a_process_that_was_killed_is_seized(tmp_path: Path) -> None:
    """Another process is named while it lives; what a killed one left behind holds nobody up."""
    command = [sys.executable, "-c", HOLDER, str(tmp_path / "lock")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:  # noqa: S603
        try:
            assert other.stdout is not None
            assert other.stdout.readline() == "held\n"
            told = rf"is in use by process {other.pid} on .+ since \d{{4}}-.+: wait until it has"
            with pytest.raises(CampaignError, match=told), locked(tmp_path / "lock"):
                pass
        finally:
            other.kill()
    assert [p.name for p in tmp_path.glob("*.json")] == ["lock-holder.json"]  # it could not tidy up
    with locked(tmp_path / "lock"):
        pass
    assert [p.name for p in tmp_path.iterdir()] == ["lock"]


def test_a_package_that_is_missing_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(store_writing, "find_spec", lambda n: None)
    old_new = tmp_path / "old", tmp_path / "new"
    refused(ImportError, "need zarr: pip install", convert_campaign, *old_new)
    words = r"need filelock: pip install 'lir-dcfp\[campaign\]'"
    refused(ImportError, words, small, tmp_path / "store")


def test_a_folder_that_holds_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    refused(CampaignError, "exists and holds no campaign", small(tmp_path).run)
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.txt"]
    for path in (tmp_path, tmp_path / "thesis.txt"):
        refused(CampaignError, "holds no campaign: name the folder", open_campaign, path)


def test_a_batch_is_an_eighth_within_bounds(tmp_path: Path) -> None:
    sizes = [
        small(tmp_path / "store", None, scales=np.linspace(0.1, 1.0, n))._work.plan.batch
        for n in (2, 30, 1000)
    ]
    assert sizes == [16, 30, 512]
    assert usual_batch(200_000) == 512
    assert usual_batch(1_000_000) == 1954  # 512 batches


def test_a_database_of_0_2_is_converted(tmp_path: Path) -> None:
    """Made by 0.2.0: four runs in two batches, with histories; columns have the names of now."""
    pytest.importorskip("zarr")
    archive = Path(__file__).parents[1] / "data" / "campaign-0.2.tar.xz"
    with tarfile.open(archive) as file:
        file.extractall(tmp_path, filter="data")
    old, new = tmp_path / "old", tmp_path / "new"
    with pytest.raises(CampaignError, match=r"has format 3, .*convert_campaign\(.* writes it anew"):
        open_campaign(old)
    converted = convert_campaign(old, new)
    assert converted.digest().startswith("d2494a0d472a739f")
    assert str(converted.status()) == "4 of 4 runs done: 4 ok"
    data = xr.open_zarr(old / "runs.zarr", chunks=None, consolidated=False)
    names = {"peak": "peak", "friction": "friction", "peak_slip_at": "reached_slip_at"}
    for name, old_name in names.items():
        np.testing.assert_array_equal(converted.results()[name], data[old_name])
    part = xr.open_zarr(old / "histories/000001/0.zarr", chunks=None, consolidated=False)
    mine = converted.histories(3)["bearing_displacement"]
    np.testing.assert_array_equal(mine, part["bearing_displacement"].sel(run=3))
    words = r"holds no campaign of version 0\.2"
    refused(CampaignError, words, convert_campaign, new, tmp_path / "third")
    (old / "runs.zarr/peak/c.1.0").unlink()
    words = r"batch 1 of .* is not as it was written: remove"
    refused(CampaignError, words, convert_campaign, old, tmp_path / "fourth")


@pytest.mark.parametrize("compress", [False, True])
@pytest.mark.parametrize("runs", [0, 2])
def test_a_chunk_gives_back_what_was_written(tmp_path: Path, runs: int, compress: bool) -> None:
    texts = np.array(["Lüftung\n", ""], dtype=object)[:runs]
    data = xr.Dataset(
        {
            "peak": (("run", "quantity"), np.full((runs, 3), np.nan), {"units": "m"}),
            "message": ("run", texts),
            "steps": ("run", np.arange(runs)),
            "position": ("quantity", [1.0, -0.0, np.inf]),
            "none": (("run", "nothing"), np.zeros((runs, 0))),
            "is_whole": True,
        },
        {"quantity": ["a", "β", "of c"], "run": np.arange(runs), "model": ("run", ["x"] * runs)},
        {"title": "é", "seconds": 0.5},
    )
    write_chunk(tmp_path / "1.npz", data, compress=compress, doubtful=3)
    for lazy in (False, True):
        found = load_chunk(tmp_path / "1.npz", lazy=lazy)
        xr.testing.assert_identical(found, data)
        assert {n: v.dtype.kind for n, v in found.variables.items()} == {
            n: v.dtype.kind for n, v in data.variables.items()
        }
    assert marks_of(tmp_path / "1.npz") == {"doubtful": 3}


def test_what_is_read_of_results_is_what_is_asked_for(store: Path) -> None:
    """Whatever rows and columns, in one step or several; the rows of a missing batch are empty."""
    whole = open_campaign(store).results().load()
    next(store.rglob("000002.npz")).unlink()
    part, gone = open_campaign(store).results(), np.arange(16) // 3 == 2
    assert part["done"].to_numpy().tolist() == (~gone).tolist()
    for name, empty in (("peak", np.nan), ("status", ""), ("peak_displacement", np.nan)):
        expected = whole[name].to_numpy().copy()
        expected[gone] = empty
        for key in (5, -1, slice(2, 12, 3), [0, 5, 15], [15, 1, 1]):
            np.testing.assert_array_equal(part[name].isel(run=key), expected[key])
    columns = part["peak"].isel(run=[1, 14], quantity=[3, 0])
    np.testing.assert_array_equal(columns, whole["peak"].to_numpy()[np.ix_([1, 14], [3, 0])])
    for name in ("model", "quantity", "status"):
        assert part[name].to_numpy().astype(str).tolist() == part[name].to_numpy().tolist()


def test_progress_counts_the_runs_of_this_call(tmp_path: Path) -> None:
    told = []
    small(tmp_path / "store").run(progress=told.append)
    assert [p.done for p in told] == list(range(1, 17))
    assert {p.total for p in told} == {16}
    (tmp_path / "store/runs/000001.npz").unlink()
    told.clear()
    small(tmp_path / "store").run(progress=told.append)
    assert [(p.done, p.total) for p in told] == [(1, 3), (2, 3), (3, 3)]


def test_a_store_of_other_sources_is_refused_or_taken_over(store, monkeypatch):
    whole = small(store).digest()
    next(store.rglob("000002.npz")).unlink()
    other = numerical_sources() | {"lir_element/device/specification.py": "0" * 8}
    monkeypatch.setattr(plan_description, "numerical_sources", lambda: other)
    words = r"other sources(.|\n)*specification.py.* is 00000000"
    refused(CampaignError, words, small(store).run)
    data = small(store).run(accept_other_sources=True)
    assert data.attrs["sources_accepted"].startswith("after 13 runs: lir-dcfp")
    small(store).run()  # they are the results database's now
    assert small(store).digest() == whole


def test_another_default_of_a_bearing_is_refused_whatever_is_accepted(store, monkeypatch):
    usual = LIRBearing.resolved
    monkeypatch.setattr(
        LIRBearing, "resolved", lambda own: usual(own) | {"rim_overrun": 0.02 * own.slider_radius}
    )
    words = r"bearings: .*rim_overrun\" was 0.008, is 0.0016"
    refused(CampaignError, words, small(store).run, accept_other_sources=True)


def test_one_table_has_every_run_with_its_units(store: Path) -> None:
    """Of the campaign and of what is opened; batches without a mark are not in it."""
    campaign = small(store)
    data = campaign.run()
    table = campaign.to_dataframe()
    assert list(table.columns[:6]) == [
        "model", "parameter_set", "motion", "scale", "radius", "friction",
    ]  # fmt: skip
    assert table.index.tolist() == list(range(16))
    for name, by_bearing in (
        ("bearing displacement", "peak_displacement"),
        ("interface slip", "peak_slip"),
        ("rim force", "peak_rim_force"),
    ):
        expected = data[by_bearing].to_numpy().reshape(16, -1).max(axis=1)
        np.testing.assert_array_equal(table[name], expected)
        assert table.attrs["units"][name] == data[by_bearing].attrs["units"]
    runs = IntensityRuns.from_dataset(data, PULSES, Intensity(kind="scale"), parameters="all")
    for name in ("outcome", "status", "message", "motion", "scale", "base shear over weight"):
        assert table[name].tolist() == runs.table[name].tolist(), name
    assert table["radius"].tolist() == data["radius"].to_numpy().tolist()
    assert set(table.columns[11:]) <= table.attrs["units"].keys()
    assert table.attrs["source"] == data.attrs["source"]
    next(store.rglob("000002.npz")).unlink()
    part = open_campaign(store).to_dataframe()
    assert part.equals(table[table.index // 3 != 2])


@pytest.mark.parametrize("name", ["energy", "scale", "parameter_set", "outcome"])
def test_a_parameter_has_no_name_of_a_column_or_result(tmp_path: Path, name: str) -> None:
    def made(parameters: dict[str, float]) -> Frame:
        return lumped_mass(BEARING, parameters[name])

    sample = full_grid({name: [5e4, 6e4]})
    campaign = Campaign(made, PULSES, store=tmp_path / "store", sample=sample)
    refused(CampaignError, f'"{name}" has the name of a result or column', campaign.run)
    assert list(tmp_path.iterdir()) == []


def test_fragility_takes_the_motions_that_were_run_and_one_design(store: Path) -> None:
    measure, read = Intensity(kind="PGA", measure="x"), IntensityRuns.from_dataset
    data = open_campaign(store).results()
    refused(FragilityError, r"4 sets", read, data, PULSES, measure)
    one = read(data, PULSES, measure, parameters=1)
    same = {"radius": 0.7, "friction": 0.07}
    assert one.table.equals(read(data, PULSES, measure, parameters=same).table)
    assert len(one.table) == 4
    assert len(read(data, PULSES, measure, parameters="all").table) == 16
    other = PULSES | {"large": PULSES["large"].scaled(0.5)}
    words = r"1 of 2 motions are not those .* 'large'"
    refused(FragilityError, words, read, data, other, measure, parameters=1)
    alone = time_histories(structure(), PULSES)
    refused(FragilityError, "'large'", read, alone, other, measure)
    next(store.rglob("000002.npz")).unlink()
    data = open_campaign(store).results()
    with pytest.warns(AnalysisWarning, match="2 of 4 runs are not done and left out"):
        part = read(data, PULSES, measure, parameters=1)
    assert len(part.table) == 2


def test_sources_that_numbers_depend_on_are_all_in_the_plan() -> None:
    root = Path(open_campaign.__code__.co_filename).parents[3]
    kernels = {
        p.relative_to(root).as_posix()
        for package in ("frames", "lir_element")
        for p in (root / package).glob("**/kernels/**/*.py")
    }
    known = numerical_sources().keys()
    assert len(kernels) > 10
    assert {k for k in kernels if "opensees" not in k} <= known
    assert {"lir_element/device/specification.py", "frames/batch/batch_run.py"} <= known


def test_an_archive_is_read_without_the_package(store: Path, tmp_path: Path) -> None:
    """By zarr and pandas alone, in a process that has not this package."""
    archive = archive_campaign(store, tmp_path / "runs.zip", command="lir campaign small.toml")
    first = archive.read_bytes()
    assert archive_campaign(store, archive, command="lir campaign small.toml").read_bytes() == first
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path / "read")  # noqa: S202  (written above)
    code = """
import json, sys
import numpy as np, pandas as pd, zarr
table = pd.read_csv("runs.csv")
group = zarr.open_group("results.zarr", mode="r")
quantities = [str(name) for name in group["quantity"][:]]
peak = group["peak"][:, quantities.index("bearing displacement")]
assert np.allclose(peak, table["bearing displacement"], rtol=1e-9)
assert group["motion"][:].tolist() == table["motion"].tolist()
assert not [name for name in sys.modules if name.startswith(("frames", "lir_element"))]
print(json.dumps([len(table), table["radius"].tolist(), peak.tolist()]))
"""
    given = [sys.executable, "-I", "-c", code]
    read = subprocess.run(given, cwd=tmp_path / "read", capture_output=True, check=False, text=True)  # noqa: S603
    assert read.returncode == 0, read.stderr
    count, radii, peak = json.loads(read.stdout)
    own = open_campaign(store).to_dataframe()
    assert count == len(own) == 16
    assert radii == own["radius"].tolist()
    np.testing.assert_allclose(peak, own["bearing displacement"], rtol=1e-12)
    told = (tmp_path / "read/README.md").read_text()
    for words in (
        *("lir campaign small.toml", open_campaign(store).digest(), "BSD-3-Clause"),
        *("| radius | m | parameter |", "| bearing displacement | m |", "No ground motion"),
        "| minimum axial force | N | smallest of the run |",
    ):
        assert words in told
    assert "other files" not in told  # its page is not written
    assert "Redistribution and use" in (tmp_path / "read/LICENSE").read_text()
    shutil.copytree(store, tmp_path / "study/loss/all")
    whole.main(["loss", "after", "--store", str(tmp_path / "study"), "--archive", str(tmp_path)])
    with zipfile.ZipFile(tmp_path / "study_loss.zip") as packed:
        assert {"README.md", "all/runs.csv", "all/results.zarr/.zmetadata"} <= {*packed.namelist()}
    assert not (tmp_path / "study_after.zip").exists()
    next((store / "runs").glob("*.npz")).unlink()
    refused(CampaignError, "run the campaign to its end", archive_campaign, store, archive)
    assert archive.read_bytes() == first
    refused(CampaignError, "must end in .zip", archive_campaign, store, tmp_path / "runs.tar")
