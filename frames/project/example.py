"""The project that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

import math
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np
from scipy import signal

if TYPE_CHECKING:
    from pathlib import Path

    from frames._types import FloatArray

PULSES = {f"artificial-{k}": 1.6 + 0.3 * k for k in range(1, 8)}
"""Period of the pulse in each artificial motion [s]."""

_STEP, _LENGTH = 0.005, 25.0  # s
_GROUND = 2.0 * math.pi * 1.2, 0.7  # rad/s, -: filter of the noise (Kanai and Tajimi)


def write_example(folder: Path) -> list[Path]:
    """Write a project's file and artificial motions into a folder.

    The motions are filtered noise with a pulse of velocity (a harmonic under a bell of two
    periods) in it, weaker across: there to try the project with, not to design by.

    Parameters
    ----------
    folder : Path
        Made if it is not there; what is in it stays.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    FileExistsError
        If a file is there already.
    """
    motions = folder / "motions"
    text = resources.files("frames.project").joinpath("example.toml").read_text(encoding="utf-8")
    contents = {folder / "project.toml": text}
    table = ["name,x,y,dt,unit,near_fault"]
    for seed, (name, period) in enumerate(PULSES.items()):
        table.append(f"{name},{name}-x.txt,{name}-y.txt,{_STEP},m/s2,yes")
        for axis, share in (("x", 1.0), ("y", 0.6)):
            values = share * _artificial(period, 2 * seed + (axis == "y"))
            contents[motions / f"{name}-{axis}.txt"] = _column(values)
    contents[motions / "motions.csv"] = "\n".join(table) + "\n"
    for path in contents:
        if path.exists():
            raise FileExistsError(str(path))
    motions.mkdir(parents=True, exist_ok=True)
    for path, content in contents.items():
        path.write_text(content, encoding="utf-8")
    return list(contents)


def _artificial(period: float, seed: int) -> FloatArray:
    # Noise that a soil layer filters, under a bell, and a pulse that starts and ends at rest
    # [m/s2]; both without what a record's processing takes out below 0.1 Hz.
    time = np.arange(0.0, _LENGTH, _STEP)
    white = np.random.default_rng(seed).standard_normal(len(time))
    soil = signal.lfilter(*_layer(), white)
    slow = signal.butter(4, 0.1, "highpass", fs=1.0 / _STEP, output="sos")
    noise = signal.sosfiltfilt(slow, soil * np.sin(np.pi * time / _LENGTH) ** 2)
    phase = (time - 8.0) / period
    bell = np.where(np.abs(phase) < 1.0, 0.5 * (1.0 + np.cos(np.pi * phase)), 0.0)
    pulse = np.gradient(bell * np.sin(2.0 * np.pi * phase), _STEP)
    found: FloatArray = 1.5 * noise / np.abs(noise).max() + 0.25 * pulse
    return found


def _layer() -> tuple[FloatArray, FloatArray]:
    # The filter of Kanai and Tajimi as a recursion.
    omega, ratio = _GROUND
    upper = np.array([2.0 * ratio * omega, omega**2])
    lower = np.array([1.0, 2.0 * ratio * omega, omega**2])
    numerator, denominator, _ = signal.cont2discrete((upper, lower), _STEP)
    return numerator.ravel(), denominator


def _column(values: FloatArray) -> str:
    return "\n".join(f"{value:.6g}" for value in values) + "\n"
