"""Input of an equivalent-linear analysis: the bearings of a structure, and their loads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias, TypeVar, cast, final

import numpy as np

from frames.design._errors import CheckError
from frames.design.calculation.rendering import quantity
from frames.design.codes.bounds import BoundName, PropertyBounds
from frames.design.codes.pendulum import FrictionPendulum
from frames.frame import Frame
from frames.model.load_combinations import isolator_combinations
from frames.statics.gravity import gravity
from frames.statics.overturning import mass_centre, overturning_share
from lir_element import LIRBearing
from lir_element.argument_checks import require_positive, require_type, require_vector
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY

AVERAGE = "average"
"""Name of the combination of loads under which bearings are stiff and rub as on average."""


@final
@dataclass(frozen=True, kw_only=True, repr=False)
class IsolationSystem:
    """The bearings of a structure and their loads.

    Parameters
    ----------
    bearings : tuple of LIRBearing or FrictionPendulum, (n,)
        Each bearing of the structure; none may be left out.
    positions : tuple of (float, float), (n,)
        Positions in plan, x and y [m].
    loads : tuple of float, (n,)
        Their axial loads, compression positive [N]: those of the average combination.
    plan : (float, float)
        Sides of the structure's plan along x and y, b and d [m].
    weight : float, optional
        Seismic weight W above the isolation interface [N]; the sum of the loads if None.
    eccentricity : (float, float), optional
        Distance of the centre of mass from that of stiffness along x and y [m], without the
        accidental one; from `centre_of_mass` if None.
    centre_of_mass : (float, float), optional
        Centre of mass above the bearings, x and y [m]; that of the loads if None.
    combinations : mapping of str to tuple of float
        Axial loads of the bearings in other combinations of vertical loads, without the
        horizontal earthquake [N].
    unknown_loads : str
        Reason that the loads of single bearings are unknown, although their sum is known: checks
        and tests that need them are then not evaluated. Empty if they are known.
    names : tuple of str, optional
        Names of the bearings; `labels` are "1" to "n" if left out.
    gravity : float
        Acceleration of gravity [m/s2].

    Raises
    ------
    CheckError, ValueError, TypeError
        If numbers are out of bounds, or their counts differ.

    Examples
    --------
    >>> pendulum = FrictionPendulum((2.5,), (0.06,))
    >>> system = IsolationSystem(bearings=(pendulum,) * 4, loads=(375e3,) * 4, plan=(20.0, 20.0),
    ...                          positions=((-9, -9), (9, -9), (9, 9), (-9, 9)))
    >>> system.force(0.30), system.seismic_weight
    (270000.0, 1500000.0)
    """

    bearings: tuple[LIRBearing | FrictionPendulum, ...]
    positions: tuple[tuple[float, float], ...]
    loads: tuple[float, ...]
    plan: tuple[float, float]
    weight: float | None = None
    eccentricity: tuple[float, float] | None = None
    centre_of_mass: tuple[float, float] | None = None
    combinations: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    unknown_loads: str = ""
    names: tuple[str, ...] = ()
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        count = len(self.bearings)
        for name in ("bearings", "positions", "loads", "plan"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        names = self.labels
        groups = {"loads": self.loads, "positions": self.positions, "names": names}
        for name, values in groups.items():
            if len(values) != count or count == 0:
                msg = f"{len(values)} {name} for {count} bearings: give one value for each"
                raise CheckError(msg)
        combinations = {
            key: require_vector(f"loads of combination {key!r} [N]", v, count, error=CheckError)
            for key, v in self.combinations.items()
        }
        found = {key: tuple(v.tolist()) for key, v in combinations.items()}
        object.__setattr__(self, "combinations", found)
        for name, load in zip(names, self.loads, strict=True):
            remedy = "a bearing without load resists no shear; check its gravity loads"
            require_positive(f"load of bearing {name}", load, "N", remedy=remedy, error=CheckError)
        for name, place in zip(names, self.positions, strict=True):
            require_vector(f"position of bearing {name} [m]", place, 2, error=CheckError)
        for side in require_vector("plan [m]", self.plan, 2, error=CheckError):
            remedy = "give plan=(b, d), the sides of the structure in plan"
            require_positive("side of the plan", side, "m", remedy=remedy, error=CheckError)
        for name in ("eccentricity", "centre_of_mass"):
            if getattr(self, name) is not None:
                require_vector(f"{name} [m]", getattr(self, name), 2, error=CheckError)
        if self.weight is not None:
            require_positive("weight", self.weight, "N", error=CheckError)
        require_positive("gravity", self.gravity, "m/s2", error=CheckError)

    @classmethod
    def from_frame(
        cls,
        frame: Frame,
        *,
        s_ms: float | None = None,
        combinations: Mapping[str, Mapping[str, float]] | None = None,
        plan: tuple[float, float] | None = None,
        weight: float | None = None,
        eccentricity: tuple[float, float] | None = None,
    ) -> IsolationSystem:
        """Return the bearings of a frame, loaded as in its equilibrium under permanent loads.

        The centre of mass is that of the frame's masses above the bearings. The model decides if
        their loads are known, by their share of an overturning moment.

        Parameters
        ----------
        frame : Frame
            The model, with its load cases.
        s_ms : float, optional
            S_MS [g]: the combinations are those of `isolator_combinations`, with the vertical
            earthquake 0.2 S_MS D.
        combinations : mapping of str to mapping of str to float, optional
            Factors of the load cases by combination instead, "average" among them. Each costs an
            equilibrium. Without `s_ms` and this there is the average combination of
            `isolator_combinations` alone, and no check of axial loads.
        plan : (float, float), optional
            Sides of the structure's plan [m]; the extent of the frame's nodes if None.
        weight : float, optional
            Seismic weight [N]; that of the bearings in the average combination if None.
        eccentricity : (float, float), optional
            As in `IsolationSystem`.

        Returns
        -------
        IsolationSystem
            Bearings in the frame's order.

        Raises
        ------
        CheckError
            If there is no average combination.
        ModelError
            If there is no equilibrium, or a load case has no factor.
        """
        chosen = combinations
        if chosen is None:
            chosen = isolator_combinations(s_ms or 0.0)
            chosen = chosen if s_ms is not None else {AVERAGE: chosen[AVERAGE]}
        if AVERAGE not in chosen:
            msg = (
                f'combinations {", ".join(chosen)}: add "average", whose loads define the friction'
            )
            raise CheckError(msg)
        states = {name: gravity(frame.combined(factors)) for name, factors in chosen.items()}
        found = {name: tuple(map(float, state.axial_forces)) for name, state in states.items()}
        system = states[AVERAGE].system
        places = np.array([node.position[:2] for node in frame.nodes.values()])
        nodes = [frame.nodes[link.j] for link in frame.bearings.values()]
        sides = np.ptp(places, axis=0) if plan is None else plan
        return cls(
            bearings=tuple(link.bearing for link in frame.bearings.values()),
            positions=tuple((node.x, node.y) for node in nodes),
            loads=found.pop(AVERAGE),
            plan=(float(sides[0]), float(sides[1])),
            weight=weight,
            eccentricity=eccentricity,
            centre_of_mass=mass_centre(system),
            combinations=found,
            unknown_loads=overturning_share(system).sentence(),
            names=tuple(frame.bearings),
            gravity=frame.gravity,
        )

    def __repr__(self) -> str:
        """Return number, weight and radii on one line."""
        radii = sorted({f"{p.effective_radius:.4g}" for p in self.pendulums})
        return (
            f"IsolationSystem: {len(self.bearings)} bearings of effective radius "
            f"{', '.join(radii)} m under {quantity(self.seismic_weight, 'N', 'kN')}"
        )

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the bearings; "1" to "n" if none were given."""
        return tuple(self.names) or tuple(str(k + 1) for k in range(len(self.bearings)))

    @property
    def seismic_weight(self) -> float:
        """W, the seismic weight above the isolation interface [N]."""
        return sum(self.loads) if self.weight is None else self.weight

    @cached_property
    def pendulums(self) -> tuple[FrictionPendulum, ...]:
        """The bearings in design formulas, (n,)."""
        return tuple(map(FrictionPendulum.of, self.bearings))

    @property
    def strength(self) -> float:
        """Force of all bearings at zero displacement, all surfaces sliding [N]."""
        pairs = zip(self.pendulums, self.loads, strict=True)
        return sum(p.effective_friction * load for p, load in pairs)

    def force(self, displacement: float) -> float:
        """Return the lateral force of all bearings at a displacement of all [m], in N."""
        pairs = zip(self.pendulums, self.loads, strict=True)
        return sum(p.force(displacement, load) for p, load in pairs)

    def loop_energy(self, displacement: float) -> float:
        """Return the energy that a cycle of all bearings dissipates [J]."""
        pairs = zip(self.pendulums, self.loads, strict=True)
        return sum(p.loop_energy(displacement, load) for p, load in pairs)


class Extremes(NamedTuple):
    """A system with its nominal and with its upper properties, for minima of forces.

    Attributes
    ----------
    nominal, upper : IsolationSystem
        The system.
    """

    nominal: IsolationSystem
    upper: IsolationSystem


Boundable: TypeAlias = LIRBearing | FrictionPendulum | IsolationSystem | Frame
Bounded = TypeVar("Bounded", bound=Boundable)
Device = TypeVar("Device", bound=LIRBearing)
Pendulum = TypeVar("Pendulum", bound=FrictionPendulum)


def with_property_bounds(
    what: Bounded,
    bound: BoundName,
    bounds: PropertyBounds,
    *,
    interface: BoundName | None = None,
) -> Bounded:
    """Return a bearing, a frame or an isolation system with friction at a bound.

    Parameters
    ----------
    what : LIRBearing, FrictionPendulum, Frame or IsolationSystem
        Object with nominal friction; all bearings of a frame or system are changed.
    bound : {"lower", "nominal", "upper"}
        The bound.
    bounds : PropertyBounds
        The factors.
    interface : {"lower", "nominal", "upper"}, optional
        Bound of the interface friction, if it differs from that of the surfaces.

    Returns
    -------
    LIRBearing, FrictionPendulum, Frame or IsolationSystem
        A copy; a frame's name gets the bound.

    Raises
    ------
    CheckError
        If a word is no bound, or a bearing cannot be at it: friction of 1 and more, an interface
        that slides before the surfaces do.

    Examples
    --------
    >>> from frames.design import PropertyModificationFactors
    >>> from lir_element import CoulombFriction
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.05), interface_friction=0.15)
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.6, 1.8))
    >>> upper = with_property_bounds(bearing, "upper", bounds)
    >>> round(upper.frictions[0].f_max, 4), round(upper.interface_friction, 4)
    (0.09, 0.27)
    """
    require_type("bounds", bounds, PropertyBounds, "PropertyBounds")
    factor = bounds.friction.at(bound)
    inner = bounds.interface_factors.at(bound if interface is None else interface)
    try:
        return cast("Bounded", _with_factors(what, factor, inner, bound))
    except ValueError as cause:
        msg = (
            f"at the {bound} bound, friction times {factor:g} and interface friction times "
            f"{inner:g}: {cause}; or give narrower factors (`bounds`)"
        )
        raise CheckError(msg) from cause


def _with_factors(what: Boundable, factor: float, inner: float, bound: str) -> Boundable:
    if isinstance(what, LIRBearing):
        return _bearing(what, factor, inner)
    if isinstance(what, FrictionPendulum):
        return _pendulum(what, factor)
    if isinstance(what, IsolationSystem):
        found = (
            _bearing(b, factor, inner) if isinstance(b, LIRBearing) else _pendulum(b, factor)
            for b in what.bearings
        )
        return replace(what, bearings=tuple(found))
    require_type("what", what, Frame, "an LIRBearing, a Frame or an IsolationSystem")
    links = what.bearings.items()
    devices = {name: _bearing(link.bearing, factor, inner) for name, link in links}
    return what.with_bearings(devices, worded("{name}, {bound} bound", name=what.name, bound=bound))


def _bearing(bearing: Device, factor: float, inner: float) -> Device:
    bottom, top = bearing.frictions
    laws = (bottom.scaled(factor), top.scaled(factor))
    return replace(bearing, friction=laws, interface_friction=inner * bearing.interface_friction)


def _pendulum(pendulum: Pendulum, factor: float) -> Pendulum:
    return replace(pendulum, frictions=tuple(factor * mu for mu in pendulum.frictions))
