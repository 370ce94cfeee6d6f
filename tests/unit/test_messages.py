"""What is told at small doors: a load in kN, a file that is none of results, long values."""

from pathlib import Path

import numpy as np
import pytest

import frames
from frames import audit, audit_report, load, lumped_mass, modes, peaks, time_history
from lir_element import DesignWarning, cyclic_test
from tests.scenes import small_bearing

BEARING = small_bearing()


def test_a_load_in_kilonewtons_is_told() -> None:
    with pytest.warns(DesignWarning, match=r"axial_load = 150 N .*150 kN are 1.5e\+05 N"):
        cyclic_test(BEARING, [0.0, 0.001], 150.0)


def test_a_file_that_holds_no_results_is_told(tmp_path: Path) -> None:
    path = tmp_path / "other.nc"
    path.write_text("no results")
    with pytest.raises(OSError, match=r"other\.nc has no results \(netCDF\): use a file"):
        load(path)


def test_results_print_in_a_few_lines() -> None:
    model = lumped_mass(BEARING, 15e3)
    motion = frames.GroundMotion(x=np.sin(np.arange(0.0, 1.0, 0.01)), dt=0.01)
    data = time_history(model, motion)
    with pytest.raises(TypeError, match="data = a list of 1 must be a Dataset") as told:
        peaks([data])  # type: ignore[arg-type]
    assert len(str(told.value)) < 300
    found = modes(model, 2)
    assert len(repr(found)) < 300
    assert f"{found.periods[0]:.4g}" in repr(found)
    assert "<table>" in found._repr_html_()
    findings = audit(data)
    assert repr(findings) == audit_report(data)
    assert isinstance(findings, tuple)
    assert "check of modelling assumptions" in findings._repr_html_()
