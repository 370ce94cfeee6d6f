"""Ctrl-C, sent for real: answered at once at every level, and what was computed is kept."""

import json
import signal
import statistics
import subprocess  # runs this interpreter on the lines below  # noqa: S404
import sys
import threading
import time
from collections.abc import Iterator

import pytest

from lir_element import AnalysisInterrupted
from tests.patience import patience, start_up

TIMES = 3
BEGUN = 0.1  # of a start of Python, 1.8 s: pieces of the loop have been computed; then twice that
PROMPT = 0.15  # of the same, where a piece of the loop and the Dataset take 0.05 s
SCRIPT = """
import json, signal, sys
import numpy as np
from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, LIRBearing, cyclic_test
bearing = LIRBearing(
    radius=1.0, slider_height=0.1, slider_radius=0.1, capacity=0.2,
    friction=CoulombFriction(0.05), interface_friction=0.1,
)
wave = 0.7 * np.sin(3.0 * np.arange(0.0, 4000.0, 0.02))
motion = GroundMotion(x=wave, y=0.5 * wave, dt=0.02)

def analyse(duration, level, options):
    if level.startswith("rig "):
        path = 0.15 * np.sin(np.linspace(0.0, 100.0 * duration, max(2, int(100.0 * duration))))
        return cyclic_test(bearing, path, 1e5, level=level.removeprefix("rig "))
    if options.pop("followed", False):
        options["progress"] = lambda share: None
    return time_history(lumped_mass(bearing, 1e4), motion, duration, level=level, **options)

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may start tests without it
for line in sys.stdin:
    level, options, times = json.loads(line)
    analyse(0.1, level, dict(options))
    for time in range(times):
        print("begin", flush=True)
        try:
            for turn in range(1000):
                try:
                    analyse(4000.0, level, dict(options))
                except Exception:
                    print("swallowed", flush=True)
        except KeyboardInterrupt as stop:
            if type(stop) is KeyboardInterrupt:  # before the first step: nothing is lost
                print("early", flush=True)
                continue
            data = stop.data
            step = data["time"].to_numpy()
            print(type(stop).__name__, data.attrs["status"], len(step), float(step[-1]), stop.time,
                  bool(np.isfinite(data["bearing_force"]).all()), turn, flush=True)
"""


class Child:
    """A process that analyses what it is told; another one after a test that failed."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[str] | None = None
        self.start = start_up()

    def told(self, *words: object) -> "subprocess.Popen[str]":
        """Return the process, which has been told what to analyse."""
        if self.process is None:
            self.process = subprocess.Popen(  # noqa: S603
                [sys.executable, "-c", SCRIPT],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(words) + "\n")
        self.process.stdin.flush()
        return self.process

    def kill(self) -> None:
        """End the process wherever it is."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


@pytest.fixture(scope="module")
def child() -> Iterator[Child]:
    made = Child()
    yield made
    if made.process is not None:
        made.process.communicate(timeout=patience())  # which closes its input
        assert made.process.returncode == 0


@pytest.mark.parametrize(
    ("level", "options"),
    [
        ("pendulum", {"record_every": 1000}),
        ("pendulum", {"record_every": 1000, "followed": True}),
        ("contact", {"record_every": 100}),
        ("rigid_body", {"record_every": 10}),
        ("rigid_body", {"record_every": 2, "integrator": "explicit"}),
        ("rig pendulum", {}),
        pytest.param("auto", {"record_every": 1000}, marks=pytest.mark.nightly),
        pytest.param("rig contact", {}, marks=pytest.mark.nightly),
        pytest.param("rig rigid_body", {}, marks=pytest.mark.nightly),
    ],
    ids=str,
)
def test_answered_and_kept(level: str, options: dict[str, object], child: Child) -> None:
    process = child.told(level, options, TIMES)
    assert process.stdout is not None
    waited, counts = [], []
    watch = threading.Timer(patience(), process.kill)
    watch.start()
    try:
        for turn in range(TIMES):
            assert process.stdout.readline() == "begin\n"
            time.sleep(BEGUN * (1 + turn) * child.start)
            process.send_signal(signal.SIGINT)
            sent = time.perf_counter()
            words = process.stdout.readline().split()
            waited.append(time.perf_counter() - sent)
            counts.append(0 if words == ["early"] else check(*words))
    except BaseException:
        child.kill()
        raise
    finally:
        watch.cancel()
    assert max(counts) > 1, counts  # a busy machine may not have come far at first
    if statistics.median(waited) >= PROMPT * child.start:
        child.start = start_up()  # of what is as busy as the machine was
    start = child.start
    assert statistics.median(waited) < PROMPT * start, (waited, start)


def check(kind, status, count, end, stopped, finite, turn):
    """Check what the child says of one interrupted run; returns the number of steps recorded."""
    assert (kind, status, finite, turn) == ("AnalysisInterrupted", "interrupted", "True", "0")
    assert 0.0 <= float(end) <= float(stopped)
    return int(count)


def test_stops_what_catches_exceptions() -> None:
    """A loop over runs that goes on after any failure must stop all the same."""
    assert issubclass(AnalysisInterrupted, KeyboardInterrupt)
    assert not issubclass(AnalysisInterrupted, Exception)
