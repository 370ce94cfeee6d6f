"""Files for a second program to confirm a project: models, links, spectra, expected results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, cast

import numpy as np
import pandas as pd

from frames._errors import ModelError
from frames.design.codes.isolation import with_property_bounds
from frames.exchange.pendulum_link import pendulum_link
from frames.io import MODEL_FILES

if TYPE_CHECKING:
    from pathlib import Path

    from frames.design.codes.bounds import BoundName
    from frames.design.codes.outcome import BoundResult
    from frames.design.project.check_register import Preliminary
    from frames.design.project.inputs import ProjectInputs
    from frames.frame import Frame

Program = Literal["etabs", "sap2000"]
DAMPED_FROM = 0.8
"""Share of the effective period from which on the spectrum has the effective damping [-].

Shorter modes are of the structure and keep 5 % (EN 1998-2 7.5.5; ASCE 7-22 17.6.3).
"""

_LINK = {
    "radius": "radius [m]",
    "slow": "friction at rest [-]",
    "fast": "friction at high speed [-]",
    "rate": "rate parameter [s/m]",
    "elastic": "stiffness before sliding [N/m]",
    "effective": "effective stiffness [N/m]",
    "damping": "effective damping [N s/m]",
    "vertical": "axial stiffness [N/m]",
}


class Handover(NamedTuple):
    """Tables for another program by file, and models that were written or why not."""

    tables: dict[str, pd.DataFrame]  # links, spectrum, expected: in SI units
    said: tuple[str, ...]  # a line for each model


def handed_over(
    parts: ProjectInputs, known: Preliminary, program: Program, folder: Path
) -> Handover:
    """Write a project's model at each bound of friction for a program, and return its tables."""
    said: list[str] = []
    links: list[dict[str, object]] = []
    for result in known.equivalent.bounds.values():
        bound = cast("BoundName", result.bound)
        frame = with_property_bounds(known.frame, bound, parts.bounds())
        said.append(_written(frame, result, program, folder))
        links += _links(known, frame, result)
    tables = {
        "links": pd.DataFrame(links),
        "spectrum": _spectrum(known),
        "expected": _expected(known),
    }
    return Handover(tables, tuple(said))


def _written(frame: Frame, result: BoundResult, program: Program, folder: Path) -> str:
    # The model with links at the displacement of this bound; a line on it.
    write, endings = MODEL_FILES[program]
    path = folder / f"model-{result.bound}{endings[0]}"
    try:
        write(frame, path, displacement=result.displacement)
    except ModelError as cause:
        return f"{path.name} is not written, because {cause}"
    return f"{path.name}: links at {1e3 * result.displacement:.1f} mm"


def _links(known: Preliminary, frame: Frame, result: BoundResult) -> list[dict[str, object]]:
    # A row for each bearing: numbers of its link under its load at rest.
    rows: list[dict[str, object]] = []
    loads = dict(zip(known.system.labels, known.system.loads, strict=True))
    for name, link in frame.bearings.items():
        d = result.displacement
        found = pendulum_link(link.bearing, loads[name], d)
        numbers = {head: getattr(found, key) for key, head in _LINK.items()}
        rows.append(
            {"bearing": name, "type": known.kinds.get(name, ""), "bound": result.bound}
            | {"load [N]": loads[name], "displacement [m]": d}
            | numbers
            | {"damping ratio [-]": 2.0 * found.fast * loads[name] / (np.pi * found.effective * d)}
        )
    return rows


def _spectrum(known: Preliminary) -> pd.DataFrame:
    # Ordinates at 5 %, and at each bound with the effective damping for the isolated modes.
    start, end = known.spectrum.reach
    joints = [DAMPED_FROM * each.period for each in known.equivalent.bounds.values()]
    grid = np.geomspace(max(start, 0.02), min(end, 10.0), 120)
    periods = np.unique(np.concatenate([grid, joints, [t * (1.0 - 1e-6) for t in joints]]))
    table = pd.DataFrame({"period [s]": periods})
    table["5 % [m/s2]"] = known.spectrum.acceleration(periods, 0.05)
    for each in known.equivalent.bounds.values():
        damped = known.spectrum.acceleration(periods, each.damping)
        long = periods >= DAMPED_FROM * each.period
        table[f"{each.bound} [m/s2]"] = np.where(long, damped, table["5 % [m/s2]"])
    return table


def _expected(known: Preliminary) -> pd.DataFrame:
    # Expected results of the other program's modal analysis, by the equivalent-linear analysis.
    rows: list[dict[str, object]] = []
    for each in known.equivalent.bounds.values():
        shears = np.cumsum(each.storey_forces[::-1])[::-1]
        names = [level.name for level in known.frame.levels][: len(shears)]
        numbers = {
            "displacement [m]": each.displacement,
            "total displacement [m]": each.total_displacement,
            "effective period [s]": each.period,
            "effective damping [-]": each.damping,
            "damping factor [-]": each.damping_factor,
            "shear of the isolation system [N]": each.base_shear,
        }
        numbers |= {
            f"shear for design above {name} [N]": float(v)
            for name, v in zip(names, shears, strict=False)
        }
        rows += [{"bound": each.bound, "quantity": key, "value": v} for key, v in numbers.items()]
    return pd.DataFrame(rows)
