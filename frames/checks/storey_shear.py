"""Shear above the isolation system in time histories, and its least value by ASCE 7-22."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import CheckError
from frames.analysis.recovery import storey_forces
from frames.checks.check import Check
from frames.checks.equivalent import Judge
from frames.checks.history_rules import HISTORY_RULES
from frames.checks.suite import Suite, motion_of, suite_of
from frames.checks.trace import Trace
from frames.results.kept import REACHED, require_steps

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.checks.bounds import BoundName
    from frames.checks.outcome import EquivalentLinear
    from frames.frame import Frame

_KEPT = f"{REACHED}storey_shear"


def storey_shear_peaks(data: xr.Dataset, frame: Frame) -> FloatArray:
    """Return the largest shear in plan of each storey, the first being that of the bearings.

    Parameters
    ----------
    data : xarray.Dataset
        Of one `time_history` with its histories; or of any runs that kept
        `reached_storey_shear`.
    frame : Frame
        The structure as it was analysed.

    Returns
    -------
    ndarray, (n_runs, n_storeys)
        Sizes of vectors [N].

    Raises
    ------
    ModelError
        If the frame has no level, or is not the one that was analysed.
    ValueError
        If neither was kept.
    """
    if _KEPT in data.variables:
        return np.atleast_2d(data[_KEPT].transpose(..., "storey").to_numpy())
    require_steps(data, "storey_shear_peaks")
    forces = storey_forces(frame, data).sel(component=["Vx", "Vy"])
    size = np.linalg.norm(forces.transpose("time", "storey", "component").to_numpy(), axis=-1)
    return np.asarray(size.max(axis=0)[None])


def storey_shear_check(
    data: xr.Dataset, frame: Frame, equivalent: EquivalentLinear, bound: BoundName
) -> Check:
    """Check the shear above the isolation system of time histories against its least value.

    Parameters
    ----------
    data : xarray.Dataset
        As for `storey_shear_peaks`.
    frame : Frame
        The structure as it was analysed, at the bound.
    equivalent : EquivalentLinear
        Of ASCE 7-22 with a superstructure.
    bound : {"lower", "nominal", "upper"}
        Bound of the properties in these runs, one of the analysis.

    Returns
    -------
    Check
        Shear of the storey on the base level over R_I, at least 60 % of V_s (80 % of an irregular
        structure); where it fails, forces of the structure above are to be multiplied by the
        ratio. Several runs count as ASCE 7-22 has it.

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
    failed = str(data.attrs["status"]) != "ok"
    suite = Suite(statistic="single", failed=(failed,), reason=str(data.attrs["message"]))
    said = f"of {data.attrs['motion']}" if "motion" in data.attrs else ""
    if "run" in data.dims:
        suite = suite_of(data, HISTORY_RULES["ASCE 7-22"])
        said = f"of {', '.join(motion_of(data, k) for k in range(data.sizes['run']))}"
    known, t = equivalent.bounds[bound].trace, Trace()
    if suite.is_usable:
        suite.enter(t, "V_st", storey_shear_peaks(data, frame)[:, 1], "N")
        t.given("R_I", known.value("R_I"), source="ASCE 7-22 17.5.4.2")
        t("V_run", "V_st / R_I", "N")
    else:  # no value: none is above the least one
        t.given("V_run", 0.0, "N", note=suite.reason)
    t.given("V_s", known.value("V_s"), "N", note="of the equivalent-linear analysis")
    t.given("a_dyn", known.value("a_dyn"), source="ASCE 7-22 17.6.4")
    t("V_least", "a_dyn * V_s", "N")
    return Judge(t, bound).worst(
        "ASCE 7-22 17.6.4", "storey shear of time histories", "V_run", ">=", "V_least",
        subjects=(list(frame.levels)[1].name,),
        note=f"{said}; where it fails, forces above the isolation count times the ratio",
    )  # fmt: skip
