"""Records of bearings at the start, and their bundle at the level 'contact' as kernels read it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lir_element.device.friction import least_coefficients
from lir_element.device.sliders import face_records, initial_bodies, slider_record
from lir_element.layout import HEAT_PARTS, SCRATCH, SEARCH, STATE, Floats, Records, Words

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from lir_element.device.bearing import LIRBearing


WORDS = ("bodies_old", "bodies_new", "touch_old", "touch_new")
"""Records of `Contacts` that are there as words, too."""


class Contacts(NamedTuple):
    """Bearings whose sliders are bodies: constants, committed (old) and trial (new) state, scratch.

    `row` is the row of each bearing of a model in the other arrays, -1 for bearings at another
    level. Unused contact points at the end of a row have no share.
    """

    row: npt.NDArray[np.int64]  # (n_bearings,)
    sliders: Records  # (n,)
    points: Records  # (n, m)
    bodies_old: Records  # (n,)
    bodies_new: Records
    touch_old: Records  # (n, m)
    touch_new: Records
    bodies_old_words: Words  # (n, words): the same memory
    bodies_new_words: Words
    touch_old_words: Words
    touch_new_words: Words
    search_old: Records  # (n,)
    search_new: Records
    scratch: Records  # (n,)


class BodyStep(NamedTuple):
    """One bearing made of bodies, over one step: constants, both of its ends, scratch.

    A view of `Contacts` or of a rigid-body run that kernels hand on; `old` is read, `new` written.
    """

    props: Any  # record of PROPS
    sliders: Any  # of SLIDERS
    points: Records  # (m,)
    old: Any  # of BODIES
    new: Any
    touch_old: Records  # (m,)
    touch_new: Records
    search_old: Any  # record of SEARCH; None in a rigid-body run
    search_new: Any
    scratch: Any  # record of SCRATCH


def initial_state(props: Records) -> Records:
    """Return the state records (n,) of undeformed, unloaded bearings with properties `props`."""
    state = np.zeros(len(props), dtype=STATE)
    state["axis"][:, 2] = 1.0
    state["axis_top"][:, 2] = 1.0
    string = props["length"] + props["fixed_load"] / props["axial_stiffness"]
    state["string"] = string
    state["centres"][:, 2] = -string
    state["friction_coefficient"] = least_coefficients(props)
    state["temperature"] = props["initial_temperature"][:, None]
    return state


def heat_parts(props: Records) -> Floats:
    """Return the parts of the temperatures of bearings with properties `props` (n,), at the start.

    Shapes: result (n, 3, HEAT_PARTS).
    """
    return np.zeros((len(props) if props["heats"].any() else 0, 3, HEAT_PARTS))


def contact_arrays(
    bearings: Sequence[LIRBearing], chosen: Sequence[bool], gravity: float
) -> Contacts:
    """Return the bundle of those `bearings` that are `chosen`, undeformed and unloaded."""
    row = np.full(len(bearings), -1, dtype=np.int64)
    row[np.flatnonzero(chosen)] = np.arange(int(np.sum(chosen)))
    picked = [b for b, choice in zip(bearings, chosen, strict=True) if choice]
    each = [face_records(bearing) for bearing in picked]
    most = max((faces.shape[1] for faces, _ in each), default=0)
    sliders = np.concatenate([slider_record(bearing, gravity) for bearing in picked])
    faces = np.concatenate([_padded(part, most) for part, _ in each])
    touches = np.concatenate([_padded(start, most) for _, start in each])
    for k, (part, _) in enumerate(each):  # unused points lie on a real one
        faces["arm"][k, part.shape[1] :] = faces["arm"][k, 0]
        touches["spot"][k, part.shape[1] :] = touches["spot"][k, 0]
    bodies = initial_bodies(len(picked))
    others, news = bodies.copy(), touches.copy()
    return Contacts(
        row=row,
        sliders=sliders,
        points=faces,
        bodies_old=bodies,
        bodies_new=others,
        touch_old=touches,
        touch_new=news,
        bodies_old_words=as_rows(bodies),
        bodies_new_words=as_rows(others),
        touch_old_words=as_rows(touches),
        touch_new_words=as_rows(news),
        search_old=np.zeros(len(picked), dtype=SEARCH),
        search_new=np.zeros(len(picked), dtype=SEARCH),
        scratch=np.zeros(len(picked), dtype=SCRATCH),
    )


def reset(contacts: Contacts, bearings: Sequence[LIRBearing]) -> None:
    """Reset the chosen bearings, in order, to the undeformed and unloaded state."""
    contacts.bodies_old[:] = initial_bodies(len(bearings))
    contacts.search_old[:] = np.zeros(1, dtype=SEARCH)
    for k, bearing in enumerate(bearings):
        start = face_records(bearing)[1][0]
        contacts.touch_old[k, : len(start)] = start


def detached(contacts: Contacts) -> Contacts:
    """Return a copy that shares no memory, its words being views of its own records again."""
    own = {name: values.copy() for name, values in contacts._asdict().items()}
    for name in WORDS:
        own[f"{name}_words"] = as_rows(own[name])
    return Contacts(**own)


def as_rows(records: Records) -> Words:
    """Return records (n, ...) as rows of 64-bit words (n, m), sharing their memory."""
    return records.view(np.int64).reshape(len(records), -1)


def _padded(records: Records, count: int) -> Records:
    out = np.zeros((1, count), dtype=records.dtype)
    out[:, : records.shape[1]] = records
    return out
