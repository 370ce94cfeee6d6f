"""Features of the model that a run can leave out, and their effect on the kernels' records."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lir_element.layout import Records

Level = Literal["pendulum", "contact"]
AnyLevel = Literal["pendulum", "contact", "rigid_body"]
LEVELS = ("pendulum", "contact")
ALL_LEVELS = (*LEVELS, "rigid_body")
"""Levels of fidelity: of an element, and of a whole analysis."""


@dataclass(frozen=True, kw_only=True)
class Features:
    """Modelled features of a run; all by default. True: modelled, False: left out.

    Parameters
    ----------
    rims : bool
        Rims of the plates. Left out: the slider goes on beyond them.
    interface : bool
        The plane interface between the two sliders. Left out: the slider is rigid.
    uplift : bool
        The axial contact opens. Left out: it pulls.
    plate_rotation : bool
        Rotations of the nodes reach the bearing, and its end moments (P-Delta among them) the
        nodes. Left out: parallel plates, and the bearing passes forces only.
    velocity_dependence : bool
        Low friction depends on speed. Left out: it is `f_max` throughout.
    second_direction : bool
        Both horizontal directions. Left out: the x-z plane; no node moves along y nor turns about
        x or z, and the motion's y component is not applied.
    vertical_coupling : bool
        The axial force enters friction and restoring force, and a lateral displacement lifts the
        plates. If it is left out, both use the force under permanent loads. Vertical motion then
        has a spring and a damper of its own, which also pull, and uplift is left out, too.
    pressure_dependence : bool
        Low friction depends on pressure (`LIRBearing.pressure_dependence`). Left out: it is that
        at the reference pressure.
    friction_heating : bool
        Low friction depends on temperature (`LIRBearing.friction_heating`). Left out: it is that
        at the reference temperature; temperatures are computed all the same.

    Raises
    ------
    TypeError
        If a value is not a bool.

    Examples
    --------
    >>> Features(vertical_coupling=False).left_out
    ('uplift', 'vertical_coupling')
    """

    rims: bool = True
    interface: bool = True
    uplift: bool = True
    plate_rotation: bool = True
    velocity_dependence: bool = True
    second_direction: bool = True
    vertical_coupling: bool = True
    pressure_dependence: bool = True
    friction_heating: bool = True

    def __post_init__(self) -> None:
        for name in self.names():
            value = getattr(self, name)
            if not isinstance(value, (bool, np.bool_)):
                msg = f"{name} = {value!r} must be True (modelled) or False (left out)"
                raise TypeError(msg)
            object.__setattr__(self, name, bool(value))
        if not self.vertical_coupling:
            object.__setattr__(self, "uplift", False)

    @classmethod
    def all(cls) -> Features:
        """Return the features with nothing left out."""
        return cls()

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the names of all features."""
        return tuple(field.name for field in fields(cls))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Names of the features left out."""
        return tuple(name for name in self.names() if not getattr(self, name))

    def without(self, *names: str) -> Features:
        """Return the features without those named.

        Parameters
        ----------
        *names : str
            Names from `Features.names()`.

        Returns
        -------
        Features
            A new object.

        Raises
        ------
        ValueError
            If a name is not in `Features.names()`.
        """
        return self._switched(names, on=False)

    def including(self, *names: str) -> Features:
        """Return the features with those named; uplift brings vertical coupling with it.

        Parameters
        ----------
        *names : str
            Names from `Features.names()`.

        Returns
        -------
        Features
            A new object.

        Raises
        ------
        ValueError
            If a name is not in `Features.names()`.
        """
        if "uplift" in names:
            names = (*names, "vertical_coupling")
        return self._switched(names, on=True)

    def _switched(self, names: tuple[str, ...], *, on: bool) -> Features:
        unknown = [name for name in names if name not in self.names()]
        if unknown:
            msg = f"feature {unknown[0]!r} does not exist: choose from {', '.join(self.names())}"
            raise ValueError(msg)
        return replace(self, **dict.fromkeys(names, on))


def apply(features: Features, props: Records, static_load: ArrayLike | None = None) -> Records:
    """Return bearing properties with features left out.

    Shapes: props (n,), static_load (n,), result (n,).
    """
    out = props.copy()
    if not features.rims:
        out["rim_displacement"] = np.inf
    if not features.interface:
        out["fused"] = 1
        out["interface_friction"] = np.inf
    if not features.velocity_dependence:
        out["friction_drop"] = 0.0
    if not features.pressure_dependence:
        out["pressure_rate"] = 0.0
    if not features.friction_heating:
        out["softens"] = 0
    if not features.uplift:
        out["bilateral"] = 1
    if not features.vertical_coupling and static_load is not None:
        load = np.broadcast_to(np.asarray(static_load, dtype=np.float64), out.shape)
        if not (load > 0.0).all():
            msg = (
                f"static load {np.min(load):g} N: without vertical coupling every bearing needs "
                "compression under permanent loads; keep vertical_coupling=True"
            )
            raise ValueError(msg)
        if out["goes_on"].any():
            msg = (
                "vertical_coupling = False does not support a bearing with a backup: keep "
                "vertical_coupling=True, or set backup=None"
            )
            raise ValueError(msg)
        out["fixed_load"] = load
    return out
