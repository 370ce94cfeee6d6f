"""A project's spectrum point by point: how it is read, and what analyses make of it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("typer")

from frames import MotionWarning
from frames.design import (
    ProjectError,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    code_named,
    equivalent_linear,
)
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from tests import scenes
from tests.scenes import MOTIONS, STICK, project_head
from tests.square_system import square_system

G = 9.80665
SYSTEM = square_system()
BOUNDS = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
GRID = np.concatenate([[0.0], np.geomspace(0.01, 10.0, 400)])
PROJECT = project_head("Site", "CODE") + STICK + MOTIONS + scenes.BOUNDS + "[spectrum]\n"
POINTS = ((0.0, 0.6), (0.2, 1.4), (0.5, 1.3), (1.0, 0.8), (2.0, 0.36), (4.0, 0.14), (10.0, 0.03))
LIST = "points = [" + ", ".join(f'["{t} s", "{a} g"]' for t, a in POINTS) + "]\n"


def spectrum_of(folder: Path, text: str, code: str = "ASCE 7-22") -> Spectrum:
    (folder / "site.toml").write_text(PROJECT.replace("CODE", code) + text, encoding="utf-8")
    return ProjectInputs(read_project(folder / "site.toml"), folder).spectrum()


def test_displacement_by_the_ordinate_at_the_period(tmp_path: Path) -> None:
    """D_M = g S_aM T_M^2 / (4 pi^2 B_M), S_aM linear between the points, by hand."""
    spectrum = spectrum_of(tmp_path, LIST)
    periods, levels = np.array(POINTS).T
    for result in equivalent_linear(SYSTEM, spectrum, bounds=BOUNDS).bounds.values():
        t = result.trace
        level = float(np.interp(t.value("T_M"), periods, levels))
        assert t.value("S_aM") == pytest.approx(level, rel=1e-12)
        expected = G * level * t.value("T_M") ** 2 / (4.0 * math.pi**2 * t.value("B_M"))
        assert t.value("D_M") == pytest.approx(expected, rel=1e-9)
    plain = equivalent_linear(SYSTEM, Spectrum.asce7(s_ms=1.26, s_m1=0.8), bounds=BOUNDS)
    assert "S_aM" not in plain["lower"].trace
    assert "6 % low at 3 s" in plain["lower"].trace["D_M"].note


@pytest.mark.parametrize(
    ("code", "spectrum", "symbols"),
    [
        ("ASCE 7-22", Spectrum.asce7(s_ms=1.2, s_m1=0.6), ("D_M", "D_TM")),
        ("EN 1998", Spectrum.en1998(a_g=3.4, ground_type="B"), ("d_dc", "d_max")),
        ("NCh2745", Spectrum.nch2745(soil="II", zone=3), ("D_D", "D_M", "D_TM")),
    ],
)
def test_points_of_a_codes_spectrum_give_what_its_formulas_give(code, spectrum, symbols):
    chosen = code_named(code)
    points = chosen.by_points(GRID.tolist(), np.asarray(spectrum.acceleration(GRID)).tolist())
    method = chosen.analysis()
    one, two = (
        equivalent_linear(SYSTEM, each, bounds=BOUNDS, code=method) for each in (points, spectrum)
    )
    for bound, result in one.bounds.items():
        for symbol in symbols:
            expected = two.bounds[bound].trace.value(symbol)
            assert result.trace.value(symbol) == pytest.approx(expected, rel=2e-3)


def test_points_that_end_below_the_period_are_doubted() -> None:
    """At 3 s a multi-period spectrum that ends at 2 s is a guess, and none that ends there is."""
    periods, levels = np.array(POINTS)[:5].T
    short = Spectrum.asce7_multi_period(periods, levels)
    with pytest.warns(MotionWarning, match=r"from its last point, 2 s, to T = 2\.\d+ s"):
        equivalent_linear(SYSTEM, short, bounds=BOUNDS)
    periods, levels = np.array(POINTS)[:6].T  # to 4 s
    longer = Spectrum.asce7_multi_period(periods, levels)
    equivalent_linear(SYSTEM, longer, bounds=BOUNDS)
    assert "last point, 2 s" in short.beyond_points(3.0)
    assert not short.beyond_points(1.9)
    assert "last point, 4 s, to T" in longer.beyond_points(12.0)
    assert not Spectrum.asce7_multi_period(*np.array(POINTS).T).beyond_points(12.0)


def test_lists_and_tables_are_the_same(tmp_path: Path) -> None:
    in_list = spectrum_of(tmp_path, LIST)
    for unit, factor in (("g", 1.0), ("m/s2", G), ("gal", 100.0 * G)):
        rows = "\n".join(f"{t},{factor * a:.12g}" for t, a in POINTS)
        (tmp_path / "site.csv").write_text(f"# MCE_R\nperiod [s], acceleration [{unit}]\n{rows}\n")
        table = spectrum_of(tmp_path, 'points = "site.csv"\n')
        assert np.allclose(table.points, in_list.points, rtol=1e-10)
        assert table.parameters["S_MS"] == pytest.approx(0.9 * 1.4)
    for cut, code in ((";", "utf-8-sig"), ("\t", "utf-16"), (",", "utf-8-sig")):
        text = f"period [s]{cut}acceleration [g]\n" + "\n".join(f"{t}{cut}{a}" for t, a in POINTS)
        (tmp_path / "site.csv").write_text(text if cut == "," else text.replace(".", ","), code)
        table = spectrum_of(tmp_path, 'points = "site.csv"\n')
        assert np.allclose(table.points, in_list.points, rtol=1e-12)
    own = spectrum_of(tmp_path, LIST + 's_m1 = 0.75\nt_l = "6 s"\nv_s30 = "500 m/s"\n')
    assert (own.parameters["S_M1"], own.parameters["T_L"]) == (0.75, 6.0)
    europe = spectrum_of(tmp_path, LIST, "EN 1998-1")
    assert europe.code == "EN 1998"
    assert europe.damping_factor(0.10) == pytest.approx(1.0 / math.sqrt(10.0 / 15.0))
    assert europe.acceleration(0.35) == pytest.approx(1.35 * G)


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("points = 3\n", "ASCE 7-22", r'must be a file, "spectrum.csv", or a list'),
        ('points = [["0 s", "1 g"]]\n', "EN 1998", r"spectrum.points"),
        ('points = [["0 s", 1.0], ["3 s", "1 g"]]\n', "EN 1998", "has no unit"),
        ('points = [["1 s", "1 g"], ["0 s", "1 g"]]\n', "EN 1998", "rising: sort them"),
        ('points = [["1 s", "1 g"], ["3 s", "1 g"]]\n', "ASCE 7-22", "must begin at 0"),
        ('points = "none.csv"\n', "NCh2745", "none.csv: No such file"),
        ('points = "odd.csv"\n', "NCh2745", 'odd.csv begins with "T,Sa": its first line must be'),
        ('points = "unit.csv"\n', "NCh2745", "accelerations are in ft/s2: write them in g"),
        ('points = "row.csv"\n', "NCh2745", "row.csv, line 3: 1.0,x must be two numbers"),
        ('points = "comma.csv"\n', "EN 1998", "line 2: 0,0,1,5 must be.*need semicolons"),
        ('points = "quoted.csv"\n', "EN 1998", "line 2: 0,5 has a decimal comma, but commas sep"),
        ('points = "thousands.csv"\n', "EN 1998", "line 2: 1.000,5 has thousands separators"),
        ('points = "latin.csv"\n', "EN 1998", "latin.csv: is not text in UTF-8.*save it as UTF-8"),
        (LIST + 'soil = "II"\n', "NCh2745", "spectrum.soil is not known"),
        ("s_ms = 1.0\n", "ASCE 7-22", "spectrum.s_m1 is missing"),
    ],
)
def test_what_is_no_spectrum_is_refused(tmp_path: Path, text: str, code: str, words: str) -> None:
    (tmp_path / "odd.csv").write_text("T,Sa\n0,1\n1,1\n")
    (tmp_path / "unit.csv").write_text("period [s],acceleration [ft/s2]\n0,1\n1,1\n")
    head = "period [s],acceleration [g]\n"
    (tmp_path / "comma.csv").write_text(f"{head}0,0,1,5\n")
    (tmp_path / "quoted.csv").write_text(f'{head}"0,5","1,5"\n')
    (tmp_path / "thousands.csv").write_text(f"{head.replace(',', ';')}0,5;1.000,5\n")
    (tmp_path / "latin.csv").write_bytes(b"\xe9\n")
    (tmp_path / "row.csv").write_text("period [s],acceleration [g]\n0,1\n1.0,x\n")
    with pytest.raises(ProjectError, match=words):
        spectrum_of(tmp_path, text, code)
