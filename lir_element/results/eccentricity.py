"""Where the resultant between the two sliders acts, read off recorded states."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lir_element.device.sliders import interface_height

if TYPE_CHECKING:
    from lir_element.layout import Floats, Records


def interface_eccentricity(props: Records, states: Records) -> Floats:
    """Return how far the resultant in the plane of the interface lies off the sliders' axes.

    Moment equilibrium of the bottom slider about the centre of its sphere: the normal force of the
    plate passes through that centre, friction and rim act at the vertex, the interface at the
    height h_b above it (`interface_height`; docs/theory.md, section 10)::

        e_b = ((R_1 - h_b) F_h - R_1 F_1 + R_1 P_1) / N,      e_t = e_b - s.

    Parameters
    ----------
    props : records, shape (n_bearings,)
        Properties.
    states : records, shape (n_steps, n_bearings)
        Committed states of the level 'pendulum'.

    Returns
    -------
    ndarray, shape (n_steps, n_bearings)
        The larger of both eccentricities [m]; zero where the axial force has faded (below 0.1 % of
        the design load). For a rigid slider: in the same plane.
    """
    radius = props["radius"][:, :1]
    slider_height = props["radius"].sum(axis=1) - props["length"]
    height = interface_height(props["radius"], props["slider_radius"], slider_height)[:, None]
    n = states["axis"]
    size = np.linalg.norm(n[..., :2], axis=-1, keepdims=True)
    outward = n[..., :2] / np.where(size > 0.0, size, 1.0)
    rim = states["rim_force"][..., :1] * outward * n[..., 2:]  # in the basis t
    moment = (radius - height) * states["interface_force"] + radius * (
        rim - states["friction_force"][..., 0, :]
    )
    load = states["axial_force"]
    pressed = load > props["axial_floor"]
    bottom = moment / np.where(pressed, load, np.inf)[..., None]
    top = np.where(pressed[..., None], bottom - states["slip"], 0.0)
    larger: Floats = np.maximum(np.linalg.norm(bottom, axis=-1), np.linalg.norm(top, axis=-1))
    return larger
