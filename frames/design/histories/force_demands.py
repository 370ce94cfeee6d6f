"""Design forces in members, storeys and under bearings: of suites, by the rules of a code."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import standing_in
from frames.design.codes.secant import CheckBuilder
from frames.design.histories.demand_table import said
from frames.design.histories.eccentricity import Case, levels_of
from frames.design.histories.suite import peaks_of_runs
from frames.results.recorded import PEAK
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import pandas as pd
    import xarray as xr

    from frames._types import FloatArray, IntArray
    from frames.design.calculation.check import Check
    from frames.design.codes.outcome import BoundResult
    from frames.design.histories.suite import RunSet


BASE = "base shear of time histories"
STOREY = "storey shear of time histories"
LEAST = "least one, of the equivalent-linear analysis"


class ShearFactor(NamedTuple):
    """Factors on the earthquake's part of forces and drifts, 1 at least."""

    # above the isolation: the larger ratio of least shear to that of the runs, of the lowest
    # storey and at the base
    above: float = 1.0
    isolation: float = 1.0  # for the forces of the bearings, and below: that at the base


def shear_checks(case: Case, known: BoundResult, storey: str = "", note: str = "") -> list[Check]:
    """Return the shears of runs against their least values, at the base and over it.

    Less is no failure: it is the shear to design for, and the ratio the factor on the forces.
    """
    data, suite, rules = case.data, case.suite, case.rules
    clause = f"{rules.cited} {rules.force_clause}".strip()

    def judged(t: Trace, title: str, symbol: str, subject: str) -> Check:
        demand, least = t.value(symbol), t.value("V_least")
        more = ""
        if not suite.void and 0.0 < demand < least:
            factor = least / demand
            more = worded("forces and drifts are raised by {factor:.4g}", factor=factor)
            if title == STOREY:
                more = worded(
                    "forces and drifts above the isolation are raised by {factor:.4g}",
                    factor=factor,
                )
        said = joined(more, note)
        standing = standing_in(rules.code, "history minima")
        judge = CheckBuilder(t, known.bound, standing, void=suite.void).of("minimum")
        return judge.worst(clause, title, symbol, ">=", "V_least", subjects=(subject,), note=said)

    t = Trace()
    suite.enter(t, "V", peaks_of_runs(data, "base_shear"), "N")
    t.given("V_least", known.trace.value("V_b_dyn"), "N", note=LEAST)
    found = [judged(t, BASE, "V", "")]
    if not storey:
        return found
    if not case.keeps("storey_shear"):
        msg = "runs have no storey shears (peak_storey_shear): run them again"
        raise CheckError(msg)
    t = Trace()
    suite.enter(t, "V_st", peaks_of_runs(data, "storey_shear")[:, 0], "N")
    t.given("R_I", known.trace.value("R_I"), source=known.trace["R_I"].source)
    suite.form(t, "V_run", "V_st / R_I", "N", of="V_st")
    t.given("V_s", known.trace.value("V_s"), "N", note="of the equivalent-linear analysis")
    t.given("a_dyn", known.trace.value("a_dyn"), source=known.trace["a_dyn"].source)
    t("V_least", "a_dyn * V_s", "N")
    return [*found, judged(t, STOREY, "V_run", storey)]


def raise_of(checks: list[Check]) -> ShearFactor:
    """Return the factors of the least shears on forces."""
    factors = {BASE: 1.0, STOREY: 1.0}
    for check in checks:
        if not check.void and check.demand > 0.0:
            factors[check.title] = max(check.limit / check.demand, 1.0)
    return ShearFactor(above=max(factors.values()), isolation=factors[BASE])


def raises_by_case(checks: Iterable[Check]) -> dict[tuple[str, str], ShearFactor]:
    """Return the factors of the least shears on the forces of runs."""
    cases: dict[tuple[str, str], list[Check]] = {}
    for check in checks:
        if check.scope == "minimum" and check.title in {BASE, STOREY}:
            cases.setdefault((check.level, check.bound), []).append(check)
    return {case: raise_of(each) for case, each in cases.items()}


class _Kind(NamedTuple):
    # A table: the variable it is of, its dimensions with the heads of their columns, its forces.
    variable: str
    columns: dict[str, str]
    forces: str


_KINDS = {
    "members": _Kind("member_force", {"member": "member", "station": "station"}, "component"),
    "storeys": _Kind("storey_force", {"section": "storey"}, "storey_component"),
    "reactions": _Kind("reaction_force", {"bearing": "bearing", "side": "side"}, "reaction"),
}
EXTREMES = ("max", "min")
"""Words of a table for the largest and the smallest value."""

_SIGN = np.array([1.0, -1.0])
_DIGITS = 3  # after the point, of forces: less than a millinewton is round-off


def force_demands(
    cases: Sequence[Case], raises: Mapping[tuple[str, str], ShearFactor] | None = None
) -> dict[str, pd.DataFrame]:
    """Return the design forces of members, storeys and bearings from time histories."""
    import pandas as pd

    found: dict[str, pd.DataFrame] = {}
    known = raises or {}
    for name, kind in _KINDS.items():
        parts = []
        for level, own in levels_of(cases).items():
            tables = []
            for case in own:
                if case.keeps(kind.variable):
                    more = known.get((level, case.bound), ShearFactor())
                    table = _of_bound(case, kind, _factors(case.data, name, kind, more))
                    if name == "storeys":
                        table = pd.concat([table, _drifts(case, more.above)])
                    tables.append(table.assign(level=level, bound=case.bound))
            parts += _with_governing(tables, [*kind.columns.values(), "force", "extreme"])
        if parts:
            table = pd.concat(parts, ignore_index=True)
            first = ["level", "bound"]
            rest = [column for column in table.columns if column not in first]
            found[name] = table[[*first, *rest]].set_index("level")
    return found


def _factors(data: xr.Dataset, name: str, kind: _Kind, more: ShearFactor) -> FloatArray:
    # Height of each section, in the order of the table: the foot of the lowest level is the first
    # of the storeys.
    shape = tuple(data.sizes[dim] for dim in kind.columns)
    factors = np.full(shape, more.isolation if name == "reactions" else more.above)
    if name == "storeys":
        factors[0] = more.isolation
    return factors.ravel()


def _acting(data: xr.Dataset, kind: _Kind) -> FloatArray:
    # All six forces of each section, (run, section, force, extreme, at once).
    name, six = PEAK + kind.variable, kind.forces
    if name not in data:
        msg = "moved has no forces of the structure: run it with Recording(forces=True)"
        raise CheckError(msg)
    order = ("run", *kind.columns, six, "extreme", f"{six}_at_once")
    return data[name].transpose(*order).to_numpy().reshape(data.sizes["run"], -1, 6, 2, 6)


def _of_bound(case: Case, kind: _Kind, factors: FloatArray) -> pd.DataFrame:
    import pandas as pd

    data, suite = case.data, case.suite
    dims, six = tuple(kind.columns), kind.forces
    order = ("run", *dims, six, "extreme")

    def at(runs: xr.Dataset) -> FloatArray:
        times = runs[f"{PEAK}{kind.variable}_at"].transpose(*order).to_numpy()
        return times.reshape(runs.sizes["run"], -1, 6, 2)

    together = np.concatenate([_acting(runs, kind) for runs in case.parts])
    times = np.concatenate([at(runs) for runs in case.parts])
    rest = data[f"{PEAK}{kind.variable}_at_rest"].transpose(*order[:-1]).to_numpy()[0]
    own = np.einsum("rscwc->rscw", together)
    value, which = case.counted(own * _SIGN)
    added, ways = case.added(own * _SIGN)
    value = (value + added) * _SIGN
    still = rest.reshape(-1, 6)[:, :, None]
    more = factors[:, None, None]
    value = np.where(more > 1.0, still + more * (value - still), value)

    def of_motion(values: FloatArray) -> FloatArray:
        index = which.reshape(1, *which.shape, *(1,) * (values.ndim - 4))
        found: FloatArray = np.take_along_axis(values, index, axis=0)[0]
        return found

    labels = [list(map(str, data[dim].to_numpy())) for dim in (*dims, six)]
    names = pd.MultiIndex.from_product(
        [*labels, EXTREMES], names=[*kind.columns.values(), "force", "extreme"]
    )
    table = names.to_frame(index=False)
    table["unit"] = ["N m" if force[0] in "MT" else "N" for force in table["force"]]
    table["value"] = _shown(value)
    table["permanent"] = _shown(np.repeat(rest.ravel(), 2))
    table["moved masses add"] = _shown(added * _SIGN)
    table["masses"] = ways.ravel()
    table["raised by"] = np.repeat(factors, 12)
    table = _with_motions(table, case, which.ravel())
    table["single"] = _shown(of_motion(own))
    table["time [s]"] = of_motion(times).ravel()
    acting = of_motion(together).reshape(-1, 6)
    for k, force in enumerate(labels[-1]):
        table[f"{force} then"] = _shown(acting[:, k])
    table["void"] = _void(suite)
    return table


def _shown(values: FloatArray) -> FloatArray:
    return np.asarray(np.round(values, _DIGITS).ravel() + 0.0)  # no -0


def _void(suite: RunSet) -> str:
    # The table of demands names the runs and the reason.
    if not suite.void:
        return ""
    count = worded("{count} of {n} runs failed", count=sum(suite.failed), n=len(suite.failed))
    own = count if suite.reason else ""
    moved = "runs with moved masses failed" if suite.moved_failed else ""
    return joined(own, moved)


def _drifts(case: Case, factor: float) -> pd.DataFrame:
    # Forces of the means of the storeys' lines.
    import pandas as pd

    data, suite = case.data, case.suite
    if not case.keeps("drift"):
        return pd.DataFrame()
    each, times = (case.peaks(name) for name in ("drift", "drift_at"))
    value, which = case.counted(each)
    added, ways = case.added(each)
    table = pd.DataFrame({"storey": list(map(str, data["level"].to_numpy()[1:]))})
    table = table.assign(
        force="drift", extreme=EXTREMES[0], unit="1", value=factor * (value + added)
    )
    table = table.assign(**{"moved masses add": added, "masses": ways, "raised by": factor})
    table = _with_motions(table, case, which)
    columns = np.arange(len(which))
    return table.assign(
        **{"single": each[which, columns], "time [s]": times[which, columns]},
        void=_void(suite),
    )


def _with_motions(table: pd.DataFrame, case: Case, which: IntArray) -> pd.DataFrame:
    motions = np.array(case.motions, dtype=object)
    return table.assign(statistic=said(case.suite), motion=motions[which])


def _with_governing(tables: list[pd.DataFrame], rows: list[str]) -> list[Any]:
    # Envelope of the tables of all bounds, with the same rows each.
    if not tables:
        return []
    sign = np.where(tables[0]["extreme"] == EXTREMES[0], 1.0, -1.0)
    out = np.stack([sign * table["value"].to_numpy() for table in tables])
    most = out.max(axis=0)
    found = []
    for table, mine in zip(tables, out, strict=True):
        if not table[rows].equals(tables[0][rows]):
            msg = "the bounds of a level are not of one structure"
            raise AssertionError(msg)
        governs = np.where(mine == most, "yes", "no")
        found.append(table.assign(governs=governs))
    return found
