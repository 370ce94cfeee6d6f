"""The nonlinear parts of a structure as the time loop reads them: links and hinged members."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.assembly.system import SCRATCH, STATE_SIZE, WIDEST
from frames.bundles.run_data import MOST_HALVINGS
from lir_element.layout import Field, dtype_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import SparseMatrix
    from frames.assembly.coordinates import Basis
    from frames.assembly.system import NonlinearParts

    Array = npt.NDArray[Any]

_POOL = 256 * 2**20  # bytes of flexibilities kept between steps, at most


PART_COUNTS = dtype_of(
    (
        Field("active", "-", "", "deformations of loose parts", (), "i8"),
        Field("rows", "-", "", "rows that are taken of the pool", (), "i8"),
        Field("live", "-", "", "active ones whose flow Newton's method changes", (), "i8"),
        Field("gains", "-", "", "flows that have a gain", (), "i8"),
        Field("factors", "-", "", "live ones of the factors in `matrix`", (), "i8"),
        Field("at_halvings", "-", "", "1 + halvings of the step of these, 0: none", (), "i8"),
    )
)
PART_SCHEME = dtype_of(
    (
        Field("speed", "1/s", "", "speed at the end of a step by its deformation"),
        Field("known_v", "-", "", "of that speed, by the committed one"),
        Field("known_a", "s", "", "and by the committed acceleration"),
        Field("share", "-", "", "of the forces at the end of the step that count"),
        Field("tolerance", "N", "", "what parts may lack of their equilibrium"),
    )
)


class NonlinearElements(NamedTuple):
    """Nonlinear parts with `m` deformations in all, and the flexibility of the frame.

    The force of a deformation is ``k0 d + g``: k0 belongs to the linear structure, and the time
    loop adds g. The changes of the parts in a step are their flows: of a link the change of g, of a
    hinged member the change of the plastic parts of its five deformations, whose forces are ``g =
    -k0 plastic``. Committed (old) and trial; changed in place.
    """

    kind: Array  # (n,) law by number
    first: Array  # (n + 1,) first deformation of each part
    owner: Array  # (m,) part of each deformation
    par: Array  # (n, constants)
    elastic: Array  # (m,) k0 of parts of one deformation, 0 if it is not of the structure
    stiff: Array  # (m,) elastic stiffness, of hinged members too; 0 of parts added later
    scale: Array  # (m,) to a force: 1, and 1 / length of the member for moments
    old: Array  # (n, STATE_SIZE)
    new: Array
    d_old: Array  # (m,) deformation, its rates, force beyond the elastic one
    d: Array
    v_old: Array
    v: Array
    a_old: Array
    g_old: Array
    g_before: Array  # one step before the committed one
    change: Array  # (m,) g - g_old
    flow: Array  # (m,) flows, of the last step, and as guessed: from these are the deformations
    flow_old: Array
    predicted: Array
    give: Array  # (m, WIDEST) derivatives of the flows by the part's deformations
    loose: Array  # (n,) 1 if the force of the step is not linear
    active: Array  # (m,) deformations of loose parts
    live: Array  # (m,) those of them that a step of Newton's method changes the flow of
    place: Array  # (m,) places in the pool
    counts: Array  # (1,) PART_COUNTS
    gain: Array  # (m, n_b) flows by a step of b, as the last tangent has them
    gained: Array  # (m,) flows that have a gain
    factored: Array  # (m,) live ones of the factors in `matrix`
    at: Array  # (n_b,) step of b that the guessed flows belong to
    known: Array  # (m,) deformation if b rests
    linear: Array  # (m,) deformation if nothing is loose
    framed: Array  # (m,) deformation that the frame has under the flows
    way: Array  # (m,) step of Newton's method
    to_b: Array  # (m, n_b) deformations of b and of the modes
    to_e: Array  # (m, n_e)
    of_e: Array  # (n_e, m) the same, transposed
    push_e: Array  # (m, n_e) loads of a flow of 1 on the modes
    still: Array  # (m, m) deformations by a flow of 1, of massless DOFs
    follow: Array  # (halvings, m, n_b) deformations of b with the modes that follow
    lead: Array  # (halvings, n_b, m) the same, transposed
    slot: Array  # (halvings, m) place in the pool plus one, 0 if there is none
    pool: Array  # (size, m) deformations by a flow of 1, at a step
    load_b: Array  # (n_b,) committed forces g in frame coordinates
    load_e: Array
    matrix: Array  # (m * m,) factors of Newton's method
    order: Array  # (m,) of their rows
    right: Array  # (m, max(n_b, 1)) scratch
    small: Array  # SCRATCH, of a hinged member
    vector: Array  # (m,) scratch
    modes: Array  # (3, n_e) flexibility, and scratch
    scheme: Array  # (1,) PART_SCHEME
    work: Array  # (5,) of yielding, of dampers, of stops; all on the linear structure; lent [J]


def part_sizes(parts: NonlinearElements | None) -> tuple[int, int, int]:
    """Return the numbers of deformations and of parts, and the size of a part's data."""
    return (0, 0, 0) if parts is None else (len(parts.d), len(parts.kind), STATE_SIZE)


def parts_arrays(
    found: NonlinearParts, rows: SparseMatrix, basis: Basis
) -> NonlinearElements | None:
    """Return the parts at rest, if there are any; `rows` (m, n_free) are their deformations."""
    if not len(found.kind):
        return None
    m, n = int(found.first[-1]), len(found.kind)
    n_b, n_e = len(basis.load_b), len(basis.load_e)
    sizes = MOST_HALVINGS + 1
    pool = max(2 * m, min(sizes * m, _POOL // (8 * m)))

    def each() -> Array:
        return np.zeros(m)

    to_b = np.ascontiguousarray(rows @ basis.expand_b)
    to_e = np.ascontiguousarray(rows @ basis.expand_e)
    still = np.ascontiguousarray(rows @ basis.shift(rows.T.toarray()))

    return NonlinearElements(
        kind=found.kind.copy(),
        first=found.first.copy(),
        owner=np.repeat(np.arange(n), np.diff(found.first)),
        par=found.par.copy(),
        elastic=found.elastic.copy(),
        stiff=found.own_stiffness(),
        scale=found.scale.copy(),
        old=np.zeros((n, STATE_SIZE)),
        new=np.zeros((n, STATE_SIZE)),
        d_old=each(),
        d=each(),
        v_old=each(),
        v=each(),
        a_old=each(),
        g_old=each(),
        g_before=each(),
        change=each(),
        flow=each(),
        flow_old=each(),
        predicted=each(),
        give=np.zeros((m, WIDEST)),
        loose=np.zeros(n, np.int64),
        active=np.zeros(m, np.int64),
        live=np.zeros(m, np.int64),
        place=np.zeros(m, np.int64),
        counts=np.zeros(1, dtype=PART_COUNTS),
        gain=np.zeros((m, n_b)),
        gained=np.zeros(m, np.int64),
        factored=np.zeros(m, np.int64),
        at=np.zeros(n_b),
        known=each(),
        linear=each(),
        framed=each(),
        way=each(),
        to_b=to_b,
        to_e=to_e,
        of_e=np.ascontiguousarray(to_e.T),
        push_e=_pushed(found, to_e),
        still=_pushed(found, still),
        follow=np.zeros((sizes, m, n_b)),
        lead=np.zeros((sizes, n_b, m)),
        slot=np.zeros((sizes, m), np.int64),
        pool=np.zeros((pool, m)),
        load_b=np.zeros(n_b),
        load_e=np.zeros(n_e),
        matrix=np.zeros(m * m),
        order=np.zeros(m, np.int64),
        right=np.zeros((m, max(n_b, 1))),
        small=np.zeros(SCRATCH),
        vector=each(),
        modes=np.zeros((3, n_e)),
        scheme=np.zeros(1, dtype=PART_SCHEME),
        work=np.zeros(5),
    )


def _pushed(found: NonlinearParts, rows: Array) -> Array:
    # Rows of deformations as rows of flows: a plastic deformation p of a member is a force -k0 p.
    out = rows.copy()
    for k in range(len(found.links), len(found.kind)):
        own = slice(found.first[k], found.first[k + 1])
        out[own] = -found.par[k, :25].reshape(5, 5).T @ rows[own]
    return out
