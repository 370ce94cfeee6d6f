"""Own measures of a campaign: values beside single runs, the plan, errors with their run."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

pytest.importorskip("filelock")

from frames import GroundMotion, lumped_mass, time_history
from frames.risk import (
    Campaign,
    CampaignError,
    Intensity,
    IntensityRuns,
    LimitState,
    Measure,
    open_campaign,
)
from lir_element import AnalysisWarning
from tests.refusals import refused
from tests.scenes import small_bearing

BEARING = small_bearing(interface_friction=0.16)
FRAME = lumped_mass(BEARING, 5e4)
MOTIONS = {
    name: GroundMotion(x=np.sin(np.linspace(0.0, 2.0 * np.pi, n)), dt=0.01, name=name)
    for name, n in (("short", 61), ("long", 101))
}
LEVEL = 0.01  # m


def beyond(data: xr.Dataset) -> float:
    """Time for which a bearing is further away than LEVEL [s]."""
    way = np.hypot(*data["bearing_displacement"].isel(bearing=0).to_numpy().T[:2])
    return float(np.ptp(data["time"].to_numpy()[away(way)])) if away(way).any() else 0.0


def away(way: np.ndarray) -> np.ndarray:
    return way > LEVEL


MEASURES = {
    "time beyond 10 mm": Measure(beyond, "s"),
    "mean shear": Measure(lambda data: data["base_shear"].isel(axis=0).mean(), "N"),
}


def small(store: Path, **other: object) -> Campaign:
    given = {"scales": [1.0, 3.0], "batch": 3, "measures": MEASURES} | other
    return Campaign(FRAME, MOTIONS, store=store, **given)  # type: ignore[arg-type]


def test_values_are_those_of_single_runs_until_their_own_end(tmp_path: Path) -> None:
    campaign = small(tmp_path / "store")
    data = campaign.run(workers=2)
    table = campaign.to_dataframe()
    assert table["status"].tolist() == ["ok"] * 4
    for _, row in table.iterrows():
        own = time_history(FRAME, MOTIONS[row["motion"]].scaled(row["scale"]))
        assert row["time beyond 10 mm"] == beyond(own)
        shear = own["base_shear"].isel(axis=0).to_numpy()
        assert row["mean shear"] == pytest.approx(shear.mean(), rel=1e-12)
    assert table["time beyond 10 mm"].max() > 0.0
    assert table.attrs["units"]["mean shear"] == "N"
    # the others are what a campaign without measures has, and no histories are kept
    plain = small(tmp_path / "plain", measures=None).run(workers=1)
    kept = [str(name) for name in plain["quantity"].to_numpy()]
    np.testing.assert_array_equal(data["peak"].sel(quantity=kept), plain["peak"])
    assert not (tmp_path / "store/histories").exists()
    again = small(tmp_path / "again", batch=1)
    again.run(workers=1)
    assert again.digest() == campaign.digest()


def test_fragility_may_be_of_an_own_measure(tmp_path: Path) -> None:
    data = small(tmp_path / "store").run(workers=1)
    runs = IntensityRuns.from_dataset(data, MOTIONS, Intensity(kind="scale"))
    limit = LimitState("long away", "time beyond 10 mm", 0.2)
    expected = data["peak"].sel(quantity="time beyond 10 mm").to_numpy() > 0.2
    assert runs.exceeded(limit).tolist() == expected.tolist()
    assert 0 < expected.sum() < 4


def test_runs_that_stop_have_none(tmp_path: Path) -> None:
    campaign = small(tmp_path / "store", scales=[1.0, 30.0])
    with pytest.warns(AnalysisWarning, match="not ok"):
        campaign.run(workers=1)
    table = campaign.to_dataframe()
    stopped = table["outcome"] != "complete"
    assert 0 < stopped.sum() < 4
    assert table["mean shear"].isna().tolist() == stopped.tolist()


def of_level(level: float) -> Measure:
    return Measure(lambda data: float(data["time"][-1]) + level, "s")


def test_a_function_is_part_of_the_plan(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store, name = tmp_path / "store", "time beyond 10 mm"
    small(store).run(workers=1)
    same = {name: Measure(beyond, "s"), "mean shear": MEASURES["mean shear"]}
    small(store, measures=same).run(workers=1)  # nothing is left to do
    words = f'measures: "{name}" was .* is '
    other_unit = MEASURES | {name: Measure(beyond, "ms")}
    refused(CampaignError, words, small(store, measures=other_unit).run)
    refused(CampaignError, r"measures was .* is None", small(store, measures=None).run)
    monkeypatch.setitem(globals(), "LEVEL", 0.02)  # of a function that the measure calls
    refused(CampaignError, words, lambda: small(store).run())
    assert of_level(0.02).digest() != of_level(0.03).digest()
    assert of_level(0.02).digest() == of_level(0.02).digest()


def broken(data: xr.Dataset) -> float:
    if data["motion"] == "long" and data["scale"] > 2.0:
        return float(data["no such variable"])
    return 1.0


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (broken, r'measure "own" of run 3 \("lumped mass, set 0" under 3 x "long"\): KeyError'),
        (lambda data: data["time"], r'measure "own" of run 0 .*: TypeError'),
        (lambda data: math.nan, r'measure "own" of run 0 .* is not a number'),
    ],
)
def test_errors_are_named_with_their_run(tmp_path, function, words):
    with pytest.raises(CampaignError, match=words):
        small(tmp_path / "store", measures={"own": Measure(function, "1")}).run(workers=1)
    assert open_campaign(tmp_path / "store").status().done in {0, 3}


def test_what_cannot_be_told_again_is_refused(tmp_path: Path) -> None:
    scope: dict[str, Callable[[xr.Dataset], float]] = {}
    exec("def typed(data): return 1.0", scope)  # noqa: S102  # as at a prompt
    refused(CampaignError, "source of typed cannot be read", Measure, scope["typed"], "1")
    refused(TypeError, "a function or a lambda", Measure, max, "1")
    store, bare = tmp_path / "store", {"x": beyond}
    refused(TypeError, r'measures\["x"\].*a Measure', small, store, measures=bare)
    own = small(store, measures={"base shear": Measure(beyond, "s")})
    refused(CampaignError, 'measure "base shear" has the name of a quantity', own.run)
    assert not store.exists()
