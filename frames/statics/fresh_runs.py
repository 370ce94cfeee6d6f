"""Runs that start from one equilibrium: each in arrays of its own, none changes what they share."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

from frames.kernel_data import IntegrationState, run_arrays
from frames.nonlinear_data import NonlinearElements
from lir_element.bundles.contact_data import Contacts, detached

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames.statics.gravity import GravityState

T = TypeVar("T")

_REMADE = frozenset({"reduced", "inverse_e", "follow_e", "lead_e", "follow", "pool"})
# of step sizes: the loop makes them again, as `has_reduced` says


def with_own_arrays(shared: GravityState, seconds: float) -> GravityState:
    """Return a state for runs to change, at rest as `restart` makes it."""
    own: dict[str, Any] = {"run": run_arrays(shared.model), "seconds": seconds}
    if shared.contacts is not None:
        own["contacts"] = detached(shared.contacts)
    if shared.parts is not None:
        own["parts"] = NonlinearElements(*(array.copy() for array in shared.parts))
    mine = replace(shared, **own)
    _ = shared.formed  # one for both
    declared = {field.name for field in fields(shared)}
    known = {name: value for name, value in vars(shared).items() if name not in declared}
    vars(mine).update(known)  # what was formed of the structure: no run changes it
    restart(mine, shared)
    return mine


def once(state: GravityState, name: str, form: Callable[[], T]) -> T:
    """Return what results form of a structure alone, formed by the first of its runs."""
    if name not in state.formed:  # by two threads at once: the same twice
        state.formed[name] = form()
    found: T = state.formed[name]
    return found


def restart(mine: GravityState, shared: GravityState) -> None:
    """Put a state from `with_own_arrays` back to rest."""
    pairs: list[tuple[IntegrationState | Contacts | NonlinearElements | None, Any]] = [
        (mine.run, shared.run),
        (mine.contacts, shared.contacts),
        (mine.parts, shared.parts),
    ]
    spared = frozenset() if shared.run.has_reduced.any() else _REMADE
    for own, rest in pairs:
        for name in () if own is None else own._fields:
            if name not in spared:
                getattr(own, name)[...] = getattr(rest, name)
