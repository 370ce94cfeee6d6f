"""Verbs that change a frame that is built: copies, other bearings, parts that go."""

from __future__ import annotations

import copy as copying
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

from frames._errors import ModelError
from frames.model.components import DEFAULT_CASE, BearingLink, bearing_height
from frames.model.geometry_checks import fits, require_bearing_place
from frames.model.load_combinations import combination, factor_all, factor_loads
from frames.model.names import known_name, new_name
from frames.model.nonlinear import NonlinearBuilder

if TYPE_CHECKING:
    from lir_element import LIRBearing


class FrameEditor(NonlinearBuilder):
    """A frame that can be copied, put on other bearings, and lose parts."""

    def copy(self, name: str | None = None) -> Self:
        """Return a copy that shares nothing that can be changed.

        Parameters
        ----------
        name : str, optional
            Name of the copy; that of this frame if None.

        Returns
        -------
        Frame
            What is added to one is not added to the other.
        """
        found = copying.copy(self)
        if name is not None:
            found._name = new_name(name, (), "frame")
        return found

    def with_bearings(
        self, bearing: LIRBearing | Mapping[str, LIRBearing], name: str | None = None
    ) -> Self:
        """Return a copy on other bearings.

        Parameters
        ----------
        bearing : LIRBearing or mapping
            One device for all bearings, or devices by name of bearing; those that are not named
            stay.
        name : str, optional
            Name of the copy; that of this frame if None.

        Returns
        -------
        Frame
            The same structure. Where a device has another height, the node below it is moved up
            or down, which a node of the ground can be that carries nothing else.

        Raises
        ------
        ModelError
            If there is no bearing of a name, or a device does not fit between its nodes.
        """
        found = self.copy(name)
        chosen = bearing if isinstance(bearing, Mapping) else dict.fromkeys(self._bearings, bearing)
        for each, device in chosen.items():
            known_name(each, self._bearings, "bearing")
            link = self._bearings[each]
            found._settle_under(each, link, bearing_height(each, device))
            require_bearing_place(found._nodes, each, link.i, link.j, device)
            found._bearings[each] = replace(link, bearing=device)
        return found

    def combined(
        self,
        factors: Mapping[str, float],
        name: str | None = None,
        *,
        weight: str = DEFAULT_CASE,
        masses: bool = False,
    ) -> Self:
        """Return a copy whose permanent loads are a combination of the load cases.

        Parameters
        ----------
        factors : mapping of str to float
            Factor of each load case [-], as in ``{"D": 1.2, "L": 0.5}``; `isolator_combinations`
            has those of ASCE 7. A case of the frame that is left out is refused, one that the
            frame does not have does no harm.
        name : str, optional
            Name of the copy; that of this frame if None.
        weight : str
            The case to which the weight of masses, members and superelements belongs.
        masses : bool
            False: masses stay as they are, those that loads make (`set_mass_source`) included.
            True: all that weighs in the combination is mass, lumped masses and those of members
            by the factor of `weight`, loads by their own.

        Returns
        -------
        Frame
            The copy; `weight_factor` says by what masses weigh.

        Raises
        ------
        ModelError
            If a case has no factor, or masses cannot follow.
        """
        found = self.copy(name)
        chosen = combination(self, factors, weight)
        (factor_all if masses else factor_loads)(found, chosen, weight)
        return found

    def remove(self, kind: str, name: str) -> None:
        """Take a part out of the frame.

        Parameters
        ----------
        kind : str
            "member", "spring", "link", "hinges", "bearing", "diaphragm", "level", "mass", "load" or
            "floor load": a mass or a load has the name of its node, and goes in all load cases;
            hinges have that of their member. A member's hinges and own loads go with it, a floor
            load that rests on it must go as well.
        name : str
            Its name.

        Raises
        ------
        ModelError
            If there is no such part.
        """
        groups: dict[str, dict[str, Any]] = {
            "member": self._members,
            "spring": self._springs,
            "link": self._links,
            "hinges": self._hinges,
            "bearing": self._bearings,
            "diaphragm": self._diaphragms,
            "level": self._levels,
            "mass": self._masses,
            "load": self._loads,
            "floor load": self._floor_loads,
        }
        if kind not in groups:
            msg = f"kind = {kind!r}: choose one of {', '.join(groups)}"
            raise ModelError(msg)
        known_name(name, groups[kind], kind)
        del groups[kind][name]
        if kind == "member":
            self._uniform_loads.pop(name, None)
            self._hinges.pop(name, None)
            self._tapered_loads.pop(name, None)
        elif kind == "mass":
            self._weightless.pop(name, None)

    def _settle_under(self, name: str, link: BearingLink, height: float) -> None:
        # Moves the node below a bearing so that a device of another height fits.
        low, high = self._nodes[link.i], self._nodes[link.j]
        if fits(high.z - low.z, height):
            return
        ends: list[tuple[str, ...]] = [
            *((member.i, member.j) for member in self._members.values()),
            *((spring.i, spring.j) for spring in self._springs.values()),
            *((part.i, part.j) for part in self._links.values()),
            *((other.i, other.j) for key, other in self._bearings.items() if key != name),
            *(part.nodes for part in self._superelements.values()),
        ]
        ground = {"ux", "uy", "uz"} <= self._fixed.get(link.i, frozenset())
        if ground and not any(link.i in nodes for nodes in ends):
            self._nodes[link.i] = replace(low, z=high.z - height)
