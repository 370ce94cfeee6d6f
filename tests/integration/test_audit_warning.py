"""A completed run with a mark in its assumption check is told apart wherever it is shown."""

import math
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from frames import (
    Analysis,
    AuditWarning,
    GroundMotion,
    audit,
    audit_report,
    load,
    lumped_mass,
    moment_frame,
    save,
    time_history,
)
from frames.batch.time_histories import _warn_of_runs
from frames.demo import status_of, table_of, write_results
from frames.plots import histories
from frames.results.assumption_checks import needed_level
from frames.results.findings import Findings, remark
from lir_element import Features
from validation.scenes import EXAMPLE_MASS, example_bearing

TIME = np.arange(0.0, 5.0, 0.005)
PUSH = GroundMotion(
    x=2.6 * np.exp(-(((TIME - 2.0) / 1.2) ** 2)) * np.sin(2 * np.pi * TIME / 1.6), dt=0.005
)
WITHOUT = Features(rims=False, interface=False)


@pytest.fixture(scope="module")
def model():
    return lumped_mass(example_bearing(), EXAMPLE_MASS)


@pytest.fixture(scope="module")
def marked(model):
    with pytest.warns(AuditWarning, match="rims left out: reached") as told:
        data = time_history(model, PUSH, features=WITHOUT)
    with pytest.warns(AuditWarning, match="rims left out: reached") as again:
        Analysis(model, features=WITHOUT).run(PUSH)
    assert {each[0].filename for each in (told, again)} == {__file__}
    return data


def test_status_stays(marked):
    assert marked.attrs["status"] == "ok"
    assert marked.attrs["message"] == "completed"


def test_a_run_without_a_mark_does_not_warn(model):
    with warnings.catch_warnings():
        warnings.simplefilter("error", AuditWarning)
        calm = time_history(model, PUSH.scaled(0.2))
    assert "! " not in calm.attrs["audit"]
    assert status_of(calm) == "completed"


def test_summaries_show_it(tmp_path):
    building = moment_frame(bays=(1, 1), storeys=1, bearing=example_bearing())
    marked = time_history(building, PUSH, features=WITHOUT)
    assert status_of(marked) == "completed, warning"
    line = next(line for line in audit_report(marked).splitlines() if line.startswith("! rims"))
    assert f"one: warning: {line[2:]}" in table_of({"one": marked}).splitlines()
    write_results({"one": marked}, tmp_path)
    assert line[2:] in (tmp_path / "summary.csv").read_text(encoding="utf-8")


def test_figures_show_it_after_loading(marked, tmp_path):
    save(marked, tmp_path / "one.nc")
    figure = histories({"one": load(tmp_path / "one.nc")})
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert "one (see its assumption check)" in texts


def test_auto_keeps_what_meets_no_rim_where_it_is(model):
    """Rims that are met ask for the level "contact": rim forces are off at "pendulum"."""
    kept = time_history(model, PUSH.scaled(0.6), level="auto")
    assert float(kept["rim_force"].max()) == 0.0
    assert kept.attrs["level"] == "pendulum"
    with warnings.catch_warnings():
        warnings.simplefilter("error", AuditWarning)  # a small slip is right at "pendulum", too
        plain = time_history(model, PUSH.scaled(0.81))
    assert 1e-3 < float(plain["interface_slip_size"].max()) < 0.02
    met = time_history(model, PUSH.scaled(0.81), level="auto")
    assert met.attrs["level"] == "contact"
    assert float(met["interface_slip_size"].max()) == pytest.approx(
        float(plain["interface_slip_size"].max()), rel=0.02
    )


def test_auto_hands_sliders_that_spin_to_the_bodies(model):
    """Pushed along x and y out of phase, the slider runs along its rims."""
    time = np.arange(0.0, 12.0, 0.005)
    bell = 2.2 * np.exp(-(((time - 3.0) / 2.0) ** 2))
    x, y = (bell * np.sin(2 * np.pi * time / 1.6 + phase) for phase in (0.0, 1.2))
    push = GroundMotion(x=x, y=y, dt=0.005)
    cheap = time_history(model, push)
    spin = float(np.abs(cheap["slider_spin"]).max())
    assert spin > 0.5
    assert needed_level(audit(cheap)) == "contact"
    said = f"the sliders spun by {spin:.2g} rad, on which the slip depends; rerun with"
    assert said in cheap.attrs["audit"]
    kept = time_history(model, push, level="auto")
    assert kept.attrs["level"] == "contact"
    assert "rerun with level" not in kept.attrs["audit"]


def test_of_many_runs_the_gravest_doubt_is_named():
    edge, thrown = "interface eccentricity reached 0.8", "accelerations: node top reached 79 g"
    known = {
        text: remark(text.split()[0].strip(":"), 1.0, text, doubtful=True)
        for text in (edge, thrown)
    }
    said = [(), (edge,), (edge, thrown), (thrown,)]
    rows = [
        SimpleNamespace(
            place=k,
            status="ok",
            message="",
            failed_at=math.nan,
            findings=Findings(known[text] for text in texts),
        )
        for k, texts in enumerate(said)
    ]
    with pytest.warns(AuditWarning, match=f"first, run 2: {edge}; {thrown}") as found:
        _warn_of_runs(rows)
    assert "3 of 4 runs completed with a warning" in str(found[0].message)
    assert "; 2 with unreliable forces or accelerations" in str(found[0].message)
    with pytest.warns(AuditWarning, match=f"with a warning; the first, run 1: {edge}"):
        _warn_of_runs(rows[:2])
