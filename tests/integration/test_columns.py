"""A column of results: one formula, whether taken up step by step or read off a Dataset."""

import shutil
import warnings
from pathlib import Path

import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

from frames import Frame, moment_frame, time_histories, time_history
from frames.results.peak_response import largest
from frames.results.quantities import QUANTITIES
from lir_element import CoulombFriction, VelocityFriction
from tests.patience import fresh
from tests.scenes import simple_bearing, swell

ROOT = Path(__file__).parents[2]
MOTION = swell(
    x=(2.6, 1.4),
    y=(1.3, 0.9),
    z=(14.0, 0.35),
    middle=1.0,
    width=0.6,
    end=2.5,
    dt=0.01,
    name="both ways and up",
)
BY_STEP = [name for name, quantity in QUANTITIES.items() if quantity.by_step]
FROM_NODES = {"gap", "centre_shift"}
"""Quantities that a Dataset forms of displacements of nodes: of the same state, added up anew."""


@pytest.fixture(scope="module")
def runs() -> tuple[xr.Dataset, xr.Dataset]:
    """Return one run as its histories, and as a row of a batch."""
    bearing = simple_bearing(friction=(VelocityFriction(0.05, 0.03, 12.0), CoulombFriction(0.06)))
    model: Frame = moment_frame((1, 1), 1, bearing=bearing)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return (
            time_history(model, MOTION, dt=0.005),
            time_histories(model, [MOTION], dt=0.005, workers=1),
        )


def test_the_motion_moves_every_column(runs: tuple[xr.Dataset, xr.Dataset]) -> None:
    """Rims are met, sliders spin, bearings lift off: else the next test tells nothing."""
    data = runs[0]
    for name in BY_STEP:
        at_rest = QUANTITIES[name].of(data)[0]
        assert (largest(data, name).values > at_rest).any(), name


@pytest.mark.parametrize("name", BY_STEP)
def test_compiled_code_and_histories_have_the_same_bits(runs, name):
    data, batch = runs
    values, times = largest(data, name)
    kept = batch[f"peak_{name}"].isel(run=0), batch[f"peak_{name}_at"].isel(run=0)
    if name in FROM_NODES:
        assert_allclose(kept[0], values, rtol=1e-9, atol=1e-12)  # m; sums in another order
    else:
        assert_array_equal(kept[0], values)
        assert_array_equal(kept[1], times)


COLUMN = {
    "frames/kernels/quantities.py": (
        "    now.spin = size(state.spin)\n",
        "    now.spin = size(state.spin)\n"
        "    now.pressed_in = either(state.rim_closure[0], state.rim_closure[1])\n",
    ),
    "frames/results/quantities.py": (
        '    "tilt": Quantity(',
        '    "pressed_in": _stepped(\n'
        '        "m",\n'
        '        "deformation of a rim",\n'
        '        lambda d: of_bearings(d, "rim_closure", "surface").max(axis=-1),\n'
        '        title="rim deformation",\n'
        '        demand="rim deformation",\n'
        '        raised="difference",\n'
        '        limit="slip_left",\n'
        '        symbol="g_in",\n'
        "    ),\n"
        '    "tilt": Quantity(',
    ),
}
"""All that a column takes: the file, where, and what stands there then."""

RUN = """
import warnings
import numpy as np
from docs.build import reached
from frames import GroundMotion, Recording, lumped_mass, peaks, time_histories, time_history
from frames.design import DesignLimits, history_checks, history_demands
from lir_element import CoulombFriction, LIRBearing

warnings.simplefilter("ignore")
bearing = LIRBearing(radius=1.0, slider_height=0.1, slider_radius=0.1, capacity=0.01,
                     friction=CoulombFriction(0.05), interface_friction=0.13)
model = lumped_mass(bearing, 3e4)
motion = GroundMotion(x=3.0 * np.sin(np.linspace(0.0, 3.0, 16)), dt=0.01)
data = time_history(model, motion, dt=0.01)
value = float(data["rim_closure"].max())
few = time_history(model, motion, dt=0.01, recording=Recording.peaks())
batch = time_histories(model, [motion], dt=0.01, workers=1)
for other in (few, batch):
    assert float(other["peak_pressed_in"].max()) == value
    assert other["peak_pressed_in"].attrs["units"] == "m"
for table in (peaks(data), peaks(few)):
    assert table.loc["rim deformation", "value"] == value
assert "rim deformation" in batch["quantity"].to_numpy()
assert history_demands(batch, "ASCE 7-22").loc["rim deformation", "value"] == value
checks = history_checks(batch, model, "ASCE 7-22", limits=DesignLimits(slip_left=0.01))
[check] = [check for check in checks if check.title == "rim deformation"]
assert (check.symbol, check.demand, check.limit) == ("g_in", value, 0.01)
moved = batch.assign_coords(mass_shift=("run", ["+x"]))
moved = moved.assign(peak_pressed_in=1.5 * moved["peak_pressed_in"])
raised = history_demands(batch, "ASCE 7-22", moved=moved)
assert raised.loc["rim deformation", "value"] == 1.5 * value
[row] = [row for row in reached() if "pressed_in" in row]
assert row == "| `peak_pressed_in` | bearing | m | largest deformation of a rim |"
print(value)
"""


def test_a_column_is_added_in_two_files(tmp_path: Path) -> None:
    """In a copy of the packages, kernels as plain Python; the page's table has its row."""
    for name in ("lir_element", "frames", "docs"):
        skipped = shutil.ignore_patterns("__pycache__", "_kernels", "figures", "validation")
        shutil.copytree(ROOT / name, tmp_path / name, ignore=skipped)
    for path, (old, new) in COLUMN.items():
        text = (tmp_path / path).read_text(encoding="utf-8")
        assert text.count(old) == 1, path
        (tmp_path / path).write_text(text.replace(old, new), encoding="utf-8")
    done = fresh(RUN, cwd=tmp_path, check=False, PYTHONPATH=str(tmp_path), NUMBA_DISABLE_JIT="1")
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) > 0.0
