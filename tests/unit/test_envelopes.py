"""Envelopes of histories, and the tables that are written of them."""

import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from frames import envelope, write_tables


def history() -> xr.DataArray:
    values = np.array([[1.0, -2.0, np.nan], [5.0, 0.5, np.nan], [-3.0, 7.0, np.nan]])
    labels = {"time": [0.0, 0.1, 0.2], "end": ["i", "j", "k"]}
    return xr.DataArray(values, labels, ("time", "end"), attrs={"units": "N"})


def test_extremes_and_when():
    found = envelope(history())
    assert found["largest"].to_numpy()[:2].tolist() == [5.0, 7.0]
    assert found["smallest"].to_numpy()[:2].tolist() == [-3.0, -2.0]
    assert found["time_of_largest"].to_numpy()[:2].tolist() == [0.1, 0.2]
    assert found["time_of_smallest"].to_numpy()[:2].tolist() == [0.2, 0.0]
    assert all(np.isnan(found[name][2]) for name in found)
    assert found["largest"].attrs["units"] == "N"
    assert found.to_dataframe().loc["j", "largest"] == 7.0


def test_time_may_be_any_dimension():
    xr.testing.assert_identical(envelope(history().transpose("end", "time")), envelope(history()))


def test_values_without_time_are_refused():
    with pytest.raises(ValueError, match=r"dimensions \('end',\): an envelope needs 'time'"):
        envelope(history().isel(time=0))


def tables() -> dict[str, pd.DataFrame]:
    return {"members": envelope(history()).to_dataframe().dropna()}


def test_tables_as_files(tmp_path):
    write_tables(tables(), tmp_path / "forces")
    read = pd.read_csv(tmp_path / "forces" / "members.csv", index_col="end")
    pd.testing.assert_frame_equal(read, tables()["members"])


def test_tables_as_a_workbook(tmp_path):
    pytest.importorskip("openpyxl")
    more = {"a name that is longer than 31 characters": tables()["members"]}
    write_tables(tables() | more, tmp_path / "forces.xlsx")
    read = pd.read_excel(tmp_path / "forces.xlsx", sheet_name=None, index_col=0)
    assert [len(name) for name in read] == [7, 31]
    assert read["members"].loc["i", "smallest"] == -3.0


def test_a_missing_package_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(ImportError, match=r"needs openpyxl: pip install 'lir-dcfp\[excel\]'"):
        write_tables(tables(), tmp_path / "forces.xlsx")
