"""What analyses say of how far they are: on a terminal, in a notebook, in a log file."""

import io
import sys

import numpy as np
import pytest

from frames import Frame, GroundMotion, _progress_line, lumped_mass, time_histories, time_history
from frames._progress_line import ProgressLine
from frames.demo import bearing_for
from tests import etabs_models

PULSE = GroundMotion(x=1.5 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016, name="pulse")


class Notebook(io.StringIO):
    """The standard error of a notebook's kernel."""


Notebook.__module__ = "ipykernel.iostream"


kinds = pytest.mark.parametrize("kind", [io.StringIO, Notebook])


@kinds
def test_a_time_history_draws_a_bar(kind, monkeypatch):
    written = kind()
    monkeypatch.setattr(sys, "stderr", written)
    data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), PULSE, progress=True)
    assert data.attrs["status"] == "ok"
    text = written.getvalue()
    assert text.endswith("\n")
    assert f"[{20 * '#'}]" in text.rpartition("\r")[2]
    assert text.startswith("\r") is isinstance(written, Notebook)


@kinds
def test_many_time_histories_tell_how_many_are_done(kind, monkeypatch):
    written = kind()
    monkeypatch.setattr(sys, "stderr", written)
    frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    time_histories(frame, {"pulse": PULSE}, scales=[0.5, 1.0], workers=1, progress=True)
    assert "2 of 2 runs" in written.getvalue()
    assert ("\r" in written.getvalue()) is isinstance(written, Notebook)


def test_lines_that_stay_are_written_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    for kind, seconds in ((io.StringIO, 30.0), (Notebook, 0.5)):
        stream = kind()
        monkeypatch.setattr(sys, "stderr", stream)
        line = ProgressLine()
        for elapsed in (0.9 * seconds, seconds, 1.9 * seconds, 2.0 * seconds):
            line.write(f"at {elapsed:g} s", elapsed, ends=False)
        words = stream.getvalue().replace("\r", "\n").split("\n")
        assert [w.strip() for w in words if w.strip()] == [f"at {k * seconds:g} s" for k in (1, 2)]


@pytest.mark.parametrize("quiet", ["", "1"])
def test_a_long_import_says_what_it_makes(quiet, monkeypatch, tmp_path) -> None:
    stream = Notebook()
    monkeypatch.setenv("LIR_QUIET", quiet)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(_progress_line, "_EVERY", (0.0, 0.0))
    path = tmp_path / "tower.e2k"
    path.write_text(etabs_models.building(), encoding="utf-8")
    frame = Frame.from_etabs(path)
    lines = stream.getvalue().split("\r")
    assert any("loads" in line for line in lines) is not bool(quiet)
    assert lines[-1].startswith(f"tower.e2k: {len(frame.nodes)} nodes") is not bool(quiet)


def test_progress_is_a_function_or_true() -> None:
    frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    with pytest.raises(TypeError, match="progress = 3 must be True, or a function of the share"):
        time_history(frame, PULSE, progress=3)  # type: ignore[arg-type]
