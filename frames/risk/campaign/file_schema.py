"""The keys of a campaign's file, and their dependencies."""

from __future__ import annotations

import math
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Generic, Literal, Self, TypeVar, get_type_hints

from pydantic import BeforeValidator, Field, create_model, model_validator

from frames.design.project.derived import Table, WholeFile, table_of
from frames.design.project.quantities import Acceleration, Length, Ratio, Time, quantity, si
from frames.design.project.schema import MotionSource
from frames.design.project.schema_bearing import Bearing, completed
from frames.design.project.schema_structure import Structure
from frames.design.project.structure_loads import LoadsTable
from frames.risk.campaign.comparison import (
    LARGER,
    LIR,
    OTHERS,
    PLAIN,
    SAME_PLAN,
    ComparedDevices,
    collapse_limit,
    overlap_limit,
)
from frames.risk.campaign.designs import FACTOR, UNITS, names_of
from frames.risk.campaign.devices import Device
from frames.risk.campaign.ductility import ductility_limit
from frames.risk.fragility.intensity import Intensity, Kind
from frames.risk.fragility.limit_state import LimitState
from lir_element.device.friction import VelocityFriction
from lir_element.fields import unit_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element import FrictionLaw

_Lengths = tuple[Annotated[Length, Field(gt=0.0)], ...]
_Ratios = tuple[Annotated[Ratio, Field(gt=0.0)], ...]
_Accelerations = tuple[Annotated[Acceleration, Field(gt=0.0)], ...]


class MeasureTable(Table):
    """Keys of the intensity measure."""

    intensity: Kind = "scale"
    period: Time | None = None
    periods: tuple[Annotated[Time, Field(gt=0.0)], ...] = ()
    measure: str = "RotD50"

    @model_validator(mode="after")
    def _of_its_kind(self) -> Self:
        if (self.intensity == "Sa") != (self.period is not None):
            msg = 'period goes with intensity = "Sa", as period = "3 s": give both, or neither'
            raise ValueError(msg)
        if (self.intensity == "Sa_avg") != bool(self.periods):
            msg = 'periods go with intensity = "Sa_avg", as periods = ["0.6 s", "3 s", "9 s"]: '
            raise ValueError(msg + "give both, or neither")
        self.measured()  # periods rise
        return self

    def measured(self) -> Intensity:
        """Return the intensity measure."""
        return Intensity(
            kind=self.intensity, period=self.period, measure=self.measure, periods=self.periods
        )


class FragilityTable(MeasureTable):
    """``[fragility]``: limit states, and the measure that their curves are over."""

    drift: _Ratios = ()
    displacement: _Lengths = ()
    residual_displacement: _Lengths = ()
    floor_acceleration: _Accelerations = ()
    ductility: _Ratios = ()
    slip_over_overlap: _Ratios = ()
    rim_contact: bool = False
    bearing_failure: bool = False

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.limits():
            msg = "has no limit state: give one, such as drift = [0.005] or bearing_failure = true"
            raise ValueError(msg)
        return self

    def limits(self) -> list[LimitState]:
        """Return the limit states, in the order of their keys."""
        made: list[tuple[Callable[[float], LimitState], tuple[float, ...]]] = [
            (LimitState.drift, self.drift),
            (LimitState.displacement, self.displacement),
            (LimitState.residual_displacement, self.residual_displacement),
            (LimitState.floor_acceleration, self.floor_acceleration),
            (ductility_limit, self.ductility),
            (overlap_limit, self.slip_over_overlap),
        ]
        found = [make(value) for make, values in made for value in values]
        found += [LimitState.rim_contact()] if self.rim_contact else []
        return found + ([LimitState.bearing_failure()] if self.bearing_failure else [])


_Point = tuple[Acceleration, Annotated[float, Field(gt=0.0)]]
HazardPoints = Path | Annotated[tuple[_Point, ...], Field(min_length=2)]
"""A file, or intensities and their return periods [years]."""


class LossTable(MeasureTable):
    """``[loss]``: components and their repair, one hazard or several by name, collapse."""

    components: Path
    replacement: float = Field(gt=0.0)
    hazard: HazardPoints | None = None
    hazards: dict[str, HazardPoints] = Field(default_factory=dict)
    collapse_drift: Annotated[Ratio, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _one_hazard_or_several(self) -> Self:
        if (self.hazard is None) != bool(self.hazards):
            found = "hazard and" if self.hazards else "neither hazard nor"
            msg = (
                f'has {found} [loss.hazards]: give hazard = [["0.5 m/s2", 50], ["3 m/s2", 2475]], '
            )
            raise ValueError(msg + "or several hazards by name")
        return self


T = TypeVar("T")

_IN_G = "Sa", "Sa_avg", "PGA"  # measures that are accelerations


_Length = Annotated[Length, Field(gt=0.0)]
_Strength = Annotated[Ratio, Field(gt=0.0)] | Literal["unbreakable"]

MOST_COMPARED = 5
"""Largest number of devices besides the first in one figure."""

RIMS_OF_EACH = "the rims of each"
"""Name of the group of all devices."""

GEOMETRY = "radius", "slider_height", "slider_radius", "capacity"
"""Parameters that ``[parameters]`` does not vary if the file has devices, which set them."""


def _strength(given: object) -> float:
    # Strength of rims over the design load; "unbreakable" is infinite.
    return math.inf if given == "unbreakable" else si(given, "", "1.0")


class DeviceTable(table_of(Device)):  # type: ignore[misc]  # its keys are the fields
    """``[devices.<name>]``: how the bearings of a device differ from ``[bearing]``."""

    rims: Annotated[float, BeforeValidator(_strength)] | None = None


class Between(Table, Generic[T]):
    """Bounds between which a number is searched."""

    low: T
    high: T


_NUMBERS: dict[str, Any] = {
    each.name: (Between[quantity(unit_of(Device, each.name))] | None, None)  # type: ignore[misc]
    for each in fields(Device)
    if each.metadata
}
SearchedNumbers: Any = create_model("SearchedNumbers", __base__=Table, **_NUMBERS)
SearchedNumbers.__doc__ = "``[search.parameters]``: numbers of a device, between bounds."


class SearchTable(Table):
    """``[search]``: the device, its searched parameters, and the limit state of the median."""

    device: str
    limit: str | None = None
    parameters: SearchedNumbers
    checked: bool = True
    points: int = Field(default=16, ge=2)
    trials: int = Field(default=4, ge=0)
    dispersion: Annotated[Ratio, Field(gt=0.0)] = 0.4
    seed: int = Field(default=0, ge=0)


class CampaignTable(Table):
    """``[campaign]``: name, devices that are run, Python files with friction laws."""

    name: str = Field(min_length=1)
    devices: tuple[str, ...] = Field(default=(LIR,), min_length=1)
    extensions: tuple[str, ...] = ()
    batch: int | None = Field(default=None, ge=1)


class CampaignMotions(MotionSource):
    """``[motions]``: the records, and the factors that each is run at."""

    scales: tuple[float, ...] = Field(default=(1.0,), min_length=1)
    intensities: tuple[Annotated[Acceleration, Field(gt=0.0)], ...] = ()
    tail: Annotated[Time, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _scales_or_intensities(self) -> Self:
        if self.intensities and "scales" in self.model_fields_set:
            msg = "has scales and intensities, and both scale the motions: leave one out"
            raise ValueError(msg)
        if self.pulses is not None and (self.intensities or "scales" in self.model_fields_set):
            msg = "has pulses, which their velocities scale: leave "
            raise ValueError(msg + f"{'intensities' if self.intensities else 'scales'} out")
        return self


class Sampling(Table):
    """``[sample]``: how sets of parameters are chosen."""

    kind: Literal["grid", "latin hypercube", "sobol", "saltelli"]
    size: int | None = Field(default=None, ge=1)
    seed: int = Field(default=0, ge=0)

    @model_validator(mode="after")
    def _size_of_its_kind(self) -> Self:
        if (self.kind == "grid") != (self.size is None):
            needs = "has the size of its values: leave size out"
            msg = f'"{self.kind}" ' + (
                needs if self.kind == "grid" else "needs a size: give size = 64"
            )
            raise ValueError(msg)
        return self


class Range(Table, Generic[T]):
    """Values of a parameter, or bounds between which it is distributed."""

    values: tuple[T, ...] | None = Field(default=None, min_length=1)
    low: T | None = None
    high: T | None = None
    distribution: Literal["uniform", "loguniform", "normal"] = "uniform"
    mean: T | None = None
    deviation: T | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        bounds = (self.low, self.high)
        if (self.values is None) == (None in bounds) or (self.values and any(bounds)):
            msg = 'needs values = [...], or low and high: {low = "1.5 m", high = "2.5 m"}'
            raise ValueError(msg)
        if (self.distribution == "normal") != (self.mean is not None) or (
            (self.mean is None) != (self.deviation is None)
        ):
            msg = 'distribution = "normal" alone has mean and deviation: give both, or neither'
            raise ValueError(msg)
        return self


class Parameters(Table):
    """``[parameters]``: varied values of bearings and damping; its keys are of `parameters_of`."""


class CampaignAnalysis(Table):
    """``[analysis]``: how time histories are run."""

    level: Literal["pendulum", "contact"] = "pendulum"
    dt: Time | None = None
    duration: Time | None = None
    workers: int | None = Field(default=None, ge=1)


class CompareTable(ComparedDevices, Table):
    """``[compare]``: devices beside the LIR-DCFP, strengths of their rims, collapse."""

    devices: tuple[str, ...] = Field(default=("DCFP", "larger DCFP"), min_length=1)
    groups: dict[str, Annotated[tuple[str, ...], Field(min_length=2)]] = Field(default_factory=dict)
    rims: tuple[_Strength, ...] = ()
    slider_radius: _Length | None = None
    larger: _Length | None = None
    collapse_drift: Annotated[Ratio, Field(gt=0.0)] | None = None
    collapse_ductility: Annotated[Ratio, Field(gt=1.0)] | None = None
    maximum_considered: Annotated[Acceleration, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _of_its_device(self) -> Self:
        if self.collapse_drift is not None and self.collapse_ductility is not None:
            msg = "has collapse_drift and collapse_ductility: leave one out"
            raise ValueError(msg)
        for key, device in (("slider_radius", SAME_PLAN), ("larger", LARGER)):
            if getattr(self, key) is not None and device not in self.devices:
                msg = (
                    f'{key} applies to the "{device}" alone: name it in devices, or leave {key} out'
                )
                raise ValueError(msg)
        if SAME_PLAN in self.devices and self.slider_radius is None:
            msg = f'"{SAME_PLAN}" needs slider_radius: give one below that of the LIR-DCFP'
            raise ValueError(msg)
        lists = {f"groups.{name}": each for name, each in self.groups.items()}
        for key, values in (lists | {"devices": self.devices, "rims": self.rims}).items():
            if len({*values}) < len(values):
                msg = f"{key} = {list(values)} has one twice: name it once"
                raise ValueError(msg)
        return self

    def collapse(self) -> LimitState:
        """Return the definition of collapse."""
        return collapse_limit(self.collapse_drift, self.collapse_ductility)


class CampaignFile(WholeFile):
    """A whole file, with the tables of those that it is based on."""

    based_on: str | tuple[str, ...] = ()
    campaign: CampaignTable
    structure: Structure | None = None
    structures: dict[str, Structure] = Field(default_factory=dict)
    loads: LoadsTable | None = None
    bearing: Bearing
    bearings: dict[str, Bearing] = Field(default_factory=dict)
    devices: dict[str, DeviceTable] = Field(default_factory=dict)
    motions: CampaignMotions
    parameters: Parameters | None = None
    sample: Sampling | None = None
    analysis: CampaignAnalysis = CampaignAnalysis()
    fragility: FragilityTable | None = None
    compare: CompareTable | None = None
    search: SearchTable | None = None
    loss: LossTable | None = None

    def measured(self) -> Intensity | None:
        """Return the intensity measure of ``[fragility]``, or that of ``[loss]``, if any."""
        table = self.fragility or self.loss
        return None if table is None else table.measured()

    @model_validator(mode="after")
    def _loss_over_intensities(self) -> Self:
        if self.loss is None:
            return self
        if not self.motions.intensities:
            msg = "[loss] needs records of common intensities: give motions.intensities, as "
            raise ValueError(msg + '["1 m/s2", "2 m/s2"]')
        stated = self.loss.model_fields_set & {*MeasureTable.model_fields}
        if self.fragility is not None and stated and self.loss.measured() != self.measured():
            msg = f"loss.{min(stated)}: [fragility] has another measure, leave it out of [loss]"
            raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _one_structure_or_several(self) -> Self:
        if (self.structure is None) != bool(self.structures):
            msg = "needs [structure], or several as [structures.<name>]: give one of both"
            raise ValueError(msg)
        if self.structures and self.search is not None:
            msg = "[search] needs one [structure]: leave the others out"
            raise ValueError(msg)
        unknown = sorted(set(self.bearings) - set(self.structures))
        if unknown:
            msg = f"[bearings.{unknown[0]}] has no structure: add "
            raise ValueError(msg + f"[structures.{unknown[0]}], or leave it out")
        return self

    @model_validator(mode="after")
    def _intensities_of_a_measure(self) -> Self:
        table = self.fragility or self.loss
        measure = None if table is None else table.intensity
        if self.motions.intensities and measure not in _IN_G:
            msg = 'motions.intensities are accelerations: [fragility] intensity = "Sa" with its '
            msg += 'period, "Sa_avg" with its periods, or "PGA", says of what'
            raise ValueError(msg)
        if self.compare is not None and self.compare.maximum_considered and measure not in _IN_G:
            msg = 'compare.maximum_considered is an acceleration: [fragility] intensity = "Sa" '
            msg += 'with its period, "Sa_avg" with its periods, or "PGA", says of what'
            raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _devices_made_once(self) -> Self:
        section = "[devices]" if self.devices else "[compare]" if self.compare else ""
        if not section:
            return self
        if "devices" in self.campaign.model_fields_set and not self.devices:
            msg = "campaign.devices: [compare] has the devices, leave it out"
            raise ValueError(msg)
        for name in (*GEOMETRY, *(f"{each}{FACTOR}" for each in GEOMETRY)):
            if getattr(self.parameters, name, None) is not None:
                msg = f"parameters.{name}: {section} makes its devices by it, leave it out"
                raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _searched_is_there(self) -> Self:
        if self.search is None:
            return self
        if self.search.device not in self.devices:
            msg = f'search.device: "{self.search.device}" is no table of [devices]: name one'
            raise ValueError(msg)
        if not self.search.parameters.model_fields_set:
            msg = 'search.parameters: name one, as plan = {low = "600 mm", high = "900 mm"}'
            raise ValueError(msg)
        if self.fragility is None:
            msg = "[search] needs a measure and limit states: add [fragility]"
            raise ValueError(msg)
        if self.parameters is not None:
            msg = "[search] has its own parameters: leave [parameters] and [sample] out"
            raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _compared_devices_are_there(self) -> Self:
        compare, known = self.compare or CompareTable(), list(self.devices) or [LIR, PLAIN]
        given = compare.model_fields_set
        named = {f"compare.groups.{name}": (each, known) for name, each in compare.groups.items()}
        if "devices" in self.campaign.model_fields_set:
            named["campaign.devices"] = self.campaign.devices, known
        if "devices" in given or (self.compare is not None and not self.devices):
            others = known[1:] if self.devices else list(OTHERS)
            named["compare.devices"] = compare.devices, others
        for key, (names, allowed) in named.items():
            for name in names:
                if name not in allowed:
                    msg = f'{key}: "{name}" is none of {", ".join(allowed)}'
                    raise ValueError(msg)
        if compare.groups and (not self.devices or "devices" in given):
            msg = "compare.groups replace compare.devices: leave one out"
            raise ValueError(msg if self.devices else "compare.groups are of [devices]: add these")
        for name, each in self.groups().items() if self.devices and self.compare else ():
            if len(each) - 1 > MOST_COMPARED:
                msg = f"[compare] has {len(each) - 1} devices beside {each[0]} ({name}): name at "
                raise ValueError(msg + f"most {MOST_COMPARED}")
        for key in {"rims", "slider_radius", "larger"} & given if self.devices else ():
            msg = f"compare.{key}: [devices] says it of each device, leave it out"
            raise ValueError(msg)
        return self

    @model_validator(mode="before")
    @classmethod
    def _bearings_of_structures(cls, given: object) -> object:
        return completed(given) if isinstance(given, dict) else given

    def run_devices(self) -> dict[str, DeviceTable]:
        """Return the tables of the devices that are run, all or those of ``[campaign]``."""
        named = self.campaign.devices if "devices" in self.campaign.model_fields_set else ()
        return {name: each for name, each in self.devices.items() if name in (named or (name,))}

    def groups(self) -> dict[str, list[str]]:
        """Return the devices that are run by group; the first is compared with the others."""
        run, compare = list(self.run_devices()), self.compare or CompareTable()
        others = compare.devices if "devices" in compare.model_fields_set else run
        whole = {RIMS_OF_EACH: dict.fromkeys((run[0], *others))}
        found = {}
        for name, (first, *rest) in (compare.groups or whole).items():
            kept = [each for each in rest if each in run]
            if first in run and kept:
                found[name] = [first, *kept]
        return found

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.parameters is None) != (self.sample is None):
            msg = "[parameters] and [sample] belong together: give both, or neither"
            raise ValueError(msg)
        return self


def parameters_of(law: type[FrictionLaw]) -> type[Parameters]:
    """Return the keys of ``[parameters]`` for bearings with a friction law."""
    units = {
        name: unit_of(each, name)
        for each in (VelocityFriction, law)
        for name in names_of(each)
        if get_type_hints(each)[name] is float
    }
    keys: dict[str, Any] = {
        name: (Range[quantity(unit)] | None, None)  # type: ignore[misc]
        for name, unit in (UNITS | units).items()
    }
    return create_model("Parameters", __base__=Parameters, __doc__=Parameters.__doc__, **keys)
