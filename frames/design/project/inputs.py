"""Objects of a project's file: structure, bearings, spectrum, bounds, motions, limits."""

from __future__ import annotations

import contextlib
import runpy
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

from frames._errors import in_project_file
from frames.assembly.assemble import assemble
from frames.design._errors import ProjectError
from frames.design.codes.bounds import PropertyBounds, PropertyModificationFactors
from frames.design.codes.history_rules import HistoryRules
from frames.design.codes.isolation import AVERAGE, IsolationSystem
from frames.design.codes.registry import DesignCode, code_named
from frames.design.codes.superstructure import Superstructure
from frames.design.devices.limits import DesignLimits
from frames.design.hazard.motion_set import MotionSet
from frames.design.hazard.synthetic_motions import pulse_motions
from frames.design.project.member_sections import named_section
from frames.design.project.moat_and_dampers import STANDARD, on_types, types_by_column, with_devices
from frames.design.project.schema import PointsTable, read_points
from frames.design.project.schema_bearing import Bearing, FactorSources
from frames.design.project.schema_structure import (
    ImportedModel,
    IrregularFrame,
    MomentFrame,
    OpenSeesModel,
    ShearBuilding,
)
from frames.design.project.source_files import RunningScript, SourceFiles, tell
from frames.design.project.structure_loads import BuildingLoads, loads_of
from frames.design.project.structure_plan import building_frame
from frames.design.sizing.target import INTERFACE_PRESSURE, DesignTarget
from frames.io import Frame
from frames.library.shear_buildings import shear_building
from lir_element import CoulombFriction, LIRBearing
from lir_element.argument_checks import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames.design.codes.registry import AnalysisMethod
    from frames.design.hazard.spectrum import Spectrum
    from frames.design.project.schema import MotionSource, ProjectFile
    from frames.design.project.schema_structure import Structure

T = TypeVar("T")


class ProjectInputs:
    """Objects of a project's file; an error of its methods names the section at fault."""

    # other files are found from the folder
    def __init__(self, file: ProjectFile, folder: Path) -> None:
        self.file, self.folder = file, folder
        self.sources = SourceFiles(file, folder)

    def code(self) -> DesignCode:
        """Return the code that the project is designed by."""
        return code_named(self.file.project.code, ProjectError)

    def bearing(self) -> LIRBearing:
        """Return the bearing under each column that no other type is named for."""
        given = self.file.bearing
        if given is None:
            msg = "[bearing] is missing: write it, or run `lir design --write`"
            raise ProjectError(msg)
        return bearing_of(given)

    def devices(self) -> dict[str, LIRBearing]:
        """Return the bearing of each type: "standard", and those of ``[bearings.<type>]``."""
        found = {STANDARD: self.bearing()}
        for name, given in self.file.bearings.items():
            if name == STANDARD:
                msg = (
                    f"[bearings.{name}] must not have the name of the type in [bearing]: rename it"
                )
                raise ProjectError(msg)
            found[name] = bearing_of(given, f"bearings.{name}")
        return found

    def frame(self) -> Frame:
        """Return the structure on its bearings, under the average combination of its loads."""
        return self._averaged(self.loaded_frame())

    def loaded_frame(self) -> Frame:
        """Return the structure on its bearings, with its load cases "D", "L" and "S"."""
        return self._loaded_and_types[0].copy()

    def types(self) -> dict[str, str]:
        """Return the type of each bearing: "standard", or of ``[bearings.<type>]``."""
        return self._loaded_and_types[1]

    @cached_property
    def _loaded_and_types(self) -> tuple[Frame, dict[str, str]]:
        # Made once: an imported model needs seconds.
        devices = self.devices()

        def made() -> tuple[Frame, dict[str, str]]:
            frame = self._frame(devices[STANDARD])
            chosen = types_by_column(self.file.bearings, self._averaged(frame))
            return on_types(frame, chosen, devices), chosen

        frame, chosen = in_section("structure", made)
        return with_devices(frame, self.file.moat, self.file.dampers), chosen

    def _averaged(self, frame: Frame) -> Frame:
        # Under the average combination of its loads.
        if not frame.load_cases:
            return frame
        return frame.combined(self.code().loads.combinations(None)[AVERAGE])

    def system(self, frame: Frame, spectrum: Spectrum) -> IsolationSystem:
        """Return the bearings of the structure with its load cases, by the code's combinations."""
        chosen = self.code().loads.combined(spectrum)
        if not frame.load_cases:  # all of it is dead load
            return IsolationSystem.from_frame(frame, combinations=chosen)
        weight = frame.gravity * float(assemble(frame).node_mass[:, 0].sum())
        return IsolationSystem.from_frame(frame, combinations=chosen, weight=weight)

    def provisional_frame(self) -> Frame:
        """Return the structure on bearings of any size, for its loads alone."""
        bearing = LIRBearing(
            radius=2.0,
            slider_height=0.4,
            slider_radius=0.3,
            capacity=0.3,
            friction=CoulombFriction(0.05),
            interface_friction=0.2,
        )
        return in_section("structure", lambda: self._frame(bearing))

    def _frame(self, bearing: LIRBearing) -> Frame:
        loads = loads_of(self.file.loads, self.code().loads)
        name = self.file.project.name
        return frame_of(self.file.structure, bearing, name, self.folder, loads)

    def superstructure(self, frame: Frame) -> Superstructure | None:
        """Return the structure above the bearings; None without ``[superstructure]``."""
        above = self.file.superstructure
        if above is None:
            return None
        given = above.model_dump(exclude_none=True)
        given.setdefault("R", 1.0)  # of codes that do not read it
        if isinstance(self.file.structure, ShearBuilding):  # others have no stiffness of a storey
            given["storey_stiffness"] = self.file.structure.storey_stiffness
        return in_section("superstructure", lambda: Superstructure.from_frame(frame, **given))

    def spectrum(self) -> Spectrum:
        """Return the design spectrum."""
        given = self.file.spectrum
        if isinstance(given, PointsTable):
            return in_section("spectrum", lambda: self._by_points(given))
        keys = given.model_dump(exclude={"code"}, exclude_none=True)
        return in_section("spectrum", lambda: self.code().spectrum(**keys))

    def _by_points(self, given: PointsTable) -> Spectrum:
        points = given.points
        if isinstance(points, Path):
            points = read_points(self.folder / points)
        periods = [period for period, _ in points]
        levels = [level for _, level in points]
        keys = given.model_dump(exclude={"code", "points"}, exclude_none=True)
        return self.code().by_points(periods, levels, **keys)

    def bounds(self) -> PropertyBounds:
        """Return the lower and upper bound friction properties."""
        given = self.file.bounds

        def made() -> PropertyBounds:
            inner = None if given.interface is None else self._factors(given.interface)
            return PropertyBounds(self._factors(given.friction), inner)

        return in_section("bounds", made)

    def _factors(self, given: tuple[float, float] | FactorSources) -> PropertyModificationFactors:
        # As given, or put together of their sources as the code does.
        if isinstance(given, FactorSources):
            return self.code().factors(**given.model_dump(exclude_unset=True))
        return PropertyModificationFactors(*given)

    def limits(self, **others: float) -> DesignLimits:
        """Return the limits of the engineer; `others` apply if the file gives none."""
        made: Callable[[], DesignLimits] = partial(self.file.limits.made, **others)
        return in_section("limits", made)

    def rules(self) -> HistoryRules:
        """Return the rules for time histories: those of the code, uplift from the file."""
        keys = {"uplift_allowed", "least_gap", "accidental_eccentricity"}
        given = self.file.analysis.model_dump(exclude_none=True, include=keys)
        if given.get("accidental_eccentricity") == "none":
            given["accidental_eccentricity"] = 0.0
        rules, kind = self.code().histories, self.file.analysis.nonstructural

        def made() -> HistoryRules:
            return replace(rules if kind is None else rules.for_elements(kind), **given)

        return in_section("analysis", made)

    def analysis(self) -> AnalysisMethod:
        """Return the equivalent-linear analysis of the code, with the file's limit of drifts."""
        found: Any = self.code().analysis()
        if self.file.analysis.nonstructural is None:
            return cast("AnalysisMethod", found)
        return cast("AnalysisMethod", replace(found, drift=self.rules().drift))

    def target(self) -> DesignTarget:
        """Return the choices of ``lir design``."""
        limits = self.limits(interface_pressure=INTERFACE_PRESSURE)
        made: Callable[[], DesignTarget] = partial(self.file.design.made, limits=limits)
        return in_section("design", made)

    def motions(self) -> MotionSet:
        """Return the motions as they are given, not scaled to the spectrum."""
        given = self.file.motions
        return varied(given, motions_of(given, self.folder, lambda: self.bearing().period))


def bearing_of(given: Bearing, section: str = "bearing") -> LIRBearing:
    """Return the bearing of a section, or raise a ProjectError."""
    made: Callable[[], LIRBearing] = given.made
    return in_section(section, made)


def frame_of(
    given: Structure,
    bearing: LIRBearing,
    name: str,
    folder: Path,
    loads: BuildingLoads | None = None,
) -> Frame:
    """Return the structure of a section on its bearings; scripts are found from the folder."""
    if isinstance(given, (MomentFrame, IrregularFrame)):
        return building_frame(given, bearing, name, folder, loads)
    if loads is not None:
        msg = (
            f'[loads] is for moment and irregular frames, and kind = "{given.kind}" has its own '
            "masses and loads: remove the section"
        )
        raise ProjectError(msg)
    if isinstance(given, ShearBuilding):
        return shear_building(
            bearing,
            given.storey_mass,
            given.storey_stiffness,
            base_mass=given.base_mass,
            storey_height=given.storey_height,
            plan=(given.bays, given.bay_width),
            eccentricity=given.eccentricity,
            name=name,
        )
    if isinstance(given, ImportedModel):
        return _imported(given, bearing, name, folder)
    return _opensees(given, bearing, name, folder)


def _imported(given: ImportedModel, bearing: LIRBearing, name: str, folder: Path) -> Frame:
    from lir_element.opensees.library import opensees

    path = folder / given.file
    if not path.is_file():
        msg = f"file = {given.file} is not in {folder}: name the exported model"
        raise ProjectError(msg)
    with contextlib.suppress(ImportError):  # which shells alone need
        opensees().wipe()
    read: Callable[..., Frame] = Frame.from_sap2000
    if given.kind == "etabs":
        shapes = {k: named_section(v, column=False).section for k, v in given.sections.items()}
        library = [folder / file for file in given.library]
        read = partial(Frame.from_etabs, sections=shapes, library=library)
    size = path.stat().st_size / 1e6
    tell(f"reading {path}, a model of {given.kind.upper()} ({size:.1f} MB)")
    with in_project_file():
        return read(
            path,
            bearing,
            at=given.bearings_at or None,
            **given.model_dump(exclude={"kind", "file", "bearings_at", "sections", "library"}),
            name=name,
        )


def _opensees(given: OpenSeesModel, bearing: LIRBearing, name: str, folder: Path) -> Frame:
    from lir_element.opensees.library import opensees

    script = folder / given.script
    if not script.is_file():
        msg = f"script = {given.script} is not in {folder}: name the model's script"
        raise ProjectError(msg)
    opensees().wipe()
    with RunningScript(script, "script", folder):
        runpy.run_path(script.name, run_name="__main__")
    with in_project_file():
        return Frame.from_opensees(
            given.base_nodes,
            bearing,
            **given.model_dump(exclude={"kind", "script", "base_nodes"}),
            name=name,
        )


def motions_of(given: MotionSource, folder: Path, period: Callable[[], float]) -> MotionSet:
    """Return the motions of a section as read; `period` is that of the bearings [s]."""

    def made() -> MotionSet:
        if given.pulses is not None:
            asked = given.pulses
            periods = asked.periods or [ratio * period() for ratio in asked.period_ratios]
            found = pulse_motions(
                periods, asked.velocities, shapes=asked.shapes, cycles=asked.cycles
            )
        elif given.folder is not None:
            found = MotionSet.from_folder(folder / given.folder, given.table)
        else:
            found = _record_sets(given.fema_p695)
        found = found.only(given.only) if given.only else found
        return found.fault_normal() if given.fault_normal else found

    return in_section("motions", made)


def _record_sets(names: Sequence[str]) -> MotionSet:
    # Motions of FEMA P695, several sets as one; the fact "set" names a motion's own set.
    sets = {name: MotionSet.fema_p695(name) for name in names}
    facts = {
        motion: {**known, "set": name}
        for name, each in sets.items()
        for motion, known in each.facts.items()
    }
    return MotionSet({n: motion for each in sets.values() for n, motion in each.items()}, facts)


def varied(given: MotionSource, motions: MotionSet) -> MotionSet:
    """Return motions rotated, without their vertical component, or repeated, by a section."""

    def made() -> MotionSet:
        found = motions.turned(given.turned) if given.turned else motions
        if "without" in given.vertical:
            found = found.without_vertical(beside="with" in given.vertical)
        second = given.repeated
        if second is None:
            return found
        return found.repeated(second.factors, following=second.following, gap=second.gap)

    return in_section("motions", made)


def in_section(section: str, make: Callable[[], T]) -> T:
    """Call `make` and return its result; an error of a wrong value names the section."""
    try:
        return make()
    except ProjectError:
        raise
    except (ValueError, TypeError, OSError, OverflowError) as cause:
        why: object = cause
        if isinstance(cause, OSError) and cause.filename:
            why = f"{shown(str(cause.filename))}: {cause.strerror}: name a file that can be read"
        msg = f"[{section}] {why}"
        raise ProjectError(msg) from cause
