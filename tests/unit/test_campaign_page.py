"""A campaign's page: its numbers are those of the results database, failures are in them."""

import re
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

import xarray as xr
from typer.testing import CliRunner

from frames.command.app import app
from frames.design import ProjectError
from frames.risk import IntensityRuns, fragility_of, open_campaign
from frames.risk.campaign.file import fragility_in, read_campaign
from frames.risk.campaign.plot_response import response_by_factor, runs_by_model
from lir_element import AnalysisWarning
from tests.unit.test_campaign_file import FILE

STRONG = (
    FILE.replace('capacity = "300 mm"', 'capacity = "180 mm"')
    .replace('only = ["artificial-1"]', 'only = ["artificial-1", "artificial-3"]')
    .replace("scales = [1.0, 1.5]", "scales = [0.6, 1.0, 1.2, 1.6]")
    .replace('radius = {values = ["1500 mm", "2 m"]}\n', "")
    .replace('"latin hypercube"\nsize = 4\nseed = 3', '"grid"')
    .replace('{low = 0.04, high = "8 %"}', "{values = [0.05, 0.06]}")
    .replace('duration = "3 s"\n', "")
)
AVERAGE = '[fragility]\nintensity = "Sa_avg"\n'
ASKED = """[fragility]
intensity = "PGA"
drift = [0.005, "40 %"]
bearing_failure = true
"""


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """Results of a campaign in which bearings fail, with its page."""
    folder = put_example(tmp_path_factory.mktemp("campaign"))
    (folder / "strong.toml").write_text(STRONG + ASKED)
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):  # failures, on purpose
        done = CliRunner().invoke(app, ["campaign", str(folder / "strong.toml")])
    assert done.exit_code == 0, done.output
    return folder / "strong-results"


def read_fragility(store: Path) -> pd.DataFrame:
    table = pd.read_csv(store / "campaign-fragility.csv", keep_default_na=False)
    return table.set_index(["structure", "limit state"])


@pytest.fixture(scope="module")
def data(store: Path) -> xr.Dataset:
    return open_campaign(store).results().load()


@pytest.fixture(scope="module")
def runs(store: Path, data: xr.Dataset) -> dict[str, IntensityRuns]:
    motions = read_campaign(store.parent / "strong.toml").motions
    return runs_by_model(data, motions)


def test_responses_are_those_of_the_database_with_failures_as_infinite(store, data):
    table = pd.read_csv(store / "campaign-response.csv")
    assert len(table) == 2 * 4
    reached = data["peak_displacement"].max("bearing").to_numpy()
    failed = data["status"].to_numpy() != "ok"
    assert set(data["status"].to_numpy()) <= {"ok", "slip_exceeded", "slip_unstable"}
    assert failed.any()
    for _, row in table.iterrows():
        own = (data["model"] == row["structure"]).to_numpy()
        own &= (data["scale"] == row["factor"]).to_numpy()
        assert row["runs"] == own.sum() == 4
        assert row["bearing failed [-]"] == failed[own].mean()
        demand = np.where(failed[own], np.inf, reached[own])
        for part, word in ((0.5, "median"), (0.84, "84 %")):
            expected = np.quantile(demand, part, method="inverted_cdf")
            assert row[f"bearing displacement, {word} [m]"] == pytest.approx(expected, rel=1e-9)
    assert np.isinf(table["bearing displacement, 84 % [m]"]).any()


def test_failures_are_counted_by_cause(store: Path, data: xr.Dataset) -> None:
    table = pd.read_csv(store / "campaign-failures.csv")
    status = pd.Series(data["status"].to_numpy()[data["status"].to_numpy() != "ok"])
    assert table.groupby("cause")["runs"].sum().to_dict() == status.value_counts().to_dict()
    assert set(table["counts as"]) == {"bearing failure"}
    first = data["scale"].to_numpy()[data["status"].to_numpy() != "ok"].min()
    assert table["from factor"].min() == first


def test_curves_are_those_of_the_runs_or_say_why_there_is_none(store, data):
    asked = fragility_in(store.parent / "strong.toml")
    assert asked is not None
    names = ["storey drift 0.5 %", "storey drift 40 %", "failure of a bearing"]
    assert [limit.name for limit in asked.limits()] == names
    motions = read_campaign(store.parent / "strong.toml").motions
    table = read_fragility(store)
    assert len(table) == 6
    curves = 0
    for model in ("LIR-DCFP", "DCFP"):
        chosen = {"model": model, "parameters": "all"}
        own = IntensityRuns.from_dataset(data, motions, asked.measured(), **chosen)
        for limit in asked.limits():
            row = table.loc[model, limit.name]
            drift = data["peak_drift"].max(set(data["peak_drift"].dims) - {"run"}).to_numpy()
            here = (data["model"] == model).to_numpy()
            lost = (data["status"] != "ok").to_numpy()[here]
            over = lost | (drift[here] > limit.limit) if limit.limit else lost
            assert (row["exceeded"], row["known"]) == (over.sum(), 16)
            if row["no curve"]:
                continue
            curves += 1
            curve = fragility_of(own, limit)
            assert float(row["median [m/s2]"]) == pytest.approx(curve.median, rel=1e-9)
    assert curves >= 1
    assert table.loc[("DCFP", "storey drift 40 %"), "no curve"]  # no run goes so far


def test_the_page_has_the_tables_figures_and_how_to_open_the_data(store: Path) -> None:
    text = (store / "campaign.html").read_text(encoding="utf-8")
    table = read_fragility(store)
    drawn = {name for (_, name), row in table.iterrows() if not row["no curve"]}
    assert text.count("<img src=") == 1 + len(drawn)
    for heading in ("What was run", "Runs that failed", "Responses", "Fragility", "The data"):
        assert f">{heading}</h2>" in text
    assert ">failed</td>" in text
    code = re.search(r"<pre>lir campaign-status.*?\n\n(.*?)</pre>", text, re.DOTALL)
    assert code is not None
    said = code[1].replace("&#34;", '"').replace("\\u0027", "'")
    exec(compile(said, "page", "exec"), {})  # noqa: S102  (what the page tells its reader to run)


def test_the_figure_shows_the_shares_that_failed(runs: dict[str, IntensityRuns]) -> None:
    figure = response_by_factor(runs)
    titles = [panel.get_title(loc="left") for panel in figure.axes]
    bars = figure.axes[titles.index("runs in which a bearing failed [%]")].patches
    heights = [bar.get_height() for bar in bars]
    expected = [
        100.0 * float((own.table["outcome"][own.table["scale"] == s] == "bearing failure").mean())
        for own in runs.values()
        for s in (0.6, 1.0, 1.2, 1.6)
    ]
    assert heights == pytest.approx(expected)
    none = figure.axes[titles.index("runs whose analysis failed [%]")].patches
    assert [bar.get_height() for bar in none] == [0.0] * 8


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[fragility]\n", "has no limit state"),
        ('[fragility]\nintensity = "Sa"\ndrift = [0.005]\n', "period goes with intensity"),
        (f"{AVERAGE}drift = [0.005]\n", "periods go with intensity"),
        (f'{AVERAGE}periods = ["3 s", "1 s"]\ndrift = [0.005]\n', "two or more that rise"),
        ("[fragility]\ndrift = [0.0]\n", "drift"),
        ("[fragility]\ndisplacement = [0.3]\n", "has no unit"),
        ("[fragility]\ndrifts = [0.005]\n", 'is "drift" meant?'),
    ],
)
def test_what_is_wrong_with_limit_states_is_told(store: Path, text: str, words: str) -> None:
    file = store.parent / "wrong.toml"
    file.write_text(STRONG + text)
    with pytest.raises(ProjectError) as told:
        read_campaign(file)
    assert words in str(told.value).replace("\n", " ")
