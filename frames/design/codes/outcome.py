"""Results of an equivalent-linear analysis: at each bound, and over all bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Checks
from frames.design.calculation.rendering import quantity
from frames.design.calculation.trace import Trace
from lir_element.texts import html_table, text_table

if TYPE_CHECKING:
    import pandas as pd


class Symbols(NamedTuple):
    """Symbols of a code for the results of its equivalent-linear analysis."""

    displacement: str  # at the centre
    total: str  # the largest of a bearing, with torsion
    stiffness: str  # effective ones
    damping: str
    period: str
    factor: str  # damping factor
    base_shear: str  # shear of the isolation system
    shear: str  # design shear above it
    # displacement capacity that bearings need, if it is more than the total one
    allowed: str = ""


class Iteration(NamedTuple):
    """A round of the search for the displacement."""

    assumed: float  # displacement that stiffness and damping are of [m]
    stiffness: float  # effective stiffness [N/m]
    damping: float  # effective damping ratio [-]
    period: float  # effective period [s]
    found: float  # displacement that these give [m]


@dataclass(frozen=True, eq=False, repr=False)
class BoundResult:
    """The equivalent-linear analysis at one bound of the bearings' properties."""

    bound: Bound
    trace: Trace  # the whole calculation, by the code's symbols
    symbols: Symbols  # how the code calls displacement, stiffness and so on
    iterations: tuple[Iteration, ...]  # how the displacement was found
    displacements: tuple[float, ...]  # the largest of each bearing, torsion included [m]
    # at the base level and at each floor above, for design [N]; empty without superstructure
    storey_forces: tuple[float, ...]
    checks: Checks

    @property
    def displacement(self) -> float:
        """Displacement at the centre [m]."""
        return self.trace.value(self.symbols.displacement)

    @property
    def total_displacement(self) -> float:
        """Largest displacement of a bearing, torsion included [m]."""
        return self.trace.value(self.symbols.total)

    @property
    def allowed_displacement(self) -> float:
        """Largest displacement that a bearing must allow, with the code's factor on it [m]."""
        return self.trace.value(self.symbols.allowed or self.symbols.total)

    @property
    def stiffness(self) -> float:
        """Effective stiffness [N/m]."""
        return self.trace.value(self.symbols.stiffness)

    @property
    def damping(self) -> float:
        """Effective damping ratio [-]."""
        return self.trace.value(self.symbols.damping)

    @property
    def period(self) -> float:
        """Effective period [s]."""
        return self.trace.value(self.symbols.period)

    @property
    def damping_factor(self) -> float:
        """Damping factor of the code [-]."""
        return self.trace.value(self.symbols.factor)

    @property
    def base_shear(self) -> float:
        """Shear of the isolation system [N]."""
        return self.trace.value(self.symbols.base_shear)

    @property
    def superstructure_shear(self) -> float | None:
        """Design shear above the isolation system [N]; None without superstructure."""
        name = self.symbols.shear
        return self.trace.value(name) if name in self.trace else None

    def __repr__(self) -> str:
        """Return the main numbers on one line."""
        allowed = ""
        if self.symbols.allowed:
            allowed = f", bearings must allow {1e3 * self.allowed_displacement:.0f} mm"
        return (
            f"{self.bound}: displacement {1e3 * self.displacement:.0f} mm, with torsion "
            f"{1e3 * self.total_displacement:.0f} mm{allowed}; period {self.period:.2f} s, damping "
            f"{100.0 * self.damping:.1f} %, base shear {1e-3 * self.base_shear:.0f} kN"
        )


_COLUMNS = (
    ("displacement", "m", "mm"),
    ("total_displacement", "m", "mm"),
    ("allowed_displacement", "m", "mm"),
    ("period", "s", "s"),
    ("damping", "-", "%"),
    ("damping_factor", "-", "-"),
    ("stiffness", "N/m", "kN/m"),
    ("base_shear", "N", "kN"),
    ("superstructure_shear", "N", "kN"),
)


@dataclass(frozen=True, eq=False, repr=False)
class EquivalentLinear:
    """Results of an equivalent-linear analysis at all bounds.

    Attributes
    ----------
    code : str
        Standard.
    bounds : mapping of str to BoundResult
        Results at "lower" and "upper" bound, or at "nominal" alone.
    general : Checks
        Checks that both bounds enter.

    Examples
    --------
    >>> from frames.design import IsolationSystem, PropertyBounds
    >>> from frames.design import PropertyModificationFactors, Spectrum, equivalent_linear
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> target = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
    >>> linear = equivalent_linear(system, target, bounds=bounds)
    >>> round(linear["lower"].period, 2), round(linear["upper"].period, 2)
    (2.63, 2.25)
    >>> linear.checks.passed
    True
    """

    code: str
    bounds: Mapping[str, BoundResult]
    general: Checks

    @property
    def checks(self) -> Checks:
        """All checks."""
        return Checks([*(c for each in self.bounds.values() for c in each.checks), *self.general])

    @property
    def displacement(self) -> float:
        """Largest displacement at the centre [m]."""
        return max(each.displacement for each in self.bounds.values())

    @property
    def total_displacement(self) -> float:
        """Largest displacement of a bearing, torsion included [m]."""
        return max(each.total_displacement for each in self.bounds.values())

    @property
    def allowed_displacement(self) -> float:
        """Largest displacement that a bearing must allow, with the code's factor on it [m]."""
        return max(each.allowed_displacement for each in self.bounds.values())

    @property
    def base_shear(self) -> float:
        """Largest shear of the isolation system [N]."""
        return max(each.base_shear for each in self.bounds.values())

    @property
    def superstructure_shear(self) -> float | None:
        """Largest design shear above the isolation system [N]; None without superstructure."""
        found = [each.superstructure_shear for each in self.bounds.values()]
        return max((v for v in found if v is not None), default=None)

    def __getitem__(self, bound: str) -> BoundResult:
        """Return the result at a bound."""
        if bound not in self.bounds:
            msg = f"no bound {bound!r}: choose one of {tuple(self.bounds)}"
            raise CheckError(msg)
        return self.bounds[bound]

    @property
    def _columns(self) -> list[tuple[str, str, str]]:
        # The needed displacement capacity is beside the total displacement if it is more.
        more = any(each.symbols.allowed for each in self.bounds.values())
        return [column for column in _COLUMNS if more or column[0] != "allowed_displacement"]

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each bound, numbers in SI units."""
        import pandas as pd

        rows = {
            name: [getattr(each, column) for column, *_ in self._columns]
            for name, each in self.bounds.items()
        }
        columns = [f"{name} [{unit}]" for name, unit, _ in self._columns]
        return pd.DataFrame.from_dict(rows, orient="index", columns=columns)

    def __str__(self) -> str:
        """Return results and checks as tables."""
        return f"{text_table(self.rows(), self.head())}\n\n{self.checks}"

    def __repr__(self) -> str:
        """Return the main numbers of each bound."""
        return "\n".join([f"{self.code}, equivalent-linear", *map(repr, self.bounds.values())])

    def _repr_html_(self) -> str:
        table = html_table(f"{self.code}, equivalent-linear", self.rows(), self.head())
        return table + self.checks._repr_html_()

    def head(self) -> tuple[str, ...]:
        """Return the titles of `rows`, with units: mm, kN, per cent."""
        return ("bound", *(f"{name.replace('_', ' ')} [{u}]" for name, _, u in self._columns))

    def rows(self) -> list[tuple[str, ...]]:
        """Return a row for each bound as text, for tables."""
        return [
            (
                name,
                *(
                    ""
                    if (value := getattr(each, column)) is None
                    else quantity(value, unit, shown, units=False)
                    for column, unit, shown in self._columns
                ),
            )
            for name, each in self.bounds.items()
        ]
