"""The projects that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

import json
import math
import re
import shutil
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np
from scipy import signal

from frames._errors import ModelError, in_project_file
from frames.design._errors import ProjectError
from frames.design.codes.registry import ExampleProject, known_codes
from frames.design.hazard.code_rules import canonical
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.source_files import tell
from frames.exchange.import_report import Options
from frames.exchange.members import standing
from frames.exchange.to_frame import READERS, case_of, judged
from frames.io import MODEL_FILES
from frames.motion.spectra import response_spectrum
from frames.results.storage import make_folder, write_whole
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    from collections.abc import Mapping
    from importlib.resources.abc import Traversable
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
_VERTICAL, _FASTER = 2.0 / 3.0, 3.0  # vertical spectrum over the horizontal one, and its periods
_UPWARD = 8  # added to the seeds of vertical components


def motion_files(target: Spectrum, *, vertical: bool = False) -> Mapping[str, str]:
    """Return artificial motions as files of a folder, with the table that names them.

    They are filtered noise with a pulse of velocity in it, weaker across, whose amplitudes are
    brought to the spectrum: there to try a project with, not to design by.
    """
    z = ",z" if vertical else ""
    table = [f"name,x,y{z},dt,unit,near_fault,strike,azimuth_x,azimuth_y"]  # x across the fault
    files: dict[str, str] = {}
    for seed, (name, period) in enumerate(PULSES.items()):
        parts = {
            "x": _matched(_artificial(period, 2 * seed), target),
            "y": _ACROSS * _matched(_artificial(period, 2 * seed + 1), target),
        }
        if vertical:
            noise = _noise(2 * len(PULSES) + _UPWARD + seed)
            parts["z"] = _VERTICAL * _matched(noise, target, _FASTER)
        names = [f"{name}-{axis}.txt" for axis in parts]
        files |= {at: _column(values) for at, values in zip(names, parts.values(), strict=True)}
        table.append(f"{name},{','.join(names)},{_STEP},m/s2,yes,0,90,0")
    return files | {"motions.csv": "\n".join(table) + "\n"}


def _matched(values: FloatArray, target: Spectrum, faster: float = 1.0) -> FloatArray:
    # Fourier amplitudes times the ratio of the spectra, several times; periods above the longest
    # one fade. `faster` is the factor by which the periods of the spectrum are shorter.
    periods = np.geomspace(_SHORTEST, _LONGEST, _PERIODS)
    wanted = np.asarray(target.acceleration(np.minimum(faster * periods, _LONGEST)))
    frequency = np.fft.rfftfreq(len(values), _STEP)
    with np.errstate(divide="ignore"):
        at = np.clip(1.0 / frequency, _SHORTEST, _LONGEST)
    found = values
    for _ in range(_ROUNDS):
        reached = response_spectrum(found, _STEP, periods)["pseudo_acceleration"].to_numpy()
        ratio = np.interp(at, periods, wanted / reached)
        found = np.fft.irfft(ratio * np.fft.rfft(found), len(values))
    window = signal.windows.tukey(len(found), 0.1)
    slow = signal.butter(4, 0.1 * faster, "highpass", fs=1.0 / _STEP, output="sos")
    result: FloatArray = signal.sosfiltfilt(slow, found * window)
    return result


def _noise(seed: int) -> FloatArray:
    # Noise that a soil layer filters, under a bell, without the part below 0.1 Hz that the
    # processing of records removes; its largest value is one.
    time = np.arange(0.0, _LENGTH, _STEP)
    white = np.random.default_rng(seed).standard_normal(len(time))
    soil = signal.lfilter(*_layer(), white)
    slow = signal.butter(4, 0.1, "highpass", fs=1.0 / _STEP, output="sos")
    noise = signal.sosfiltfilt(slow, soil * np.sin(np.pi * time / _LENGTH) ** 2)
    found: FloatArray = noise / np.abs(noise).max()
    return found


def _artificial(period: float, seed: int) -> FloatArray:
    # Noise, and a pulse that starts and ends at rest [m/s2].
    time = np.arange(0.0, _LENGTH, _STEP)
    phase = (time - 8.0) / period
    bell = np.where(np.abs(phase) < 1.0, 0.5 * (1.0 + np.cos(np.pi * phase)), 0.0)
    pulse = np.gradient(bell * np.sin(2.0 * np.pi * phase), _STEP)
    found: FloatArray = 1.5 * _noise(seed) + 0.25 * pulse
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


BUILDINGS = {
    "hospital": "six storeys, L-shaped, walls of shells, by an OpenSees script; NCh2745",
    "office": "four storeys of concrete with walls, two types of bearing; EN 1998",
    "imported": "four storeys of concrete from a file of SAP2000, one type of bearing; EN 1998",
    "near-fault": "eight braced storeys of steel, vertical motion, uplift; ASCE 7-22",
}
"""Whole buildings besides the plain example, and the subject of each."""

_WITH_VERTICAL = frozenset({"near-fault"})  # buildings whose motions have a vertical component
_PLAIN = "example.toml"
_NO_BEARING = """# Put the section [bearing] here that `lir design` prints.

"""
_KEPT_AS_TEXT = ".txt"  # ending of files of a building that are not Python of this package


def write_example(
    folder: Path,
    code: str | None = None,
    building: str | None = None,
    model: Path | None = None,
) -> list[Path]:
    """Write a project's file and artificial motions into a folder; of a model a copy, too.

    The motions are filtered noise with a pulse of velocity in it, weaker across, with amplitudes
    fitted to the design spectrum. They are for trying the project, not for design.
    """
    if model is not None and building is not None:
        msg = f"--example {building} and --from {model} exclude each other: leave one out"
        raise ProjectError(msg)
    texts = _plain(code) if building is None else _building(building, code)
    if model is not None:
        texts = {"project.toml": _of_model(texts["project.toml"], model)}
    for name in (*texts, "motions/motions.csv"):  # before the motions are made
        if (folder / name).exists():
            raise FileExistsError(str(folder / name))
    make_folder(folder)
    if model is not None and folder.resolve() != model.resolve().parent:
        if (folder / model.name).exists():
            raise FileExistsError(str(folder / model.name))
        shutil.copyfile(model, folder / model.name)
    written = _put(folder, texts)
    parts = ProjectInputs(read_project(written[0]), folder)
    motions = motion_files(parts.spectrum(), vertical=building in _WITH_VERTICAL)
    return [*written, *_put(folder / "motions", motions)]


def _of_model(text: str, model: Path) -> str:
    # The plain file with a model of another program as its structure; `lir design` has bearings.
    suffix = model.suffix.lower()
    endings = {program: known for program, (_, known) in MODEL_FILES.items()}
    kind = next((program for program, known in endings.items() if suffix in known), "")
    if not kind or not model.is_file():
        listed = ", ".join(", ".join(known) for known in endings.values())
        msg = (
            f"--from {model} must be a text file exported from SAP2000 or ETABS, with the ending "
            f"{listed}"
        )
        raise ProjectError(msg)
    section = _kept().joinpath("imported.toml").read_text(encoding="utf-8")
    section = _as_read(section, kind, model).replace("KIND", kind).replace("FILE", model.name)
    text = _replaced(text, "structure", f"[structure]\n{section}\n")
    text = _replaced(_replaced(text, "loads", ""), "bearing", _NO_BEARING)
    return re.sub(r'(?m)^name = "[^"]*"', f'name = "{model.stem}"', text, count=1)


def _as_read(section: str, kind: str, model: Path) -> str:
    # The section with the model's features, and the reasons against it as comments.
    building, reasons = None, ""
    with in_project_file():
        try:
            building = READERS[kind.upper()](model, Options())
            judged(building, Options())
        except ModelError as cause:
            reasons = str(cause)
            tell(f"{reasons}\ncorrect this in [structure] of project.toml, or in the model")
    if building is not None:
        named = [*building.groups, *building.link_properties]
        cases = [name for name, part in building.patterns.items() if case_of(part.kind)]
        dead = [name for name in cases if case_of(building.patterns[name].kind) == "D"]
        for example, found in (
            ('["ISOLATED"]', json.dumps(named[:4], ensure_ascii=False) if named else ""),
            ("{ Dead = 1.0 }", _shares(dict.fromkeys(cases, 1.0))),
            (
                "{ Dead = 1.0, Live = 0.25 }",
                _shares({name: 1.0 if name in dead else 0.25 for name in cases}),
            ),
            ('["hinges"]', "".join(re.findall(r"allow = (\[.*?\])", reasons)[-1:])),
        ):
            section = section.replace(example, found or example)
        if any({"rx", "ry"} & {*building.restraints[name]} for name in standing(building)):
            section = section.replace("# base_rot", "base_rot")  # overturning goes to the bearings
        counts = f"{len(building.frames)} frame objects, {len(building.areas)} areas"
        storeys = f"{len(building.stories) - 1} storeys, " if building.stories else ""
        head = f"{building.program} {building.version}: {storeys}{counts}, "
        section = f"# {head}{len(standing(building))} supports\n{section}"
    return section + "".join(f"# {line}\n" for line in reasons.splitlines())


def _shares(given: Mapping[str, float]) -> str:
    pairs = (f"{json.dumps(name, ensure_ascii=False)} = {share}" for name, share in given.items())
    return f"{{ {', '.join(pairs)} }}" if given else ""


def _replaced(text: str, name: str, by: str) -> str:
    # A section with all its keys.
    return re.sub(rf"(?ms)^\[{name}\].*?(?=^\[|\Z)", lambda _: by, text)


def _put(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    paths = [folder / name for name in texts]
    for path in paths:
        if path.exists():
            raise FileExistsError(str(path))
    make_folder(folder)
    for path, text in zip(paths, texts.values(), strict=True):
        write_whole(path, text)
    return paths


def _kept() -> Traversable:
    return resources.files("frames.design.project").joinpath("examples")


def _building(name: str, code: str | None) -> dict[str, str]:
    # Its files by name; one that names a code must name its own.
    require_choice("example", name, tuple(BUILDINGS), error=ProjectError)
    kept = sorted(_kept().joinpath(name).iterdir(), key=lambda file: file.name != "project.toml")
    texts = {
        file.name.removesuffix(_KEPT_AS_TEXT): file.read_text(encoding="utf-8") for file in kept
    }
    own = re.search(r'(?m)^code = "([^"]*)"', texts["project.toml"])
    if code is not None and own is not None and canonical(code) != own[1]:
        msg = f'code = "{code}": the example "{name}" has the code {own[1]}: leave --code out'
        raise ProjectError(msg)
    return texts


def _plain(code: str | None) -> dict[str, str]:
    # The commented file of ASCE 7-22, its sections replaced.
    known = {each.name: each for each in known_codes() if each.example is not None}
    asked = canonical("ASCE 7-22" if code is None else code)
    require_choice("code", asked, tuple(known), error=ProjectError)
    own = known[asked]
    text = _kept().joinpath(_PLAIN).read_text(encoding="utf-8")
    text = text.replace('code = "ASCE 7-22"', f'code = "{own.name}"')
    chosen = own.example or ExampleProject({}, {})
    for name, content in chosen.sections.items():
        text = _replaced(text, name, f"[{name}]\n{content}\n")
    return {"project.toml": text}
