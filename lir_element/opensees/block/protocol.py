"""Messages of a `genericClient`: vectors of float64 whose first entry names the action.

Source: OpenSees documentation of the element, OpenFresco's remote test protocol, and what the
stock builds send (the header first: eleven int32, the first the number of degrees of freedom, the
last the length of all vectors).
"""

from __future__ import annotations

SET_TRIAL = 3
COMMIT = 5
GET_FORCE = 10
GET_INITIAL = 12
GET_TANGENT = 13
GET_DAMPING = 14
GET_MASS = 15
END = 99

ANSWERED = frozenset({GET_FORCE, GET_INITIAL, GET_TANGENT, GET_DAMPING, GET_MASS})
"""Actions that are answered by one vector."""

HEADER_BYTES = 44
HEADER_WORDS = 11


def vector_length(dofs: int) -> int:
    """Return the length of all vectors: a matrix by columns, or action, motion and time."""
    return max(dofs * dofs, 3 * dofs + 2)
