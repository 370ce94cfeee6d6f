"""The project that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

import math
import re
from importlib import resources
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import signal

from frames.design._errors import ProjectError
from frames.design.hazard.spectrum import Spectrum
from frames.motion.spectra import response_spectrum
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    from pathlib import Path

    from frames._types import FloatArray

PULSES = {f"artificial-{k}": 1.6 + 0.3 * k for k in range(1, 8)}
"""Period of the pulse in each artificial motion [s]."""

_STEP, _LENGTH = 0.005, 25.0  # s
_GROUND = 2.0 * math.pi * 1.2, 0.7  # rad/s, -: filter of the noise (Kanai and Tajimi)
_SHORTEST, _LONGEST, _PERIODS = 0.05, 6.0, 60  # s, s, -: at which motions follow the spectrum
_ROUNDS = 10
_ACROSS = 0.6  # weaker component over the stronger one


_UPLIFT = """level = "pendulum"
uplift_allowed = true             # corners lift for a moment; without it such runs count as failed
"""


class _Example(NamedTuple):
    # What differs by standard: spectrum, and sections of the file.
    spectrum: Spectrum
    sections: dict[str, str]


def _examples() -> dict[str, _Example]:
    return {
        "ASCE 7-22": _Example(Spectrum.asce7(1.2, 0.7), {}),
        "EN 1998": _Example(
            Spectrum.en1998(3.4, "B"),
            {
                "spectrum": '# the ground of type 1, elastic\na_g = "3.4 m/s2"\nground_type = "B"\n'
                "kind = 1\n",
                "bearing": _bearing("2.5 m", 185, 150, 0.04, 0.075),
                "analysis": _UPLIFT,
            },
        ),
        "NCh2745": _Example(
            Spectrum.nch2745("II", 3),
            {
                "spectrum": 'soil = "II"\nzone = 3\n',
                "bearing": _bearing("1.5 m", 185, 227, 0.04, 0.095),
                "analysis": _UPLIFT,
            },
        ),
    }


def _bearing(radius: str, slider: int, capacity: int, friction: float, interface: float) -> str:
    # As `lir design` proposes it for the example's building.
    return (
        f'radius = "{radius}"\nslider_height = "{slider} mm"\nslider_radius = "{slider} mm"\n'
        f'capacity = "{capacity} mm"               # displacement at which rims are met\n'
        f"friction = {friction:g}\ninterface_friction = {interface:g}\n"
    )


def write_example(folder: Path, code: str = "ASCE 7-22") -> list[Path]:
    """Write a project's file and artificial motions into a folder.

    The motions are filtered noise with a pulse of velocity in it, weaker across, whose amplitudes
    are brought to the design spectrum: there to try the project with, not to design by.

    Parameters
    ----------
    folder : Path
        Made if it is not there; what is in it stays.
    code : {"ASCE 7-22", "EN 1998", "NCh2745"}
        The project's code: spectrum, bearing and motions go by it.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    FileExistsError
        If a file is there already.
    ProjectError
        If the code is not known.
    """
    known = _examples()
    require_choice("code", code, tuple(known), error=ProjectError)
    motions, chosen = folder / "motions", known[code]
    contents = {folder / "project.toml": _text(code, chosen)}
    table = ["name,x,y,dt,unit,near_fault,strike,azimuth_x,azimuth_y"]  # x across the fault
    for seed, (name, period) in enumerate(PULSES.items()):
        table.append(f"{name},{name}-x.txt,{name}-y.txt,{_STEP},m/s2,yes,0,90,0")
        for axis, share in (("x", 1.0), ("y", _ACROSS)):
            raw = _artificial(period, 2 * seed + (axis == "y"))
            values = share * _matched(raw, chosen.spectrum)
            contents[motions / f"{name}-{axis}.txt"] = _column(values)
    contents[motions / "motions.csv"] = "\n".join(table) + "\n"
    for path in contents:
        if path.exists():
            raise FileExistsError(str(path))
    motions.mkdir(parents=True, exist_ok=True)
    for path, content in contents.items():
        path.write_text(content, encoding="utf-8")
    return list(contents)


def _text(code: str, chosen: _Example) -> str:
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
