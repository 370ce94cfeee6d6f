"""Campaigns that are stopped: by a signal at any moment, by Ctrl-C, by a disk that is full."""

import errno
import json
import os
import re
import signal
import subprocess  # noqa: S404  # of this interpreter
import sys
from pathlib import Path

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass
from frames.batch.cases import BatchProgress
from frames.risk import Campaign, CampaignError, CampaignStore, full_grid
from tests.patience import patience
from tests.refusals import refused
from tests.scenes import small_bearing

pytest.importorskip("filelock")

DRIVER = """
import json, os, random, signal, sys, time
import numpy as np
from pathlib import Path
from frames import GroundMotion, lumped_mass, time_histories
from frames.risk import Campaign, CampaignError, CampaignStore, full_grid
from lir_element import CoulombFriction, LIRBearing

bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
                     friction=CoulombFriction(0.066), interface_friction=0.16)
frame = lumped_mass(bearing, 5e4)
pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.01, name="pulse")
time_histories(frame, pulse)

def campaign(store):
    return Campaign(frame, pulse, store=store, batch=2,
                    sample=full_grid({"friction": np.linspace(0.04, 0.08, 12)}))

def in_child(store):
    child = os.fork()
    if not child:
        try:
            campaign(store).run(workers=1)
        except BaseException as cause:
            print(repr(cause), file=sys.stderr, flush=True)
            os._exit(1)
        os._exit(0)
    return child

def marks(store):
    return {p.name: p.stat().st_mtime_ns for p in Path(store, "runs").glob("*.npz")}

assert os.waitpid(in_child("whole"), 0)[1] == 0
chance, kills, kept = random.Random(7), 0, {}
while kills < 4:
    child = in_child("killed")
    time.sleep(chance.uniform(0.0, 0.8))
    os.kill(child, signal.SIGKILL)
    code = os.waitpid(child, 0)[1]
    now = marks("killed")
    assert kept.items() <= now.items(), "a batch was lost, or done twice"
    kept = now
    if code == 0:
        break
    assert os.WIFSIGNALED(code), "it failed on its own"
    kills += 1
assert os.waitpid(in_child("killed"), 0)[1] == 0
assert kept.items() <= marks("killed").items()
both = [campaign(store).digest() for store in ("whole", "killed")]
print(json.dumps({"kills": kills, "digests": both}))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="processes are forked and killed")
def test_kills_at_random_moments_change_nothing(tmp_path: Path) -> None:
    done = subprocess.run(  # noqa: S603  # this interpreter, this text
        [sys.executable, "-W", "ignore", "-c", DRIVER],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=patience(),
        check=False,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path), "OPENBLAS_NUM_THREADS": "1"},
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert found["kills"] >= 2
    assert found["digests"][0] == found["digests"][1]
    left = {p.name for p in tmp_path.iterdir()} - {"whole", "killed"}
    assert all(name.startswith(".killed.") for name in left), "stores half made, never taken up"


OWN = "layout.npz", "rows.npz", "plan.json"


def small(store: Path) -> Campaign:
    bearing = small_bearing(interface_friction=0.16)
    pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.01, name="pulse")
    sample = full_grid({"friction": [0.04, 0.05, 0.06, 0.07]})
    return Campaign(lumped_mass(bearing, 5e4), pulse, store=store, batch=2, sample=sample)


def test_after_ctrl_c_the_rest_is_run(tmp_path: Path) -> None:
    def stop(progress: BatchProgress) -> None:
        if progress.done == 3:
            raise KeyboardInterrupt

    campaign = small(tmp_path / "store")
    with pytest.raises(KeyboardInterrupt):
        campaign.run(workers=1, progress=stop)
    assert campaign.status().done == 2
    partly = campaign.results()
    assert partly["done"].to_numpy().tolist() == [True, True, False, False]
    assert partly["status"].to_numpy().tolist() == ["ok", "ok", "", ""]
    whole = small(tmp_path / "whole")
    whole.run()
    told: list[BatchProgress] = []
    campaign.run(progress=told.append)
    assert [p.total for p in told] == [2, 2]
    assert campaign.digest() == whole.digest()


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of files there")
def test_a_full_disk_is_told_and_the_store_stays(tmp_path, monkeypatch):
    """No file can grow at all: as on a full disk, each write fails, in reality."""
    import resource  # not on Windows

    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # what is cut off would be kept
    campaign = small(tmp_path / "store")

    def fill(progress: BatchProgress) -> None:
        if progress.done == 3:
            resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        with pytest.raises(
            OSError, match=r"batch 1 could not be written.* 1 batches .* kept"
        ) as no:
            campaign.run(workers=1, progress=fill)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert no.value.errno == errno.EFBIG
    assert campaign.status().done == 2
    assert campaign.results()["status"].to_numpy().tolist() == ["ok", "ok", "", ""]
    campaign.run()
    whole = small(tmp_path / "whole")
    whole.run()
    assert campaign.digest() == whole.digest()


def test_a_store_that_cannot_be_made_leaves_nothing(tmp_path, monkeypatch):
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(OSError, match="store could not be written: No space left"):
        small(tmp_path / "store").run()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        *((f"runs/00000{k}.npz", "damaged .*: remove it, and run") for k in (0, 1)),
        *((name, "damaged .* restore it from a copy") for name in OWN),
    ],
)
@pytest.mark.parametrize("junk", [b"", b"\x00\xff" * 40, b"[]", b"{}", None])
def test_damaged_databases_say_where(tmp_path, made_once, name, words, junk):
    """Another content, or cut in the middle."""
    made_once("small campaign", lambda part: small(part / "store").run(), tmp_path)
    store = tmp_path / "store"
    content = (store / name).read_bytes()
    (store / name).write_bytes(content[: len(content) // 2] if junk is None else junk)
    is_json = name == "plan.json" and junk in {b"[]", b"{}"}
    read = CampaignStore.digest if name.startswith("runs") else CampaignStore.results
    for use in (read, lambda own: own.results().load()):
        said = "." if is_json else rf"{re.escape(Path(name).name)} is {words}"
        refused(CampaignError, said, use, CampaignStore(store))
    if "remove" in words and not junk:
        (store / name).unlink()
        small(store).run()
        small(store).digest()


def test_a_chunk_under_another_name_is_no_result(tmp_path, made_once):
    made_once("small campaign", lambda part: small(part / "store").run(), tmp_path)
    runs = tmp_path / "store" / "runs"
    (runs / "000001.npz").write_bytes((runs / "000000.npz").read_bytes())
    for read in (CampaignStore.digest, CampaignStore.status, lambda own: own.results().load()):
        words = r"000001\.npz .*a copy of 000000\.npz.*remove it"
        refused(CampaignError, words, read, CampaignStore(tmp_path / "store"))
