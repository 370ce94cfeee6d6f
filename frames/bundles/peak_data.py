"""Bundles of arrays with which largest values are kept while a run goes on (kernels/peaks.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[Any]

ENERGY_TERMS = (
    "input",
    "gravity",
    "kinetic",
    "elastic",
    "damping",
    "low_friction_bottom",
    "low_friction_top",
    "high_friction",
    "friction_elastic",
    "rims",
    "contact",
    "sliders",
    "yielding",
    "dampers",
    "stops",
    "numerical",
)
"""Terms of the energy balance, in the order of `Output.energy`."""

PRESSED = 0.05
"""Axial force over the static one below which eccentricities are left to uplift."""

LOADED = 0.5
"""The same above which the resultant's offset has a limit: an edge's force depends on the load as
well, and bearings that lift off or land are on an edge for an instant.
"""

FULL_SLIP = 1.0 - 1e-9
"""Share of the interface's friction resistance above which it counts as slipping."""

LOOSE = 0.01
"""Axial force over the static one up to which sliders are loose between their plates."""

LEAST_SHARE = 1e-3
"""Axial force over the static one that the interface's friction is taken for at least."""


class Devices(NamedTuple):
    """Input of the bearings' peaks."""

    records: Array  # (n_bearings,) PROPS, everything modelled
    height: Array  # (n_bearings,) of the interface over the vertex of the bottom cap [m]
    radius: Array  # (n_bearings,) of the bottom surface as the run models it [m]
    floor: Array  # (n_bearings,) axial force below which there is no eccentricity [N]
    static: Array  # (n_bearings,) axial force under permanent loads [N]
    on_ground: Array  # (n_bearings,) 1 if node i is fixed


class Shape(NamedTuple):
    """Input of the structure's peaks: rows over free degrees of freedom.

    With ``x = (b, eta, beyond)`` those that are needed, and behind them the storey shears of
    members, are ``moves.T @ x + rest`` and, of accelerations, ``rates.T @ x``; rows are sparse.
    """

    moves: Array  # (n_x, n_u + 2 n_storeys): displacements, then shears along x and y
    rest: Array  # (n_u + 2 n_storeys,)
    rates: Array  # (n_x, n_a)
    mass_e: Array  # (n_e,) 0 of lagging coordinates without mass: their acceleration has no use
    u_start: Array  # rows over displacements: pairs of drifts, then of lines, then three of shear
    u_place: Array
    u_value: Array
    shear: Array  # (3, m + 1) base shear of other supports: of forces beyond, constant
    crossed: Array  # (n_storeys, n_bearings) 1 if the bearing passes through the storey
    a_start: Array  # rows over accelerations: three a node, then three a level
    a_place: Array
    a_value: Array
    sizes: Array  # (4,) nodes, levels, storeys, lines
    x: Array  # scratch: (AT_ONCE, n_x), as `rest`, (AT_ONCE, n_x), (AT_ONCE, n_a)
    u: Array
    x_rate: Array
    a: Array


class Reached(NamedTuple):
    """Largest values so far and their times; changed in place."""

    bearing: Array  # (n_bearings, columns)
    bearing_at: Array
    shown: Array  # (1,) scratch: a record with a field for each quantity of a bearing
    columns: Array  # (1, columns) the same memory as numbers
    axis: Array  # (3,) displacement along each axis
    axis_at: Array
    node: Array  # (n_nodes, 2) accelerations in plan, vertical
    node_at: Array
    level: Array  # (n_levels, 2)
    level_at: Array
    storey: Array  # (n_storeys,)
    storey_at: Array
    shear: Array  # (n_storeys,)
    shear_at: Array
    line: Array  # (n_lines,)
    line_at: Array
    whole: Array  # (5,) base shear, terms of the energy
    whole_at: Array
    total: Array  # (3,) sliding work, its reduction, uplifts
    lifted: Array  # (n_bearings, 2) time lifted off [s]; 1 if lifted off at the last step
    loose: Array  # (n_bearings, 2) slip gained by loose sliders, slip at the last step [m]
    met: Array  # (n_bearings, 5) of the last step: slip x, y, displacement x, y [m], 1 at a rim
    last: Array  # (2,) time of the last step taken up, and their number
