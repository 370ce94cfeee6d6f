"""Shear above the isolation system in time histories, and its least value by ASCE 7-22."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import CheckError
from frames.analysis.recovery import storey_forces
from frames.checks.check import Check
from frames.checks.equivalent import Judge
from frames.checks.trace import Trace
from frames.results.kept import require_steps

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.checks.bounds import BoundName
    from frames.checks.outcome import EquivalentLinear
    from frames.frame import Frame


def storey_shear_peaks(data: xr.Dataset, frame: Frame) -> FloatArray:
    """Return the largest shear in plan of each storey, the first being that of the bearings.

    Parameters
    ----------
    data : xarray.Dataset
        Of a `time_history` with its histories.
    frame : Frame
        The structure as it was analysed.

    Returns
    -------
    ndarray, (n_storeys,)
        Sizes of vectors [N].

    Raises
    ------
    ModelError
        If the frame has no level, or is not the one that was analysed.
    ValueError
        If the steps between the ends were not recorded.
    """
    require_steps(data, "storey_shear_peaks")
    forces = storey_forces(frame, data).sel(component=["Vx", "Vy"])
    size = np.linalg.norm(forces.transpose("time", "storey", "component").to_numpy(), axis=-1)
    return np.asarray(size.max(axis=0))


def storey_shear_check(
    data: xr.Dataset, frame: Frame, equivalent: EquivalentLinear, bound: BoundName
) -> Check:
    """Check the shear above the isolation system in a time history against its least value.

    Parameters
    ----------
    data : xarray.Dataset
        As for `storey_shear_peaks`.
    frame : Frame
        The structure as it was analysed, at the bound.
    equivalent : EquivalentLinear
        Of ASCE 7-22 with a superstructure.
    bound : {"lower", "nominal", "upper"}
        Bound of the properties in this run, one of the analysis.

    Returns
    -------
    Check
        Shear of the storey on the base level over R_I, at least 60 % of V_s (80 % of an irregular
        structure); where it fails, forces of the structure above are to be multiplied by the
        ratio. It is of this run, where the standard takes the mean of a suite.

    Raises
    ------
    CheckError
        If the analysis has no such minimum at this bound, or the frame fewer than two levels.
    ModelError, ValueError
        As `storey_shear_peaks`.
    """
    if bound not in equivalent.bounds or "V_s_dyn" not in equivalent.bounds[bound].trace:
        msg = (
            f"equivalent has no least storey shear (V_s_dyn) at the bound {bound!r}: give that of "
            "ASCE 7-22 with a superstructure, at this bound"
        )
        raise CheckError(msg)
    if len(frame.levels) < 2:
        msg = f"{frame.name} has {len(frame.levels)} levels: a storey above the base needs two"
        raise CheckError(msg)
    known, t = equivalent.bounds[bound].trace, Trace()
    if str(data.attrs["status"]) == "ok":
        t.given("V_st", float(storey_shear_peaks(data, frame)[1]), "N")
        t.given("R_I", known.value("R_I"), source="ASCE 7-22 17.5.4.2")
        t("V_run", "V_st / R_I", "N")
    else:  # no value: none is above the least one
        t.given("V_run", 0.0, "N", note=str(data.attrs["message"]))
    t.given("V_s", known.value("V_s"), "N", note="of the equivalent-linear analysis")
    t.given("a_dyn", known.value("a_dyn"), source="ASCE 7-22 17.6.4")
    t("V_least", "a_dyn * V_s", "N")
    return Judge(t, bound).worst(
        "ASCE 7-22 17.6.4", "storey shear of time histories", "V_run", ">=", "V_least",
        subjects=(frame.levels[1].name,),
        note=f"of {data.attrs['motion']} alone, not of the mean; where it fails, forces above the "
        "isolation count times the ratio",
    )  # fmt: skip
