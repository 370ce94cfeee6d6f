"""Campaigns on a Dask cluster of processes: the same digest, with a worker killed on the way."""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass
from frames.batch.cases import BatchProgress
from frames.risk import Campaign, CampaignError, Measure, full_grid
from lir_element import CoulombFriction, LIRBearing
from tests.patience import patience

pytest.importorskip("zarr")
pytest.importorskip("filelock")
distributed = pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="workers are killed by a signal"),
    pytest.mark.filterwarnings("ignore"),  # of the cluster itself
]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two workers, processes of one thread, over loopback."""
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as made,
        distributed.Client(made) as client,
    ):
        yield client


def small(store: Path, sets: int = 12) -> Campaign:
    bearing = LIRBearing(
        radius=0.75,
        slider_height=0.085,
        slider_radius=0.08,
        capacity=0.175,
        friction=CoulombFriction(0.066),
        interface_friction=0.16,
    )
    pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.01, name="pulse")
    sample = full_grid({"friction": np.linspace(0.04, 0.08, sets)})
    end = {"end": Measure(lambda data: data["base_shear"].isel(time=-1, axis=0), "N")}
    frame = lumped_mass(bearing, 5e4)
    return Campaign(frame, pulse, store=store, batch=2, sample=sample, measures=end)


def test_workers_that_are_slow_or_killed_change_nothing(tmp_path: Path, cluster: Any) -> None:
    """One worker stands still for two seconds, the other is killed; a new one takes its place."""
    killed: list[int] = []
    slow, lost = cluster.run(os.getpid).values()

    def disturb(progress: BatchProgress) -> None:
        if progress.done >= 4 and not killed:
            os.kill(slow, signal.SIGSTOP)
            threading.Timer(2.0, os.kill, (slow, signal.SIGCONT)).start()
            killed.append(lost)
            os.kill(lost, signal.SIGKILL)

    far, near = small(tmp_path / "far", 24), small(tmp_path / "near", 24)
    far.run(client=cluster, progress=disturb)
    near.run(workers=2)
    assert killed
    assert far.status().statuses == {"ok": 24}
    assert far.digest() == near.digest()


def test_a_scheduler_that_is_lost_is_told_and_the_rest_is_run_here(tmp_path: Path) -> None:
    campaign, whole = small(tmp_path / "store"), small(tmp_path / "whole")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as made:
        client = distributed.Client(made, timeout=patience())

        def lose(progress: BatchProgress) -> None:
            if progress.done == 4:
                made.close(timeout=patience())

        with pytest.raises(CampaignError, match="lost: the batches before are kept"):
            campaign.run(client=client, progress=lose)
    assert 2 <= campaign.status().done < 12
    campaign.run()
    whole.run()
    assert campaign.digest() == whole.digest()
