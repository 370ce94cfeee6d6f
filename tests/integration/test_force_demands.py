"""Forces for design by suites: statistics taken by hand, forces by slopes and deflections."""

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
from frames.design.histories.eccentricity import Case
from frames.design.histories.force_demands import ShearFactor, force_demands
from frames.design.histories.suite import RunSet
from frames.library.moved_masses import with_moved_masses
from frames.model.axes import default_up, local_axes
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


def bending(m, length, first, second, area, turns, rise, load):
    """Return moments and shears of a bar from its ends' slopes and relative deflection.

    Slope-deflection equations with shear deformation, second order by the string with the bar's
    shape functions (Przemieniecki), and clamped moments of a uniform load: sagging positive on the
    first fibre, in the plane in which `rise` is the deflection.
    """
    stiffness = m.elastic_modulus * first
    phi = 12.0 * stiffness / (m.shear_modulus * area * length**2) if math.isfinite(area) else 0.0
    (a, b), chord = turns, rise / length
    near = stiffness / (length * (1.0 + phi)) * ((4 + phi) * a + (2 - phi) * b - 6 * chord)
    far = stiffness / (length * (1.0 + phi)) * ((2 - phi) * a + (4 + phi) * b - 6 * chord)
    factor = second * length / (30.0 * (1.0 + phi) ** 2)
    own, other = 4 + 5 * phi + 2.5 * phi**2, 1 + 5 * phi + 2.5 * phi**2
    near += factor * (own * a - other * b - 3.0 * chord)
    far += factor * (own * b - other * a - 3.0 * chord)
    near, far = near - load * length**2 / 12.0, far + load * length**2 / 12.0
    shear = (near + far) / length - second * chord  # on end i, across the bar
    return near, far, shear - 0.5 * load * length


def recomputed(frame, u, rest):
    """Return forces of members at ends i and j from displacements (time, node, 6)."""
    index = {name: k for k, name in enumerate(frame.nodes)}
    found = {}
    for name, member in frame.members.items():
        i, j = (np.array(frame.nodes[end].position) for end in (member.i, member.j))
        assert member.offsets == ((0.0,) * 3,) * 2
        axes, length = local_axes(i[None], j[None], default_up(i[None], j[None]))
        axes, length, m = axes[0], float(length[0]), member.section
        left, right = (u[:, index[end]] for end in (member.i, member.j))
        d, turn = (right - left)[:, :3] @ axes.T, [e[:, 3:] @ axes.T for e in (left, right)]
        load = axes @ np.asarray(frame.uniform_loads.get(name, np.zeros(3)))
        axial = m.elastic_modulus * m.area / length * d[:, 0]
        second = axial[0]
        twist = turn[1][:, 0] - turn[0][:, 0]
        torque = m.shear_modulus * m.torsion_constant / length * twist
        torque += second * (m.inertia_y + m.inertia_z) / (m.area * length) * twist
        about_z = [e[:, 2] for e in turn]
        about_y = [-e[:, 1] for e in turn]  # slopes dw/dx
        z = bending(m, length, m.inertia_z, second, m.shear_area_y, about_z, d[:, 1], load[1])
        y = bending(m, length, m.inertia_y, second, m.shear_area_z, about_y, d[:, 2], load[2])
        # on end i: moment about z is `near`, about y its opposite; the section's are opposite
        first = [axial - 0.5 * load[0] * 0, -z[2], -y[2], torque, y[0], -z[0]]
        last = [axial, -(z[2] + load[1] * length), -(y[2] + load[2] * length), torque, -y[1], z[1]]
        found[name] = np.array([first, last])
    return found


def test_members_by_slopes_and_deflections(frame, runs, tables):
    """Each extreme of a suite again from displacements alone, with the mean of seven motions."""
    table = tables["members"].reset_index()
    rows = table.set_index(["bound", "member", "station", "force", "extreme"])["value"].sort_index()
    for bound, data in runs.items():
        per_run = []
        for k in range(data.sizes["run"]):
            u = data["node_displacement"].isel(run=k).transpose("time", "node", "dof").to_numpy()
            per_run.append(recomputed(frame, u, None))
        for name in frame.members:
            histories = np.stack([one[name] for one in per_run])  # run, end, force, time
            high, low = histories.max(axis=3).mean(axis=0), histories.min(axis=3).mean(axis=0)
            size = np.abs(histories).max(axis=(0, 1, 3))
            scale = np.where(np.arange(6) < 3, size[:3].max(), size[3:].max())
            for e, station in enumerate("ij"):
                for c, force in enumerate(("N", "Vy", "Vz", "T", "My", "Mz")):
                    found = rows[bound, name, station, force]
                    assert found["max"] == pytest.approx(high[e, c], abs=1e-6 * scale[c] + 2e-3)
                    assert found["min"] == pytest.approx(low[e, c], abs=1e-6 * scale[c] + 2e-3)


def test_columns_carry_the_shear_of_their_storey_at_every_step(frame, runs):
    """Section forces of columns turned to global axes and summed: what inertia above asks for."""
    data = runs["lower"].isel(run=3)
    u = data["node_displacement"].transpose("time", "node", "dof").to_numpy()
    forces = recomputed(frame, u, None)
    for k, storey in enumerate(data["storey"].to_numpy(), start=1):
        total = 0.0
        for name, member in frame.members.items():
            if name.startswith(f"column-{k}"):
                i, j = (np.array(frame.nodes[end].position)[None] for end in (member.i, member.j))
                axes, _ = local_axes(i, j, default_up(i, j))
                total = total + forces[name][0, :3].T @ axes[0]
        shear = data["storey_shear"].sel(storey=storey).transpose("time", "axis").to_numpy()
        scale = np.abs(shear).max(axis=0)
        assert np.abs(total - shear)[:, :2].max() < 1e-6 * scale[:2].max()
        assert np.abs(total - shear)[:, 2].max() < 1e-6 * scale[2]


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


def test_drifts_are_those_that_runs_reached(runs, tables):
    table = tables["storeys"]
    drifts = table[table["force"] == "drift"].set_index(["bound", "storey"])["value"]
    for bound, data in runs.items():
        mean = data["peak_drift"].mean("run")
        assert drifts[bound].to_numpy() == pytest.approx(mean.to_numpy(), rel=1e-12)


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


def test_moved_masses_add_section_by_section(runs, tables, moved):
    """The larger difference of two ways by hand, on the side to which the extreme goes."""
    raises = {("MCE_R", "lower"): ShearFactor(above=1.3)}
    found = force_demands(cases(runs, moved), raises)
    for kind, places in (
        ("members", ("member", "station", "component")),
        ("storeys", ("section", "storey_component")),
        ("reactions", ("bearing", "side", "reaction")),
    ):
        six, variable = places[-1], f"peak_{kind.removesuffix('s')}_force"
        table = found[kind].reset_index()
        own = tables[kind].reset_index()
        lower = (table["bound"] == "lower").to_numpy()
        assert set(table.loc[~lower, "moved masses add"]) == {0.0}
        assert set(table.loc[~lower, "masses"]) == {""}
        changed = 0
        for k in np.flatnonzero(lower)[:: 7 if kind == "members" else 1]:
            row = table.iloc[k]
            if row["force"] == "drift":
                continue
            labels = {
                p: row[p if p in row else {"section": "storey"}.get(p, "force")] for p in places
            }
            labels |= {
                "extreme": {"max": "largest", "min": "smallest"}[row["extreme"]],
                f"{six}_at_once": row["force"],
            }
            centred = float(runs["lower"][variable].isel(run=4).sel(labels))
            each = moved[variable].sel(labels).to_numpy()
            sign = 1.0 if row["extreme"] == "max" else -1.0
            more = sign * (each - centred)
            added = max(float(more.max()), 0.0)
            assert row["moved masses add"] == pytest.approx(sign * added, abs=2e-3)
            if added > 1.0:
                changed += 1
                assert row["masses"] == ("+x", "-y")[int(more.argmax())]
            before, rest = own.iloc[k]["value"], row["permanent"]
            factor = 1.3 if kind == "members" or (kind == "storeys" and row["raised by"] > 1) else 1
            expected = rest + factor * (before + sign * added - rest)
            assert row["value"] == pytest.approx(expected, rel=1e-9, abs=5e-3)
            farthest = max(sign * own.iloc[k]["single"], *(sign * each))
            assert row["single"] == pytest.approx(sign * farthest, abs=2e-3)
            beyond = farthest - sign * own.iloc[k]["single"]
            assert beyond <= 2e-3 or "masses" in row["motion"]
        assert changed > 5
    drift = found["storeys"].query("force == 'drift' and bound == 'lower'").set_index("storey")
    more = moved["peak_drift"] - runs["lower"]["peak_drift"].isel(run=4)
    added = np.maximum(more.max("run").to_numpy(), 0.0)
    mean = runs["lower"]["peak_drift"].mean("run").to_numpy()
    assert drift["value"].to_numpy() == pytest.approx(1.3 * (mean + added), rel=1e-12)


def test_moved_runs_that_fail_or_kept_no_forces(runs, moved):
    failed = moved.copy()
    failed["status"] = failed["status"].copy(data=["ok", "no_convergence"])
    table = force_demands(cases(runs, failed))["members"]
    of_lower = table[table["bound"] == "lower"]
    assert set(of_lower["void"]) == {"runs with moved masses failed"}
    assert set(of_lower["moved masses add"]) == {0.0}
    bare = moved.drop_vars([n for n in moved.data_vars if str(n).endswith("_force")])
    with pytest.raises(CheckError, match="kept no forces of the structure"):
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
    data["status"] = data["status"].copy(data=["ok"] * 5 + ["no_convergence"] * 2)
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
