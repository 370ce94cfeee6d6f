"""A batch that was stopped goes on from the runs that it kept: the same numbers, none twice."""

import subprocess  # this Python, a script of this test  # noqa: S404
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from time import sleep

import numpy as np
import pytest
import xarray as xr

from frames import (
    BatchProgress,
    Frame,
    GroundMotion,
    ModelWarning,
    Recording,
    lumped_mass,
    shear_building,
    time_histories,
)
from frames.batch import completed_runs
from frames.batch.batch_dataset import RunResult
from frames.batch.batch_run import Worker
from lir_element import AnalysisInterrupted, CoulombFriction, LIRBearing
from tests.integration.test_batch import untimed
from tests.scenes import small_bearing

SCALES = [0.1, 0.2, 0.3, 0.8]  # the interface fails under the last one
pytestmark = pytest.mark.filterwarnings("ignore::lir_element.AnalysisWarning")


def bearing(friction: float = 0.05) -> LIRBearing:
    return small_bearing(friction=CoulombFriction(friction), interface_friction=0.15)


def model(friction: float = 0.05) -> Frame:
    return lumped_mass(bearing(friction), 15e3)


def motions() -> dict[str, GroundMotion]:
    """Two of unlike length and step: histories have no common grid."""
    found = {}
    for name, count, dt in (("short", 201, 0.02), ("long", 601, 0.01)):
        t = dt * np.arange(count)
        wave = 3.0 * np.sin(2.0 * np.pi * t / 1.5) * np.sin(np.pi * t / t[-1])
        found[name] = GroundMotion(x=wave, y=0.4 * wave[::-1], dt=dt)
    return found


def stopped_in_the_sixth(monkeypatch: pytest.MonkeyPatch) -> Callable[[BatchProgress], None]:
    """Let runs wait from the sixth on until they are stopped, which is after the fifth."""
    run = Worker.row

    def row(worker: Worker, place: int) -> RunResult | None:
        if place < 5:
            return run(worker, place)
        while not worker._is_stopped():
            sleep(1e-3)
        return None

    def stop(progress: BatchProgress) -> None:
        if progress.done == 5:
            monkeypatch.undo()
            raise KeyboardInterrupt

    monkeypatch.setattr(Worker, "row", row)
    return stop


def counted(told: list[BatchProgress]) -> Sequence[int]:
    return [told[-1].done, told[-1].total, told[-1].taken]


@pytest.mark.parametrize("record", [None, Recording(every=3, extremes=True), Recording(every=None)])
def test_the_rest_is_done_and_all_is_as_without_a_stop(tmp_path, record, monkeypatch) -> None:
    given = {"scales": SCALES, "record": record, "dt": 0.01, "workers": 1}
    whole = time_histories(model(), motions(), **given)
    with pytest.raises(AnalysisInterrupted, match="of 8 runs") as caught:
        time_histories(
            model(), motions(), **given, resume=tmp_path, progress=stopped_in_the_sixth(monkeypatch)
        )
    done = caught.value.data.sizes["run"]
    assert done == 5
    told: list[BatchProgress] = []
    again = time_histories(model(), motions(), **given, resume=tmp_path, progress=told.append)
    assert counted(told) == [8 - done, 8 - done, done]
    xr.testing.assert_identical(untimed(again), untimed(whole))
    assert list(again.data_vars) == list(whole.data_vars)
    told.clear()
    third = time_histories(model(), motions(), **given, resume=tmp_path, progress=told.append)
    assert counted(told) == [0, 0, 8]
    xr.testing.assert_identical(untimed(third), untimed(whole))


def test_other_models_and_cases_in_another_order(tmp_path) -> None:
    """A building of more degrees of freedom beside a mass; the cases turned round."""
    models = {
        "mass": model(),
        "building": shear_building(bearing(), [10e3, 10e3], [2e7, 2e7], base_mass=12e3),
    }
    cases = [(m, name, 0.4) for m in models for name in motions()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole = time_histories(models, motions(), cases=cases[::-1])
        time_histories(models, motions(), cases=cases[1:3], resume=tmp_path)
        told: list[BatchProgress] = []
        again = time_histories(
            models, motions(), cases=cases[::-1], resume=tmp_path, progress=told.append
        )
    assert counted(told) == [2, 2, 2]
    xr.testing.assert_identical(untimed(again), untimed(whole))


@pytest.mark.parametrize(
    "change",
    [
        lambda kept: {"models": model(0.051)},
        lambda kept: {"motions": {n: m.scaled(1.0000001) for n, m in motions().items()}},
        lambda kept: {"scales": [0.21]},
        lambda kept: {"dt": 0.005},
        lambda kept: {"level": "contact", "scales": [0.2]},
        lambda kept: {"record": Recording(every=3)},
        lambda kept: kept.setattr(completed_runs, "sources_hash", lambda: "another") or {},
    ],
    ids=["friction", "motion", "scale", "step", "level", "recording", "sources"],
)
def test_runs_of_another_input_are_left_aside(tmp_path, monkeypatch, change) -> None:
    given = {"models": model(), "motions": motions(), "scales": [0.2], "dt": 0.01}
    time_histories(**given, resume=tmp_path)
    told: list[BatchProgress] = []
    with pytest.warns(ModelWarning, match="the 2 runs in .* of another model"):
        time_histories(**given | change(monkeypatch), resume=tmp_path, progress=told.append)
    assert counted(told) == [2, 2, 0]


def test_a_file_that_is_cut_off_or_another_run_s_is_run_again(tmp_path) -> None:
    given = {"scales": [0.2, 0.5], "workers": 1}
    whole = time_histories(model(), motions()["short"], **given, resume=tmp_path)
    cut, empty = sorted(tmp_path.iterdir())
    kept = cut.read_bytes()
    for content in (kept[:3000], empty.read_bytes()):  # the latter is the other run's
        cut.write_bytes(content)
        again = time_histories(model(), motions()["short"], **given, resume=tmp_path)
        xr.testing.assert_identical(untimed(again), untimed(whole))
    empty.write_bytes(b"")
    again = time_histories(model(), motions()["short"], **given, resume=tmp_path)
    xr.testing.assert_identical(untimed(again), untimed(whole))


def test_a_process_that_was_killed(tmp_path) -> None:
    """Killed without a word after its third run: those three are there."""
    script = tmp_path / "batch.py"
    script.write_text(
        "import os, signal, sys\n"
        f"sys.path.insert(0, {str(Path(__file__).parent)!r})\n"
        "from test_kept_runs import SCALES, model, motions, time_histories\n"
        "def end(progress):\n"
        "    if progress.done == 3:\n"
        "        os.kill(os.getpid(), getattr(signal, 'SIGKILL', signal.SIGTERM))\n"
        f"time_histories(model(), motions(), scales=SCALES, workers=1, progress=end, "
        f"resume={str(tmp_path / 'kept')!r})\n"
    )
    assert subprocess.run([sys.executable, str(script)], check=False).returncode != 0  # noqa: S603
    told: list[BatchProgress] = []
    again = time_histories(
        model(), motions(), scales=SCALES, resume=tmp_path / "kept", progress=told.append
    )
    assert counted(told) == [5, 5, 3]
    xr.testing.assert_identical(
        untimed(again), untimed(time_histories(model(), motions(), scales=SCALES))
    )
