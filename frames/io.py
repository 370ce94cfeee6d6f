"""Frames from other programs' models and to them, and `Frame` with all of this as its methods."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal, cast

import frames.frame as model
from frames._csv import BOOKS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from frames.exchange.import_report import BaseRotations, ImportReport
    from frames.model.sections import Section
    from frames.motion.ground_motion import GroundMotion
    from frames.statics.model_check import ModelCheck
    from lir_element import LIRBearing

__all__ = ["Frame", "read_etabs", "read_opensees", "read_sap2000", "write_etabs", "write_sap2000"]


def read_opensees(
    base_nodes: Sequence[int],
    bearing: LIRBearing | Mapping[int, LIRBearing],
    *,
    vertical: Literal["y", "z"] | None = None,
    base_rotations: Literal["kept", "free", "fixed"] = "kept",
    base_diaphragm: bool = True,
    gravity: float | None = None,
    damping: bool = True,
    levels: Mapping[str, Sequence[int]] | None = None,
    other_supports: Collection[int] = (),
    accept_nonlinear: bool = False,
    vertical_mass: Literal["horizontal"] | Mapping[int, float] | None = None,
    length_unit: float = 1.0,
    force_unit: float = 1.0,
    name: str = "OpenSees model",
) -> Frame:
    """Import OpenSeesPy's current model, linear at its present state, and put it on bearings.

    Parameters
    ----------
    base_nodes : sequence of int
        Tags of the nodes above bearings. Fixed ones are released: their translations and the
        rotation about the vertical.
    bearing : LIRBearing or mapping
        One bearing for all base nodes, or one by tag.
    vertical : {None, "z", "y"}
        Axis of the OpenSees model that points up: None is z in three dimensions and y in
        the plane. Results are in the axes of docs/conventions.md, z up.
    base_rotations : {"kept", "free", "fixed"}
        Rotations of the base nodes about horizontal axes: held if the model holds them (as stiff
        base beams would), free (of a model that has base beams), or held.
    base_diaphragm : bool
        True if base nodes at one elevation move in plan as one rigid body, as on a base slab.
    gravity : float, optional
        Acceleration of gravity [m/s2] for a model without loads: its masses then have weight. None:
        the bearings carry its present loads.
    damping : bool
        True to import the damping of the model (Rayleigh, modal, dashpots).
    levels : mapping, optional
        Tags of nodes by name of level, for storey drifts. None: "level-0" at the base, and
        one at each elevation with mass.
    other_supports : collection of int
        Tags of supports that carry elements and shall stay as they are.
    accept_nonlinear : bool
        True to freeze the present stiffness of elements that have left their initial one, and of
        gaps, bars that only pull or push, and nonlinear dashpots.
    vertical_mass : {None, "horizontal"} or mapping
        Vertical mass besides that of the model: "horizontal" lets masses act along the vertical as
        along x, a mapping gives kg by tag. It adds no weight to a loaded model.
    length_unit, force_unit : float
        Units of the OpenSees model [m], [N]: 1e-3 and 1e3 for mm and kN. Time is in seconds.
    name : str
        Name of the frame.

    Returns
    -------
    Frame
        Nodes are named by their tags; "ground-<tag>" and "bearing-<tag>" are below the base nodes.
        The model is the superelement "opensees", whose `notes` repeat the warnings.

    Raises
    ------
    ModelError
        If the model cannot be imported; the message has the remedy.
    ImportError
        If openseespy is not installed.

    Warns
    -----
    ModelWarning
        If elements are or may be nonlinear, with their share of the strain energy, or if the
        isolation is damped.

    Notes
    -----
    The OpenSees model stays as it is, time and recorders too, but its analysis objects are wiped
    (`wipeAnalysis`). Copies of its nonlinear uniaxial materials are added for a trial, under tags
    from 2,147,000,000 on; no element has them. Displacements count from its present state. Two
    kinds of damping are invisible: `modalDampingQ` and the option ``-damp`` of elements. See
    docs/choices_opensees.md.
    """
    from frames.opensees.frame import imported  # needs the optional openseespy
    from frames.opensees.structure import Options

    options = Options(
        base_nodes,
        bearing,
        vertical,
        base_rotations,
        base_diaphragm,
        gravity,
        damping,
        levels,
        other_supports,
        accept_nonlinear,
        vertical_mass,
        length_unit,
        force_unit,
    )
    return imported(Frame, options, name)


def read_sap2000(
    path: str | Path,
    bearing: LIRBearing | Mapping[str, LIRBearing] | None = None,
    *,
    at: Sequence[str] | None = None,
    loads: Mapping[str, float] | str | None = None,
    mass: Mapping[str, float] | None = None,
    allow: Collection[str] = (),
    mesh: float = 1.25,
    base_rotations: BaseRotations = "kept",
    base_diaphragm: bool = True,
    decimal: Literal[".", ","] = ".",
    name: str | None = None,
) -> Frame:
    """Read a SAP2000 model, and put it on bearings (docs/exchange.md has the details).

    Parameters
    ----------
    path : str or Path
        A .s2k or .$2k text file, or an .xlsx workbook with the same tables.
    bearing : LIRBearing or mapping, optional
        One for all joints that are restrained vertically and in plan, or one by name of a
        group, joint, link or link property. None: supports and links as the file has them.
    at : sequence of str, optional
        Groups, joints, links or link properties that get the one bearing.
    loads : mapping or str, optional
        Permanent loads: factors by load pattern, or the name of a combination of static loads.
        "all": dead, live and snow patterns in full, as the cases "D", "L" and "S" that codes
        combine. None: dead loads, and others by their share in the mass source.
    mass : mapping, optional
        Shares of load patterns that are mass, instead of the file's mass source.
    allow : collection of str
        Objects that may be left out although they change the answer, by the key in the refusal.
    mesh : float
        Longest side of the shell elements of walls and slabs [m].
    base_rotations : {"kept", "free", "fixed"}
        Rotations of joints on bearings about horizontal axes: as the supports hold them, free,
        or held.
    base_diaphragm : bool
        True if joints on bearings at one elevation move in plan as one rigid body.
    decimal : {".", ","}
        Decimal sign of a text file.
    name : str, optional
        Name of the frame; that of the file if None.

    Returns
    -------
    Frame
        Nodes and members have the names of joints and frame objects; `imported` lists objects read,
        read as something else, and left out.

    Raises
    ------
    ModelError
        If the file cannot be used, or an omission would change the answer: the message has line,
        table and remedy.
    ImportError
        If openseespy, which has the shells, or openpyxl, which reads workbooks, is needed and
        not installed.

    Warns
    -----
    ModelWarning
        If the model has probable mistakes: unknown words, mass without weight, supports that do not
        let each bearing carry its column, a level on the bearings without mass.
    """
    from frames.exchange.import_report import Options
    from frames.exchange.to_frame import imported

    options = Options(
        bearing, at, loads, mass, mesh, base_rotations, base_diaphragm, allow, decimal
    )
    return imported(Frame, "SAP2000", path, options, name)


def read_etabs(
    path: str | Path,
    bearing: LIRBearing | Mapping[str, LIRBearing] | None = None,
    *,
    at: Sequence[str] | None = None,
    loads: Mapping[str, float] | str | None = None,
    mass: Mapping[str, float] | None = None,
    allow: Collection[str] = (),
    mesh: float = 1.25,
    base_rotations: BaseRotations = "kept",
    base_diaphragm: bool = True,
    decimal: Literal[".", ","] = ".",
    sections: Mapping[str, Section] | None = None,
    library: str | Path | Sequence[str | Path] = (),
    name: str | None = None,
) -> Frame:
    """Read an ETABS model, and put it on bearings (docs/exchange.md has the details).

    Parameters
    ----------
    path : str or Path
        A .e2k or .$et text file.
    bearing, at, loads, mass, allow, mesh, base_rotations, base_diaphragm, decimal, name
        As in `read_sap2000`; joints are named by point and story, "12-Story2".
    sections : mapping, optional
        Constants of frame sections that the file has by the name of a catalogue alone, or in
        place of its own: {"W24X55": Section(...)}, local z along axis 2. Materials and
        modifiers are those of the file.
    library : str, Path or sequence of them
        Files of the program that have sections by their names ("AISC14.xml", among its
        property libraries): constants of those that the model only names.

    Returns
    -------
    Frame
        Nodes are points at stories, members lines at stories, "C1-Story2"; levels are the stories.
        `imported` lists objects read, read as something else, and left out.

    Raises
    ------
    ModelError
        If the file cannot be used, or an omission would change the answer: the message has line,
        section and remedy.
    ImportError
        If openseespy, which has the shells, is needed and not installed.

    Warns
    -----
    ModelWarning
        As for `read_sap2000`.
    """
    from frames.exchange.import_report import Options
    from frames.exchange.to_frame import imported

    options = Options(
        bearing,
        at,
        loads,
        mass,
        mesh,
        base_rotations,
        base_diaphragm,
        allow,
        decimal,
        sections,
        library,
    )
    return imported(Frame, "ETABS", path, options, name)


def write_sap2000(
    frame: model.Frame,
    path: str | Path,
    *,
    displacement: float | None = None,
    units: str = "KN, m, C",
) -> None:
    """Write the frame as SAP2000's text tables, to check one program by the other.

    Parameters
    ----------
    frame : Frame
        The frame.
    path : str or Path
        The .s2k file.
    displacement : float, optional
        Displacement of the equivalent-linear analysis [m]: bearings become friction isolator links
        with their effective stiffness and damping at it. Needed if there are bearings.
    units : str
        Units of the file.

    Raises
    ------
    ModelError
        If the frame has superelements other than shells of an imported model, nonlinear links,
        plastic hinges, or something else that the tables cannot hold; the message names it.

    Notes
    -----
    Shells are areas, one for each element, without mass: read them again with `mesh` no shorter
    than their sides.
    Weights of masses and members are loads of joints, as here, not self weight. A link has the
    radius, Q/W by the speed and the axial stiffness of its bearing
    (`frames.exchange.pendulum_link.pendulum_link`). Rims, interface and slip have no link:
    write `frame.with_bearings(bearing.as_dcfp(rims=False))` to compare like with like.
    """
    from frames.exchange.from_frame import building_of
    from frames.exchange.write_sap2000 import tables_of, text_of
    from frames.results.storage import write_whole

    write_whole(path, text_of(tables_of(building_of(frame, displacement, units))))


def write_etabs(
    frame: model.Frame,
    path: str | Path,
    *,
    displacement: float | None = None,
    units: str = "KN, m, C",
) -> dict[str, str]:
    """Write the frame as ETABS' text, to check one program by the other.

    Parameters
    ----------
    frame : Frame
        The frame.
    path : str or Path
        The .e2k file.
    displacement, units
        As in `write_sap2000`.

    Returns
    -------
    dict of str to str
        Names of nodes ("12-Story2") and members ("C1-Story2") in the file.

    Raises
    ------
    ModelError
        As in `write_sap2000`; and if two nodes are at one place, which ETABS merges.

    Notes
    -----
    Stories are the frame's levels or diaphragms, the lowest node the base; other nodes are points
    below the next story. Springs to a held node at one place are springs of points.
    docs/exchange.md lists the features of the file that no file of ETABS confirms.
    """
    from frames.exchange.from_frame import building_of
    from frames.exchange.write_etabs import EtabsWriter
    from frames.results.storage import write_whole

    writer = EtabsWriter(building_of(frame, displacement, units, program="ETABS"))
    write_whole(path, writer.text())
    return writer.names


MODEL_FILES = {
    "etabs": (write_etabs, (".e2k", ".$et")),
    "sap2000": (write_sap2000, (".s2k", ".$2k", *BOOKS)),
}
"""Programs: the writer of their models, and endings of the files, the written one first."""


class Frame(model.Frame):
    """A structure on bearings, built by one call at a time; `frames.assembly` reads it.

    Units are SI, axes are global and right-handed with z up. Every call checks its input and leaves
    the frame unchanged when it refuses.

    Parameters
    ----------
    name : str
        Name of the model.
    gravity : float
        Acceleration of gravity [m/s2], >= 0: every mass weighs mass * gravity along -z.

    Examples
    --------
    >>> from frames.model.sections import Section
    >>> frame = Frame("mast")
    >>> frame.add_node("foot", 0.0, 0.0, 0.0)
    >>> frame.add_node("top", 0.0, 0.0, 4.0)
    >>> frame.fix("foot", "all")
    >>> frame.add_member("mast", "foot", "top", Section.box(0.3, 0.3, 0.01))
    >>> frame.add_mass("top", 5000.0)
    """

    from_opensees = staticmethod(read_opensees)
    from_sap2000 = staticmethod(read_sap2000)
    from_etabs = staticmethod(read_etabs)
    to_sap2000 = write_sap2000
    to_etabs = write_etabs

    def program_tables(
        self,
        data: xr.Dataset | Mapping[str, xr.Dataset],
        *,
        units: str = "KN, m",
        stations: int = 3,
    ) -> dict[str, pd.DataFrame]:
        """Return largest and smallest results in the columns of SAP2000's and ETABS' tables.

        Parameters
        ----------
        data : xarray.Dataset or mapping
            Result of `time_history` with this frame; or several by name of the output case.
        units : str
            Units of force and length: "KN, m", "N, m", "N, mm", "Kip, in" or "Kip, ft".
        stations : int
            Stations of each member at equal distances, both ends among them.

        Returns
        -------
        dict of str to pandas.DataFrame
            "Joint Displacements", "Joint Reactions", "Base Reactions", "Element Forces - Frames"
            and "Story Drifts", as far as the model has them; `write_tables` writes them as a
            workbook or CSV. A row "Max" and a row "Min" over the recorded steps of each case, whose
            values are not of one instant; stations along members, signs by axes 1, 2 and 3
            (docs/exchange.md).

        Raises
        ------
        ModelError
            If the frame is not the one that was analysed, or the units are not known.
        ValueError
            If the recording lacks a needed variable.

        Examples
        --------
        >>> import numpy as np
        >>> from frames import GroundMotion, moment_frame, time_history
        >>> from frames.demo import bearing_for
        >>> frame = moment_frame((1, 1), 1, bearing=bearing_for(400e3))
        >>> data = time_history(frame, GroundMotion(x=np.ones(11), dt=0.01))
        >>> list(frame.program_tables(data)["Element Forces - Frames"])[:6]
        ['Frame', 'Station', 'OutputCase', 'CaseType', 'StepType', 'P']
        """
        from frames.recording.program_tables import program_tables

        return program_tables(self, data, units=units, stations=stations)

    def check(self, motion: GroundMotion | None = None) -> ModelCheck:
        """Sum up the model, and list values in probably wrong units or places.

        Parameters
        ----------
        motion : GroundMotion, optional
            The motion it is meant for.

        Returns
        -------
        ModelCheck
            Mass, weight and loads; periods on a fixed base and on the bearings; axial force,
            pressure and settlement of each bearing; unusual values. It prints as a table.

        Raises
        ------
        ModelError
            If the model cannot be assembled. If only the equilibrium fails, the table says so.
        """
        from frames.statics.model_check import check_model  # the analysis reads the model

        return check_model(self, motion)

    @property
    def imported(self) -> ImportReport | None:
        """Account of the frame's import from a file; None if it was built."""
        return cast("ImportReport | None", self._imported)
