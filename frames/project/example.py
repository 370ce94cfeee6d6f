"""The project that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

from importlib import resources
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from frames._types import FloatArray

PULSES = {
    "pulse-1.5s": 1.5, "pulse-1.8s": 1.8, "pulse-2.1s": 2.1, "pulse-2.4s": 2.4,
    "pulse-2.7s": 2.7, "pulse-3.0s": 3.0, "pulse-3.4s": 3.4,
}  # fmt: skip
"""Period of each artificial pulse [s]."""

_STEP, _LENGTH = 0.005, 20.0  # s


def write_example(folder: Path) -> list[Path]:
    """Write a project's file and artificial motions into a folder.

    The motions are velocity pulses (a harmonic under a bell of two periods) with a weaker, shorter
    one across: there to try the project with, not to design by.

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
    for name, period in PULSES.items():
        table.append(f"{name},{name}-x.txt,{name}-y.txt,{_STEP},m/s2,yes")
        contents[motions / f"{name}-x.txt"] = _column(_pulse(period, 0.6))
        contents[motions / f"{name}-y.txt"] = _column(_pulse(0.7 * period, 0.3))
    contents[motions / "motions.csv"] = "\n".join(table) + "\n"
    for path in contents:
        if path.exists():
            raise FileExistsError(str(path))
    motions.mkdir(parents=True, exist_ok=True)
    for path, content in contents.items():
        path.write_text(content, encoding="utf-8")
    return list(contents)


def _pulse(period: float, speed: float) -> FloatArray:
    # Acceleration of a velocity pulse that starts and ends at rest [m/s2].
    time = np.arange(0.0, _LENGTH, _STEP)
    phase = (time - 3.0 - period) / period
    bell = np.where(np.abs(phase) < 1.0, 0.5 * (1.0 + np.cos(np.pi * phase)), 0.0)
    velocity = speed * bell * np.sin(2.0 * np.pi * phase)
    return np.gradient(velocity, _STEP)


def _column(values: FloatArray) -> str:
    return "\n".join(f"{value:.6g}" for value in values) + "\n"
