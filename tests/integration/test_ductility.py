"""How far links and hinges yielded, against the histories; what thinned recordings keep of it."""

import math

import numpy as np
import pytest

from frames import (
    GroundMotion,
    Recording,
    ductility,
    lumped_mass,
    moment_frame,
    peaks,
    shear_building,
    storey_drift,
    storey_ductility,
    time_history,
)
from frames.laws import Bilinear, HertzGap, PlasticHinge, Tie, ViscousDamper
from lir_element import AnalysisWarning
from tests.scenes import simple_bearing as device

DT, HEIGHT = 0.005, 3.0
TIME = np.arange(0.0, 4.0, DT)
BELL = np.exp(-(((TIME - 1.5) / 0.9) ** 2))
MOTION = GroundMotion(
    x=4.0 * BELL * np.sin(2 * np.pi * TIME / 1.4), y=1.5 * BELL * np.sin(5.0 * TIME), dt=DT
)
STIFFNESS, STRENGTH = 3e7, 6e4  # N/m, N
YIELD = STRENGTH / STIFFNESS


def stick():
    """Return storeys that yield, with a rod, a rod that cannot yield, a damper and a wall."""
    frame = shear_building(
        device().as_dcfp(rims=False),
        [3e4] * 3,
        [STIFFNESS] * 3,
        storey_height=HEIGHT,
        storey_law=lambda k: Bilinear(stiffness=k, yield_force=STRENGTH, hardening=0.02),
    )
    frame.add_link("rod", "floor-1", "base", Tie(stiffness=1e6, yield_force=5e3), "ux")
    frame.add_link("cable", "base", "floor-1", Tie(stiffness=1e5), "ux")
    frame.add_link("damper", "base", "floor-1", ViscousDamper(coefficient=1e4), "ux")
    wall = HertzGap(gap=0.1, stiffness=1e9)
    frame.add_moat("moat", ["base"], {"x+": wall, "x-": wall})
    return frame


@pytest.fixture(scope="module")
def storeys():
    data = time_history(stick(), MOTION, dt=DT)
    assert data.attrs["status"] == "ok"
    return data


@pytest.fixture(scope="module")
def hinged():
    hinge = PlasticHinge(moment_y=2.5e4, moment_z=2.5e4, hardening=0.02)
    plain = device().as_dcfp(rims=False)
    frame = moment_frame((1, 1), 1, bearing=plain, hinges={"column": hinge})
    return time_history(frame, MOTION, dt=DT)


def test_storeys_yield_as_they_drift(storeys):
    """The deformation of a storey's link is its drift: a floor of a stick does not turn."""
    drift = HEIGHT * storey_drift(storeys).to_numpy()
    table, rows = ductility(storeys), storey_ductility(storeys)
    assert list(rows.index) == ["storey-1", "storey-2", "storey-3"]
    for k, name in enumerate(rows.index):
        for axis, letter in enumerate("xy"):
            reached = np.abs(drift[:, k, axis])
            row = table.loc[f"{name}-{letter}"]
            assert row["kind"] == "link"
            assert row["largest"] == pytest.approx(reached.max(), rel=1e-7)
            assert row["time"] == TIME[reached.argmax()]
            assert row["ductility"] == pytest.approx(reached.max() / YIELD, rel=1e-7)
            assert rows.loc[name, letter] == row["ductility"]
            assert row["residual"] == pytest.approx(reached[-1], rel=1e-6)
            assert rows.loc[name, f"residual_{letter}"] == row["residual"]
            assert row["yield"] == pytest.approx(YIELD)
            assert math.isnan(row["cumulative"])
    assert rows["x"].max() > 20.0


def test_the_work_of_links_is_that_under_their_loops(storeys):
    """Force times change of deformation, less the elastic energy at the end, f^2 / 2k."""
    table = ductility(storeys)
    for name in ("storey-1-x", "storey-2-x"):
        one = storeys.sel(link=name)
        f, d = one["link_force"].to_numpy(), one["link_deformation"].to_numpy()
        loops = float((0.5 * (f[1:] + f[:-1]) * np.diff(d)).sum())
        stored = 0.5 * f[-1] ** 2 / STIFFNESS
        assert table.loc[name, "work"] == pytest.approx(loops - stored, rel=2e-3)


def test_a_rod_is_stretched_where_it_pulls_alone(storeys):
    """It goes further slack than it is stretched: only the elongation counts."""
    d = storeys["link_deformation"].sel(link="rod").to_numpy()
    force = storeys["link_force"].sel(link="rod").to_numpy()
    row = ductility(storeys).loc["rod"]
    assert -d.min() > d.max()
    assert row["largest"] == pytest.approx(d[force > 0.0].max())
    assert row["ductility"] == pytest.approx(d.max() / 5e-3)
    assert "cable" not in ductility(storeys).index
    assert "damper" not in ductility(storeys).index


def test_hinges_turn(hinged):
    table = ductility(hinged)
    about = (hinged["hinge_rotation"].sel(hinge_force_component=m) for m in ("My", "Mz"))
    turned = np.hypot(*(each.to_numpy() for each in about))
    assert list(table.index) == [str(name) for name in hinged["hinge"].to_numpy()]
    assert turned.max() > 1e-3
    for k, (_, row) in enumerate(table.iterrows()):
        assert row["kind"] == "hinge"
        assert row["largest"] == pytest.approx(turned[:, k].max(), rel=1e-12)
        assert row["time"] == TIME[turned[:, k].argmax()]
        assert row["residual"] == pytest.approx(turned[-1, k], rel=1e-12)
        assert row["cumulative"] == hinged["hinge_turn"].to_numpy()[:, k].max()
        assert row["cumulative"] >= row["largest"]
        assert math.isnan(row["ductility"])
        assert math.isnan(row["yield"])
    yielding = float(hinged["energy"].sel(term="yielding")[-1])
    assert table["work"].sum() == pytest.approx(yielding, rel=1e-9)


def test_peaks_of_yielding(storeys, hinged):
    table = peaks(storeys)
    worst = ductility(storeys)["ductility"]
    row = table.loc["link ductility"]
    assert (row["value"], row["where"]) == (worst.max(), worst.idxmax())
    energy = storeys["energy"]
    share = energy.sel(term="yielding").max() / abs(energy.sel(term="input")).max()
    assert table.loc["work of yielding over input", "value"] == pytest.approx(float(share))
    walls = storeys["link_force"].sel(link=["moat-base-x+", "moat-base-x-"])
    assert float(walls.max()) > 1e5
    assert table.loc["force of a wall", "value"] == float(walls.max())
    assert "plastic rotation of hinges" not in table.index
    turned = peaks(hinged).loc["plastic rotation of hinges"]
    assert turned["value"] == ductility(hinged)["largest"].max()
    assert turned["where"] == ductility(hinged)["largest"].idxmax()
    assert "force of a wall" not in peaks(hinged).index


def test_a_structure_without_parts_has_no_rows():
    data = time_history(lumped_mass(device(), 3e4), MOTION, 0.5, dt=DT)
    assert ductility(data).empty
    assert not {"link ductility", "work of yielding over input"} & set(peaks(data).index)
    with pytest.raises(ValueError, match="no links of storeys that yield"):
        storey_ductility(data)


def test_what_stayed_elastic_has_no_time():
    calm = time_history(stick(), MOTION.scaled(0.15), 1.0, dt=DT)
    table = ductility(calm)
    assert (table["ductility"] < 1.0).all()
    strong = PlasticHinge(moment_y=1e9, moment_z=1e9)
    frame = moment_frame((1, 1), 1, bearing=device(), hinges={"column": strong})
    rows = ductility(time_history(frame, MOTION.scaled(0.15), 1.0, dt=DT))
    assert (rows["largest"] == 0.0).all()
    assert rows["time"].isna().all()


def test_a_run_that_stopped_leaves_nothing():
    frame = stick().with_bearings(device(slip_capacity=0.004))
    with pytest.warns(AnalysisWarning):
        data = time_history(frame, MOTION, dt=DT)
    table = ductility(data)
    assert table["residual"].isna().all()
    assert table["largest"].max() > 0.0


def test_a_recording_without_the_histories_keeps_the_table(storeys):
    short = time_history(stick(), MOTION, dt=DT, recording=Recording(channels=("bearing_force",)))
    assert "link_force" not in short
    assert ductility(short).equals(ductility(storeys))
