"""Figures of the claim about structures that yield: loops from both programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np

from validation.claims.opensees_yielding_section import AXIAL, HINGE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from validation.claims.opensees_yielding_runs import Both
    from validation.claims.opensees_yielding_section import Path

THEIRS = {"color": "0.65", "linewidth": 3.0}
OURS = {"color": "C0", "linewidth": 0.9}
NAMES = ("here", "OpenSees")
"""In the order of results from both programs."""


def draw_loops(cases: Sequence[tuple[str, Both]]) -> Figure:
    """Draw force over deformation of the part of each building that reaches most."""
    drawn, axes = plt.subplots(2, 2, figsize=(8.0, 6.0), layout="constrained")
    for axis, (title, both) in zip(axes.flat, cases, strict=True):
        part = int(np.argmax(both.reached[1]))
        turns = ":" in both.names[part]
        for which, style in ((1, THEIRS), (0, OURS)):
            axis.plot(
                1e3 * both.deformation[which][:, part],
                1e-3 * both.force[which][:, part],
                label=NAMES[which],
                **style,
            )
        axis.set_title(f"{title}\n{both.names[part]}", fontsize=9)
        axis.set_xlabel("plastic rotation [mrad]" if turns else "deformation [mm]")
        axis.set_ylabel("moment [kN m]" if turns else "force [kN]")
        axis.grid(visible=True, alpha=0.3)
    axes[0, 0].legend(loc="lower right")
    return drawn


def draw_column(own: Path, fibres: Path) -> Figure:
    """Draw axial force over moment, and moment over plastic rotation, of a column."""
    drawn, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.6), layout="constrained")
    for path, name, style in ((fibres, NAMES[1], THEIRS), (own, NAMES[0], OURS)):
        left.plot(path.moment / HINGE.moment_y, path.axial / AXIAL, label=name, **style)
        right.plot(1e3 * path.rotation, 1e-3 * path.moment, label=name, **style)
    left.plot([1, 0, -1, 0, 1], [0, 1, 0, -1, 0], "k--", linewidth=0.8, label="|n| + |m| = 1")
    left.set_xlabel("moment / plastic moment [-]")
    left.set_ylabel("axial force / capacity [-]")
    left.legend(loc="lower left", fontsize=8)
    right.set_xlabel("plastic rotation [mrad]")
    right.set_ylabel("moment [kN m]")
    for axis in (left, right):
        axis.grid(visible=True, alpha=0.3)
    return drawn
