"""Bearings beside rigid sliders: numbers of the page are those of the runs, words follow them."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from frames import time_history
from frames.command.app import app
from frames.design import ProjectError, with_property_bounds
from frames.design.project.comparison import (
    OURS,
    PLAIN,
    Comparison,
    compare_project,
    compared_histories,
)
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.report.comparison_page import by_motion, verdicts, write_comparison
from tests.unit.test_project import ASCE

ONE = (
    ASCE.replace(', "artificial-3", "artificial-5"', "")
    .replace("[analysis]\n", '[analysis]\nlevel = "pendulum"\nbounds = ["nominal", "upper"]\n')
    .replace("scale = 0.8", "scale = 0.92")  # rims are met, but not with more friction
)
WEAK = ONE.replace("scale = 0.92", "scale = 0.3")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """Motions of the example, and two small projects."""
    made = put_example(tmp_path_factory.mktemp("compared"))
    (made / "one.toml").write_text(ONE)
    (made / "weak.toml").write_text(WEAK)
    return made


def parts_of(file: Path) -> ProjectInputs:
    return ProjectInputs(read_project(file), file.parent)


@pytest.fixture(scope="module")
def page(folder: Path) -> tuple[str, Any, Path]:
    """The page that the command writes, with what it says and its folder."""
    out = folder / "out"
    done = CliRunner().invoke(app, ["compare", str(folder / "one.toml"), "--results", str(out)])
    assert done.exit_code == 0, done.output
    return (out / "compare.html").read_text(encoding="utf-8"), done, out


@pytest.fixture(scope="module")
def found(folder: Path) -> Comparison:
    """The same comparison in Python."""
    return compare_project(parts_of(folder / "one.toml"))


def test_the_table_is_that_of_single_runs(found: Comparison, folder: Path) -> None:
    """One motion: the envelope is the largest of two runs, made here one by one."""
    parts, known = parts_of(folder / "one.toml"), found.known
    motion = known.motions["artificial-1"]
    plain = {name: link.bearing.as_dcfp() for name, link in known.frame.bearings.items()}
    frames = {OURS: known.frame, PLAIN: known.frame.with_bearings(plain)}
    table = found.table()
    for k, (device, frame) in enumerate(frames.items(), start=1):
        bounds = ("nominal", "upper")
        both = [with_property_bounds(frame, bound, parts.bounds()) for bound in bounds]
        runs = [time_history(each, motion, level="pendulum") for each in both]
        moved = [run["bearing_displacement"] for run in runs]
        reached = max(float(np.hypot(*(u.sel(axis=a) for a in "xy")).max()) for u in moved)
        assert table.iloc[:, k]["isolator displacement"] == pytest.approx(reached, rel=1e-9)
        forces = max(float(run["rim_force"].max()) for run in runs)
        motions = found.by_motion().set_index("device")
        assert motions.loc[device, "rim force [N]"] == pytest.approx(forces, rel=1e-9)
        assert table.iloc[:, k]["rim force"] == pytest.approx(forces, rel=1e-9)


def test_the_page_shows_the_numbers_of_the_tables(page: tuple[str, Any, Path]) -> None:
    text, done, out = page
    table = pd.read_csv(out / "compare.csv", index_col=0)
    assert table.columns[1].startswith("LIR-DCFP, ")
    assert "<h2" in text
    for name, unit, factor in (("isolator displacement", "mm", 1e3), ("base shear", "kN", 1e-3)):
        ours, plain = (factor * float(table[column][name]) for column in table.columns[1:3])
        cell = "<td[^>]*>([^<]+)</td>"
        row = re.search(rf"<td[^>]*>{name}</td><td[^>]*>{unit}</td>{2 * cell}", text)
        assert row is not None
        assert [float(cell) for cell in row.groups()] == pytest.approx([ours, plain], rel=1e-3)
    assert text.count("<img src=") == 5  # by motion, loops, storeys, both bearings
    assert "http" not in re.sub(r'src="data:[^"]+"', "", text).replace("http://www.w3.org", "")
    assert re.sub(r"\s+", " ", done.stdout).count("Rim contact occurs") == 1


def test_what_is_said_follows_the_numbers(found: Comparison) -> None:
    (verdict,) = verdicts(found)
    table = found.table()
    ours, plain = table.iloc[:, 1], table.iloc[:, 2]
    said = " ".join(verdict.details)
    lower = said.partition("LIR-DCFP lower: ")[2].partition("With the")[0]
    higher = said.partition("LIR-DCFP higher: ")[2].partition("In return")[0]
    for name in ("base shear", "floor acceleration in plan", "isolator displacement"):
        change = ours[name] / plain[name] - 1.0
        where = lower if change < -0.02 else higher if change > 0.02 else ""
        assert name in where or abs(change) <= 0.021
        assert f"{100.0 * change:+.0f} %" in where or not where
    assert verdict.is_ours is None or (verdict.is_ours == (not higher))
    counts = found.counts(OURS, verdict.level)
    assert counts.runs == 2
    rims = found.runs.where(device=OURS).of("peak_rim_force").max(axis=1)
    assert counts.met == sum(force > 0.0 for force in rims) == 1  # less friction goes farther
    assert "the interface slips by" in said


def test_where_no_rim_is_met_the_plain_one_is_said_to_do(folder: Path, tmp_path: Path) -> None:
    weak = compare_project(parts_of(folder / "weak.toml"))
    (verdict,) = verdicts(weak)
    assert verdict.is_ours is False
    assert "No run reaches a restraining rim" in verdict.head
    assert "In return" not in " ".join(verdict.details)
    written = write_comparison(weak, tmp_path, WEAK, None)
    assert [path.name for path in written] == ["compare.csv", "compare-motions.csv", "compare.html"]
    text = written[-1].read_text(encoding="utf-8")
    assert "Written without figures" in text
    assert "<img" not in text


def test_runs_that_stop_are_told_and_not_compared(found: Comparison) -> None:
    (level,) = found.levels
    stopped = found.by_motion()
    stopped.loc[0, "failed"] = "upper (slip_exceeded)"
    crosses = [line for line in by_motion(stopped).axes[0].lines if line.get_marker() == "x"]
    assert [len(line.get_xdata()) for line in crosses] == [1, 0]
    void = {
        device: table.assign(void="nominal: 1 of 1 runs failed" if device == OURS else "")
        for device, table in found.demands.items()
    }
    (verdict,) = verdicts(Comparison(known=found.known, runs=found.runs, demands=void))
    assert verdict.is_ours is False
    assert "Only the DCFP has values for design" in verdict.head
    assert not [text for text in verdict.details if "lower:" in text or "higher:" in text]
    assert verdict.level == level
    both = {device: table.assign(void="none counts") for device, table in found.demands.items()}
    (verdict,) = verdicts(Comparison(known=found.known, runs=found.runs, demands=both))
    assert verdict.is_ours is None
    assert "No verdict" in verdict.head


def test_the_run_that_is_shown_displaces_most(found: Comparison, folder: Path) -> None:
    data, case, bearing = compared_histories(parts_of(folder / "one.toml"), found)
    sizes = np.hypot(*(data[OURS]["bearing_displacement"].sel(axis=a) for a in "xy"))
    worst = str(sizes["bearing"].to_numpy()[int(np.argmax(sizes.max("time").to_numpy()))])
    assert bearing == worst
    assert case.startswith("artificial-1, ")
    assert float(sizes.max()) == pytest.approx(
        found.by_motion().set_index("device").loc[OURS, "isolator displacement [m]"], rel=1e-6
    )


def test_a_plain_bearing_is_not_compared_with_itself(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "motions", tmp_path / "motions")
    rigid = ONE.replace("interface_friction = 0.18", "interface_friction = inf")
    (tmp_path / "rigid.toml").write_text(rigid)
    with pytest.raises(ProjectError, match=r"interface_friction = inf of .* is a plain DCFP"):
        compare_project(parts_of(tmp_path / "rigid.toml"))
