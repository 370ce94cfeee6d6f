"""Runs of another campaign that are taken over: which, and that they are what would be computed."""

from pathlib import Path
from typing import Any

import pytest

from frames import Frame, Recording, lumped_mass
from frames.batch.cases import BatchProgress
from frames.risk import Campaign, CampaignError, full_grid, open_campaign
from frames.risk.campaign import batches
from frames.risk.campaign.designs import with_parameters
from tests.refusals import refused
from tests.unit.test_campaign import BEARING, PULSES

pytest.importorskip("filelock")


def campaign(store: Path, motions: object, scales: list[float], **more: object) -> Campaign:
    given = {"sample": full_grid({"radius": [0.7, 0.9]}), "batch": 3} | more
    models = given.pop("models", None) or lumped_mass(BEARING, 5e4)
    return Campaign(models, motions, store=store, scales=scales, **given)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    store = tmp_path_factory.mktemp("first") / "runs"
    campaign(store, PULSES["small"], [0.5, 1.0]).run(workers=1)
    return store


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    found = campaign(tmp_path_factory.mktemp("whole") / "runs", PULSES, [0.5, 1.0, 1.5])
    found.run(workers=1)
    return found


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Hear how many runs are computed from here on."""
    computed: list[int] = []
    true = batches.time_histories

    def heard(*args: object, **kwargs: object) -> object:
        if "cases" in kwargs:
            computed.append(len(kwargs["cases"]))  # type: ignore[arg-type]
        return true(*args, **kwargs)  # type: ignore[arg-type]

    monkeypatch.setattr(batches, "time_histories", heard)
    return computed


def test_what_is_known_is_not_computed_again(first, whole, tmp_path, monkeypatch):
    computed = counted(monkeypatch)
    found = campaign(tmp_path / "runs", PULSES, [0.5, 1.0, 1.5])
    found.run(workers=1, reuse=first)
    assert sum(computed) == 12 - 4
    assert found.status().reused == 4
    assert "(8 computed, 4 taken over)" in str(found.status())
    assert found.digest() == whole.digest()


def test_campaigns_are_merged(first, whole, tmp_path, monkeypatch):
    """Several campaigns that hold all runs of one make it without a computation."""
    others = [first]
    for k, (motions, scales) in enumerate(
        (([PULSES["small"]], [1.5]), ([PULSES["large"]], [1.5, 1.0, 0.5]))
    ):
        others.append(tmp_path / f"other {k}")
        campaign(others[-1], motions, scales).run(workers=1)
    computed = counted(monkeypatch)
    merged = campaign(tmp_path / "merged", PULSES, [0.5, 1.0, 1.5])
    merged.run(workers=1, reuse=others)
    assert computed == []
    assert merged.status().reused == 12
    assert merged.digest() == whole.digest()
    assert open_campaign(merged.store.path).digest() == whole.digest()


def test_what_reads_the_same_is_computed_once_in_a_campaign(tmp_path, monkeypatch):
    """Over its batches and after a resume, whatever the interface that a plain DCFP has not."""
    grid = {"interface_friction": [0.14, 0.16], "interface_yield_displacement": [1e-4, 2e-4]}
    models = {"LIR": lumped_mass(BEARING, 5e4), "DCFP": lumped_mass(BEARING.as_dcfp(), 5e4)}
    more = {"sample": full_grid(grid), "models": models}
    computed, told = counted(monkeypatch), list[BatchProgress]()
    found = campaign(tmp_path / "runs", PULSES, [0.5], **more)
    found.run(workers=1, progress=told.append)
    assert sum(computed) == 8 + 2
    assert "16 of 16 runs" in str(told[-1])
    for text in (found.status(), told[-1]):
        assert "(10 computed, 6 taken over)" in str(text)
    sorted((tmp_path / "runs" / "runs").iterdir())[-1].unlink()
    computed.clear()
    found.run(workers=1)
    assert computed == []
    monkeypatch.setattr(batches.CampaignJob, "digest", lambda _, row, frame: f"{row} {frame}")
    apart = campaign(tmp_path / "apart", PULSES, [0.5], **more)
    apart.run(workers=1)
    assert sum(computed) == 16
    assert apart.digest() == found.digest()


def softer(given: dict[str, float]) -> Frame:
    model = lumped_mass(BEARING, 5e4)
    if given["radius"] > 0.8:  # beyond the first set another structure than before
        given = given | {"friction": 0.05}
    return with_parameters(model, given)


@pytest.mark.parametrize(
    ("more", "reused"),
    [({"sample": full_grid({"radius": [0.8, 0.7]})}, 1), ({"models": {"lumped mass": softer}}, 1)],
    ids=["another first set", "a function with the same first set"],
)
def test_a_run_is_known_by_its_own_structure(
    first: Path, tmp_path: Path, more: dict[str, Any], reused: int
) -> None:
    alone = campaign(tmp_path / "alone", PULSES["small"], [0.5], **more)
    alone.run(workers=1)
    found = campaign(tmp_path / "runs", PULSES["small"], [0.5], **more)
    found.run(workers=1, reuse=first)
    assert found.status().reused == reused
    assert found.digest() == alone.digest()


def test_what_was_computed_otherwise_is_refused(first: Path, tmp_path: Path) -> None:
    for name, more, match in (
        ("step", {"dt": 0.005}, r"(?s)reuse.*options"),
        ("parameters", {"sample": full_grid({"friction": [0.05]})}, "no run is the same"),
        ("set", {"sample": full_grid({"radius": [0.8, 0.6]})}, "no run is the same"),
        ("histories", {"record": Recording()}, r"(?s)reuse.*record"),
    ):
        other = campaign(tmp_path / name, PULSES["small"], [0.5], **more)
        refused(CampaignError, match, other.run, workers=1, reuse=first)
    with pytest.raises(CampaignError, match="holds no campaign"):
        campaign(tmp_path / "new", PULSES["small"], [0.5]).run(reuse=tmp_path / "nothing")
