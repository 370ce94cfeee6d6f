"""`[compare]` of a campaign: its devices, and ratios and margins recomputed from the database."""

import dataclasses
import math
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

import xarray as xr
from scipy import optimize, stats
from typer.testing import CliRunner

from frames import gravity, lumped_mass
from frames.command.app import app
from frames.design import ProjectError
from frames.risk import CampaignError, FragilityError, Intensity, LossComponent, open_campaign
from frames.risk.campaign.comparison import (
    OTHERS,
    collapse_limit,
    dish_diameter,
    filling_intensity,
)
from frames.risk.campaign.devices import Device, highest_ratio, moat_of
from frames.risk.campaign.file import comparison_in, loss_in, models_in, read_campaign
from frames.risk.campaign.file_schema import CompareTable
from frames.risk.campaign.search import MedianSearch
from lir_element import AnalysisWarning, cyclic_test
from tests.refusals import refused
from tests.scenes import DEVICE, STICK, wide_bearing

BEARING = wide_bearing(capacity=0.2, friction=0.06, interface_friction=0.2, design_load=300e3)
ABOVE = STICK.replace("100 t", "60 t").replace("300 kN", "200 kN") + 'base_mass = "60 t"\n'
SLIDERS = DEVICE.replace("180 mm", "200 mm").replace("0.18", "0.2") + 'design_load = "300 kN"\n'
FILE = f"""
[campaign]
name = "Rims"
{ABOVE}{SLIDERS}"""
FILE += """
[motions]
folder = "motions"
intensities = ["2 m/s2", "2.5 m/s2", "3 m/s2", "4 m/s2", "5 m/s2"]
tail = "1 s"
[fragility]
intensity = "Sa"
period = "2.5 s"
measure = "x"
floor_acceleration = ["0.3 g"]
[compare]
rims = [0.5, "unbreakable"]
collapse_drift = "0.3 %"
[analysis]
dt = "10 ms"
workers = 1
"""
OWN = """[devices.LIR]
pressure = "3 MPa"
least_slider_radius = "175 mm"
plan = "700 mm"
[devices.wide]
kind = "DCFP"
slider_radius = "150 mm"
moat = "400 mm"
rim_overrun = "20 mm"
rims = 0.5
[devices.tall]
kind = "DCFP"
rims = "unbreakable"
plan = "800 mm"
"""
COMPARED = '[compare]\nrims = [0.5, "unbreakable"]\ncollapse_drift = "0.3 %"\n'
PERIODS = (1.6, 1.9, 2.2, 2.5)
run = CliRunner().invoke


def put_pulses(found: Path) -> Path:
    """Put motions of some periods into a folder."""
    (found / "motions").mkdir()
    t = np.arange(0.0, 5.0, 0.01)
    rows = ["name,x,dt,unit"]
    for period in PERIODS:
        pulse = np.sin(2.0 * np.pi * t / period) * np.sin(np.pi * t / 5.0)
        np.savetxt(found / f"motions/{period}.txt", pulse)
        rows.append(f"p{period},{period}.txt,0.01,m/s2")
    (found / "motions/motions.csv").write_text("\n".join(rows) + "\n")
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A comparison under pulses of some periods, run."""
    found = put_pulses(tmp_path_factory.mktemp("compare"))
    (found / "rims.toml").write_text(FILE)
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):  # failures, on purpose
        done = run(app, ["campaign", "--no-figures", str(found / "rims.toml")])
    assert done.exit_code == 0, done.output
    return found


@pytest.fixture(scope="module")
def data(folder: Path) -> xr.Dataset:
    return open_campaign(folder / "rims-results").results().load()


def collapsed(data: xr.Dataset, device: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intensity, motion and collapse of the runs of a device, from statuses and storeys."""
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
    status = own["status"].to_numpy().astype(str)
    assert set(status) <= {"ok", "rim_overrun", "slip_exceeded", "slip_unstable", "inaccurate"}
    drift = own["peak"].sel(quantity="storey drift, mean").to_numpy()
    failed = ~np.isin(status, ["ok", "inaccurate"])
    return own["scale"].to_numpy(), own["motion"].to_numpy(), failed | (drift > 0.003)


def likeliest_median(im: np.ndarray, exceeded: np.ndarray) -> float:
    """Median of the lognormal curve that makes the outcomes most likely."""

    def unlikely(x: np.ndarray) -> float:
        p = stats.norm.cdf((np.log(im) - x[0]) / math.exp(x[1]))
        p = np.clip(p, 1e-12, 1.0 - 1e-12)
        return float(-np.log(np.where(exceeded, p, 1.0 - p)).sum())

    options = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000}
    found = optimize.minimize(unlikely, [1.0, -1.5], method="Nelder-Mead", options=options)
    return math.exp(found.x[0])


def test_devices_are_what_they_are_called() -> None:
    asked = CompareTable(devices=OTHERS, rims=(0.5, "unbreakable"), slider_radius="150 mm")
    frames = asked.frames(lumped_mass(BEARING, 3e4))
    devices = {name: next(iter(frame.bearings.values())).bearing for name, frame in frames.items()}
    of_rims = {
        rims: [f"{name}, {rims}" for name in ("LIR-DCFP", "DCFP", "DCFP of the same plan")]
        for rims in ("rims of 0.5 W", "unbreakable rims")
    }
    by_device = zip(*of_rims.values(), strict=True)
    assert list(devices) == [*(name for pair in by_device for name in pair), "larger DCFP"]
    assert asked.by_rims() == {rims: [*each, "larger DCFP"] for rims, each in of_rims.items()}
    assert [each.is_dcfp for each in devices.values()] == [False] * 2 + [True] * 5
    stiffness = BEARING.resolved()["rim_stiffness"]
    for name, each in devices.items():
        if name == "larger DCFP":
            assert each.lateral_capacity == math.inf
            continue
        assert dish_diameter(each) == pytest.approx(dish_diameter(BEARING), rel=1e-12), name
        assert each.resolved()["rim_stiffness"] == stiffness
        assert each.rim_yield_force == (math.inf if "unbreakable" in name else 0.5 * 300e3)
    same = devices["DCFP of the same plan, rims of 0.5 W"]
    # 50 mm less in radius are 50 mm more of sliding on a surface of R = 1.5 m, L = 2.8 m
    assert same.lateral_capacity == pytest.approx(0.2 + 0.05 * 2.8 / 1.5, rel=1e-12)
    assert dish_diameter(BEARING) == pytest.approx(2.0 * (0.2 * 1.5 / 2.8 + 0.2), rel=1e-12)


SEVERAL = FILE.replace(ABOVE, "")
for old, new in (
    ('["2 m/s2", "2.5 m/s2", "3 m/s2", "4 m/s2", "5 m/s2"]', '["2 m/s2", "5 m/s2"]'),
    ("tail =", 'only = ["p1.6", "p2.5"]\ntail ='),
    ('collapse_drift = "0.3 %"', 'collapse_ductility = 3\ndevices = ["DCFP"]'),
    ("[fragility]", "[fragility]\nductility = [2]\nslip_over_overlap = [0.5]"),
):
    SEVERAL = SEVERAL.replace(old, new)
for kind, bays in (("low", 1), ("long", 2)):
    SEVERAL += f"""
[structures.{kind}]
kind = "moment frame"
bays = [{bays}, 1]
bay_width = ["6 m", "6 m"]
storeys = 1
storey_height = "3 m"
floor_load = "800 kg/m2"
columns = {{ box = ["160 mm", "8 mm"], hinges = {{ yield_stress = "235 MPa" }} }}
beams = {{ i_shape = ["300 mm", "150 mm", "10 mm", "7 mm"] }}
"""


def test_several_structures_with_hinges(tmp_path: Path) -> None:
    """Ductility from the rotations of the database; pairs within a structure; own bearings."""
    folder = put_pulses(tmp_path)
    own = '[bearings.low]\ndesign_load = "200 kN"\n'
    (folder / "two.toml").write_text(SEVERAL + own)
    frames = models_in(folder / "two.toml")
    loads = {
        n: {b.bearing.design_load for b in each.bearings.values()} for n, each in frames.items()
    }
    assert {n: each for n, each in loads.items() if "unbreakable" in n} == {
        f"{kind}, {device}, unbreakable rims": {load}
        for kind, load in (("low", 200e3), ("long", 300e3))
        for device in ("LIR-DCFP", "DCFP")
    }
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        done = run(app, ["campaign", "--no-figures", str(folder / "two.toml")])
    assert done.exit_code == 0, done.output
    data = open_campaign(folder / "two-results").results().load()
    page = (folder / "two-results/campaign.html").read_text()
    assert "Collapse is failure of a bearing, or a ductility of a plastic hinge above 3." in page
    margins = pd.read_csv(folder / "two-results/campaign-margins.csv", index_col=0)
    for name, frame in frames.items():
        at = data.isel(run=np.flatnonzero(data["model"].to_numpy() == name))
        # box 160 x 8 mm of 235 MPa, 3 m: M_p L / (6 E I)
        z, i = (0.16**3 - 0.144**3) / 4.0, (0.16**4 - 0.144**4) / 12.0
        hinges = [str(h) for h in at["hinge"].to_numpy() if str(h).split(":")[0] in frame.hinges]
        turned = at["peak_hinge_rotation"].sel(hinge=hinges).max("hinge").to_numpy()
        over = 1.0 + turned / (235e6 * z * 3.0 / (6.0 * 200e9 * i)) > 3.0
        failed = ~np.isin(at["status"].to_numpy().astype(str), ["ok", "inaccurate"])
        assert margins.loc[name, "collapsed"] == (over | failed).sum()
    assert margins["collapsed"].sum() > margins["bearing failed"].sum()
    ratios = pd.read_csv(folder / "two-results/campaign-ratios.csv")
    assert {*ratios["structure"]} == {"low", "long"}
    pairs = ratios[["structure", "rims", "own", "over"]].drop_duplicates()
    assert len(pairs) == 4
    for _, row in pairs.iterrows():
        assert row["own"] == f"{row['structure']}, LIR-DCFP, {row['rims']}"
        assert row["over"] == f"{row['structure']}, DCFP, {row['rims']}"
    table = pd.read_csv(folder / "two-results/campaign-fragility.csv")
    slips = table[table["limit state"] == "slip 50 % of the overlap"]
    for _, row in slips[slips["structure"].str.contains(" DCFP")].iterrows():  # which do not slip
        assert row["exceeded"] == margins.loc[row["structure"], "bearing failed"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[structures.low]", "[structure]", "or several as "),
        (
            "[analysis]",
            "[bearings.tall]\nradius = '2 m'\n[analysis]",
            "has no structure: add",
        ),
        (', hinges = { yield_stress = "235 MPa" }', "", "no structure has any: set hinges"),
        ("collapse_ductility = 3", "collapse_ductility = 3\ncollapse_drift = 0.1", "leave one out"),
        (
            "[compare]",
            "[compare.groups]\na = ['LIR-DCFP', 'DCFP']\n[compare]",
            "compare.groups are of",
        ),
    ],
)
def test_structures_that_cannot_be_are_refused(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    put_pulses(tmp_path)
    (tmp_path / "two.toml").write_text(SEVERAL.replace(old, new))
    refused(ProjectError, words, read_campaign, tmp_path / "two.toml")


def test_without_strengths_rims_are_those_of_the_bearing() -> None:
    frame = lumped_mass(BEARING, 3e4)
    asked = CompareTable(devices=("DCFP", "larger DCFP"), larger="400 mm")
    found = {
        name: next(iter(each.bearings.values())).bearing
        for name, each in asked.frames(frame).items()
    }
    assert list(found) == ["LIR-DCFP", "DCFP", "larger DCFP"]
    assert {each.resolved()["rim_overrun"] for each in found.values()} == {0.1 * 0.2}
    assert {each.rim_yield_force for each in found.values()} == {math.inf}
    assert found["larger DCFP"].lateral_capacity == pytest.approx(0.4, rel=1e-12)
    assert dish_diameter(found["larger DCFP"], 0.3) == pytest.approx(2 * (0.3 * 1.5 / 2.8 + 0.2))


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"devices": ("larger DCFP",), "larger": "100 mm"}, "above the capacity"),
        ({"devices": ("DCFP of the same plan",), "slider_radius": "200 mm"}, "below the 200 mm"),
        ({"devices": ("DCFP",)}, "has a rigid slider"),
    ],
)
def test_devices_that_cannot_be_are_refused(asked: dict[str, Any], words: str) -> None:
    bearing = BEARING.as_dcfp() if "rigid" in words else BEARING
    frames = CompareTable(**asked).frames
    refused(CampaignError, words, frames, lumped_mass(bearing, 3e4))


SEARCH = (
    OWN.partition("[devices.wide]")[0].replace('plan = "700 mm"', "rims = 1")
    + """[search]
device = "LIR"
limit = "collapse"
points = 4
trials = 1
[search.parameters]
interface_friction = {low = 0.1, high = 0.3}
plan = {low = "500 mm", high = "750 mm"}
"""
)


def test_a_search_runs_allowed_points_and_names_the_best(folder: Path) -> None:
    compare = '[compare]\ncollapse_drift = "0.3 %"\n'
    few = FILE.replace(COMPARED, SEARCH + compare).replace('"2.5 m/s2", "3 m/s2", ', "")
    (folder / "search.toml").write_text(few)
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        done = run(app, ["campaign", str(folder / "search.toml")])
    assert done.exit_code == 0, done.output
    table = pd.read_csv(folder / "search-results/search.csv", index_col=0)
    assert table["stage"].tolist() == [0, 0, 0, 0, 1]
    assert (table["ratio of checks [-]"] <= 1.0).all()
    assert table["interface_friction"].between(0.1, 0.3).all()
    assert table.loc[table["best"], "median [m/s2]"].item() == table["median [m/s2]"].max()
    assert comparison_in(folder / "search.toml") is None  # there is one device
    loaded = models_in(folder / "search.toml")["LIR"]
    for _, row in table.iterrows():
        device = Device(plan=row["plan"], interface_friction=row["interface_friction"])
        ratio = highest_ratio(device.on(loaded))
        assert ratio == pytest.approx(row["ratio of checks [-]"])
    data = open_campaign(folder / "search-results/stage-1").results()
    im, _, exceeded = collapsed(data, str(data["model"].to_numpy()[0]))
    median, shares = (
        table["median [m/s2]"].iloc[-1],
        [exceeded[im == at].mean() for at in (2, 4, 5)],
    )
    curve = stats.norm.cdf(np.log(np.array([2.0, 4.0, 5.0]) / median) / 0.4)
    assert curve.mean() == pytest.approx(min(max(np.mean(shares), 1e-3), 0.999), abs=1e-6)


def test_a_search_finds_the_top_of_a_surface_that_is_known_within_its_constraint() -> None:
    """Medians fall off from a ridge; beyond x = 0.4 nothing is allowed."""
    search = MedianSearch(
        build=dict,  # type: ignore[arg-type]
        bounds={"x": (0.0, 1.0), "y": (0.0, 2.0)},
        limit=collapse_limit(None),
        intensity=Intensity(kind="PGA"),
        scales=[1.0],
        constraint=lambda point: point["x"] / 0.4,  # type: ignore[index]
        points=32,
    )
    points = search.first_points()
    assert len(points) == 32
    assert max(point["x"] for point in points) <= 0.4
    rows = [p | {"median [m/s2]": math.exp(-abs(p["x"] - 0.7) - abs(p["y"] - 0.5))} for p in points]
    found = search.proposed(rows)
    assert 0.3 < found["x"] <= 0.4
    assert found["y"] == pytest.approx(0.5, abs=0.3)
    refused(
        CampaignError,
        "choose bounds",
        dataclasses.replace(search, constraint=lambda _: 2.0).first_points,
    )


def test_devices_of_the_file_are_sized_as_it_says(folder: Path) -> None:
    """By hand: sliders by pressure, the way by plan or moat; R = 1.5 m, L = 2.8 m."""
    asked = FILE.replace('rims = [0.5, "unbreakable"]', 'devices = ["wide"]')
    (folder / "own.toml").write_text(asked.replace("[compare]", f"{OWN}[compare]"))
    compared = comparison_in(folder / "own.toml")
    assert compared is not None
    assert compared.groups == {"the rims of each": ["LIR", "wide"]}
    grouped = (
        asked.replace("[compare]", f"{OWN}[compare]")
        .replace(
            'devices = ["wide"]', 'groups = {a = ["LIR", "wide", "tall"], b = ["wide", "tall"]}'
        )
        .replace('name = "Rims"', 'name = "Rims"\ndevices = ["tall", "LIR"]')
    )
    (folder / "groups.toml").write_text(grouped)
    those = comparison_in(folder / "groups.toml")  # whose first is run, with those that are
    assert those is not None
    assert (those.groups, [*those.frames]) == ({"a": ["LIR", "tall"]}, ["LIR", "tall"])
    bearings = {
        name: [link.bearing for link in frame.bearings.values()]
        for name, frame in compared.frames.items()
    }
    lir, wide, tall = bearings["LIR"][0], bearings["wide"][0], bearings["tall"][0]
    loads = gravity(compared.frames["tall"]).axial_forces
    assert lir.slider_radius == pytest.approx(math.sqrt(loads[0] / (math.pi * 3e6)))
    assert lir.resolved()["design_load"] == pytest.approx(loads[0])
    assert lir.lateral_capacity == pytest.approx((0.35 - lir.slider_radius) * 2.8 / 1.5)
    assert dish_diameter(lir) == pytest.approx(0.7)
    assert wide.lateral_capacity == pytest.approx(0.4 - 2.0 * 0.02 * 2.8 / (2.0 * 1.5))
    assert moat_of(bearings["wide"]) == pytest.approx(0.4)
    with pytest.warns(AnalysisWarning, match=r"bearing failed \(rim deformation 0.02"):
        slow = cyclic_test(wide, np.linspace(0.0, 0.5, 251), loads[0])
    assert float(slow["bearing_displacement"].max()) == pytest.approx(0.4, abs=0.002)
    assert moat_of(bearings["LIR"]) == pytest.approx(lir.lateral_capacity + lir.slider_radius)
    assert wide.rim_yield_force == 0.5 * 300e3
    assert tall.rim_yield_force == math.inf
    assert moat_of(bearings["tall"]) == tall.lateral_capacity == pytest.approx(0.2 * 2.8 / 1.5)


def test_plates_that_would_touch_have_higher_sliders() -> None:
    """Two dishes of 1 m on R = 1.5 m rise by 2 x 85.8 mm; sliders were 200 mm high, now of 100."""
    flat = dataclasses.replace(BEARING, radius=1.45, slider_height=0.1)
    (made,) = (
        each.bearing for each in Device(plan=1.0).on(lumped_mass(flat, 3e4)).bearings.values()
    )
    assert made.slider_height == pytest.approx(0.18)
    assert made.radii == pytest.approx((1.49, 1.49))
    assert made.effective_radius == pytest.approx(flat.effective_radius)
    assert dish_diameter(made) == pytest.approx(1.0)


def test_motions_are_scaled_to_the_intensities(folder: Path, data: xr.Dataset) -> None:
    motions = read_campaign(folder / "rims.toml").motions
    measure = Intensity(kind="Sa", period=2.5, measure="x")
    assert {round(measure.of(motion), 9) for motion in motions.values()} == {1.0}
    assert [motion.duration for motion in motions.values()] == [pytest.approx(5.99)] * 4
    assert sorted(set(data["scale"].to_numpy())) == [2.0, 2.5, 3.0, 4.0, 5.0]
    page = (folder / "rims-results/campaign.html").read_text()
    assert "Sa(2.5 s, 5 %), x [m/s2]" in page
    assert "factor on the motions" not in page.split('id="fragility"')[0]


def test_margins_are_those_of_the_database(folder: Path, data: xr.Dataset) -> None:
    table = pd.read_csv(folder / "rims-results/campaign-margins.csv", index_col=0)
    assert len(table) == 5
    considered = filling_intensity(BEARING, 2.5)
    found = 0
    for device, row in table.iterrows():
        im, _, exceeded = collapsed(data, str(device))
        assert (row["runs"], row["collapsed"]) == (20, exceeded.sum())
        if pd.isna(row["median [m/s2]"]):
            assert row["no curve"]
            continue
        found += 1
        median = likeliest_median(im, exceeded)
        assert row["median [m/s2]"] == pytest.approx(median, rel=1e-4)
        assert row["margin [-]"] == pytest.approx(median / considered, rel=1e-4)
        assert row["median, low [m/s2]"] <= median <= row["median, high [m/s2]"]
    assert found >= 3
    page = (folder / "rims-results/campaign.html").read_text()
    assert "Collapse is failure of a bearing, or a storey drift above 0.3 %." in page


def test_ratios_are_of_paired_records(folder: Path, data: xr.Dataset) -> None:
    table = pd.read_csv(folder / "rims-results/campaign-ratios.csv")
    assert len(table) == 2 * 2 * 2
    own = table[(table["limit state"] == "collapse") & table["ratio [-]"].notna()]
    assert len(own) >= 1
    for _, row in own.iterrows():
        first = f"LIR-DCFP, {row['rims']}"
        medians = [likeliest_median(*collapsed(data, name)[::2]) for name in (first, row["over"])]
        assert row["ratio [-]"] == pytest.approx(medians[0] / medians[1], rel=1e-4)
        assert row["low [-]"] <= row["ratio [-]"] <= row["high [-]"]
        # leaving whole records out by turns stays near the interval: both devices met the same
        left_out = []
        for gone in {*data["motion"].to_numpy()}:
            pair = []
            for name in (first, row["over"]):
                im, motion, exceeded = collapsed(data, name)
                pair.append(likeliest_median(im[motion != gone], exceeded[motion != gone]))
            left_out.append(pair[0] / pair[1])
        assert min(left_out) > 0.8 * row["low [-]"]
        assert max(left_out) < 1.25 * row["high [-]"]
    assert (table["ratio [-]"].isna() == table["no ratio"].notna()).all()
    # stripes beyond the limit, record by record: by counting, and p by the binomial's own formula
    for _, row in table[table["limit state"] == "collapse"].iterrows():
        both = [collapsed(data, name) for name in (f"LIR-DCFP, {row['rims']}", row["over"])]
        totals = [{m: over[at == m].sum() for m in {*at}} for _, at, over in both]
        differ = [totals[0][m] - totals[1][m] for m in totals[0]]
        more, less = sum(d > 0 for d in differ), sum(d < 0 for d in differ)
        assert (row["more"], row["less"]) == (more, less)
        tail = sum(math.comb(more + less, k) for k in range(min(more, less) + 1))
        assert row["p"] == pytest.approx(min(1.0, 2.0 * tail / 2.0 ** (more + less)))
        assert row["verdict"] == "too few differ"  # four records decide nothing


def test_sizes_are_those_of_the_devices(folder: Path, data: xr.Dataset) -> None:
    table = pd.read_csv(folder / "rims-results/campaign-devices.csv", index_col=0)
    larger = table.loc["larger DCFP"]
    own = data["model"].to_numpy() == "larger DCFP"
    largest = float(data["peak_displacement"].to_numpy()[own].max())
    assert larger["largest displacement [m]"] == pytest.approx(largest, rel=1e-12)
    assert larger["dish diameter [m]"] == pytest.approx(2.0 * (largest * 1.5 / 2.8 + 0.2))
    weak, strong = (table.loc[f"DCFP, {rims}"] for rims in ("rims of 0.5 W", "unbreakable rims"))
    assert weak["rims yield at [N]"] == 150e3
    stiffness = BEARING.resolved()["rim_stiffness"]
    hardened = 0.005 * stiffness * (0.02 - 150e3 / stiffness)
    assert weak["rims break at [N]"] == pytest.approx(150e3 + hardened)
    assert np.isinf(strong[["rims yield at [N]", "rims break at [N]"]].to_numpy(dtype=float)).all()
    status = data["status"].to_numpy()[data["model"].to_numpy() == "DCFP, unbreakable rims"]
    assert "rim_overrun" not in status
    assert "rim_overrun" in data["status"].to_numpy()


def test_the_intensity_considered_may_be_given(folder: Path) -> None:
    changed = FILE.replace('collapse_drift = "0.3 %"', 'maximum_considered = "0.3 g"')
    (folder / "other.toml").write_text(changed)
    found = comparison_in(folder / "other.toml")
    assert found is not None
    assert found.considered == pytest.approx(0.3 * 9.80665)
    assert found.collapse == collapse_limit(None)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("rims = [0.5", 'devices = ["DCFP of the same plan"]\nrims = [0.5', "needs slider_radius"),
        ("rims = [0.5", 'slider_radius = "150 mm"\nrims = [0.5', "alone: name it in devices"),
        ("rims = [0.5", "rims = [0.5, 0.5", "has one twice"),
        ("rims = [0.5", "rims = [-0.5", "compare.rims"),
        ("rims = [0.5", 'devices = ["FPS"]\nrims = [0.5', '"FPS" is none of DCFP'),
        ("[compare]", f"{OWN}[compare]", "compare.rims: [devices] says it"),
        (COMPARED, f'{OWN}[compare]\ndevices = ["LIR"]\n', "none of wide, tall"),
        (
            COMPARED,
            f'{OWN}[compare.groups]\na = ["LIR", "LIR"]\n',
            "groups.a = ['LIR', 'LIR'] has one",
        ),
        (COMPARED, f'{OWN}[compare.groups]\na = ["LIR", "FPS"]\n', 'a: "FPS" is none of LIR, wide'),
        (COMPARED, f'{OWN}capacity = "0.3 m"\n', "[devices.tall] plan and capacity are given"),
        (COMPARED, f"{OWN}interface_friction = 0.2\n", "applies to an LIR-DCFP"),
        (COMPARED, SEARCH.replace('"LIR"', '"FPS"'), '"FPS" is no table of [devices]'),
        (COMPARED, SEARCH.replace('"collapse"', '"ruin"'), "choose one of floor acceleration"),
        (COMPARED, SEARCH.replace("0.3}", "0.1}").replace("limit", "#"), "low = 0.1 must be below"),
        (COMPARED, OWN.replace("800", "300"), "no capacity before the rims: give more than 400 mm"),
        ('name = "Rims"', 'name = "Rims"\ndevices = ["DCFP"]', "[compare] has the devices"),
        ('tail = "1 s"', "scales = [1.0]", "has scales and intensities"),
        ('intensity = "Sa"\nperiod = "2.5 s"\n', "", "motions.intensities are accelerations"),
        (
            "[analysis]",
            '[sample]\nkind = "grid"\n[parameters]\ncapacity = {values = ["0.2 m"]}\n[analysis]',
            "parameters.capacity: [compare] makes its devices by it",
        ),
    ],
)
def test_messages_name_key_and_remedy(folder: Path, old: str, new: str, words: str) -> None:
    (folder / "bad.toml").write_text(FILE.replace(old, new, 1))
    found = run(app, ["campaign", str(folder / "bad.toml")])
    assert found.exit_code == 2
    assert words in " ".join(found.output.split())


COMPONENTS = """component,damaged by,quantity,median,dispersion,cost,source
walls,drift,10,0.2 %,0.4,200,assumed
walls,drift,10,0.6 %,0.4,900,assumed
ceilings,floor acceleration above,10,0.3 g,0.5,100,assumed
"""
HAZARD = "Sa [g],return period [years]\n0.05,30\n0.2,300\n0.9,20000\n"
LOSS = """
[loss]
components = "components.csv"
replacement = 2e4
hazard = "hazard.csv"
"""


def test_losses_are_those_of_numpy_and_scipy(folder: Path, data: xr.Dataset) -> None:
    (folder / "components.csv").write_text(COMPONENTS)
    (folder / "hazard.csv").write_text(HAZARD)
    (folder / "loss.toml").write_text(FILE + LOSS)
    store = ["--store", str(folder / "rims-results")]
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        done = run(app, ["campaign", str(folder / "loss.toml"), *store])
    assert done.exit_code == 0, done.output
    page = folder / "rims-results/campaign.html"
    text = page.read_text()
    assert '<h2 id="loss">' in text
    loss = pd.read_csv(page.with_name("campaign-loss.csv"))
    annual = pd.read_csv(page.with_name("campaign-annual_loss.csv")).set_index("structure")
    for device in ("LIR-DCFP, rims of 0.5 W", "DCFP, rims of 0.5 W"):
        im, _, down = collapsed(data, device)
        own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
        drift = own["peak_drift"].to_numpy()[:, 0]
        slight, severe = (stats.lognorm.cdf(drift, 0.4, scale=m) for m in (0.002, 0.006))
        walls = 10.0 * (200.0 * (slight - severe) + 900.0 * severe)
        floors = own["peak_floor_plan"].to_numpy()[:, 1:]
        ceilings = 1e3 * stats.lognorm.cdf(floors, 0.5, scale=0.3 * 9.80665).sum(axis=1)
        each = np.where(down, 1.0, np.minimum((walls + ceilings) / 2e4, 1.0))
        at = np.unique(im)
        mean = np.array([each[im == level].mean() for level in at])
        row = loss[loss["structure"] == device]
        np.testing.assert_allclose(row["loss [-]"], mean, rtol=1e-6)
        parts = ["collapse [-]", "walls [-]", "ceilings [-]"]
        np.testing.assert_allclose(row[parts].sum(axis=1), mean, rtol=1e-6)
        assert (row["loss, low [-]"] <= mean).all()
        assert (mean <= row["loss, high [-]"]).all()
        g, years = np.log([0.05, 0.2, 0.9]), np.log([30.0, 300.0, 20000.0])

        def rate(sa: float, g: np.ndarray = g, years: np.ndarray = years) -> float:
            return float(np.exp(-np.interp(np.log(sa / 9.80665), g, years)))

        line = lambda sa, at=at, mean=mean: np.interp(sa, [0.0, *at], [0.0, *mean])  # noqa: E731
        steps = np.geomspace(0.05 * 9.80665, 0.9 * 9.80665, 40001)
        rates = np.array([rate(sa) for sa in steps])
        middle = line(np.sqrt(steps[1:] * steps[:-1]))
        expected = float(-np.diff(rates) @ middle) + mean[-1] * rates[-1]
        assert annual.loc[device, "loss [1/year]"] == pytest.approx(expected, rel=1e-3)
        above = mean[-1] * rate(at[-1]) / expected
        assert annual.loc[device, "above [-]"] == pytest.approx(above, rel=1e-3)
    ratio = annual["loss [1/year]"].iloc[0] / annual["loss [1/year]"]
    np.testing.assert_allclose(annual["ratio [-]"].iloc[1:], ratio.iloc[1:], rtol=1e-6)
    points = '[["0.05 g", 60], ["0.2 g", 600], ["0.9 g", 40000]]'
    several = LOSS.replace("hazard =", "[loss.hazards]\nhere =") + f"rare = {points}\n"
    (folder / "loss.toml").write_text(FILE + several)
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        done = run(app, ["campaign", "--no-figures", str(folder / "loss.toml"), *store])
    assert done.exit_code == 0, done.output
    both = pd.read_csv(page.with_name("campaign-annual_loss.csv")).set_index("structure")
    of = {name: table.drop(columns="hazard") for name, table in both.groupby("hazard")}
    pd.testing.assert_frame_equal(of["here"], annual)
    np.testing.assert_allclose(of["rare"].iloc[:, :3], 0.5 * annual.iloc[:, :3], rtol=1e-6)
    assert "rare, DCFP, rims of 0.5 W" in page.read_text()


def test_components_stand_in_storeys_from_below() -> None:
    own = xr.Dataset(
        {
            "peak_drift": (("run", "storey"), np.array([[0.01, 0.02]])),
            "peak_floor_plan": (("run", "level"), np.array([[1.0, 2.0, 4.0]])),
        }
    )
    one = {"medians": [0.02], "dispersions": [1e-3], "costs": [7.0], "quantity": [3.0, 5.0]}
    walls = LossComponent(name="walls", damaged_by="drift", **one)
    assert walls.repair(own)[0] == pytest.approx(0.5 * 5.0 * 7.0)
    one["medians"] = [2.0]
    below = LossComponent(name="desks", damaged_by="floor acceleration", **one)
    assert below.repair(own)[0] == pytest.approx(0.5 * 5.0 * 7.0)
    above = LossComponent(name="ceilings", damaged_by="floor acceleration above", **one)
    assert above.repair(own)[0] == pytest.approx(0.5 * 3.0 * 7.0 + 5.0 * 7.0)
    one["quantity"] = [3.0, 5.0, 7.0]
    more = LossComponent(name="desks", damaged_by="floor acceleration", **one)
    refused(FragilityError, "3 quantities for 2 storeys", more.repair, own)


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("components.csv", "dispersion", "beta", 'has no column "dispersion"'),
        ("components.csv", "0.3 g", "0.3", 'line 4: median = "0.3" has no unit'),
        ("components.csv", "0.6 %", "0.1 %", "component walls: medians = [0.002, 0.001] must rise"),
        ("components.csv", "floor acceleration above", "wind", "damaged_by"),
        ("hazard.csv", "return period", "return", "its first line must be"),
        ("hazard.csv", "0.2,", "0.02,", "must be positive and rise"),
        ("loss.toml", 'hazard = "hazard.csv"', 'hazard = [["1 m/s2", 30]]', "loss.hazard"),
        ("loss.toml", "2e4\n", '2e4\nintensity = "PGA"\n', "[fragility] has another measure"),
        ("loss.toml", 'hazard = "hazard.csv"', 'hazard = "none.csv"', "none.csv"),
        ("loss.toml", 'hazard = "hazard.csv"', "", "loss: has neither hazard nor [loss.hazards]"),
        ("loss.toml", "hazard =", '[loss.hazards]\na = "none.csv"\nb =', "[loss.hazards.a]"),
    ],
)
def test_what_is_no_loss_is_refused(
    tmp_path: Path, file: str, old: str, new: str, words: str
) -> None:
    texts = {"components.csv": COMPONENTS, "hazard.csv": HAZARD, "loss.toml": FILE + LOSS}
    texts[file] = texts[file].replace(old, new)
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    refused(ProjectError, re.escape(words), loss_in, tmp_path / "loss.toml")
