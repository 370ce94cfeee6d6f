"""How far the bearing and elements of OpenSees lie apart, as one cause after the other is left out.

A mass on one bearing under a recorded motion, in both programs. Large displacements are left out by
similarity: motion in plan, friction and yield displacement times a small factor, rate of friction
over it, and a linear pendulum would answer the same times that factor.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeAlias, TypeVar

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, Features, LIRBearing, VelocityFriction
from lir_element.opensees import builtin_element
from lir_element.units import STANDARD_GRAVITY
from validation.opensees.runs import Track, lumped
from validation.scenes import EXAMPLE_MASS, example_bearing

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from lir_element.opensees.compare.builtin_writing import BuiltinKind

Gap: TypeAlias = dict[str, float]
"""Differences of OpenSees from the bearing by what they are differences of, as shares.

Of a mass: its largest displacement, the largest force, the dissipated energy, and the path: the
largest distance of the displacements in plan at any time, over the peak.
"""

LOAD = EXAMPLE_MASS * STANDARD_GRAVITY
STEP = 0.005  # s
TENTH = 0.1  # of all displacements, where they are small
FINE_SLIP = 0.01e-3  # m, elastic sliding where it is left out
F_MAX, F_MIN, RATE, SLIP = 0.065, 0.0325, 15.0, 0.25e-3  # of the paper's example, and the default


class Chosen(Protocol):
    """A setting: a frozen dataclass that names the element."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def kind(self) -> BuiltinKind:
        """The element of OpenSees."""


S = TypeVar("S", bound=Chosen)


@dataclass(frozen=True)
class Setting:
    """What is run: which element, and what is modelled."""

    kind: BuiltinKind
    """Element of OpenSees."""
    unmapped: tuple[str, ...] = ()
    """What it is given as it stands for the bearing: of "friction", "rate", "yield"."""
    speed: bool = True
    """Whether friction depends on speed."""
    coupled: bool = True
    """Whether axial force and lateral motion are coupled in our bearing."""
    scale: float = 1.0
    """Factor of similarity [-]."""
    slip: float = SLIP
    """Yield displacement on a surface [m]."""
    dt: float = STEP
    their_dt: float = STEP
    """Step here, and in OpenSees [s]."""
    level: bool = False
    plane: bool = False
    """Whether the vertical motion, and the motion along y are left out."""
    lift: bool = False
    """Whether the element of OpenSees lifts the mass as it moves."""


@dataclass(frozen=True)
class Row:
    """One cause: how it is left out, and the differences before and after."""

    kind: str
    cause: str
    how: str
    before: Gap
    after: Gap


Rung = tuple[str, str, dict[str, Any]]
"""A cause, how it is left out, and the changes of a setting that do so."""

VERTICAL: Rung = (
    "vertical coupling: the bearing rises as it moves, which changes its axial force",
    "here: `Features(vertical_coupling=False)`",
    {"coupled": False},
)
LIFT: Rung = (VERTICAL[0], "there: the option `-inclVertdisp` (`lift=True`)", {"lift": True})
LARGE: Rung = (
    "large displacements: sphere, its inclined normal force",
    "both: motion and friction times 0.1",
    {"scale": TENTH},
)
ELASTIC: Rung = (
    "elastic sliding: a constant stiffness there, a constant displacement here, while friction "
    "changes with speed",
    "both: `yield_displacement` 0.01 mm",
    {"slip": FINE_SLIP},
)
FRICTION: Rung = (
    "moment equilibrium of the rigid slider",
    "there: μ (R1 + R2)/L in place of μ",
    {"unmapped": ("rate", "yield")},
)
SPEED: Rung = ("measure of speed", "there: rate α R/L in place of α", {"unmapped": ("yield",)})
YIELD: Rung = (
    "yield displacement over the bearing",
    "there: u_y L/R in place of u_y",
    {"unmapped": ()},
)


def bearing_of(setting: Setting) -> LIRBearing:
    """Return the bearing of the paper's numerical example, plain and without rims."""
    friction: CoulombFriction | VelocityFriction = CoulombFriction(setting.scale * F_MAX)
    if setting.speed:
        friction = VelocityFriction(
            f_max=setting.scale * F_MAX, f_min=setting.scale * F_MIN, rate=RATE / setting.scale
        )
    return example_bearing(
        friction=friction, yield_displacement=setting.scale * setting.slip, design_load=LOAD
    ).as_dcfp(rims=False)


def given_as_printed(bearing: LIRBearing, what: Sequence[str]) -> LIRBearing:
    """Return the bearing whose mapping hands an element the numbers of another one unmapped."""
    radius, length = bearing.radii[0], bearing.effective_radius
    law: Any = bearing.frictions[0]
    factor = length / (2.0 * radius) if "friction" in what else 1.0
    rate = law.rate * (length / radius if "rate" in what else 1.0)
    slip = bearing.yield_displacement * (radius / length if "yield" in what else 1.0)
    if isinstance(law, VelocityFriction):
        changed = VelocityFriction(f_max=factor * law.f_max, f_min=factor * law.f_min, rate=rate)
        return replace(bearing, friction=changed, yield_displacement=slip)
    return replace(bearing, friction=CoulombFriction(factor * law.f_max), yield_displacement=slip)


def motion_of(setting: Setting, record: GroundMotion) -> GroundMotion:
    """Return the motion, in plan times the factor of similarity."""
    factor = setting.scale
    return record.scaled((factor, 0.0 if setting.plane else factor, 0.0 if setting.level else 1.0))


def here(setting: Setting, record: GroundMotion) -> Track:
    """Run a setting with the bearing of this package."""
    features = Features(vertical_coupling=setting.coupled)
    data = time_history(
        lumped_mass(bearing_of(setting), EXAMPLE_MASS),
        motion_of(setting, record),
        dt=setting.dt,
        features=features,
    )
    moved, force = (
        data[name].isel(bearing=0).to_numpy() for name in ("bearing_displacement", "bearing_force")
    )
    return Track(data["time"].to_numpy(), moved, force, float(data.attrs["seconds_loop"]), 0)


def there(setting: Setting, record: GroundMotion) -> Track:
    """Run a setting with its element of OpenSees."""
    bearing = given_as_printed(bearing_of(setting), setting.unmapped)

    def place(tag: int, i: int, j: int) -> None:
        builtin_element(setting.kind, tag, i, j, bearing, LOAD, lift=setting.lift)

    motion = motion_of(setting, record)
    return lumped(place, bearing.height, EXAMPLE_MASS, motion, setting.their_dt)


def gap(ours: Track, theirs: Track) -> Gap:
    """Return how far a run of OpenSees lies from one of this package, in plan."""
    times = ours.time[ours.time <= theirs.time[-1] + 1e-9]
    other = np.column_stack(
        [np.interp(times, theirs.time, theirs.displacement[:, k]) for k in (0, 1)]
    )
    away = np.hypot(*(ours.displacement[: len(times), :2] - other).T).max()
    peak, force = (
        [float(np.hypot(*getattr(track, name)[:, :2].T).max()) for track in (ours, theirs)]
        for name in ("displacement", "force")
    )
    energy = [
        sum(float(np.trapezoid(track.force[:, k], track.displacement[:, k])) for k in (0, 1))
        for track in (ours, theirs)
    ]
    return {
        "peak": peak[1] / peak[0] - 1.0,
        "force": force[1] / force[0] - 1.0,
        "energy": energy[1] / energy[0] - 1.0,
        "path": float(away) / peak[0],
    }


def apart(setting: Setting, record: GroundMotion) -> Gap:
    """Run a setting in both programs and return the differences."""
    return gap(here(setting, record), there(setting, record))


def largest(differences: Gap) -> float:
    """Return the largest difference in size."""
    return max(abs(value) for value in differences.values())


def ladder(first: S, rungs: Sequence[Rung], differences: Callable[[S], Gap]) -> list[Row]:
    """Leave out one cause after the other."""
    rows, setting, before = [], first, differences(first)
    for cause, how, changes in rungs:
        setting = replace(setting, **changes)
        after = differences(setting)
        rows.append(Row(first.kind, cause, how, before, after))
        before = after
    return rows


def percent(before: float, after: float) -> str:
    """Return two shares as "before → after" in per cent."""
    return f"{100.0 * before:+z.2f} → {100.0 * after:+z.2f}"
