"""Data of a frame, read-only for analyses; `Frame` adds the operations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from frames._errors import ModelError, new_name
from frames.model.components import (
    BearingLink,
    Diaphragm,
    FloorLoad,
    Hinges,
    Level,
    Link,
    Member,
    Node,
    Spring,
    TaperedLoad,
)
from frames.model.damping import Damping
from frames.model.laws import PlasticHinge
from frames.model.superelement import Superelement
from lir_element.argument_checks import require_non_negative
from lir_element.texts import html_table
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray


def frozen(values: FloatArray) -> FloatArray:
    """Return the array itself, read-only from now on."""
    values.flags.writeable = False
    return values


class FrameData:
    """Components of a frame by name, in the order added.

    Parameters
    ----------
    name : str
        Name of the model.
    gravity : float
        Acceleration of gravity [m/s2], >= 0.
    """

    def __init__(self, name: str = "frame", gravity: float = STANDARD_GRAVITY) -> None:
        """Start an empty frame."""
        self._name = new_name(name, (), "frame")
        self._gravity = require_non_negative("Frame.gravity [m/s2]", gravity, error=ModelError)
        self._nodes: dict[str, Node] = {}
        self._members: dict[str, Member] = {}
        self._springs: dict[str, Spring] = {}
        self._links: dict[str, Link] = {}
        self._hinges: dict[str, tuple[PlasticHinge | None, PlasticHinge | None]] = {}
        self._superelements: dict[str, Superelement] = {}
        self._diaphragms: dict[str, Diaphragm] = {}
        self._bearings: dict[str, BearingLink] = {}
        self._levels: dict[str, Level] = {}
        self._fixed: dict[str, frozenset[str]] = {}
        self._masses: dict[str, FloatArray] = {}
        self._weightless: dict[str, FloatArray] = {}  # masses without weight
        self._loads: dict[str, dict[str, FloatArray]] = {}  # by node and case; never changed within
        self._uniform_loads: dict[str, dict[str, FloatArray]] = {}
        self._tapered_loads: dict[str, tuple[TaperedLoad, ...]] = {}
        self._floor_loads: dict[str, FloorLoad] = {}
        self._mass_source: dict[str, float] = {}
        self._weight_factor = 1.0
        self._damping: Damping | None = None
        self._imported: object | None = None  # the account of an import

    def __getstate__(self) -> dict[str, Any]:
        # dicts of its own, so that additions to a copy are not in the original
        return {k: dict(v) if isinstance(v, dict) else v for k, v in vars(self).items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # copies of arrays can be written to: they are frozen again
        vars(self).update(state)
        cases = (*self._loads.values(), *self._uniform_loads.values())
        for group in (self._masses, self._weightless, *cases):
            for values in group.values():
                frozen(values)

    def __repr__(self) -> str:
        """Return the name and counts of the parts."""
        parts = ["nodes", "members", "springs", "diaphragms", "bearings"]
        parts += [part for part in ("links", "hinges", "superelements") if getattr(self, part)]
        counts = ", ".join(f"{len(getattr(self, part))} {part}" for part in parts)
        return f'Frame("{self._name}": {counts})'

    def _repr_html_(self) -> str:
        kinds = (
            "nodes",
            "members",
            "springs",
            "links",
            "hinges",
            "superelements",
            "diaphragms",
            "bearings",
            "levels",
            "floor_loads",
        )
        rows = [
            (kind.replace("_", " "), str(len(getattr(self, kind))))
            for kind in kinds
            if getattr(self, kind)
        ]
        if self.load_cases:
            rows.append(("load cases", ", ".join(self.load_cases)))
        if self._mass_source:
            shares = ", ".join(f"{share:g} {case}" for case, share in self._mass_source.items())
            rows.append(("mass of loads", shares))
        lumped = sum(float(values[0]) for values in self._masses.values())
        rows.append(("lumped mass", f"{1e-3 * lumped:.5g} t at {len(self._masses)} nodes"))
        rows.append(("damping", repr(self._damping)))
        return html_table(self._name, rows, notes=["totals and axial forces: frame.check()"])

    @property
    def name(self) -> str:
        """Name of the model."""
        return self._name

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s2]."""
        return self._gravity

    @property
    def damping(self) -> Damping | None:
        """Damping of the structure, None without."""
        return self._damping

    @property
    def nodes(self) -> Mapping[str, Node]:
        """Nodes by name, in the order added."""
        return MappingProxyType(self._nodes)

    @property
    def members(self) -> Mapping[str, Member]:
        """Members by name, in the order added."""
        return MappingProxyType(self._members)

    @property
    def springs(self) -> Mapping[str, Spring]:
        """Springs by name, in the order added."""
        return MappingProxyType(self._springs)

    @property
    def links(self) -> Mapping[str, Link]:
        """Nonlinear links by name, in the order added."""
        return MappingProxyType(self._links)

    @property
    def hinges(self) -> Hinges:
        """Plastic hinges at ends i and j by member."""
        return MappingProxyType(self._hinges)

    @property
    def superelements(self) -> Mapping[str, Superelement]:
        """Superelements by name, in the order added."""
        return MappingProxyType(self._superelements)

    @property
    def diaphragms(self) -> Mapping[str, Diaphragm]:
        """Diaphragms by name, in the order added."""
        return MappingProxyType(self._diaphragms)

    @property
    def bearings(self) -> Mapping[str, BearingLink]:
        """Bearings by name, in the order added."""
        return MappingProxyType(self._bearings)

    @property
    def levels(self) -> tuple[Level, ...]:
        """Storey levels in the order added: (name, z [m], nodes) each."""
        return tuple(self._levels.values())

    @property
    def fixed_dofs(self) -> Mapping[str, frozenset[str]]:
        """Fixed degrees of freedom by node."""
        return MappingProxyType(self._fixed)

    @property
    def masses(self) -> Mapping[str, FloatArray]:
        """Lumped masses by node, (6,) each: 3 x kg, 3 x kg m2; members and loads not included."""
        return MappingProxyType(self._masses)

    @property
    def weightless_masses(self) -> Mapping[str, FloatArray]:
        """Lumped masses without weight, by node, (6,) each."""
        return MappingProxyType(self._weightless)

    @property
    def weight_factor(self) -> float:
        """Factor on the weight of masses [-]: 1, or that of a load combination."""
        return self._weight_factor

    @property
    def mass_source(self) -> Mapping[str, float]:
        """Shares of permanent loads that are masses, by case [-]."""
        return MappingProxyType(self._mass_source)

    @property
    def loads(self) -> Mapping[str, FloatArray]:
        """Permanent forces by node, (6,) each: 3 x N, 3 x N m; all cases, no weights."""
        return MappingProxyType({node: _total(cases) for node, cases in self._loads.items()})

    @property
    def loads_by_case(self) -> Mapping[str, Mapping[str, FloatArray]]:
        """The same permanent forces by node and load case."""
        return MappingProxyType(self._loads)

    @property
    def uniform_loads_by_case(self) -> Mapping[str, Mapping[str, FloatArray]]:
        """Uniform loads by member and load case, as `uniform_loads`."""
        return MappingProxyType(self._uniform_loads)

    @property
    def uniform_loads(self) -> Mapping[str, FloatArray]:
        """Permanent loads by member, (3,) each in global axes [N/m]; all cases."""
        found = {member: _total(cases) for member, cases in self._uniform_loads.items()}
        return MappingProxyType(found)

    @property
    def tapered_loads(self) -> Mapping[str, tuple[TaperedLoad, ...]]:
        """Permanent loads of linear size by member; those of floor panels not included."""
        return MappingProxyType(self._tapered_loads)

    @property
    def floor_loads(self) -> Mapping[str, FloorLoad]:
        """Loads on floor panels by name, in the order added."""
        return MappingProxyType(self._floor_loads)

    @property
    def load_cases(self) -> tuple[str, ...]:
        """Cases of all permanent loads, in alphabetical order."""
        return tuple(sorted(set(self._cases())))

    def _cases(self) -> Iterator[str]:
        for group in (self._loads, self._uniform_loads):
            for cases in group.values():
                yield from cases
        for loads in self._tapered_loads.values():
            yield from (load.case for load in loads)
        yield from (load.case for load in self._floor_loads.values())


def _total(cases: Mapping[str, FloatArray]) -> FloatArray:
    return frozen(np.sum(list(cases.values()), axis=0))
