"""Buildings that yield on LIR-DCFP and plain bearings, under records of equal demand: the runs.

The demand of a scaled record is the displacement of one bearing without rims under it over the
capacity of those with rims, 250 mm: records are scaled to chosen demands.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from frames import (
    AuditWarning,
    Frame,
    GroundMotion,
    MotionWarning,
    Section,
    ductility,
    floor_acceleration,
    gravity,
    lumped_mass,
    moment_frame,
    storey_drift,
    time_history,
)
from frames.demo import bearing_for, design, pacoima
from frames.laws import Gap, PlasticHinge
from frames.library.models import DEFAULT_BEAM, DEFAULT_COLUMN
from frames.results.formulas import in_plan
from lir_element.errors import AnalysisWarning
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import xarray as xr

    from frames.demo import Place
    from lir_element import LIRBearing

YIELD_STRESS = 345e6
"""Of the steel [Pa]."""

LIR, RIMS, WIDE, MOAT = "LIR-DCFP", "DCFP with rims", "larger-diameter DCFP", "DCFP in a moat"
SYSTEMS = (LIR, RIMS, WIDE, MOAT)
SOFT, BEHIND = "DCFP in a soft moat", "LIR-DCFP, walls behind"
VARIANTS = (SOFT, BEHIND)
WALL_STIFFNESS, RESTITUTION = 5e8, 0.65
"""Of the wall at one side of the moat [N/m], and of the building against it [-]: assumptions."""

WALLS = {MOAT: (0.25, 1.0), SOFT: (0.25, 0.1), BEHIND: (0.29, 1.0)}
"""Distance of the walls [m], and their stiffness over that of a wall, by system."""

TAIL = 6.0
"""Without ground motion, for the building to come to rest [s]."""
LONGEST = 45.0
"""Of a record that is run [s]."""
LEAST, MOST = 0.3, 3.0
"""Factors on a record."""
AT2 = {
    "Newhall 1994": "RSN1044_NORTHR_NWH360.AT2",
    "Düzce 1999": "RSN1605_DUZCE_DZC270.AT2",
    "Gilroy 2 1989": "RSN766_LOMAP_G02000.AT2",
    "El Centro ICC 1987": "RSN721_SUPER.B_B-ICC090.AT2",
    "Arcelik 1999": "RSN1148_KOCAELI_ARE000.AT2",
}


@dataclass(frozen=True)
class Structure:
    """A steel frame: sections of columns and beams, and their plastic moduli [m3]."""

    name: str
    column: Section
    beam: Section
    moduli: tuple[float, float]
    weak: float  # m3, of the beam about its weak axis

    @property
    def hinges(self) -> dict[str, PlasticHinge]:
        """Hinges of columns and beams."""
        column, beam = (YIELD_STRESS * modulus for modulus in self.moduli)
        squash = YIELD_STRESS * self.column.area
        return {
            "column": PlasticHinge(moment_y=column, moment_z=column, axial=squash, hardening=0.02),
            "beam": PlasticHinge(moment_y=beam, moment_z=YIELD_STRESS * self.weak, hardening=0.03),
        }

    def yield_rotations(self) -> dict[str, float]:
        """Return the rotations at which columns and beams yield, M_p L / (6 E I) [rad]."""
        members = {"column": (self.column, 3.5), "beam": (self.beam, 6.0)}  # lengths [m]
        return {
            kind: YIELD_STRESS * modulus * length / (6.0 * _rigidity(section))
            for (kind, (section, length)), modulus in zip(members.items(), self.moduli, strict=True)
        }


def _rigidity(section: Section) -> float:
    # The larger bending stiffness [N m2].
    return float(section.elastic_modulus * max(section.inertia_y, section.inertia_z))


def box_modulus(side: float, wall: float) -> float:
    """Return the plastic modulus of a square box [m3]."""
    return (side**3 - (side - 2.0 * wall) ** 3) / 4.0


def i_moduli(depth: float, width: float, flange: float, web: float) -> tuple[float, float]:
    """Return the plastic moduli of an I-section without fillets about both axes [m3]."""
    inner = depth - 2.0 * flange
    strong = width * flange * (depth - flange) + 0.25 * web * inner**2
    return strong, 0.5 * flange * width**2 + 0.25 * inner * web**2


def structures() -> dict[str, Structure]:
    """Return the frames: the demo's, and one of light members."""
    beam, light = (0.55, 0.22, 0.020, 0.012), (0.40, 0.18, 0.0135, 0.0086)
    found = {}
    for name, column, box, section, shape in (
        ("demo", (0.40, 0.025), DEFAULT_COLUMN, DEFAULT_BEAM, beam),
        ("light", (0.30, 0.016), Section.box(0.30, 0.30, 0.016), Section.i_shape(*light), light),
    ):
        strong, weak = i_moduli(*shape)
        moduli = (box_modulus(*column), strong)
        found[name] = Structure(name, box, section, moduli, weak)
    return found


def records_in(folder: Path) -> dict[str, Callable[[], GroundMotion]]:
    """Return what reads the records, by name; those of one component shake along x."""

    def at2(file: str, name: str) -> GroundMotion:
        return GroundMotion.from_at2(folder / file, name=name)

    def chi_chi() -> GroundMotion:
        parts = [np.loadtxt(folder / f"TCU065-{axis}.ATH").ravel() for axis in "ENV"]
        count = min(len(part) for part in parts)
        x, y, z = (STANDARD_GRAVITY * part[:count] for part in parts)
        return GroundMotion(x=x, y=y, z=z, dt=0.005, name="Chi-Chi TCU065 1999")

    def lucerne() -> GroundMotion:
        file = folder / "landers" / "luc.bbp"
        return GroundMotion.from_columns(
            file, time=0, x=2, y=1, z=3, unit="cm/s2", name="Lucerne 1992"
        )

    found: dict[str, Callable[[], GroundMotion]] = {"Pacoima Dam 1971": pacoima}
    for name, file in AT2.items():
        found[name] = partial(at2, file, name)
    return found | {"Chi-Chi TCU065 1999": chi_chi, "Lucerne 1992": lucerne}


@cache
def bearings_of(name: str) -> dict[Place, LIRBearing]:
    """Return the bearings of a structure: one pressure under its own loads, as in the demo."""
    if name == "demo":
        return design()
    structure = structures()[name]
    places = [(ix, iy) for ix in range(3) for iy in range(3)]
    first = moment_frame(bearing=bearing_for(1000e3), column=structure.column, beam=structure.beam)
    loads = dict(zip(places, gravity(first).axial_forces, strict=True))
    return {
        (ix, iy): bearing_for(
            float(np.mean([loads[i, j] for i in {ix, 2 - ix} for j in {iy, 2 - iy}]))
        )
        for ix, iy in places
    }


def model_of(structure: Structure, system: str, *, elastic: bool = False) -> Frame:
    """Return a building on a system."""
    own = bearings_of(structure.name)
    if system not in (LIR, BEHIND):
        rims = (
            system == RIMS
        )  # a larger diameter: none are met, and its displacement is what it needs
        own = {place: bearing.as_dcfp(rims=rims) for place, bearing in own.items()}
    frame = moment_frame(
        bearing=own,
        column=structure.column,
        beam=structure.beam,
        name=system,
        hinges=None if elastic else structure.hinges,
    )
    if system in WALLS:
        mass = sum(each.resolved()["design_load"] for each in own.values()) / STANDARD_GRAVITY
        _add_walls(frame, mass, *WALLS[system])
    return frame


def _add_walls(frame: Frame, mass: float, gap: float, share: float) -> None:
    # Three nodes at each side run into a part of its wall.
    stiffness = share * WALL_STIFFNESS
    wall = Gap(
        gap=gap,
        stiffness=stiffness / 3.0,
        damping=Gap.damping_for(RESTITUTION, stiffness, mass) / 3.0,
    )
    for side, nodes in {
        "x-": [(0, 0), (0, 1), (0, 2)],
        "x+": [(2, 0), (2, 1), (2, 2)],
        "y-": [(0, 0), (1, 0), (2, 0)],
        "y+": [(0, 2), (1, 2), (2, 2)],
    }.items():
        names = [f"base-{ix}-{iy}" for ix, iy in nodes]
        frame.add_moat(f"moat {side}", names, {side: wall})


def motion_of(record: str, folder: Path, factor: float) -> GroundMotion:
    """Return the first 45 s of a record times a factor."""
    with warnings.catch_warnings(action="ignore", category=MotionWarning):
        motion = records_in(folder)[record]()
        if motion.duration > LONGEST:
            motion = motion.trimmed(0.0, LONGEST)
    return motion.scaled(factor)


def demand(motion: GroundMotion) -> float:
    """Return the displacement of one bearing without rims over the capacity of one with rims."""
    bearing = bearing_for(1000e3)
    model = lumped_mass(bearing.as_dcfp(rims=False), mass=1000e3 / STANDARD_GRAVITY)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", AuditWarning)
        data = time_history(model, motion)
    u = in_plan(data["bearing_displacement"].to_numpy()).max()
    return float(u) / bearing.lateral_capacity if data.attrs["status"] == "ok" else math.inf


def factor_for(wanted: float, record: str, folder: Path) -> float | None:
    """Return the factor that brings a record to a demand; None where it would exceed `MOST`."""
    motion = motion_of(record, folder, 1.0)

    def excess(factor: float) -> float:
        return min(demand(motion.scaled(factor)), 10.0) - wanted

    return float(brentq(excess, LEAST, MOST, xtol=2e-3)) if excess(MOST) > 0.0 else None


def perform(task: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Run a building on a system under a record at a demand; returns the task and its numbers."""
    structure = structures()[task["structure"]]
    model = model_of(structure, task["system"], elastic=task["elastic"])
    motion = motion_of(task["record"], folder, task["factor"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", AuditWarning)
        data = time_history(model, motion, duration=motion.duration + TAIL)
    return task | numbers(data)


def numbers(data: xr.Dataset) -> dict[str, Any]:
    """Return what is compared of a result, in SI units."""
    drift = in_plan(storey_drift(data).to_numpy())
    floors = in_plan(floor_acceleration(data).to_numpy())
    table = ductility(data)
    energy = data["energy"].isel(time=-1)
    walls = [str(n) for n in data["link"].to_numpy()] if "link" in data.dims else []
    ended = data.attrs["status"] == "ok"
    return {
        "status": str(data.attrs["status"]),
        "until": float(data["time"][-1]),
        "displacement": float(in_plan(data["bearing_displacement"].to_numpy()).max()),
        "slip": float(data["interface_slip_size"].max()),
        "drift": float(drift.max()),
        "residual": float(drift[-1].max()) if ended else None,
        "rotation": float(table["largest"].max()) if len(table) else 0.0,
        "hinges": int((table["largest"] > 1e-6).sum()) if len(table) else 0,
        "shear": float(in_plan(data["base_shear"].to_numpy()).max() / data["weight"]),
        "wall": float(abs(data["link_force"]).max() / data["weight"]) if walls else 0.0,
        "roof": float(floors[:, -1].max()),
        "floor": float(floors.max()),
        "yielding": float(energy.sel(term="yielding") / energy.sel(term="input")),
        "seconds": float(data.attrs["seconds_loop"]),
    }
