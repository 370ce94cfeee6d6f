"""Results for a project before its time histories, and the input of the histories."""

from __future__ import annotations

import hashlib
import json
import math
import warnings
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from frames._errors import ModelError, ModelWarning, MotionWarning, without_numbers
from frames.design._errors import ProjectError
from frames.design.codes.analysis import equivalent_linear
from frames.design.hazard.motion_collection import factor_doubts, twins
from frames.design.histories.eccentricity import WAYS
from frames.design.histories.motions import period_range
from frames.design.project.check_register import Preliminary
from frames.design.project.inputs import in_section
from frames.design.project.moat_and_dampers import clearance_checks
from frames.design.project.sanity_checks import file_doubts, value_doubts, wind_doubts
from frames.design.project.schema_structure import ImportedModel, OpenSeesModel
from frames.library.moved_masses import with_moved_masses
from frames.recording.recording import number_of_steps
from lir_element._version import package_version
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.hazard.spectrum import Spectrum
    from frames.design.project.inputs import ProjectInputs
    from frames.io import Frame


def preliminary(parts: ProjectInputs) -> Preliminary:
    """Return structure, spectrum, equivalent-linear analysis and scaled motions of a project."""
    told: list[warnings.WarningMessage] = []
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            known = _made(parts)
    finally:
        for each in _once(told):
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
    heard = [each.message for each in _once(told)]
    doubts = tuple(one.text for one in heard if isinstance(one, (ModelWarning, MotionWarning)))
    return replace(known, doubts=doubts)


def _once(told: list[warnings.WarningMessage]) -> list[warnings.WarningMessage]:
    # The first of those that differ by numbers alone: one thing under several loads.
    first: dict[str, warnings.WarningMessage] = {}
    for each in told:
        first.setdefault(without_numbers(str(each.message)), each)
    return list(first.values())


def _made(parts: ProjectInputs) -> Preliminary:
    parts.limits(), parts.rules(), parts.target()  # refused before anything is run
    _warn(file_doubts(parts.file))
    frame, spectrum = parts.frame(), parts.spectrum()
    _refuse_other_devices(frame)
    system = parts.system(parts.loaded_frame() if frame.load_cases else frame, spectrum)
    _warn(wind_doubts(parts.file, system, parts.bounds()))
    above = parts.superstructure(frame)
    equivalent = equivalent_linear(
        system,
        spectrum,
        bounds=parts.bounds(),
        superstructure=above,
        code=parts.analysis(),
    )
    kinds = parts.types()
    _warn(value_doubts(parts.file, system, equivalent, parts.devices(), kinds))
    motions = scaled_motions(parts, spectrum, equivalent)
    _refuse_steps(parts, motions)
    room = clearance_checks(parts.code(), equivalent, parts.limits(), frame)
    return Preliminary(
        frame=frame,
        system=system,
        spectrum=spectrum,
        superstructure=above,
        equivalent=equivalent,
        motions=motions,
        moved=moved_frames(parts, frame),
        kinds=kinds,
        combined=combined_frames(parts, system, spectrum, motions),
        checks=equivalent.checks + room,
    )


def _refuse_steps(parts: ProjectInputs, motions: MotionSet) -> None:
    # Steps that no run of these motions can have.
    dt = parts.file.analysis.dt
    for motion in motions.values():
        in_section("analysis", partial(number_of_steps, motion.duration, dt, motion.dt))


def _refuse_other_devices(frame: Frame) -> None:
    # Properties that the checks of the bearings themselves cannot cover after the runs.
    for name, link in frame.bearings.items():
        if link.bearing.is_dcfp:
            msg = (
                f"`lir run` supports LIR-DCFPs only, and interface_friction = inf of {name} "
                "is a plain DCFP: set a value (`lir design` proposes one), or use `lir "
                "compare`"
            )
            raise ProjectError(msg)
        if math.isinf(link.bearing.lateral_capacity):
            msg = (
                f"`lir run` supports bearings with rims only, and {name} has capacity = inf: set "
                "the displacement at rim contact"
            )
            raise ProjectError(msg)


def combined_frames(
    parts: ProjectInputs, system: IsolationSystem, spectrum: Spectrum, motions: MotionSet
) -> dict[str, Frame]:
    """Return a project's structure under each combination of its loads but the average one."""
    loaded = parts.loaded_frame()
    found: dict[str, Frame] = {}
    upright = any(motion.z is not None for motion in motions.values())
    for name, factors in parts.code().loads.combined(None if upright else spectrum).items():
        if name in system.combinations:
            there = {case: f for case, f in factors.items() if case in {"D", *loaded.load_cases}}
            said = (f"{f:.4g} {case}".removeprefix("1 ") for case, f in there.items() if f)
            words = " + ".join(said)
            found[words] = loaded.combined(factors)
    return found


def moved_frames(parts: ProjectInputs, frame: Frame) -> dict[str, Frame]:
    """Return a project's structure with its floors' masses moved in each direction."""
    share = parts.rules().accidental_eccentricity
    if not share:
        return {}
    try:
        return {
            way: with_moved_masses(frame, (share * x, share * y), f"{frame.name}, masses {way}")
            for way, (x, y) in WAYS.items()
        }
    except ModelError as cause:
        msg = worded(
            "time histories omit [analysis] accidental_eccentricity = {share:g}, because {cause}. "
            'Write accidental_eccentricity = "none" to confirm',
            share=share,
            cause=cause,
        )
        if parts.file.analysis.accidental_eccentricity is not None:
            raise ProjectError(msg) from cause
        _warn((msg,))
        return {}


def scaled_motions(
    parts: ProjectInputs, spectrum: Spectrum, equivalent: EquivalentLinear
) -> MotionSet:
    """Return a project's motions scaled to the spectrum or by a number, by its file."""
    motions, scale = parts.motions(), parts.file.motions.scale
    if scale != "spectrum":
        scaled = type(motions)({n: m.scaled(scale) for n, m in motions.items()}, motions.facts)
        _warn((*twins(scaled), *factor_doubts(scale, scaled)))
        return scaled
    rule = parts.code().scaling[0].name
    return motions.scaled_to(spectrum, rule=rule, periods=period_range(equivalent, rule))


def _warn(doubts: tuple[str, ...]) -> None:
    for doubt in doubts:
        warnings.warn(doubt, ModelWarning, stacklevel=3)


def inputs_of(parts: ProjectInputs, known: Preliminary) -> dict[str, str]:
    """Return a digest of each section that the time histories of a project depend on."""
    file = parts.file
    analysis = file.analysis.model_dump(mode="json", include={"level", "dt", "bounds"})
    if known.moved:
        rules = parts.rules()
        analysis["masses moved"] = rules.accidental_eccentricity
        analysis["motions of moved masses"] = file.analysis.accidental_eccentricity_motions
    said = {
        "structure": file.structure.model_dump(mode="json"),
        "bearing": None
        if file.bearing is None
        else file.bearing.model_dump(mode="json", exclude_none=True),
        "bounds": file.bounds.model_dump(mode="json"),
        "analysis": analysis,
    }
    if file.bearings:
        said["bearings"] = {
            name: kind.model_dump(mode="json", exclude_none=True)
            for name, kind in file.bearings.items()
        }
    if file.moat is not None:
        said["moat"] = file.moat.model_dump(mode="json")
    if file.dampers:
        said["dampers"] = {name: one.model_dump(mode="json") for name, one in file.dampers.items()}
    if file.loads is not None:
        said["loads"] = file.loads.model_dump(mode="json")
    found = {name: _digest(json.dumps(value).encode()) for name, value in said.items()}
    if isinstance(file.structure, OpenSeesModel):
        found["script"] = parts.sources.digest(parts.folder / file.structure.script)[:16]
    if isinstance(file.structure, ImportedModel):
        found["model file"] = parts.sources.digest(parts.folder / file.structure.file)[:16]
        library = [parts.sources.digest(parts.folder / name) for name in file.structure.library]
        if library:
            found["libraries of sections"] = _digest("".join(library).encode())
    if tables := parts.sources.tables:
        found["tables of members"] = _digest(b"".join(tables.values()))
    if parts.sources.extensions:
        found["extensions"] = _digest(json.dumps(parts.sources.extensions).encode())
    samples = [
        name.encode()
        + repr(motion.dt).encode()
        + b"".join(
            component.tobytes()
            for component in (motion.x, motion.y, motion.z)
            if component is not None
        )
        for name, motion in known.motions.items()
    ]
    found["motions"] = _digest(b"".join(samples))
    found["version of lir-dcfp"] = package_version()
    levels = parts.rules().levels
    if len(levels) > 1:
        found["levels"] = _digest(repr([(one.name, one.factor) for one in levels]).encode())
    return found


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]
