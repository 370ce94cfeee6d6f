"""Histories of bearings in an OpenSees model, as the Dataset that all analyses return."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import xarray as xr

from lir_element._version import package_version
from lir_element.element import limit_detail
from lir_element.errors import RunStatus, failure_message
from lir_element.opensees.library import commands_of
from lir_element.opensees.plugin import bearing_at, bearing_tags
from lir_element.results.dataset import (
    bearing_coordinates,
    bearing_variables,
    device_variables,
    labelled,
    some_bodies,
)
from lir_element.results.optional_variables import interface_eccentricity, optional_variables

if TYPE_CHECKING:
    from lir_element.layout import Records


class BearingRecording:
    """The committed states of bearings from now on; made by `record_bearings`.

    Examples
    --------
    In the gallery: "A bearing in OpenSeesPy" (docs/gallery/opensees/a_bearing.py).
    """

    def __init__(self, tags: tuple[int, ...], every: int, ops: Any) -> None:
        self.tags = tags
        self._version = ops.version()
        self._every = every
        self._bearings = [bearing_at(tag, ops) for tag in tags]
        self._started = time.perf_counter()
        self._loads = np.array([bearing.response("axial_force") for bearing in self._bearings])
        for bearing in self._bearings:
            bearing.start_recording(every)

    def __reduce__(self) -> NoReturn:
        """Refuse to be copied or pickled: the states are with this process's model."""
        msg = "a BearingRecording cannot be copied or pickled: copy or save its dataset()"
        raise TypeError(msg)

    def dataset(self) -> xr.Dataset:
        """Return the recorded histories so far.

        Returns
        -------
        xarray.Dataset
            Dimensions: time (the model's), bearing (its tag), axis, surface, end, and body if there
            are sliders with contact points. The variables have the names of `frames.time_history`
            (docs/results.md), in each bearing's own axes and SI units. `base_shear` is included if
            the axes of all bearings agree. The attributes hold status, message, versions and
            options. The status is "ok" up to the last completed step. If `analyze` gave a step up,
            it is "newton_failed" or the failure of a bearing, until another step is completed.

        Raises
        ------
        ValueError
            If nothing was recorded.
        MemoryError
            If there was no memory for all states.
        RuntimeError
            If the process with the bearings' states is gone.
        """
        parts = [bearing.recorded() for bearing in self._bearings]
        count = min(len(part[0]) for part in parts)
        if count == 0:
            msg = (
                f"bearings {self.tags} have no committed step since the recording began: call "
                "ops.analyze first"
            )
            raise ValueError(msg)
        times = parts[0][0][:count]
        velocity = np.stack([part[1][:count] for part in parts], axis=1)
        states = np.stack([part[2][:count] for part in parts], axis=1)
        bodies = np.stack([part[3][:count] for part in parts], axis=1)
        props = np.concatenate([bearing.placed.device.to_record() for bearing in self._bearings])
        variables = bearing_variables("time", states, velocity) | device_variables(props)
        variables["interface_eccentricity"] = labelled(
            ("time", "bearing"),
            interface_eccentricity(props, states),
            "m",
            "offset of the resultant between the sliders from their axes, the larger; 0 lifted",
        )
        variables["static_axial_force"] = labelled(
            ("bearing",), self._loads, "N", "axial force when the recording began"
        )
        variables |= optional_variables("time", states, props)
        with_points = np.array([bearing.placed.level == "contact" for bearing in self._bearings])
        if with_points.any():
            place = np.where(with_points, np.arange(len(parts)), -1)
            variables |= some_bodies("time", place, states, bodies)
        first = self._bearings[0].placed.placement.matrix
        others = (bearing.placed.placement.matrix for bearing in self._bearings)
        if all(np.array_equal(matrix, first) for matrix in others):
            variables["base_shear"] = labelled(
                ("time", "axis"),
                states["force"][:, :, 6:9].sum(axis=1),
                "N",
                "resisting force of all recorded bearings",
            )
        coordinates = {
            "time": labelled(("time",), times, "s", "time"),
            **bearing_coordinates([str(tag) for tag in self.tags]),
        }
        return xr.Dataset(variables, coordinates, self._attributes(states, props, times))

    def _attributes(self, states: Records, props: Records, times: Any) -> dict[str, Any]:
        last = states[-1]
        beyond = np.flatnonzero(last["status"])
        if len(beyond):
            place = int(beyond[0])
            status = RunStatus(int(last["status"][place]))
            where = f"bearing element {self.tags[place]}"
            detail = limit_detail(props, last, place)
            message = failure_message(status, float(times[-1]), where, detail)
        else:
            status, message = self._end()
        return {
            "status": status.name.lower(),
            "message": message,
            "lir_dcfp_version": package_version(),
            "opensees_version": self._version,
            "level": ", ".join(sorted({bearing.placed.level for bearing in self._bearings})),
            "route": ", ".join(sorted({bearing.route for bearing in self._bearings})),
            "record_every": self._every,
            "seconds": time.perf_counter() - self._started,
        }

    def _end(self) -> tuple[RunStatus, str]:
        # State of the analysis: whether a step was begun that never ended.
        outcomes = [bearing.outcome() for bearing in self._bearings]
        for tag, (code, _, time_) in zip(self.tags, outcomes, strict=True):
            if code:
                status = RunStatus(code)
                detail = "trial of the step that follows"
                return status, failure_message(status, time_, f"bearing element {tag}", detail)
        unfinished = [time_ for _, begun, time_ in outcomes if begun]
        if unfinished:
            status = RunStatus.NEWTON_FAILED
            detail = "analyze gave up the step that follows; the bearings had states"
            return status, failure_message(status, unfinished[0], "the model in OpenSees", detail)
        return RunStatus.OK, "completed"


def record_bearings(*tags: int, every: int = 1, ops: Any = None) -> BearingRecording:
    """Record the committed states of bearings in the current OpenSeesPy model from now on.

    Parameters
    ----------
    *tags : int
        Tags of their elements; all bearings of the model if none is named. An earlier recording of
        a bearing ends.
    every : int
        Record every so many committed steps.
    ops : xara.Model, optional
        As for `bearing_element`.

    Returns
    -------
    BearingRecording
        The recording. Its `dataset()` may be called at any time, also after a wipe.

    Raises
    ------
    ValueError
        If there is no such bearing, or `every` is below 1.

    Examples
    --------
    In the gallery: "A bearing in OpenSeesPy" (docs/gallery/opensees/a_bearing.py).
    """
    _check_every(every)
    host = commands_of(ops)
    chosen = tags or bearing_tags(host)
    if not chosen:
        msg = "the current OpenSees model has no bearing: add one by bearing_element"
        raise ValueError(msg)
    return BearingRecording(chosen, every, host)


def _check_every(every: object) -> None:
    if not isinstance(every, (int, np.integer)) or every < 1:
        msg = f"every = {every!r} must be an integer of at least 1"
        raise ValueError(msg)
