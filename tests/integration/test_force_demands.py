"""Forces for design by suites of runs: statistics taken by hand, and runs that do not count."""

import math
from dataclasses import replace

import numpy as np
import pytest

from frames import GroundMotion, Recording, moment_frame, time_histories
from frames.batch.runs import Runs
from frames.design import (
    HISTORY_RULES,
    PropertyBounds,
    PropertyModificationFactors,
    bounded_histories,
    with_property_bounds,
)
from frames.design._errors import CheckError
from frames.design.histories.combined_forces import (
    combinations_of,
    member_combinations,
    reaction_combinations,
    uplift_table,
)
from frames.design.histories.eccentricity import Case
from frames.design.histories.force_demands import ShearFactor, force_demands
from frames.design.histories.suite import RunSet
from frames.library.moved_masses import with_moved_masses
from tests.scenes import simple_bearing

TIME = np.arange(0.0, 2.0, 0.01)
BELL = np.exp(-(((TIME - 0.9) / 0.5) ** 2))
BOUNDS = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
RULES = HISTORY_RULES["ASCE 7-22"]
BEARING = simple_bearing(slider_height=0.2, slider_radius=0.2, capacity=0.2)


def pulse(size, name):
    wave = size * BELL * np.sin(2 * np.pi * TIME / 1.2)
    return GroundMotion(x=wave, y=0.5 * np.roll(wave, 30), dt=0.01, name=name)


MOTIONS = {f"pulse-{k}": pulse(1.2 + 0.15 * k, f"pulse-{k}") for k in range(7)}


@pytest.fixture(scope="module")
def frame():
    found = moment_frame((1, 1), 2, bearing=BEARING)
    found.add_uniform_load("beam-x-floor-1-0-0", (0.0, 0.0, -6e3))
    return found


@pytest.fixture(scope="module")
def runs(frame):
    """Return the runs of seven motions at two bounds, histories and extremes of forces kept."""
    whole = Recording(every=1, forces=True, channels=("node_displacement", "storey_shear"))
    return bounded_histories(frame, MOTIONS, BOUNDS, at=("lower", "upper"), record=whole, dt=0.01)


def cases(runs, moved=None, rules=RULES):
    """Return runs by their bound as cases, those with moved masses at the lower one."""
    beside = {"lower": [] if moved is None else [moved]}
    return [Case(Runs(d, *beside.get(at, [])), rules, "MCE_R", at) for at, d in runs.items()]


@pytest.fixture(scope="module")
def tables(runs):
    return force_demands(cases(runs))


def test_statistics_motions_and_what_governs(runs, tables):
    for kind, name, places in (
        ("members", "peak_member_force", ("member", "station", "component")),
        ("storeys", "peak_storey_force", ("section", "storey_component")),
        ("reactions", "peak_reaction_force", ("bearing", "side", "reaction")),
    ):
        table = tables[kind].reset_index()
        assert set(table["statistic"]) == {"mean of 7 runs"}
        for row in table.sample(min(200, len(table)), random_state=1).to_dict("records"):
            if row["force"] == "drift":
                continue
            data = runs[row["bound"]][name]
            keys = {
                p: row[p if p in row else {"section": "storey"}.get(p, "force")] for p in places
            }
            six = places[-1]
            extreme = {"max": "largest", "min": "smallest"}[row["extreme"]]
            sections = data.sel(keys | {"extreme": extreme})
            values = sections.sel({f"{six}_at_once": row["force"]}).to_numpy()
            assert row["value"] == pytest.approx(values.mean(), abs=1e-3)
            pick = np.argmax if row["extreme"] == "max" else np.argmin
            k = int(pick(values))
            assert row["single"] == pytest.approx(values[k], abs=1e-3)
            assert row["motion"] == str(data["motion"].to_numpy()[k])
            at_once = sections.isel(run=k)
            for force in at_once[f"{six}_at_once"].to_numpy():
                together = float(at_once.sel({f"{six}_at_once": force}))
                assert row[f"{force} then"] == pytest.approx(together, abs=1e-3)
        keys = [c for c in (*places[:-1], "storey", "force", "extreme") if c in table.columns]
        sign = np.where(table["extreme"] == "max", 1.0, -1.0)
        out = table.assign(out=sign * table["value"])
        most = out.groupby(keys)["out"].transform("max")
        assert ((out["out"] == most) == (out["governs"] == "yes")).all()


def test_least_shears_raise_the_earthquakes_part(runs, tables):
    """Of members, storeys and drifts by one factor, of bearings and the foot of all by another."""
    raises = {("MCE_R", "upper"): ShearFactor(above=1.4, isolation=1.1)}
    raised = force_demands(cases(runs), raises)
    foot = str(runs["upper"]["section"].to_numpy()[0])
    assert foot not in set(map(str, runs["upper"]["storey"].to_numpy()))
    for name, own in tables.items():
        found, upper = raised[name], (own["bound"] == "upper").to_numpy()
        by = np.where(upper, 1.1 if name == "reactions" else 1.4, 1.0)
        if name == "storeys":
            by = np.where(upper & (own["storey"] == foot).to_numpy(), 1.1, by)
        assert found["raised by"].to_numpy() == pytest.approx(by)
        assert set(own["raised by"]) == {1.0}
        rest = np.nan_to_num(own["permanent"].to_numpy())  # drifts have none
        expected = rest + by * (own["value"].to_numpy() - rest)
        assert found["value"].to_numpy() == pytest.approx(expected, rel=1e-9, abs=2e-3)
        assert np.array_equal(found["single"], own["single"], equal_nan=True)


def test_combinations_put_permanent_loads_and_earthquake_together(frame, tables):
    """Those of the runs give their values back; a fifth more of all loads adds a fifth of these."""
    frames = {"D": frame, "1.2 D": frame.combined({"D": 1.2})}
    same, more = found = combinations_of(frame, frames)
    assert not same.members.any()
    assert not same.reactions.any()
    members = member_combinations(tables["members"], found, 2.0)
    reactions = reaction_combinations(tables["reactions"], found)
    assert list(dict.fromkeys(members["combination"])) == [
        "D + E / 2",
        "1.2 D + E / 2",
        "D + E",
        "1.2 D + E",
    ]
    for kind, table in (("members", members), ("reactions", reactions)):
        keys = list(tables[kind].columns[:5])
        whole = table[table["combination"] == "D + E"]
        both = whole.merge(tables[kind], on=keys, suffixes=("", " of runs"))
        assert len(both) == len(whole)
        assert set(both["governs"]) == {"yes"}
        assert both["value"].to_numpy() == pytest.approx(both["value of runs"], abs=5e-3)
        assert both["static"].to_numpy() == pytest.approx(both["permanent"], abs=5e-3)
        for name in dict.fromkeys(whole["force"]):  # what acts at once has the row's own force
            rows = whole[whole["force"] == name]
            assert np.array_equal(rows[f"{name} then"], rows["value"])
    lighter = members[members["combination"] == "D + E / 2"]["value"].to_numpy()
    whole = members[members["combination"] == "D + E"]
    assert lighter == pytest.approx(0.5 * (whole["value"] + whole["static"]).to_numpy(), abs=5e-3)
    heavy, light = (reactions[reactions["combination"] == f"{w} + E"] for w in ("1.2 D", "D"))
    load = heavy["N then"].to_numpy() / light["N then"].to_numpy()
    pressed = (light["N then"] > 0.1 * light["N then"].max()).to_numpy()
    for name in ("Vx", "Vy"):  # at rest they have next to none
        pair = heavy[f"{name} then"].to_numpy(), (load * light[f"{name} then"]).to_numpy()
        scale = np.abs(pair[1]).max()
        assert pair[0][pressed] == pytest.approx(pair[1][pressed], abs=0.02 * scale)
    rest = more.reactions[:, 0] / 0.2
    assert rest.sum() == pytest.approx(2.0 * frame.check().carried, rel=1e-6)
    gaps, linear = dict.fromkeys(frame.bearings, 0.0), {"bearing-0-0": 7e3, "bearing-1-1": -1.0}
    uplift = uplift_table(reactions, gaps, linear)
    least = light[
        (light["side"] == "below") & (light["force"] == "N") & (light["extreme"] == "min")
    ]
    assert uplift["least load by combination [N]"].to_numpy() == pytest.approx(least["value"])
    assert uplift.loc["bearing-0-0", "tension if held [N]"] == max(7e3, -least["value"].iloc[0])


@pytest.fixture(scope="module")
def moved(frame):
    """Return runs of one motion with the masses moved two ways, forces kept."""
    ways = {"+x": (0.1, 0.0), "-y": (0.0, -0.1)}
    models = {way: with_moved_masses(frame, shares, way) for way, shares in ways.items()}
    with_bounds = {way: with_property_bounds(m, "lower", BOUNDS) for way, m in models.items()}
    data = time_histories(
        with_bounds,
        {"pulse-4": MOTIONS["pulse-4"]},
        cases=[(way, "pulse-4", 1.0) for way in ways],
        dt=0.01,
        record=Recording(every=None, forces=True),
    )
    return data.assign_coords(mass_shift=("run", list(ways)))


def test_moved_runs_that_fail_or_kept_no_forces(runs, moved):
    failed = moved.copy()
    failed["status"] = failed["status"].copy(data=["ok", "no_equilibrium"])
    table = force_demands(cases(runs, failed))["members"]
    of_lower = table[table["bound"] == "lower"]
    assert set(of_lower["void"]) == {"runs with moved masses failed"}
    assert set(of_lower["moved masses add"]) == {0.0}
    bare = moved.drop_vars([n for n in moved.data_vars if str(n).endswith("_force")])
    with pytest.raises(CheckError, match="moved has no forces of the structure"):
        force_demands(cases(runs, bare))


def test_fewer_motions_count_with_the_largest(frame):
    few = {name: MOTIONS[name] for name in ("pulse-0", "pulse-5")}
    record = Recording(every=None, forces=True)
    data = time_histories(frame, few, dt=0.01, record=record)
    table = force_demands(cases({"": data}))["reactions"]
    row = table[(table["force"] == "N") & (table["extreme"] == "max")].iloc[0]
    assert (row["statistic"], row["motion"]) == ("largest of 2 runs", "pulse-5")
    assert row["value"] == row["single"]


def test_of_runs_that_failed_there_is_no_value(runs):
    data = runs["lower"].copy()
    data["status"] = data["status"].copy(data=["ok"] * 5 + ["no_equilibrium"] * 2)
    table = force_demands(cases({"lower": data}, None, replace(RULES, unacceptable_allowed=1)))
    assert set(table["members"]["void"]) == {"2 of 7 runs failed"}
    allowed = force_demands(cases({"lower": data}, None, replace(RULES, unacceptable_allowed=2)))
    assert set(allowed["members"]["void"]) == {""}
    assert not set(allowed["members"]["motion"]) & {"pulse-5", "pulse-6"}


@pytest.mark.parametrize("statistic", ["mean", "largest"])
@pytest.mark.parametrize("failed", [(), (2,), (0, 1, 4)])
@pytest.mark.parametrize("allowed", [0, 1])
def test_many_values_count_as_one_by_one(statistic, failed, allowed):
    values = np.random.default_rng(3).normal(size=(5, 4, 3)) * 10.0
    values[0, 0, 0], values[:, 1, 1] = math.nan, math.nan
    if 0 not in failed:
        values = np.nan_to_num(values, nan=1.0)
    flags = tuple(k in failed for k in range(5))
    suite = RunSet(statistic=statistic, failed=flags, allowed=allowed)
    found = suite.values(values)
    for place in np.ndindex(4, 3):
        wanted = suite.value(values[slice(None), *place])
        assert found[place] == pytest.approx(wanted, rel=1e-15, nan_ok=True)
