"""The project that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

import math
import re
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np
from scipy import signal

from frames.design._errors import ProjectError
from frames.design.codes.registry import ExampleProject, known_codes
from frames.design.hazard.code_rules import canonical
from frames.motion.spectra import response_spectrum
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    from pathlib import Path

    from frames._types import FloatArray
    from frames.design.hazard.spectrum import Spectrum

PULSES = {f"artificial-{k}": 1.6 + 0.3 * k for k in range(1, 8)}
"""Period of the pulse in each artificial motion [s]."""

_STEP, _LENGTH = 0.005, 25.0  # s
_GROUND = 2.0 * math.pi * 1.2, 0.7  # rad/s, -: filter of the noise (Kanai and Tajimi)
_SHORTEST, _LONGEST, _PERIODS = 0.05, 6.0, 60  # s, s, -: at which motions follow the spectrum
_ROUNDS = 10
_ACROSS = 0.6  # weaker component over the stronger one


def write_example(folder: Path, code: str = "ASCE 7-22") -> list[Path]:
    """Write a project's file and artificial motions into a folder.

    The motions are filtered noise with a pulse of velocity in it, weaker across, whose amplitudes
    are brought to the design spectrum: there to try the project with, not to design by.

    Parameters
    ----------
    folder : Path
        Made if it is not there; what is in it stays.
    code : str
        The project's code, "ASCE 7-22", "EN 1998" or "NCh2745": spectrum, bearing and motions go
        by it.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    FileExistsError
        If a file is there already.
    ProjectError
        If the code is not known, or has no example.
    """
    known = {each.name: each for each in known_codes() if each.example is not None}
    require_choice("code", canonical(code), tuple(known), error=ProjectError)
    own, motions = known[canonical(code)], folder / "motions"
    if (folder / "project.toml").exists():  # before the motions are made
        raise FileExistsError(str(folder / "project.toml"))
    chosen = own.example or ExampleProject({}, {})
    target = own.spectrum(**chosen.spectrum)
    contents = {folder / "project.toml": _text(own.name, chosen)}
    table = ["name,x,y,dt,unit,near_fault,strike,azimuth_x,azimuth_y"]  # x across the fault
    for seed, (name, period) in enumerate(PULSES.items()):
        table.append(f"{name},{name}-x.txt,{name}-y.txt,{_STEP},m/s2,yes,0,90,0")
        for axis, share in (("x", 1.0), ("y", _ACROSS)):
            raw = _artificial(period, 2 * seed + (axis == "y"))
            values = share * _matched(raw, target)
            contents[motions / f"{name}-{axis}.txt"] = _column(values)
    contents[motions / "motions.csv"] = "\n".join(table) + "\n"
    for path in contents:
        if path.exists():
            raise FileExistsError(str(path))
    motions.mkdir(parents=True, exist_ok=True)
    for path, content in contents.items():
        path.write_text(content, encoding="utf-8")
    return list(contents)


def _text(code: str, chosen: ExampleProject) -> str:
    # The commented file of ASCE 7-22, its sections replaced.
    text = (
        resources.files("frames.design.project")
        .joinpath("example.toml")
        .read_text(encoding="utf-8")
    )
    text = text.replace('code = "ASCE 7-22"', f'code = "{code}"')
    for name, content in chosen.sections.items():
        text = re.sub(rf"(?ms)^\[{name}\].*?(?=^\[|\Z)", f"[{name}]\n{content}\n", text)
    return text


def _matched(values: FloatArray, target: Spectrum) -> FloatArray:
    # Fourier amplitudes times the ratio of the spectra, some times over; what is slower than the
    # longest period fades.
    periods = np.geomspace(_SHORTEST, _LONGEST, _PERIODS)
    wanted = np.asarray(target.acceleration(periods))
    frequency = np.fft.rfftfreq(len(values), _STEP)
    with np.errstate(divide="ignore"):
        at = np.clip(1.0 / frequency, _SHORTEST, _LONGEST)
    found = values
    for _ in range(_ROUNDS):
        reached = response_spectrum(found, _STEP, periods)["pseudo_acceleration"].to_numpy()
        ratio = np.interp(at, periods, wanted / reached)
        found = np.fft.irfft(ratio * np.fft.rfft(found), len(values))
    window = signal.windows.tukey(len(found), 0.1)
    slow = signal.butter(4, 0.1, "highpass", fs=1.0 / _STEP, output="sos")
    result: FloatArray = signal.sosfiltfilt(slow, found * window)
    return result


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
