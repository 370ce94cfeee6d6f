"""A campaign from its file: structures, parameters, motions, and the place of the results."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import Field, create_model
from scipy import stats

from frames.design._errors import ProjectError
from frames.design.codes.history_rules import LOADS_OF_ASCE
from frames.design.hazard.motion_set import MotionSet
from frames.design.project.derived import DerivedTable
from frames.design.project.inputs import (
    bearing_of,
    frame_of,
    in_section,
    motions_of,
    varied,
)
from frames.design.project.reading import read_file
from frames.design.project.schema_bearing import Bearing, bearing_table
from frames.design.project.source_files import load_extensions
from frames.design.project.structure_loads import loads_of
from frames.risk._errors import CampaignError
from frames.risk.campaign.campaign import Campaign
from frames.risk.campaign.comparison import DeviceComparison, collapse_limit, filling_intensity
from frames.risk.campaign.devices import Device, highest_ratio
from frames.risk.campaign.file_schema import CampaignFile, DeviceTable, Range, parameters_of
from frames.risk.campaign.loss import LossInput
from frames.risk.campaign.loss_file import hazard_of, read_components, read_hazard
from frames.risk.campaign.sampling import (
    Choice,
    full_grid,
    latin_hypercube,
    saltelli_sample,
    sobol_sample,
)
from frames.risk.campaign.search import MedianSearch
from frames.risk.fragility.scaled_motions import at_one
from lir_element.device.friction import CoulombFriction

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from frames.design.project.schema_structure import Structure
    from frames.frame import Frame
    from frames.risk.campaign.file_schema import FragilityTable, HazardPoints
    from frames.risk.campaign.sampling import ParameterSample
    from frames.risk.fragility.hazard_curve import HazardCurve
    from frames.risk.fragility.intensity import Intensity
    from lir_element import FrictionLaw, LIRBearing

WEIGHS = {"D": 1.0, "L": 0.5, "S": 0.0}
"""Shares of dead load, live load and snow that buildings of campaigns carry [-]."""

STORE = "results"
"""Default name of the results folder beside the file: the file's name and this."""


def campaign_file(path: str | Path) -> CampaignFile:
    """Return a campaign's file, checked; its parameters depend on the law of the bearings."""
    folder = Path(path).parent

    def kind(data: dict[str, Any]) -> type[CampaignFile]:
        load_extensions(data, folder, "campaign")
        bearing: Any = bearing_table()
        keys: Any = parameters_of(_law_of(data, bearing))
        return create_model(
            "CampaignFile",
            __base__=CampaignFile,
            bearing=(bearing, ...),
            bearings=(dict[str, bearing], Field(default_factory=dict)),
            parameters=(keys | None, None),
        )

    return read_file(path, kind, "docs/campaigns_file.md shows one")


def _read(given: CampaignFile | str | Path) -> CampaignFile:
    return given if isinstance(given, CampaignFile) else campaign_file(given)


def _path_of(file: CampaignFile) -> Path:
    return file.source_path or Path("campaign.toml")


def _law_of(data: dict[str, Any], table: type[Bearing]) -> type[FrictionLaw]:
    # The friction law of the bottom surface; errors of the file are left to its reading.
    try:
        friction = table.model_validate(data["bearing"]).friction
    except (ValueError, KeyError):
        return CoulombFriction
    first = friction[0] if isinstance(friction, tuple) else friction
    return first.made_of if isinstance(first, DerivedTable) else CoulombFriction


def read_campaign(given: CampaignFile | str | Path, *, store: str | Path | None = None) -> Campaign:
    """Return the campaign of a file."""
    file = _read(given)
    whole = _path_of(file)
    folder = whole.resolve().parent
    asked = file.analysis
    motions, scales = _motions(file, folder)
    return in_section(
        "campaign",
        lambda: Campaign(
            models_in(file),
            motions,
            store=whole.with_name(f"{whole.stem}-{STORE}") if store is None else store,
            sample=in_section("sample", lambda: _sample(file)),
            scales=scales,
            batch=file.campaign.batch,
            level=asked.level,
            dt=asked.dt,
            duration=asked.duration,
        ),
    )


def _frames(file: CampaignFile) -> dict[str, Frame]:
    # The structures on the bearings of the file, by name; "" of one alone.
    own, bearing = file.campaign.name, bearing_of(file.bearing)
    if file.structure is not None:
        return {"": _frame(file, file.structure, "structure", bearing, own)}
    found = {}
    for name, given in file.structures.items():
        each = bearing
        if name in file.bearings:
            each = bearing_of(file.bearings[name], f"bearings.{name}")
        found[name] = _frame(file, given, f"structures.{name}", each, f"{own}, {name}")
    return found


def _frame(
    file: CampaignFile, given: Structure, section: str, bearing: LIRBearing, name: str
) -> Frame:
    folder, loads = _path_of(file).resolve().parent, loads_of(file.loads, LOADS_OF_ASCE)
    frame = in_section(section, lambda: frame_of(given, bearing, name, folder, loads))
    return frame.combined(WEIGHS) if frame.load_cases else frame


def models_in(given: CampaignFile | str | Path) -> dict[str, Frame]:
    """Return the structures of a campaign's file on its devices, by structure and device."""
    file = _read(given)
    frames = _frames(file)
    asked = file.compare is not None and file.compare.collapse_ductility is not None
    asked = asked or (file.fragility is not None and bool(file.fragility.ductility))
    if asked and not any(frame.hinges for frame in frames.values()):
        msg = "ductility needs plastic hinges, and no structure has any: set hinges in "
        raise ProjectError(msg + "[structure.columns] or [structure.beams], or leave it out")
    return {
        _of_structure(structure, device): made
        for structure, frame in frames.items()
        for device, made in in_section("compare", partial(_devices, frame, file)).items()
    }


def _of_structure(structure: str, name: str) -> str:
    return f"{structure}, {name}" if structure else name


def fragility_in(given: CampaignFile | str | Path) -> FragilityTable | None:
    """Return the limit states and the intensity measure of a campaign's file."""
    return _read(given).fragility


def scaled_to(given: CampaignFile | str | Path) -> Intensity | None:
    """Return the measure that a campaign's file scales the motions to; None: they are as read."""
    file = _read(given)
    return file.measured() if file.motions.intensities else None


def loss_in(given: CampaignFile | str | Path) -> LossInput | None:
    """Return components, hazard and collapse of a campaign's file; None without ``[loss]``."""
    file = _read(given)
    asked, measure, folder = file.loss, file.measured(), _path_of(file).resolve().parent
    if asked is None or measure is None:
        return None
    collapse = collapse_limit(asked.collapse_drift)
    if asked.collapse_drift is None and file.compare is not None:
        collapse = file.compare.collapse()

    def hazard(given: HazardPoints) -> HazardCurve:
        if isinstance(given, Path):
            return read_hazard(folder / given, measure)
        return hazard_of(given, measure)

    several = {
        name: in_section(f"loss.hazards.{name}", partial(hazard, each))
        for name, each in asked.hazards.items()
    }
    return in_section(
        "loss",
        lambda: LossInput(
            components=read_components(folder / asked.components),
            replacement=asked.replacement,
            hazard=several if asked.hazard is None else hazard(asked.hazard),
            collapse=collapse,
        ),
    )


def comparison_in(given: CampaignFile | str | Path) -> DeviceComparison | None:
    """Return the comparison of a campaign's file; None without ``[compare]`` or two devices."""
    file = _read(given)
    own = {} if file.compare is None else file.groups() if file.devices else file.compare.by_rims()
    if file.compare is None or not own:
        return None
    bearing, asked = bearing_of(file.bearing), file.compare
    measure = file.measured()
    filling = asked.maximum_considered is None and measure is not None and measure.kind == "Sa"
    considered = asked.maximum_considered
    if filling and measure is not None and measure.period is not None:
        considered = filling_intensity(bearing, measure.period)
    pairs = [(each, rims) for each in file.structures or ("",) for rims in own]
    return DeviceComparison(
        frames=models_in(file),
        groups={
            _of_structure(each, rims): [_of_structure(each, name) for name in own[rims]]
            for each, rims in pairs
        },
        collapse=asked.collapse(),
        considered=considered,
        filling=filling,
        structures={_of_structure(each, rims): each for each, rims in pairs if each},
    )


def run_search(
    given: CampaignFile | str | Path,
    *,
    store: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
) -> pd.DataFrame:
    """Return the points of the search of a campaign's file, and run the missing ones."""
    file = _read(given)
    whole, asked = _path_of(file), file.analysis
    motions, scales = _motions(file, whole.resolve().parent)
    search = in_section("search", lambda: _search(file, _frames(file)[""], scales))
    return search.run(
        motions,
        store=whole.with_name(f"{whole.stem}-{STORE}") if store is None else store,
        workers=workers or asked.workers,
        client=client,
        level=asked.level,
        dt=asked.dt,
        duration=asked.duration,
        batch=file.campaign.batch,
    )


def _search(file: CampaignFile, frame: Frame, scales: Sequence[float]) -> MedianSearch:
    asked, fragility = file.search, file.fragility
    if asked is None or fragility is None:
        msg = "the file has no [search]: add it, or run the file with `lir campaign`"
        raise CampaignError(msg)
    collapse = [] if file.compare is None else [file.compare.collapse()]
    limits = {limit.name: limit for limit in [*fragility.limits(), *collapse]}
    name = asked.limit or list(limits)[-1]
    if name not in limits:
        msg = f'limit = "{name}" is no limit state of the file: choose one of {", ".join(limits)}'
        raise CampaignError(msg)
    device: Device = file.devices[asked.device].made()
    bounds = {
        key: (each.low, each.high)
        for key in asked.parameters.model_fields_set
        if (each := getattr(asked.parameters, key)) is not None
    }
    loaded = frame
    if "pressure" not in bounds:  # sliders by loads, once for all points
        loaded = Device(kind=device.kind, pressure=device.pressure).on(frame)
        device = replace(device, pressure=None)
    return MedianSearch(
        build=lambda point: replace(device, **point).on(loaded),  # type: ignore[arg-type]
        bounds={key: bounds[key] for key in type(asked.parameters).model_fields if key in bounds},
        limit=limits[name],
        intensity=fragility.measured(),
        scales=scales,
        constraint=highest_ratio if asked.checked else None,
        points=asked.points,
        trials=asked.trials,
        dispersion=asked.dispersion,
        seed=asked.seed,
    )


def _motions(file: CampaignFile, folder: Path) -> tuple[MotionSet, Sequence[float]]:
    # With their tail, and the factors on them: of pulses their velocities, of motions that are
    # scaled to intensities these. A second shock is scaled by the first.
    given, measure = file.motions, scaled_to(file)
    scales: Sequence[float] = given.scales
    if given.pulses is not None:
        scales = given.pulses.velocities
        one = given.pulses.model_copy(update={"velocities": (1.0,)})
        given = given.model_copy(update={"pulses": one})
    found = motions_of(given, folder, lambda: bearing_of(file.bearing).period)
    if given.tail is not None:
        longer = {name: each.with_tail(given.tail) for name, each in found.items()}
        found = MotionSet(longer, found.facts)
    if measure is not None:
        ones, power = in_section("motions", lambda: at_one(measure, found))
        scales = [level ** (1.0 / power) for level in given.intensities]
        found = MotionSet(ones, found.facts)
    return varied(given, found), scales


def _devices(frame: Frame, file: CampaignFile) -> dict[str, Frame]:
    if file.devices:

        def made(table: DeviceTable) -> Frame:
            return table.made().on(frame)  # type: ignore[no-any-return]

        tables = file.run_devices().items()
        return {n: in_section(f"devices.{n}", partial(made, each)) for n, each in tables}
    if file.compare is not None:
        return file.compare.frames(frame)
    devices = file.campaign.devices
    plain = {name: link.bearing.as_dcfp() for name, link in frame.bearings.items()}
    both = {"LIR-DCFP": frame, "DCFP": frame.with_bearings(plain)}
    return {name: both[name] for name in devices}


def distributions_in(given: CampaignFile | str | Path) -> dict[str, Choice]:
    """Return the values or distributions of the parameters of a campaign's file, by name."""
    table = _read(given).parameters
    names = () if table is None else type(table).model_fields
    ranges = {name: value for name in names if (value := getattr(table, name)) is not None}
    return {name: _choice(name, each) for name, each in ranges.items()}


def _sample(file: CampaignFile) -> ParameterSample | None:
    if file.parameters is None or file.sample is None:
        return None
    choices: dict[str, Any] = distributions_in(file)
    size, seed = file.sample.size, file.sample.seed
    if file.sample.kind == "grid" or size is None:
        return full_grid(choices)
    if file.sample.kind == "saltelli":
        for name in [n for n in choices if getattr(file.parameters, n).values is not None]:
            msg = (
                f'{name} has values: give low and high, of which the kind "saltelli" makes samples'
            )
            raise CampaignError(msg)
        return saltelli_sample(choices, size, seed=seed)
    spread: Mapping[str, Choice] = choices
    if file.sample.kind == "sobol":
        return sobol_sample(spread, size, seed=seed)
    return latin_hypercube(spread, size, seed=seed)


def _choice(name: str, given: Range[float]) -> Choice:
    low, high = given.low, given.high
    if given.values is not None or low is None or high is None:
        return given.values or ()
    if not low < high or (given.distribution == "loguniform" and low <= 0.0):
        msg = f"{name}: low = {low:g} must be below high = {high:g}, and above 0 if loguniform: "
        msg += "swap them, or write others under [parameters]"
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
