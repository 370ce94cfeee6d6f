"""What a run costs: repair of components by the fragilities of FEMA P-58, or the whole building."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import stats

from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray

AREA = 144.0
"""Floor of the building [m2]."""

STOREYS = 3
FACADE = 48.0 * 3.5
"""Of a storey [m2]."""

REPLACEMENT = 2690.97
"""Cost of a new building [USD/m2]: steel moment frames, Hwang and Lignos (2017)."""

FOOT = 0.3048


@dataclass(frozen=True)
class Component:
    """A kind of component.

    Attributes
    ----------
    name : str
        Its number in FEMA P-58.
    text : str
        What it is.
    drift : bool
        Whether drift damages it, or the acceleration of a floor [g].
    above : bool
        Whether that floor is the one above.
    medians, dispersions : tuple of float
        Of the damage states, which come one after the other.
    prices : tuple of (float, float)
        Of repair, a unit [USD]: of few and of many units, damage state by damage state.
    amounts : tuple of float
        What few and many units are.
    count : float
        Units in a storey.
    quantity : str
        Where the count comes from.
    """

    name: str
    text: str
    drift: bool
    above: bool
    medians: tuple[float, ...]
    dispersions: tuple[float, ...]
    prices: tuple[tuple[float, float], ...]
    amounts: tuple[float, float]
    count: float
    quantity: str

    @property
    def costs(self) -> tuple[float, ...]:
        """Cost of repair of a unit at each damage state [USD], if all of the building are mended."""
        total = self.count * STOREYS
        return tuple(float(np.interp(total, self.amounts, prices)) for prices in self.prices)

    def cost(self, demand: FloatArray) -> FloatArray:
        """Return the expected cost of a unit at demands, (...) [USD]."""
        with np.errstate(divide="ignore"):
            at = np.log(np.asarray(demand, dtype=np.float64))[..., None]
        reached = stats.norm.cdf((at - np.log(self.medians)) / np.asarray(self.dispersions))
        steps = np.diff(np.asarray(self.costs), prepend=0.0)
        # states in sequence: the next one is reached by none that has not reached the one before
        return np.asarray(np.minimum.accumulate(reached, axis=-1) @ steps)


COMPONENTS = (
    Component(
        "B.10.35.001",
        "connections of beams, reduced sections",
        drift=True,
        above=False,
        medians=(0.03, 0.04, 0.05),
        dispersions=(0.3, 0.3, 0.3),
        prices=((21750.0, 14790.0), (36625.0, 24905.0), (36625.0, 24905.0)),
        amounts=(3.0, 7.0),
        count=24.0,
        quantity="both ends of 12 beams",
    ),
    Component(
        "B.20.22.001",
        "curtain walls, monolithic glass",
        drift=True,
        above=False,
        medians=(0.0338, 0.0383),
        dispersions=(0.4, 0.4),
        prices=((2055.0, 1096.0), (2055.0, 1096.0)),
        amounts=(20.0, 100.0),
        count=FACADE / (30.0 * FOOT**2),
        quantity="the whole facade, 168 m2 a storey, in units of 30 square feet",
    ),
    Component(
        "C.10.11.001a",
        "partitions, gypsum on metal studs, full height",
        drift=True,
        above=False,
        medians=(0.005, 0.01, 0.021),
        dispersions=(0.4, 0.3, 0.2),
        prices=((2677.5, 1428.0), (6825.0, 3640.0), (10500.0, 7437.5)),
        amounts=(1.0, 10.0),
        count=0.1 * AREA / FOOT**2 / 100.0,
        quantity="a tenth of a foot a square foot of floor (assumed), in units of 100 feet",
    ),
    Component(
        "C.30.32.003b",
        "suspended ceilings, braced",
        drift=False,
        above=True,
        medians=(1.47, 1.88, 2.03),
        dispersions=(0.3, 0.3, 0.3),
        prices=((1740.0, 522.0), (13620.0, 4086.0), (28020.0, 8406.0)),
        amounts=(1.0, 10.0),
        count=AREA / (600.0 * FOOT**2),
        quantity="the whole floor, in units of 600 square feet",
    ),
    Component(
        "E.20.22.023",
        "electronics on desks, unsecured",
        drift=False,
        above=False,
        medians=(0.4,),
        dispersions=(0.5,),
        prices=((2000.0, 2000.0),),
        amounts=(1.0, 10.0),
        count=14.0,
        quantity="one for 10 m2 at 2,000 USD (assumed: FEMA P-58 leaves the cost to its user)",
    ),
)


def repair(drift: FloatArray, acceleration: FloatArray) -> dict[str, FloatArray]:
    """Return the expected repair over the cost of a new building, by component.

    Shapes: drift (..., storeys), acceleration (..., storeys + 1).
    """
    floors = np.asarray(acceleration) / STANDARD_GRAVITY
    whole = REPLACEMENT * AREA * STOREYS
    found = {}
    for each in COMPONENTS:
        demand = drift if each.drift else floors[..., 1:] if each.above else floors[..., :-1]
        found[each.name] = each.count * each.cost(demand).sum(axis=-1) / whole
    return found
