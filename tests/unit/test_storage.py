"""Saving results: the old file or the new one is there, and a failure is said and survived."""

import os
import signal
import subprocess  # noqa: S404
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from frames import load, save
from tests.patience import fresh, patience


def results(value: float = 1.0, count: int = 1000) -> xr.Dataset:
    return xr.Dataset({"u": ("time", np.full(count, value))}, attrs={"status": "ok"})


def script(code: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    head = "import os, sys, numpy as np, xarray as xr\nfrom frames import load, save\n"
    return fresh(head + code, *arguments, timeout=patience(), check=False)


def test_round_trip_and_replacement(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    for value in (1.0, 2.0):
        save(results(value), path)
        xr.testing.assert_identical(load(path), results(value))
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.nc"]


def test_a_file_of_version_0_2_is_read_with_the_names_of_now(tmp_path: Path) -> None:
    old = results().assign(reached_slip=2.0, reached_slip_at=3.0)
    save(old.assign_coords(masses_moved="+x"), tmp_path / "run.nc")
    now = results().assign(peak_slip=2.0, peak_slip_at=3.0).assign_coords(mass_shift="+x")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), now)
    with load(tmp_path / "run.nc", lazy=True) as data:
        xr.testing.assert_identical(data.load(), now)


def test_a_link_and_the_rights_of_a_file_are_kept(tmp_path: Path) -> None:
    path, link = tmp_path / "run.nc", tmp_path / "latest.nc"
    save(results(1.0), path)
    path.chmod(0o640)
    link.symlink_to(path)
    save(results(2.0), link)
    assert link.is_symlink()
    assert path.stat().st_mode & 0o777 == 0o640
    assert float(load(path)["u"][0]) == 2.0


@pytest.mark.parametrize("moment", ["fsync", "replace"])
def test_killed_in_the_middle(tmp_path: Path, moment: str) -> None:
    """The old results are there, whole, when the process dies before the new ones are."""
    path = tmp_path / "run.nc"
    save(results(1.0), path)
    code = """
import pathlib, signal
def die(*_): os.kill(os.getpid(), signal.SIGKILL)
os.fsync = die if sys.argv[2] == "fsync" else os.fsync
pathlib.Path.replace = die
save(xr.Dataset({"u": ("time", np.zeros(300000))}), sys.argv[1])
"""
    assert script(code, str(path), moment).returncode == -signal.SIGKILL
    xr.testing.assert_identical(load(path), results(1.0))


def test_a_full_disk_is_said_and_survived(tmp_path: Path) -> None:
    """The error names the file, the old results stay, and the process saves elsewhere and ends."""
    pytest.importorskip("resource")
    path, other = tmp_path / "run.nc", tmp_path / "other.nc"
    save(results(1.0), path)
    code = """
import resource
sys.dont_write_bytecode = True  # it would be kept where the limit cuts it off
data = xr.Dataset({"u": ("time", np.random.default_rng(0).normal(size=100000))})
soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (100000, hard))
try:
    save(data, sys.argv[1])
except OSError as error:
    print(error)
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
save(data, sys.argv[2])
print(load(sys.argv[2]).identical(data))
"""
    ended = script(code, str(path), str(other))
    assert ended.returncode == 0, ended.stderr
    said, saved = ended.stdout.strip().splitlines()
    assert str(path) in said
    assert "unchanged" in said
    assert saved == "True"
    xr.testing.assert_identical(load(path), results(1.0))
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["other.nc", "run.nc"]


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"run\.nc could not be written .*save to another place"):
        save(results(), tmp_path / "nowhere" / "run.nc")


def test_no_permission(tmp_path: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("root may write everywhere")
    tmp_path.chmod(0o500)
    with pytest.raises(PermissionError, match=r"run\.nc could not be written"):
        save(results(), tmp_path / "run.nc")


def test_packed_histories(tmp_path: Path) -> None:
    """Single precision, small, and the energy balance as it was."""
    time = np.linspace(0.0, 10.0, 4001)
    rough = np.sin(time[:, None] * np.arange(1, 9)) * 1e5
    data = xr.Dataset(
        {"force": (("time", "bearing"), rough), "energy": ("time", rough[:, 0]), "mass": 1.0 / 3.0},
        {"time": time},
    )
    save(data, tmp_path / "plain.nc")
    save(data, tmp_path / "packed.nc", compress=True)
    sizes = [(tmp_path / name).stat().st_size for name in ("plain.nc", "packed.nc")]
    assert sizes[1] < 0.6 * sizes[0]
    found = load(tmp_path / "packed.nc")
    np.testing.assert_allclose(found["force"], data["force"], rtol=1e-7)
    for exact in ("energy", "mass", "time"):
        np.testing.assert_array_equal(found[exact], data[exact])


def test_lazy_reads_what_is_used(tmp_path: Path) -> None:
    data = xr.Dataset({"force": ("time", np.arange(5.0)), "other": ("time", np.arange(5.0))})
    save(data, tmp_path / "one.nc")
    with load(tmp_path / "one.nc", lazy=True) as found:
        assert not found["other"].variable._in_memory
        np.testing.assert_array_equal(found["force"].to_numpy(), np.arange(5.0))
        assert not found["other"].variable._in_memory
