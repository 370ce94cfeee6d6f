"""Input of a drawing of a bearing, from its Dataset."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames.plots.plot_choice import need
from lir_element import LIRBearing
from lir_element.results.dataset import DEVICE

if TYPE_CHECKING:
    import xarray as xr

_USED = ("radius", "length", "slider_radius", "rim_displacement", "interface_friction")
_SAME = 1e-6  # relative: a Dataset may have been stored in single precision


@dataclass(frozen=True)
class Device:
    """A bearing's geometry, read off a Dataset."""

    radii: tuple[float, float]  # radius of the bottom and of the top surface [m]
    slider_height: float  # of the whole slider, on its axis and in plan [m]
    slider_radius: float
    # sliding at rim contact [m]; infinite without rims
    rim_displacement: tuple[float, float]
    is_dcfp: bool  # whether the slider is rigid

    @property
    def lateral_capacity(self) -> float:
        """Lateral displacement at the first rim contact, plates parallel [m]."""
        length = sum(self.radii) - self.slider_height
        return length * min(d / r for d, r in zip(self.rim_displacement, self.radii, strict=True))


def has_device(data: xr.Dataset) -> bool:
    """Return whether a Dataset, perhaps a part of a result, still has its bearings' geometry."""
    return all(name in data for name in _USED)


def device_of(data: xr.Dataset, name: str) -> Device:
    """Return the geometry of a bearing of a Dataset."""
    need(data, _USED, "draw from the whole result of time_history")
    own = {key: data[key].sel(bearing=name).to_numpy() for key in _USED}
    first, second = (float(r) for r in own["radius"])
    bottom, top = (float(d) for d in own["rim_displacement"])
    return Device(
        radii=(first, second),
        slider_height=first + second - float(own["length"]),
        slider_radius=float(own["slider_radius"]),
        rim_displacement=(bottom, top),
        is_dcfp=math.isinf(float(own["interface_friction"])),
    )


def require_own(data: xr.Dataset, name: str, bearing: object) -> None:
    """Raise unless a device is the one that a Dataset has under a name."""
    if not isinstance(bearing, LIRBearing):
        msg = f"bearing is a {type(bearing).__name__}: give a LIRBearing, or only the name"
        raise TypeError(msg)
    record = bearing.to_record()[0]
    found = {key: data[key].transpose("bearing", ...).to_numpy() for key in DEVICE if key in data}
    agrees = {
        key: np.isclose(values, record[key], rtol=_SAME, atol=0.0).reshape(len(values), -1).all(1)
        for key, values in found.items()
    }
    names = [str(other) for other in data["bearing"].to_numpy()]
    place = names.index(name)
    wrong = [key for key, same in agrees.items() if not same[place]]
    if not wrong:
        return
    key = wrong[0]
    fits = [n for n, ok in zip(names, np.all(list(agrees.values()), axis=0), strict=True) if ok]
    whose = f"it is that of {', '.join(fits[:4])}" if fits else "no bearing of the Dataset has it"
    unit = data[key].attrs.get("units", "")
    msg = (
        f"this device is not {name}: its {key} is {_shown(record[key])} {unit}, that of {name} "
        f"{_shown(found[key][place])} {unit}; {whose}: leave it out, the Dataset has it"
    )
    raise ValueError(msg)


def _shown(values: object) -> str:
    flat = np.atleast_1d(np.asarray(values, dtype=np.float64))
    return " and ".join(f"{value:.6g}" for value in dict.fromkeys(flat.tolist()))
