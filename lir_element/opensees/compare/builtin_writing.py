"""Commands of OpenSees' elements, from the equivalent properties of a plain bearing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, get_args

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing
    from lir_element.opensees.compare.builtin_mapping import BuiltinValues

BuiltinKind = Literal["singleFPBearing", "FPBearingPTV", "TripleFrictionPendulum", "TFP"]
Command = tuple[Any, ...]

BUILTIN_KINDS: tuple[BuiltinKind, ...] = get_args(BuiltinKind)
"""The elements of OpenSees that a plain bearing can be written as."""

_CONSTANT = {
    "TripleFrictionPendulum": (
        "TripleFrictionPendulum does not converge with friction that depends on velocity"
    ),
    "TFP": "TFP has constant friction",
}
_WITH_RIMS = ("TripleFrictionPendulum",)
_SAME = 1e-9  # relative difference up to which two numbers count as equal
_ITERATIONS = 50  # of the shear force inside an element
_FORCE_TOLERANCE = 1e-9  # of these, over the axial load
_INNER_SHARE = 0.2  # of the smaller outer length: the inner slider of a triple bearing
_LOCKED = 10.0  # friction coefficient that holds an inner slider
_FAR = 2.0  # times the effective radius: no rim is reached
_TENSION = 1e-6  # share of the axial stiffness that a lifted TripleFrictionPendulum keeps
_LEAST_LOAD = 1e-3  # share of the axial load that it keeps for its lateral force
_SAME_SUM = 1e-5  # of an increment: how far its three parts may miss it


def refuse(kind: str, bearing: LIRBearing, values: BuiltinValues, *, lift: bool) -> None:
    """Raise a ValueError if an element cannot represent a bearing."""
    capacity, varies = bearing.lateral_capacity, values.friction_max > values.friction_min
    if kind not in _WITH_RIMS and math.isfinite(capacity):
        msg = (
            f"capacity = {capacity:g} m: {kind} does not model rims; use "
            f"bearing.as_dcfp(rims=False), or choose {_WITH_RIMS[0]}"
        )
        raise ValueError(msg)
    if lift and kind != "singleFPBearing":
        msg = f'lift = True: {kind} cannot lift: choose "singleFPBearing", or lift=False'
        raise ValueError(msg)
    if kind in _CONSTANT and varies:
        msg = (
            f"friction between {values.friction_min:.4g} and {values.friction_max:.4g}: "
            f"{_CONSTANT[kind]}; use CoulombFriction, or choose another element"
        )
        raise ValueError(msg)
    half = 0.5 * values.friction_max
    if kind == "FPBearingPTV" and varies and abs(values.friction_min - half) > _SAME * half:
        msg = (
            f"f_min / f_max = {values.friction_min / values.friction_max:.4g}: FPBearingPTV "
            "always uses 0.5; set f_min = f_max / 2, use CoulombFriction, or choose another "
            "element"
        )
        raise ValueError(msg)
    limit = 0.1 * values.friction_max * values.length
    if values.yield_displacement > limit:
        msg = (
            f"yield displacement over the bearing {values.yield_displacement:.4g} m must be below "
            f"{limit:.4g} m (a tenth of strength over post-sliding stiffness): reduce "
            "yield_displacement"
        )
        raise ValueError(msg)


def materials(values: BuiltinValues, start: int) -> tuple[Command, ...]:
    """Return vertical, torsion and rocking; torsion yields at the torque of the sliding contact."""
    torsion: Command = ("uniaxialMaterial", "Elastic", start + 1, 0.0)
    if values.torque > 0.0:
        stiffness = values.torque / values.torsion_yield
        torsion = ("uniaxialMaterial", "ElasticPP", start + 1, stiffness, values.torsion_yield)
    return (
        ("uniaxialMaterial", "Elastic", start, values.axial_stiffness, values.axial_damping),
        torsion,
        ("uniaxialMaterial", "Elastic", start + 2, 0.0),
    )


def friction_law(tag: int, low: float, high: float, rate: float) -> Command:
    """Return the friction model: constant, or from `low` to `high` with the speed."""
    if low == high:
        return ("frictionModel", "Coulomb", tag, high)
    return ("frictionModel", "VelDependent", tag, low, high, rate)


def single(
    head: tuple[int, int, int],
    values: BuiltinValues,
    load: float,
    tags: tuple[int, ...],
    *,
    lift: bool,
    apart: bool,
) -> Command:
    """Return the command of "singleFPBearing"."""
    axial, torsion, rocking, _ = tags
    orientation = (1, 0, 0) if apart else (0, 0, 1, 1, 0, 0)  # local y; or x and y
    return (
        "element",
        "singleFPBearing",
        *head,
        axial + 3,
        values.length,
        values.initial_stiffness,
        "-P",
        axial,
        "-T",
        torsion,
        "-My",
        rocking,
        "-Mz",
        rocking,
        "-shearDist",
        0.5,
        *(("-inclVertdisp",) if lift else ()),
        "-iter",
        _ITERATIONS,
        _FORCE_TOLERANCE * load,
        "-orient",
        *orientation,  # last, because it consumes the word after a single vector
    )


def ptv(
    head: tuple[int, int, int],
    bearing: LIRBearing,
    values: BuiltinValues,
    load: float,
    tags: tuple[int, ...],
) -> Command:
    """Return the command of "FPBearingPTV"."""
    speed = int(values.friction_max > values.friction_min)
    pressure = load / (math.pi * bearing.slider_radius**2)
    steel = (4.4e-6, 18.0)  # thermal diffusivity [m2/s] and conductivity [W/(m K)]: not used
    return (
        "element",
        "FPBearingPTV",
        *head,
        values.friction_max,
        0,
        pressure,
        0,
        *steel,
        speed,
        values.rate,
        values.length,
        bearing.slider_radius,
        values.initial_stiffness,
        *tags,
        0,
        0,
        1,
        1,
        0,
        0,
        0.5,
        0,
        0.0,
        _ITERATIONS,
        _FORCE_TOLERANCE * load,
        1,
    )


def triple(
    head: tuple[int, int, int],
    bearing: LIRBearing,
    values: BuiltinValues,
    load: float,
    start: int,
) -> tuple[Command, ...]:
    """Return the commands of "TripleFrictionPendulum": friction model and element."""
    length, (first, second) = values.length, bearing.radii
    outer = tuple(length * r / (first + second) for r in (first, second))
    lengths = (_INNER_SHARE * min(outer), *outer)
    reach = min(bearing.lateral_capacity, _FAR * length)
    rims = (0.0, *(reach * part / length for part in outer))
    mu = values.friction_max + values.yield_displacement / length
    element = (
        "element",
        "TripleFrictionPendulum",
        *head,
        start + 3,
        start + 3,
        start + 3,
        start,
        start + 1,
        start + 2,
        start + 2,
        *lengths,
        *rims,
        load,
        values.yield_displacement,
        _TENSION * values.axial_stiffness,
        _LEAST_LOAD * load,
        _SAME_SUM,
    )
    return (friction_law(start + 3, mu, mu, 0.0), element)


def tfp(
    head: tuple[int, int, int], bearing: LIRBearing, values: BuiltinValues, load: float
) -> Command:
    """Return the command of "TFP"."""
    half = 0.5 * bearing.slider_height
    arms = [r - half for r in bearing.radii]
    frictions = [
        law.f_min * r / arm
        for law, r, arm in zip(bearing.frictions, bearing.radii, arms, strict=True)
    ]
    far = [2.0 * _FAR * values.length] * 4  # diameters
    return (
        "element",
        "TFP",
        *head,
        *arms,
        *bearing.radii,
        *far,
        0.0,
        0.0,
        0.0,
        0.0,
        _LOCKED,
        _LOCKED,
        *frictions,
        0.0,
        0.0,
        half,
        half,
        bearing.height,
        load,
        0.5 * values.yield_displacement,
        values.axial_stiffness,
    )
