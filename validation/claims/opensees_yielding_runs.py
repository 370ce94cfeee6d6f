"""Buildings whose structure yields, run here and wholly in OpenSees: histories of their parts."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, moment_frame, shear_building, time_history
from frames.laws import Bilinear, BoucWen, Gap, HertzGap, PlasticHinge
from frames.library.models import DEFAULT_BASE_BEAM, DEFAULT_BEAM, DEFAULT_COLUMN
from lir_element import CoulombFriction, LIRBearing
from lir_element.opensees import bearing_element
from validation.opensees.frames import Built, add_loads, build
from validation.opensees.model import (
    advance,
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)
from validation.opensees.nonlinear import plastic_rotations

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray
    from frames.model.laws import Law

EQUILIBRIUM = 1e-9  # m and rad, of the last correction in OpenSees
MASS, STIFFNESS = 2e5, 1.2e8  # kg, N/m, of a storey
LEAST = 0.25
"""Share of the largest value from which on a part is compared [-]."""
TURNING = (500.0, 500.0, 800.0)  # kg m2, at every node of the moment frame
SECTIONS = {"column": DEFAULT_COLUMN, "beam": DEFAULT_BEAM, "base_beam": DEFAULT_BASE_BEAM}
HINGES = {
    "beam": PlasticHinge(moment_y=1.6e5, hardening=0.03),
    "column": PlasticHinge(moment_y=2.5e5, moment_z=2.5e5, hardening=0.03),
}


@dataclass(frozen=True)
class Both:
    """What both programs say of a building; `found` here, `expected` in OpenSees."""

    time: FloatArray
    """(n,): Times [s]."""
    names: tuple[str, ...]
    """Links, or hinges with the moment's axis."""
    moves: tuple[FloatArray, FloatArray]
    """(n, nodes, 3): Displacements of all nodes from the beginning, found and expected [m]."""
    deformation: tuple[FloatArray, FloatArray]
    force: tuple[FloatArray, FloatArray]
    """(n, parts): Of links [m, N], or plastic rotations and moments of hinges [rad, N m]."""
    work: tuple[FloatArray, FloatArray]
    """(parts,): Taken up until the end, without what is elastic of links that yield [J]."""
    limit: FloatArray
    """(parts,): Deformation at yield, 1 where there is none [m, rad]."""
    slip: float
    """Largest slip in the bearings' interface [m]."""
    ledger: float
    """Error of the energy balance here over the input [-]."""

    @property
    def displacement(self) -> float:
        """Largest difference of any displacement over the largest one [-]."""
        found, expected = self.moves
        return float(np.abs(found - expected).max() / np.abs(expected).max())

    @property
    def reached(self) -> tuple[FloatArray, FloatArray]:
        """Largest deformation over that at yield of every part, (parts,), found and expected."""
        found, expected = (np.abs(one).max(axis=0) / self.limit for one in self.deformation)
        return found, expected

    def apart(self, values: tuple[FloatArray, FloatArray], least: float = LEAST) -> float:
        """Return the largest difference of parts' values over their own, of those that matter.

        Shapes: values (parts,).
        """
        found, expected = values
        large = np.abs(expected) >= least * np.abs(expected).max()
        return float(np.abs(found[large] / expected[large] - 1.0).max())


def pulse(scale: float) -> GroundMotion:
    """Return a motion of 6 s along x and y, with peaks of 3.2 m/s2 scaled."""
    t = np.arange(0.0, 6.0, 0.01)
    x = np.sin(np.pi * t) * np.exp(-(((t - 2.5) / 1.5) ** 2))
    y = 0.7 * np.sin(1.6 * np.pi * t) * np.exp(-(((t - 2.0) / 1.5) ** 2))
    return GroundMotion(3.2 * scale * x, 3.2 * scale * y, dt=0.01, name="pulse")


def bearing(capacity: float, friction: float = 0.05) -> LIRBearing:
    """Return the LIR-DCFP under these buildings."""
    return LIRBearing(
        radius=1.5,
        slider_height=0.15,
        slider_radius=0.15,
        capacity=capacity,
        friction=CoulombFriction(friction),
        interface_friction=0.14 if friction < 0.1 else 0.3,
    )


def stick(
    storeys: int, law: Callable[[float], Bilinear | BoucWen] | None = None, capacity: float = 0.25
) -> Frame:
    """Return a shear building, with a law for its storeys or linear."""
    return shear_building(
        bearing(capacity),
        storey_mass=MASS,
        storey_stiffness=STIFFNESS,
        storeys=storeys,
        base_mass=MASS,
        damping=None,
        storey_law=law,
    )


def equipped(law: Law) -> Frame:
    """Return a linear stick with links of a law: at the base in x and y, in its first storey."""
    frame = stick(2)
    if isinstance(law, Gap | HertzGap):
        frame.add_moat("moat", ["base"], law)
        return frame
    frame.add_link("base-x", "ground", "base", law, "ux")
    frame.add_link("base-y", "ground", "base", law, "uy")
    frame.add_link("storey", "base", "floor-1", law, (1.0, 0.5, 0.0))
    return frame


def hinged(on: LIRBearing) -> Frame:
    """Return a moment frame of one bay and two storeys with hinges, its members free of shear."""
    sections: dict[str, Any] = {
        name: replace(section, shear_area_y=math.inf, shear_area_z=math.inf)
        for name, section in SECTIONS.items()
    }
    frame = moment_frame(
        (1, 1), 2, bearing=on, damping=None, hinges=HINGES, floor_load=3000.0, **sections
    )
    for name in frame.nodes:
        if not name.startswith("ground"):
            frame.add_mass(name, 0.0, TURNING)
    return frame


def run_both(frame: Frame, motion: GroundMotion, dt: float, duration: float) -> Both:
    """Run a building with links or hinges here and in OpenSees."""
    data = time_history(frame, motion, duration, dt, on_failure="raise")
    names = [str(name) for name in data["hinge" if frame.hinges else "link"].to_numpy()]
    count, width = data.sizes["time"], len(names) * (2 if frame.hinges else 1)
    moves = np.zeros((count, len(frame.nodes), 3))
    d, f = np.zeros((count, width)), np.zeros((count, width))
    with empty_model() as ops:
        built = build(ops, frame, lambda tag, i, j, one: bearing_element(tag, i, j, one))
        add_loads(ops, frame, built)
        gravity_analysis(ops)
        ground_motion(ops, motion)
        solver(ops, EQUILIBRIUM)
        transient_steps(ops)
        for k in range(count):
            if k:
                advance(ops, 1, dt, EQUILIBRIUM)
            moves[k] = [ops.nodeDisp(tag)[:3] for tag in built.nodes.values()]
            d[k], f[k] = (_hinges if frame.hinges else _links)(ops, frame, built, names)
    here = data["node_displacement"].sel(node=list(frame.nodes)).to_numpy()[..., :3]
    parts = _hinges_here(data, names) if frame.hinges else _links_here(data, frame)
    return Both(
        time=data["time"].to_numpy(),
        names=parts.names,
        moves=(here - here[0], moves - moves[0]),
        deformation=(parts.deformation, d),
        force=(parts.force, f),
        work=(parts.work, _work(d, f, parts.stiffness, len(parts.work))),
        limit=parts.limit,
        slip=float(data["interface_slip_size"].max()),
        ledger=float(data.attrs["energy_error"]),
    )


@dataclass(frozen=True)
class _Parts:
    names: tuple[str, ...]
    deformation: FloatArray
    force: FloatArray
    work: FloatArray
    limit: FloatArray
    stiffness: FloatArray


def _links(ops: Any, frame: Frame, built: Built, names: list[str]) -> tuple[Any, ...]:
    # Gaps of OpenSees face the other way.
    tags = [built.links[name] for name in names]
    signs = [-1.0 if isinstance(link.law, Gap | HertzGap) else 1.0 for link in frame.links.values()]
    return tuple(
        [sign * ops.eleResponse(tag, what)[0] for tag, sign in zip(tags, signs, strict=True)]
        for what in ("deformation", "basicForce")
    )


def _hinges(ops: Any, _: Frame, built: Built, names: list[str]) -> tuple[Any, ...]:
    d: list[float] = []
    f: list[float] = []
    for name in names:
        tag, end = built.members[name[:-2]], "ij".index(name[-1])
        d.extend(plastic_rotations(ops, tag)[end])
        f.extend(ops.eleResponse(tag, "localForce")[6 * end + 4 : 6 * end + 6])
    return d, f


def _links_here(data: xr.Dataset, frame: Frame) -> _Parts:
    laws = [link.law for link in frame.links.values()]
    yields = [isinstance(law, Bilinear | BoucWen) for law in laws]
    limit = data["link_yield_deformation"].to_numpy()
    return _Parts(
        tuple(frame.links),
        data["link_deformation"].to_numpy(),
        data["link_force"].to_numpy(),
        data["link_work"].to_numpy()[-1],
        np.where(yields, limit, 1.0),
        np.array(
            [law.stiffness if own else math.inf for law, own in zip(laws, yields, strict=True)]
        ),
    )


def _hinges_here(data: xr.Dataset, names: list[str]) -> _Parts:
    turned, moment = data["hinge_rotation"].to_numpy(), data["hinge_force"].to_numpy()
    count, width = len(turned), 2 * len(names)
    return _Parts(
        tuple(f"{name} {axis}" for name in names for axis in ("My", "Mz")),
        turned[..., 1:].reshape(count, width),
        moment[..., 1:].reshape(count, width),
        data["hinge_work"].to_numpy()[-1],
        np.ones(width),
        np.full(width, math.inf),
    )


def _work(d: FloatArray, f: FloatArray, stiffness: FloatArray, parts: int) -> FloatArray:
    # Work of parts in OpenSees, less what is elastic at the end; that of both moments of a hinge.
    done = (0.5 * (f[1:] + f[:-1]) * np.diff(d, axis=0)).sum(axis=0) - 0.5 * f[-1] ** 2 / stiffness
    return np.asarray(done.reshape(parts, -1).sum(axis=1))
