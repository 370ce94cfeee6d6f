"""The quantities of time histories: one table with all their properties.

A quantity is added by its row here and its formula in `frames.formulas`
(docs/extending.md).
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from frames.bundles.peak_data import LOADED, PRESSED
from frames.formulas import (
    is_lifted,
    opposite,
    size,
    slips,
    vertical_change,
)
from frames.results import formulas
from frames.results.formulas import (
    formed,
    in_plan,
    of_bearings,
    of_hinges,
    of_links,
    values_of,
)
from frames.results.measures import (
    centre_shift,
    drifts_of_lines,
    drifts_of_storeys,
    gaps,
)
from frames.results.recorded import standing

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames._types import FloatArray


_IN_FIGURES = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "m/s2": ("m/s²", 1.0), "%": ("%", 1e2)}


class Quantity(NamedTuple):
    """A number of a time history: its definition, and its text in tables, checks and figures."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    of: Callable[..., FloatArray]
    """Function from a Dataset to the history (time, ...); of a sum the increments of steps first <=
    k < last.
    """
    kind: Literal["peak", "final", "sum"] = "peak"
    """Largest value, value at the last step, or sum over steps."""
    by_step: bool = False
    """True if compiled code fills it, for each bearing at each step (`bearing_quantities`)."""
    title: str = ""
    """Title of its row in the table of peaks."""
    demand: str = ""
    """Title among demands and checks."""
    checked: str = ""
    """Title among checks, if tables of demands leave it out."""
    note: str = ""
    """Remark beside the demand."""
    sign: float = 1.0
    """Sign in tables."""
    shown: str = ""
    """Unit of figures, if it is not the usual one."""
    raised: Literal["", "factor", "difference"] = ""
    """Effect of moved masses. A quantity that begins at a threshold may be zero with the masses in
    place: a difference raises it.
    """
    limit: str = ""
    """Field of `DesignLimits` that it is held against."""
    symbol: str = ""
    """Symbol in that check."""

    @property
    def in_figures(self) -> tuple[str, float]:
        """Unit in figures, and the factor to it."""
        return _IN_FIGURES.get(self.shown or self.unit, (self.pure_unit, 1.0))

    @property
    def in_checks(self) -> str:
        """Unit that checks show it in; empty for the usual one of its unit."""
        return "mm" if self.unit == "m" else self.shown

    @property
    def described(self) -> str:
        """Description of the variable that keeps it."""
        whole = self.kind != "peak" or self.meaning.startswith("1:")
        return self.meaning if whole else f"largest {self.meaning}"

    @property
    def heading(self) -> str:
        """Title among checks, and in tables of single motions."""
        return self.demand or self.checked

    @property
    def pure_unit(self) -> str:
        """Unit in tables of design: "-" of a pure number."""
        return "-" if self.unit == "1" else self.unit


_B, _L, _H = ("bearing",), ("link",), ("hinge",)
_stepped = partial(Quantity, _B, by_step=True)  # of each bearing at each step
QUANTITIES: dict[str, Quantity] = {
    "displacement": _stepped(
        "m",
        "bearing displacement in plan",
        formulas.displacement,
        title="bearing displacement",
        demand="isolator displacement",
        raised="factor",
    ),
    "displacement_left": Quantity(
        _B,
        "m",
        "bearing displacement in plan, left",
        formulas.displacement,
        "final",
        title="residual bearing displacement",
        demand="residual displacement",
        raised="difference",
        limit="displacement_left",
        symbol="D_left",
    ),
    "displacement_along": Quantity(
        ("axis",),
        "m",
        "bearing displacement along each axis",
        lambda d: formed(size, of_bearings(d, "bearing_displacement", "axis")).max(axis=1),
    ),
    "slip": _stepped(
        "m",
        "interface slip",
        lambda d: of_bearings(d, "interface_slip_size"),
        title="interface slip",
        demand="interface slip",
        raised="difference",
    ),
    "slip_left": Quantity(
        _B,
        "m",
        "interface slip, left",
        lambda d: of_bearings(d, "interface_slip_size"),
        "final",
        title="residual interface slip",
        demand="residual interface slip",
        raised="difference",
    ),
    "rim_force": _stepped(
        "N",
        "force of a rim",
        formulas.rim_force,
        title="rim force",
        demand="rim force",
        raised="difference",
        limit="rim_strength",
        symbol="P",
    ),
    "rim_plastic": Quantity(
        _B,
        "m",
        "largest plastic deformation of a rim; infinite once it is broken",
        formulas.rim_plastic,
        "sum",
        raised="difference",
    ),
    "rims_met": _stepped("1", "1: a rim was met, first then", formulas.rims_met),
    "closing": _stepped(
        "m/s", "speed along the slider's axis at which a rim was met with a slip", formulas.closing
    ),
    "force": _stepped(
        "N",
        "bearing force in plan",
        lambda d: in_plan(of_bearings(d, "bearing_force", "axis")),
        title="bearing force in plan",
        checked="lateral force of a bearing",
        raised="factor",
        limit="lateral_force",
        symbol="H",
    ),
    "axial_force": _stepped(
        "N",
        "axial force",
        lambda d: of_bearings(d, "axial_force"),
        title="axial force",
        demand="maximum axial force",
        raised="factor",
        limit="axial_force",
        symbol="N",
    ),
    "axial_tension": _stepped(
        "N",
        "negative of the minimum axial force",
        lambda d: formed(opposite, of_bearings(d, "axial_force")),
        title="minimum axial force",
        demand="minimum axial force",
        sign=-1.0,
        raised="difference",
    ),
    "vertical_tension": _stepped(
        "1",
        "negative of the least vertical force over the static one",
        lambda d: formed(opposite, formulas.vertical_ratio(d)),
    ),
    "vertical_change": _stepped(
        "1",
        "change of the vertical force over the static one",
        lambda d: formed(vertical_change, formulas.vertical_ratio(d)),
    ),
    "lifted": _stepped(
        "1",
        "1: lifted off, first then",
        lambda d: standing(d) * formed(is_lifted, formulas.vertical_ratio(d)),
    ),
    "sliding": Quantity(
        (*_B, "surface"),
        "m",
        "sliding on each surface",
        lambda d: in_plan(of_bearings(d, "slider_displacement", "surface", "axis")),
        by_step=True,
    ),
    "interface_share": _stepped(
        "1", "force of the interface over what its friction holds", formulas.share_of_interface
    ),
    "slipped": _stepped(
        "1",
        "1: the interface slipped, first then",
        lambda d: formed(slips, formulas.share_of_interface(d)),
    ),
    "slip_loose": Quantity(
        _B,
        "m",
        "growth of the interface slip while the axial force was at most 1 % of that at rest",
        formulas.slip_loose,
        "sum",
    ),
    "eccentricity": _stepped(
        "1",
        "interface eccentricity over slider radius, while pressed",
        lambda d: formulas.eccentricity(d, PRESSED),
    ),
    "eccentricity_loaded": _stepped(
        "1",
        "interface eccentricity over slider radius, while half of the load at rest presses",
        lambda d: formulas.eccentricity(d, LOADED),
        checked="normalised eccentricity e/a",
        raised="difference",
        limit="eccentricity",
        symbol="epsilon",
    ),
    "spin": _stepped(
        "rad", "spin of the sliders", lambda d: formed(size, of_bearings(d, "slider_spin"))
    ),
    "centre_shift": _stepped(
        "m",
        "shift of the spheres' centres by tilt of the plates",
        lambda d: in_plan(centre_shift(d)),
    ),
    "tilt": Quantity(_B, "rad", "tilt of a slider (levels contact and rigid_body)", formulas.tilt),
    "temperature": Quantity(
        (*_B, "contact"),
        "degC",
        "temperature of what each contact slides on",
        lambda d: of_bearings(d, "temperature", "contact"),
        title="temperature of",
    ),
    "uplifts": Quantity(
        (),
        "1",
        "how often bearings lifted off",
        formulas.uplifts,
        "sum",
        title="uplifts, all bearings",
        demand="uplifts, all bearings",
    ),
    "time_lifted": Quantity(
        _B,
        "s",
        "uplift duration",
        formulas.time_lifted,
        "sum",
        title="uplift duration",
        demand="uplift duration",
    ),
    "gap": _stepped(
        "m",
        "gap of the axial contact",
        gaps,
        title="maximum uplift",
        demand="maximum uplift",
        limit="uplift_gap",
        symbol="g",
    ),
    "base_shear": Quantity(
        (),
        "N",
        "base shear in plan",
        lambda d: in_plan(values_of(d, "base_shear", "time", "axis")),
        title="base shear",
        demand="base shear",
        raised="factor",
        limit="base_shear",
        symbol="V",
    ),
    "floor_plan": Quantity(
        ("level",),
        "m/s2",
        "floor acceleration in plan, mean of the level",
        lambda d: in_plan(formulas.of_levels(d)),
        title="floor acceleration in plan, mean",
        demand="floor acceleration in plan",
        note="mean of the level",
        raised="factor",
        limit="floor_acceleration",
        symbol="A",
    ),
    "floor_vertical": Quantity(
        ("level",),
        "m/s2",
        "floor acceleration, vertical, mean of the level",
        lambda d: formed(size, formulas.of_levels(d)[..., 2]),
        title="floor acceleration, vertical, mean",
    ),
    "node_plan": Quantity(
        ("node",),
        "m/s2",
        "acceleration of a node in plan",
        lambda d: in_plan(formulas.of_nodes(d)),
        title="acceleration in plan, worst node",
    ),
    "node_vertical": Quantity(
        ("node",),
        "m/s2",
        "acceleration of a node, vertical",
        lambda d: formed(size, formulas.of_nodes(d)[..., 2]),
        title="acceleration, vertical, worst node",
    ),
    "violence": Quantity(
        ("node",), "m/s2", "acceleration of a node with mass, 0 up to 50 g", formulas.violence
    ),
    "storey_shear": Quantity(
        ("storey",),
        "N",
        "storey shear in plan",
        lambda d: in_plan(values_of(d, "storey_shear", "time", "storey", "axis")),
        title="storey shear",
        demand="storey shear",
        raised="factor",
    ),
    "drift": Quantity(
        ("storey",),
        "1",
        "storey drift",
        lambda d: in_plan(drifts_of_storeys(d)),
        title="storey drift, mean",
        demand="storey drift ratio",
        note="mean of the storey, in plan",
        shown="%",
        raised="factor",
        limit="drift",
        symbol="theta",
    ),
    "line_drift": Quantity(
        ("line",),
        "1",
        "drift of a line of nodes",
        lambda d: in_plan(drifts_of_lines(d, "drift_by_line")[0]),
        title="storey drift, maximum at any column line",
        demand="storey drift ratio, maximum at any column line",
        note="in plan",
        shown="%",
        raised="factor",
        limit="drift",
        symbol="theta",
    ),
    "link_ductility": Quantity(
        _L,
        "1",
        "deformation of a link over that at yield",
        formulas.link_ductility,
        title="link ductility",
    ),
    "link_deformation": Quantity(_L, "m, rad", "deformation of a link", formulas.link_deformation),
    "link_deformation_left": Quantity(
        _L, "m, rad", "deformation of a link, left", formulas.link_deformation, "final"
    ),
    "link_reversal": Quantity(
        _L,
        "N, N m",
        "negative of the least force of a link",
        lambda d: -of_links(d, "link_force"),
    ),
    "link_work": Quantity(
        _L, "J", "work that a link has taken up", lambda d: of_links(d, "link_work")
    ),
    "link_work_left": Quantity(
        _L, "J", "work that a link has taken up, left", lambda d: of_links(d, "link_work"), "final"
    ),
    "hinge_rotation": Quantity(
        _H,
        "rad",
        "plastic rotation of a hinge",
        formulas.hinge_rotation,
        title="plastic rotation of hinges",
    ),
    "hinge_rotation_left": Quantity(
        _H, "rad", "plastic rotation of a hinge, left", formulas.hinge_rotation, "final"
    ),
    "hinge_turn": Quantity(
        _H, "rad", "plastic rotation run through", lambda d: of_hinges(d, "hinge_turn")
    ),
    "hinge_work": Quantity(
        _H, "J", "work that a hinge has dissipated", lambda d: of_hinges(d, "hinge_work")
    ),
    "hinge_work_left": Quantity(
        _H,
        "J",
        "work that a hinge has dissipated, left",
        lambda d: of_hinges(d, "hinge_work"),
        "final",
    ),
    "energy_input": Quantity(
        (),
        "J",
        "work of the ground motion, absolute",
        lambda d: formulas.energy_term(d, "input"),
    ),
    "energy_yielding": Quantity(
        (),
        "J",
        "work that yielding took up",
        lambda d: formulas.energy_term(d, "yielding"),
        title="work of yielding over input",
    ),
    "energy_numerical": Quantity(
        (),
        "J",
        "work that the time integration leaves over",
        lambda d: formulas.energy_term(d, "numerical"),
    ),
    "energy_gap": Quantity((), "J", "gap of the energy balance", formulas.energy_gap),
    "link_force": Quantity(
        _L,
        "N, N m",
        "force of a link",
        lambda d: np.abs(of_links(d, "link_force")),
        title="force of a wall",
    ),
    "imbalance": Quantity(
        ("resultant",),
        "1",
        "sum of all forces, or their moments, over the weight",
        lambda d: np.abs(values_of(d, "imbalance", "time", "resultant")),
    ),
    "sliding_work": Quantity(
        (),
        "N m/s",
        "sum over steps and surfaces: load, friction at high speed, speed",
        formulas.sliding_work,
        "sum",
    ),
    "sliding_work_lower": Quantity(
        (),
        "N m/s",
        "the same with what friction is below that at high speed",
        formulas.sliding_work_lower,
        "sum",
    ),
    "sliding_work_pressed": Quantity(
        (),
        "N m/s",
        "the same with what the pressure changes of that",
        formulas.sliding_work_pressed,
        "sum",
    ),
    "sliding_work_heated": Quantity(
        (),
        "N m/s",
        "the same with what the temperature changes of that",
        formulas.sliding_work_heated,
        "sum",
    ),
}
"""All of them by name, in the order of tables; a description that begins with "1:" is 0 before."""

PEAKS = {name: each for name, each in QUANTITIES.items() if each.kind == "peak"}
TOTALS = {name: each for name, each in QUANTITIES.items() if each.kind == "sum"}
LEFT = tuple(
    name.removesuffix("_left") for name, each in QUANTITIES.items() if each.kind == "final"
)
"""Quantities of which the value at the last step is kept, too."""

DEMANDS = {name: each for name, each in QUANTITIES.items() if each.demand}
"""Rows of tables of demands."""

JUDGED = DEMANDS | {name: each for name, each in QUANTITIES.items() if each.checked}
"""The same, and further quantities of checks."""
