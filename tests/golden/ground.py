"""Artificial ground motions for the projects of this folder, by numpy alone.

The ground's displacement is a sum of harmonics of random phase under an envelope that begins and
ends at rest, with one slow pulse along x; accelerations are its second differences. The first line
of a project's file says what it wants:

    # motions: seed=1 count=7 seconds=12 dt=0.01 unit=m/s2 z=no near=no
"""

import re
import sys
from pathlib import Path

import numpy as np

UNITS = {"g": 9.80665, "m/s2": 1.0, "cm/s2": 0.01}
CORNER = 0.5  # s, period at which amplitudes of acceleration begin to fall
PULSE = (0.10, 0.30)  # m, displacement of the pulse of the first motion and of the last


def asked(text):
    """Return what the first line of a project asks for."""
    first = text.splitlines()[0]
    return dict(re.findall(r"(\w+)=(\S+)", first)) if first.startswith("# motions:") else None


def write(folder, wanted):
    """Write the motions and their table; return nothing."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    seed, count = int(wanted["seed"]), int(wanted["count"])
    unit, dt = wanted.get("unit", "m/s2"), float(wanted.get("dt", 0.01))
    axes = "xyz" if wanted.get("z") == "yes" else "xy"
    facts = ",near_fault,strike,azimuth_x,azimuth_y" if wanted.get("near") == "yes" else ""
    rows = [",".join(("name", *axes, "dt", "unit")) + facts]
    for k in range(count):
        seconds = float(wanted["seconds"]) + (k % 2 if wanted.get("lengths") == "two" else 0)
        files = []
        for a, axis in enumerate(axes):
            values = acceleration(seed + 100 * k + 10 * a, seconds, dt, k / max(count - 1, 1), axis)
            name = f"m{k + 1}-{axis}.txt"
            lines = (f"{value:.7e}" for value in values / UNITS[unit])
            (folder / name).write_text("\n".join(lines) + "\n")
            files.append(name)
        turned = ",yes,30,75,345" if facts else ""
        rows.append(",".join((f"m{k + 1}", *files, f"{dt:g}", unit)) + turned)
    (folder / "motions.csv").write_text("\n".join(rows) + "\n")


def acceleration(seed, seconds, dt, share, axis):
    """Return one component [m/s2]."""
    random = np.random.default_rng(seed)
    time = np.arange(-1, round(seconds / dt) + 1) * dt  # a sample more at each end to difference
    frequency = np.geomspace(0.2, 12.0, 120)
    size = frequency / (1.0 + frequency * CORNER) / (1.0 + (frequency / 8.0) ** 2)
    size *= np.sqrt(np.gradient(frequency) / frequency) / (2.0 * np.pi * frequency) ** 2
    phase = random.uniform(0.0, 2.0 * np.pi, len(frequency))
    waves = (size[:, None] * np.sin(2.0 * np.pi * frequency[:, None] * time + phase[:, None])).sum(
        0
    )
    envelope = np.where((time > 0.0) & (time < seconds), np.sin(np.pi * time / seconds) ** 3, 0.0)
    moved = 3.0 * waves * envelope * (0.6 if axis == "z" else 1.0)
    period = 1.8 + 1.4 * share  # s
    turn = (time - 0.3 * seconds) / period
    bell = np.where(np.abs(turn) < 1.0, np.cos(0.5 * np.pi * turn) ** 4, 0.0)
    peak = {"x": 1.0, "y": 0.5, "z": 0.02}[axis] * (PULSE[0] + (PULSE[1] - PULSE[0]) * share)
    moved = moved + peak * bell * np.sin(np.pi * turn)
    return np.diff(moved, 2) / dt**2


if __name__ == "__main__":
    own = Path(sys.argv[1])
    write(own / "motions", asked((own / "project.toml").read_text(encoding="utf-8")))
