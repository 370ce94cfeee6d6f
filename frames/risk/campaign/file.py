"""A campaign from its file: what is run, over which parameters and motions, where."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Literal, Self, TypeVar, get_type_hints

from pydantic import Field, create_model, model_validator
from scipy import stats

from frames.design.codes.load_rules import LOADS_OF_ASCE
from frames.design.project.derived import DerivedTable, Table
from frames.design.project.extensions import load_extensions
from frames.design.project.inputs import bearing_of, frame_of, in_section, motions_of
from frames.design.project.quantities import Length, Ratio, SpeedRate, Time, quantity
from frames.design.project.reading import read_file
from frames.design.project.schema import (
    Bearing,
    LoadsTable,
    MotionSource,
    Structure,
    bearing_table,
)
from frames.design.project.structure_loads import loads_of
from frames.risk._errors import CampaignError
from frames.risk.campaign.campaign import Campaign
from frames.risk.campaign.designs import names_of
from frames.risk.campaign.file_fragility import FragilityTable
from frames.risk.campaign.sampling import Choice, full_grid, latin_hypercube, sobol_sample
from lir_element.device.friction import CoulombFriction, unit_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.frame import Frame
    from frames.risk.campaign.sampling import ParameterSample
    from lir_element import FrictionLaw

T = TypeVar("T")

WEIGHS = {"D": 1.0, "L": 0.5, "S": 0.0}
"""Shares of dead load, live load and snow that buildings of campaigns carry [-]."""

STORE = "results"
"""Folder of the results beside the file, if nothing is said: the file's name and this."""


class CampaignTable(Table):
    """``[campaign]``: its name, plain bearings beside, Python files with friction laws."""

    name: str = Field(min_length=1)
    devices: tuple[Literal["LIR-DCFP", "DCFP"], ...] = Field(default=("LIR-DCFP",), min_length=1)
    extensions: tuple[str, ...] = ()
    batch: int | None = Field(default=None, ge=1)


class CampaignMotions(MotionSource):
    """``[motions]``: the records, and the factors that each is run at."""

    scales: tuple[float, ...] = Field(default=(1.0,), min_length=1)


class Sampling(Table):
    """``[sample]``: how sets of parameters are chosen."""

    kind: Literal["grid", "latin hypercube", "sobol"]
    size: int | None = Field(default=None, ge=1)
    seed: int = Field(default=0, ge=0)

    @model_validator(mode="after")
    def _size_of_its_kind(self) -> Self:
        if (self.kind == "grid") != (self.size is None):
            needs = "has the size of its values: leave size out"
            msg = f'"{self.kind}" ' + (needs if self.kind == "grid" else "needs a size")
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
            msg = 'mean and deviation go with distribution = "normal", both; low and high cut it'
            raise ValueError(msg)
        return self


class Parameters(Table):
    """``[parameters]``: what of the bearings is varied; fields of their law by `parameters_of`."""

    radius: Range[Length] | None = None
    slider_height: Range[Length] | None = None
    slider_radius: Range[Length] | None = None
    capacity: Range[Length] | None = None
    friction: Range[Ratio] | None = None
    f_max: Range[Ratio] | None = None
    f_min: Range[Ratio] | None = None
    rate: Range[SpeedRate] | None = None
    interface_friction: Range[Ratio] | None = None


class CampaignAnalysis(Table):
    """``[analysis]``: how time histories are run."""

    level: Literal["pendulum", "contact"] = "pendulum"
    dt: Time | None = None
    duration: Time | None = None
    workers: int | None = Field(default=None, ge=1)


class CampaignFile(Table):
    """A whole file."""

    campaign: CampaignTable
    structure: Structure
    loads: LoadsTable | None = None
    bearing: Bearing
    motions: CampaignMotions
    parameters: Parameters | None = None
    sample: Sampling | None = None
    analysis: CampaignAnalysis = CampaignAnalysis()
    fragility: FragilityTable | None = None

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.parameters is None) != (self.sample is None):
            msg = "[parameters] and [sample] belong together: give both, or neither"
            raise ValueError(msg)
        return self


def parameters_of(law: type[FrictionLaw]) -> type[Parameters]:
    """Return the keys of ``[parameters]`` for bearings with a friction law.

    Parameters
    ----------
    law : type
        The class of the law; its fields that are numbers are keys, with their units.

    Returns
    -------
    type
        `Parameters` and these keys.
    """
    hints = get_type_hints(law)
    keys: dict[str, Any] = {
        name: (Range[quantity(unit_of(law, name))] | None, None)  # type: ignore[misc]
        for name in names_of(law)
        if hints[name] is float
    }
    return create_model("Parameters", __base__=Parameters, __doc__=Parameters.__doc__, **keys)


def _read(path: Path) -> CampaignFile:
    # The file; the law of its bearings, one of its extensions too, says what is a parameter.
    load_extensions(path, "campaign")
    bearing: Any = bearing_table()
    keys: Any = parameters_of(_law_of(path, bearing))
    kind = create_model(
        "CampaignFile",
        __base__=CampaignFile,
        bearing=(bearing, ...),
        parameters=(keys | None, None),
    )
    return read_file(path, kind, "docs/campaigns.md shows one")


def _law_of(path: Path, table: type[Bearing]) -> type[FrictionLaw]:
    # The friction law of the bottom surface; what is wrong with the file is left to its reading.
    try:
        given = tomllib.loads(path.read_text(encoding="utf-8"))["bearing"]
        friction = table.model_validate(given).friction
    except (OSError, ValueError, KeyError):
        return CoulombFriction
    first = friction[0] if isinstance(friction, tuple) else friction
    return first.made_of if isinstance(first, DerivedTable) else CoulombFriction


def read_campaign(path: str | Path, *, store: str | Path | None = None) -> Campaign:
    """Return the campaign of a file.

    Parameters
    ----------
    path : str or path
        TOML (docs/campaigns.md).
    store : str or path, optional
        Folder of the results. None: beside the file, its name and "-results".

    Returns
    -------
    Campaign
        Ready to run.

    Raises
    ------
    ProjectError
        If the file, or something that it names, cannot be used: a line for each thing.
    """
    whole = Path(path)
    file = _read(whole)
    folder = whole.resolve().parent
    bearing, name = bearing_of(file.bearing), file.campaign.name
    loads = loads_of(file.loads, LOADS_OF_ASCE)
    frame = in_section("structure", lambda: frame_of(file.structure, bearing, name, folder, loads))
    if frame.load_cases:
        frame = frame.combined(WEIGHS)
    given = file.analysis
    return in_section(
        "campaign",
        lambda: Campaign(
            _devices(frame, file.campaign.devices),
            motions_of(file.motions, folder),
            store=whole.with_name(f"{whole.stem}-{STORE}") if store is None else store,
            sample=in_section("sample", lambda: _sample(file)),
            scales=file.motions.scales,
            batch=file.campaign.batch,
            level=given.level,
            dt=given.dt,
            duration=given.duration,
        ),
    )


def workers_of(path: str | Path) -> int | None:
    """Return how many runs at a time a campaign's file asks for."""
    return _read(Path(path)).analysis.workers


def fragility_in(path: str | Path) -> FragilityTable | None:
    """Return the limit states and the measure of intensity that a campaign's file asks for."""
    return _read(Path(path)).fragility


def _devices(frame: Frame, devices: tuple[str, ...]) -> dict[str, Frame]:
    plain = {name: link.bearing.as_dcfp() for name, link in frame.bearings.items()}
    both = {"LIR-DCFP": frame, "DCFP": frame.with_bearings(plain)}
    return {name: both[name] for name in devices}


def _sample(file: CampaignFile) -> ParameterSample | None:
    if file.parameters is None or file.sample is None:
        return None
    ranges = {
        name: value
        for name in type(file.parameters).model_fields
        if (value := getattr(file.parameters, name)) is not None
    }
    choices: dict[str, Any] = {name: _choice(name, each) for name, each in ranges.items()}
    size, seed = file.sample.size, file.sample.seed
    if file.sample.kind == "grid" or size is None:
        return full_grid(choices)
    spread: Mapping[str, Choice] = choices
    if file.sample.kind == "sobol":
        return sobol_sample(spread, size, seed=seed)
    return latin_hypercube(spread, size, seed=seed)


def _choice(name: str, given: Range[float]) -> Choice:
    low, high = given.low, given.high
    if given.values is not None or low is None or high is None:
        return given.values or ()
    if not low < high or (given.distribution == "loguniform" and low <= 0.0):
        msg = f"{name}: low = {low:g} must be below high = {high:g}, and above 0 if loguniform"
        raise CampaignError(msg)
    if given.distribution == "loguniform":
        found: Choice = stats.loguniform(low, high)
    elif given.mean is not None and given.deviation is not None:
        mean, s = given.mean, given.deviation
        if not s > 0.0:
            msg = f"{name}: deviation = {s:g} must be above 0"
            raise CampaignError(msg)
        found = stats.truncnorm((low - mean) / s, (high - mean) / s, loc=mean, scale=s)
    else:
        found = stats.uniform(low, high - low)
    return found
