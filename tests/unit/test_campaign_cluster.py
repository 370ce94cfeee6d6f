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
from tests.patience import patience
from tests.scenes import small_bearing

pytest.importorskip("filelock")
distributed = pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="workers are killed by a signal"),
    pytest.mark.filterwarnings("ignore"),  # of the cluster itself
]


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Of two workers, processes of one thread, over loopback."""
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as made,
        distributed.Client(made, timeout=patience()) as found,
    ):
        yield found


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Digest of the campaign, run here."""
    campaign = small(tmp_path_factory.mktemp("near") / "store")
    campaign.run(workers=1)
    return campaign.digest()


def small(store: Path, sets: int = 16) -> Campaign:
    bearing = small_bearing(interface_friction=0.16)
    pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.01, name="pulse")
    sample = full_grid({"friction": np.linspace(0.04, 0.08, sets)})
    end = {"end": Measure(lambda data: data["base_shear"].isel(time=-1, axis=0), "N")}
    frame = lumped_mass(bearing, 5e4)
    return Campaign(frame, pulse, store=store, batch=2, sample=sample, measures=end)


def test_workers_that_are_slow_or_killed_change_nothing(tmp_path, client, whole):
    """One worker stands still for two seconds, the other is killed; a new one takes its place."""
    killed: list[int] = []
    slow, lost = client.run(os.getpid).values()

    def disturb(progress: BatchProgress) -> None:
        if progress.done >= 4 and not killed:
            os.kill(slow, signal.SIGSTOP)
            threading.Timer(2.0, os.kill, (slow, signal.SIGCONT)).start()
            killed.append(lost)
            os.kill(lost, signal.SIGKILL)

    far = small(tmp_path / "far")
    far.run(client=client, progress=disturb)
    assert killed
    assert far.status().statuses == {"ok": 16}
    assert far.digest() == whole


@pytest.mark.nightly
def test_a_scheduler_that_is_lost_is_told_and_the_rest_is_run_here(tmp_path, client, whole):
    """The last test of the cluster, which is closed by it."""
    campaign = small(tmp_path / "store")

    def lose(progress: BatchProgress) -> None:
        if progress.done == 4:
            client.cluster.close(timeout=patience())

    with pytest.raises(CampaignError, match="lost: run again to resume"):
        campaign.run(client=client, progress=lose)
    assert 2 <= campaign.status().done < 16
    campaign.run(workers=1)
    assert campaign.digest() == whole
