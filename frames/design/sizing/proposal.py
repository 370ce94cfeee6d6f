"""LIR-DCFP bearings proposed for a structure, beside plain ones of equal performance."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, TypeVar

from frames.design._errors import CheckError
from frames.design.codes.analysis import equivalent_linear
from frames.design.codes.isolation import IsolationSystem
from frames.design.hazard.spectrum import Spectrum
from frames.design.sizing.candidate import Candidate, grouped
from frames.design.sizing.fitting import Asked, fitted
from frames.design.sizing.selection import (
    OBJECTIVES,
    Impossible,
    NoCandidateError,
    Objective,
    pareto,
    ranked,
    table_of,
)
from frames.design.sizing.target import DesignTarget
from frames.frame import Frame
from lir_element import DesignWarning
from lir_element.argument_checks import require_choice, require_type
from lir_element.texts import html_table, text_table

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd

    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.codes.registry import AnalysisMethod
    from frames.design.codes.superstructure import Superstructure
    from lir_element import LIRBearing
    from lir_element.device.friction import FrictionLaw

F = TypeVar("F", bound=Frame)
Device = Literal["LIR-DCFP", "DCFP", "DCFP without rim contact"]
DEVICES: tuple[Device, ...] = ("LIR-DCFP", "DCFP", "DCFP without rim contact")

_OF_SLIDERS = {
    "slider radius [m]": "slider_radius",
    "slider height [m]": "slider_height",
    "capacity [m]": "lateral_capacity",
    "interface friction [-]": "interface_friction",
}
"""Numbers of a device in a table, by the name of the bearing's."""


@dataclass(frozen=True, eq=False, repr=False)
class Design:
    """Bearings proposed for a structure.

    Attributes
    ----------
    system : IsolationSystem
        The structure as it was given.
    chosen : Candidate
        Radius, friction, bearings by size, their analysis without rims, checks and calculation.
    candidates : tuple of Candidate
        All that were tried.
    least : str
        Minimised quantity.
    impossible : tuple of Impossible
        Pairs of radius and friction of which no bearing can be made, and why.
    fit : callable
        Fits a bearing to radius, friction and demands (`Asked`), in the same way as the candidates.

    Examples
    --------
    >>> from frames.design import DesignTarget, IsolationSystem, Spectrum, design
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> target = DesignTarget(radii=(1.5, 2.0), frictions=(0.05, 0.06), rim_share=0.8)
    >>> found = design(system, Spectrum.asce7(s_ms=1.2, s_m1=0.6), bounds=None, target=target)
    >>> len(found.candidates), found.sizes
    (4, (0, 0, 0, 0))
    """

    system: IsolationSystem
    chosen: Candidate
    candidates: tuple[Candidate, ...]
    least: Objective = "base shear"
    impossible: tuple[Impossible, ...] = ()
    fit: Callable[[float, FrictionLaw, Asked], Candidate] = field(kw_only=True)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Index of the chosen bearing at each place, (n_bearings,)."""
        return self.chosen.places

    @property
    def pareto(self) -> tuple[Candidate, ...]:
        """Pareto-optimal candidates in displacement, base shear and plate diameter."""
        return pareto(self.candidates)

    @property
    def ranked(self) -> tuple[Candidate, ...]:
        """Candidates that meet the target, best first: without warnings, then by `least`."""
        return ranked(self.candidates, self.least)

    def bearings(self, device: Device = "LIR-DCFP") -> tuple[LIRBearing, ...]:
        """Return the bearing at each place.

        Parameters
        ----------
        device : str
            "LIR-DCFP"; "DCFP": the same plates and rims with the rigid slider; "DCFP without rim
            contact": that with plates so large that there is no rim contact.

        Returns
        -------
        tuple of LIRBearing, (n_bearings,)
            The bearings in the order of the system.

        Raises
        ------
        CheckError
            If plates that large cannot be made with sliders of this height: they would overlap.
        """
        require_choice("device", device, DEVICES, error=CheckError)
        made = self.chosen.bearings
        if device != "LIR-DCFP":
            made = tuple(bearing.as_dcfp() for bearing in made)
        if device == "DCFP without rim contact":
            t = self.chosen.trace
            free = max(t.value("D"), t.value("U_cap"))
            try:
                made = tuple(replace(one, capacity=free) for one in made)
            except ValueError as cause:
                msg = f"the {device} of {1e3 * free:.0f} mm cannot be made: {cause}"
                raise CheckError(msg) from cause
        return tuple(made[size] for size in self.sizes)

    def isolated(self, frame: F, device: Device = "LIR-DCFP") -> F:
        """Return a frame on the proposed bearings, its name with that of the device.

        Parameters
        ----------
        frame : Frame
            The structure, whose bearings are in the order of the system.
        device : str
            One of `bearings`.

        Returns
        -------
        Frame
            A copy.

        Raises
        ------
        CheckError
            If it has another number of bearings.
        """
        made = self.bearings(device)
        if len(frame.bearings) != len(made):
            msg = f"the frame has {len(frame.bearings)} bearings, the design {len(made)}"
            raise CheckError(msg)
        by_name = dict(zip(frame.bearings, made, strict=True))
        return frame.with_bearings(by_name, f"{frame.name}, {device}")

    def proposing(self, tried: Candidate, sized: Candidate) -> Design:
        """Return the same design with a candidate sized further, and proposed.

        Parameters
        ----------
        tried : Candidate
            One of `candidates`.
        sized : Candidate
            Its replacement.

        Returns
        -------
        Design
            A copy.
        """
        every = tuple(sized if one is tried else one for one in self.candidates)
        return replace(self, chosen=sized, candidates=every)

    def table(self) -> pd.DataFrame:
        """Return the three devices side by side, numbers in SI units.

        Returns
        -------
        pandas.DataFrame
            A row for each; NaN if a device cannot be made: `bearings` has the reason.
        """
        import pandas as pd

        t, rows = self.chosen.trace, {}
        for device in DEVICES:
            free = device == "DCFP without rim contact"
            rows[device] = {
                "radius [m]": self.chosen.radius,
                "friction [-]": self.chosen.friction.f_max,
                **dict.fromkeys(_OF_SLIDERS, math.nan),
                "plan diameter [m]": t.value("d_plan_free" if free else "d_plan"),
            }
            if not self._refused(device):
                largest = max(self.bearings(device), key=lambda one: one.slider_radius)
                rows[device] |= {key: getattr(largest, name) for key, name in _OF_SLIDERS.items()}
        return pd.DataFrame.from_dict(rows, orient="index")

    def _refused(self, device: Device) -> str:
        # Reason that a device cannot be made; empty if it can.
        try:
            self.bearings(device)
        except CheckError as cause:
            return str(cause)
        return ""

    def to_dataframe(self) -> pd.DataFrame:
        """Return all candidates, a row for each, numbers in SI units.

        Returns
        -------
        pandas.DataFrame
            Outcome ("proposed", "Pareto-optimal", "meets the target" or "rejected"), Pareto
            optimality in displacement, base shear and plate diameter, its numbers, the governing
            limit, unmet requirements, and warnings.
        """
        return table_of(self.candidates, self.chosen, self.impossible)

    def __repr__(self) -> str:
        """Return the proposal on one line."""
        t = self.chosen.trace
        return (
            f"{len(self.sizes)} LIR-DCFP: radius {self.chosen.radius:g} m, friction "
            f"{self.chosen.friction.f_max:g}, rims at {1e3 * t.value('U_cap'):.0f} mm of "
            f"{1e3 * t.value('D'):.0f} mm, interface friction {t.value('mu_h'):g}, plates "
            f"{1e3 * t.value('d_plan'):.0f} mm"
        )

    def __str__(self) -> str:
        """Return devices, calculation and checks."""
        head, rows = self._cells()
        beyond = self.chosen.beyond_procedure
        note = f"\n\nNeeds a time history: {'; '.join(beyond)}." if beyond else ""
        note += "".join(f"\n\n{why}" for why in map(self._refused, DEVICES) if why)
        calculation = "\n".join(step.text() for step in self.chosen.trace)
        return f"{text_table(rows, head)}\n\n{calculation}\n\n{self.chosen.checks}{note}"

    def _repr_html_(self) -> str:
        head, rows = self._cells()
        return html_table(repr(self), rows, head) + self.chosen.checks._repr_html_()

    def _cells(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        table = self.table().T
        rows = [
            (str(name), *("-" if math.isnan(value) else f"{value:.4g}" for value in row))
            for name, *row in table.itertuples()
        ]
        return ("", *map(str, table.columns)), rows


def design(
    structure: Frame | IsolationSystem,
    spectrum: Spectrum,
    *,
    bounds: PropertyBounds | None,
    target: DesignTarget | None = None,
    superstructure: Superstructure | None = None,
    code: AnalysisMethod | str | None = None,
    sizes: int = 1,
    least: Objective = "base shear",
) -> Design:
    """Propose LIR-DCFP bearings for a structure, by equivalent-linear analysis.

    Each radius and friction of the target is tried. The displacement without rims is that of the
    lower bound of friction, by EN 1998 times gamma_x. Rims are at a share of it, or beyond it if
    the code has no rule for rim contact. The interface gets the friction that holds until then and
    stays stable over the rest, or over a reserve. Of the candidates that meet the target, the
    result is the one with the least base shear, or the least of `least`; those with usual liner
    pressures come first.

    Parameters
    ----------
    structure : Frame or IsolationSystem
        Places and loads of the bearings; those it has now are replaced. Of a frame loads are those
        of `IsolationSystem.from_frame`, with S_MS of the spectrum if it has one.
    spectrum : Spectrum
        As in `equivalent_linear`.
    bounds : PropertyBounds or None
        Lower and upper bound friction properties.
    target : DesignTarget, optional
        Choices and requirements.
    superstructure, code
        As in `equivalent_linear`; checks of the superstructure then count as well.
    sizes : int
        Number of sliders of different radius, for bearings of different loads.
    least : {"base shear", "displacement", "plan diameter", "bearing volume", "cost"}
        Minimised quantity: the largest base shear, the needed displacement capacity, the diameter
        of the plates, the volume of all bearings, or their cost by `DesignTarget.prices`.

    Returns
    -------
    Design
        The proposal, as a starting point: rim contact needs time histories.

    Raises
    ------
    NoCandidateError
        If no candidate meets the target: the message names the nearest and its unmet requirements,
        its `candidates` are all that were tried. It is a CheckError.
    CheckError
        If an argument is out of bounds.

    Warns
    -----
    DesignWarning
        If even the best has sliders under less than the target's `least_pressure`.

    Notes
    -----
    Loads are those of the combinations without overturning; `history_checks` has the others.

    Examples
    --------
    >>> from frames.design import DesignTarget, IsolationSystem, Spectrum, design
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> target = DesignTarget(radii=(1.5, 2.0), frictions=(0.05, 0.06), rim_share=0.8)
    >>> found = design(system, Spectrum.asce7(s_ms=1.2, s_m1=0.6), bounds=None, target=target)
    >>> device = found.system.bearings[0]
    >>> device.radii, device.frictions[0].f_max, round(device.slider_radius, 3)
    ((1.5, 1.5), 0.06, 0.2)
    """
    require_choice("least", least, tuple(OBJECTIVES), error=CheckError)
    target = DesignTarget() if target is None else target
    require_type("target", target, DesignTarget, "DesignTarget(...)")
    require_type("spectrum", spectrum, Spectrum, "a Spectrum")
    if least == "cost" and target.prices is None:
        msg = "least = 'cost' without prices: give the target prices, Prices(bearing=2000.0)"
        raise CheckError(msg)
    system = _system(structure, spectrum)
    grouped(system, sizes)  # refused here, not as a candidate that cannot be made
    known: dict[tuple[float, ...], EquivalentLinear] = {}

    def analyse(plain: LIRBearing) -> EquivalentLinear:
        key = (plain.effective_radius, plain.effective_friction)
        if key not in known:
            on = replace(system, bearings=(plain,) * len(system.loads))
            known[key] = equivalent_linear(
                on, spectrum, bounds=bounds, superstructure=superstructure, code=code
            )
        return known[key]

    def fit(radius: float, law: FrictionLaw, asked: Asked) -> Candidate:
        return fitted(radius, law, system, sizes, target, bounds, analyse, asked)

    found, impossible = [], []
    for radius, law in ((r, law) for r in target.radii for law in target.laws):
        try:
            found.append(fit(radius, law, Asked()))
        except ValueError as cause:
            impossible.append(Impossible(radius, law.f_max, str(cause)))
    best = ranked(found, least)
    if not best:
        raise NoCandidateError(tuple(found), tuple(impossible))
    for text in best[0].warnings:
        warnings.warn(text, DesignWarning, stacklevel=2)
    return Design(system, best[0], tuple(found), least, tuple(impossible), fit=fit)


def _system(structure: Frame | IsolationSystem, spectrum: Spectrum) -> IsolationSystem:
    if isinstance(structure, Frame):
        return IsolationSystem.from_frame(structure, s_ms=spectrum.parameters.get("S_MS"))
    require_type("structure", structure, IsolationSystem, "a Frame or an IsolationSystem")
    return structure
