"""A campaign's file: what it becomes, messages, and its commands from an empty folder."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("filelock")

from scipy import stats
from typer.testing import CliRunner

from frames.command.app import app
from frames.design import MotionSet, ProjectError
from frames.design.project.source_files import SourceFiles
from frames.risk import Intensity, open_campaign, sobol_indices
from frames.risk.campaign.file import campaign_file, read_campaign
from lir_element.units import STANDARD_GRAVITY
from tests.refusals import refused
from tests.scenes import DEVICE

FILE = """
[campaign]
name = "Friction of two storeys"
devices = ["LIR-DCFP", "DCFP"]
[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["6 m", "600 cm"]
storey_mass = ["100 t", "100 t"]
storey_stiffness = ["400 kN/mm", "300 kN/mm"]
storey_height = "3 m"
base_mass = "100 t"
"""
FILE += DEVICE.replace("180 mm", "300 mm").replace("0.18", "0.2")
FILE += """[motions]
folder = "motions"
only = ["artificial-1"]
scales = [1.0, 1.5]
[parameters]
friction = {low = 0.04, high = "8 %"}
radius = {values = ["1500 mm", "2 m"]}
[sample]
kind = "latin hypercube"
size = 4
seed = 3
[analysis]
duration = "3 s"
workers = 1
"""
PULSES = 'pulses = {period_ratios = [0.5, 1.0], velocities = ["0.5 m/s", "80 cm/s"]}'
run = CliRunner().invoke


@pytest.fixture
def folder(tmp_path: Path, put_example: Callable[..., Path]) -> Path:
    """Motions of the example, and a campaign's file."""
    put_example(tmp_path)
    (tmp_path / "friction.toml").write_text(FILE)
    return tmp_path


def test_a_file_is_run_and_gone_on_with(folder: Path) -> None:
    file = str(folder / "friction.toml")
    first = run(app, ["campaign", "--no-figures", file])
    assert first.exit_code == 0, first.output
    assert "16 runs = 2 models x 4 sets of parameters x 1 motions x 2 scales" in first.output
    assert "16 of 16 runs done: 16 ok" in first.output
    status = run(app, ["campaign-status", str(folder / "friction-results")])
    assert status.exit_code == 0
    assert status.output.startswith("16 of 16 runs done: 16 ok")
    data = open_campaign(folder / "friction-results").results()
    friction = np.unique(data["friction"].to_numpy())
    assert sorted(((friction - 0.04) / 0.01).astype(int)) == [0, 1, 2, 3]
    assert sorted(np.unique(data["radius"].to_numpy())) == [1.5, 2.0]
    slip = data["peak_slip"].max("bearing")
    assert float(slip.where(data["model"] == "DCFP").max()) == 0.0
    again = run(app, ["campaign", "--no-figures", file])
    assert again.output.splitlines()[-1] == first.output.splitlines()[-1]
    (folder / "friction.toml").write_text(FILE.replace("seed = 3", "seed = 4"))
    other = run(app, ["campaign", file])
    assert other.exit_code == 2
    assert 'parameters: "friction" was' in other.output


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('low = 0.04, high = "8 %"', "low = 0.04", "parameters.friction: needs values = "),
        ('low = 0.04, high = "8 %"', "low = 0.09, high = 0.04", "friction: low = 0.09 must be"),
        ("size = 4\n", "", '"latin hypercube" needs a size'),
        ('"latin hypercube"', '"grid"', "leave size out"),
        ('"latin hypercube"\nsize = 4', '"grid"', "friction has a distribution"),
        ('"latin hypercube"\nsize = 4', '"sobol"\nsize = 5', "power of 2: 4 or 8"),
        ('"latin hypercube"', '"saltelli"', "radius has values: give low and high"),
        ("radius = {values", "rim_stiffness = {values", "not a unit of N/m"),
        ("radius = {values", "radius_factor = {values", "not a unit of a pure number"),
        ("radius = {values", "radios = {values", 'radios is not known; is "radius" meant?'),
        ('"1500 mm", "2 m"', "1.5", "has no unit"),
        ('"artificial-1"', '"artificial-99"', "artificial-99"),
        ('devices = ["LIR-DCFP", "DCFP"]', 'devices = ["FPS"]', "none of LIR-DCFP, DCFP"),
        ("1.0, 1.5", "1.0, 0.0", "scale of a motion must not be 0"),
        ("[sample]", "[samples]", "samples is not known"),
        ('folder = "motions"', PULSES.replace("]}", '], periods = ["3 s"]}'), "write one of both"),
        ('folder = "motions"', PULSES, "pulses, which their velocities scale"),
        ('folder = "motions"', f'folder = "motions"\n{PULSES}', "needs one source"),
        ("scales", "turned = [0, 0]\nscales", "turned: [0.0, 0.0] has a value twice"),
        ("scales", 'vertical = ["without"]\nscales', "no vertical component: use records"),
        (
            "scales",
            "repeated = {factors = [-1]}\nscales",
            "motions.repeated.factors.0 = -1 must be",
        ),
        ("storey_mass", "storey_masses", "storey_masses is not known"),
        ('name = "Friction of two storeys"\n', "", "campaign.name is missing"),
    ],
)
def test_messages_name_key_value_and_remedy(folder: Path, old: str, new: str, words: str) -> None:
    (folder / "friction.toml").write_text(FILE.replace(old, new, 1))
    found = run(app, ["campaign", str(folder / "friction.toml")])
    assert found.exit_code == 2
    assert words in found.output.replace("\n", " ")


def test_a_file_has_the_tables_of_those_that_it_is_based_on(folder: Path) -> None:
    """Sections are merged by keys; changes and messages name the file that a key is from."""
    name, base = (folder / f"{each}.toml" for each in ("friction", "building"))
    shared, own = FILE.split("[motions]")
    base.write_text(shared)
    own = '[campaign]\nname = "Higher"\n[bearing]\nslider_height = "210 mm"\n[motions]' + own
    name.write_text(f'based_on = "building.toml"\n{own}')
    found = campaign_file(name)
    (folder / "whole.toml").write_text(
        FILE.replace("Friction of two storeys", "Higher").replace('"200 mm"', '"210 mm"', 1)
    )
    expected = campaign_file(folder / "whole.toml").model_dump()
    assert found.model_dump() == expected | {"based_on": "building.toml"}
    assert f"\n# building.toml\n{shared}" in found.source.decode()
    sources = SourceFiles(found, folder)
    base.write_text(shared.replace("radius", "radios", 1))
    assert "building.toml was changed" in sources.changed()[0]
    refused(ProjectError, r"building.toml: bearing.radios is not known", campaign_file, name)
    for given in ("friction.toml", "../building.toml", "none.toml"):
        name.write_text(f'based_on = ["{given}"]\n{own}')
        refused(ProjectError, rf'n.toml: based_on = "{given}" .*name another', campaign_file, name)
    name.write_text(own.replace("[bearing]", 'based_on = "building.toml"\n[bearing]'))
    refused(ProjectError, "campaign.based_on .* before the first section", campaign_file, name)


def test_pulses_over_the_period_of_the_bearing(folder: Path) -> None:
    """Motions of 1 m/s, of which the velocities are the factors."""
    old = 'folder = "motions"\nonly = ["artificial-1"]\nscales = [1.0, 1.5]'
    (folder / "friction.toml").write_text(FILE.replace(old, f'{PULSES}\ntail = "2 s"'))
    made = read_campaign(folder / "friction.toml")
    period = 2.0 * np.pi * np.sqrt((3.0 - 0.2) / STANDARD_GRAVITY)
    assert list(made.motions) == [
        f"symmetric pulse of {share * period:.4g} s, 1 m/s" for share in (0.5, 1.0)
    ]
    assert [motion.duration for motion in made.motions.values()] == pytest.approx(
        [period + 2.0, 2.0 * period + 2.0], abs=0.02
    )
    assert "2 motions x 2 scales" in repr(made)
    assert "0.5, 0.8" in made._repr_html_()


def test_a_second_shock_is_scaled_by_the_first(folder: Path) -> None:
    """Turned, and followed by the next, which has the intensity of its own first shock."""
    asked = """turned = [0, 90]
repeated = {factors = [0, 0.5], following = "next", gap = "3 s"}
intensities = ["2 m/s2"]
[fragility]
intensity = "PGA"
bearing_failure = true
"""
    text = FILE.replace('only = ["artificial-1"]', 'only = ["artificial-1", "artificial-2"]')
    (folder / "friction.toml").write_text(text.replace("scales = [1.0, 1.5]\n", asked))
    motions = read_campaign(folder / "friction.toml").motions
    assert len(motions) == 2 * 2 * 2
    assert isinstance(motions, MotionSet)
    sources = [facts["made_from"] for facts in motions.facts.values()]
    assert sources == ["artificial-1"] * 4 + ["artificial-2"] * 4
    measure = Intensity(kind="PGA")
    for name in ("artificial-1", "artificial-1, 90 degrees"):
        assert measure.of(motions[name]) == pytest.approx(1.0)
    both = motions["artificial-1, 90 degrees, then 0.5 artificial-2"]
    first = motions["artificial-1, 90 degrees"]
    second = both.trimmed(first.duration + 3.0 + 0.5 * both.dt)
    assert measure.of(second) == pytest.approx(0.5)


def test_a_bad_file_of_motions_is_named(folder: Path) -> None:
    table = (folder / "motions/motions.csv").read_text()
    row = next(line for line in table.splitlines() if line.startswith("artificial-1,"))
    name = row.split(",")[1]
    (folder / "motions" / name).write_text("0.1\nnan\nwhat\n")
    refused(ProjectError, name, read_campaign, folder / "friction.toml")


def test_distributions_are_those_of_the_file(folder: Path) -> None:
    text = FILE.replace(
        'friction = {low = 0.04, high = "8 %"}',
        'friction = {low = 0.03, high = 0.09, distribution = "normal", mean = 0.06, '
        'deviation = 0.01}\ncapacity = {low = "200 mm", high = "400 mm", distribution = '
        '"loguniform"}\naxial_stiffness = {values = ["90 kN/mm"]}\n'
        "rim_overrun_factor = {values = [0.5]}",
    ).replace("size = 4", "size = 64")
    (folder / "friction.toml").write_text(text)
    sample = read_campaign(folder / "friction.toml")._work.plan.sample
    assert sample is not None
    columns = dict(zip(sample.names, sample.values.T, strict=True))
    assert {*columns["axial_stiffness"]} == {9e7}
    assert {*columns["rim_overrun_factor"]} == {0.5}
    normal = stats.norm(0.06, 0.01)
    cut = normal.cdf([0.03, 0.09])
    shares = (normal.cdf(columns["friction"]) - cut[0]) / (cut[1] - cut[0])
    assert sorted((shares * 64.0).astype(int)) == list(range(64))
    logs = np.log2(columns["capacity"] / 0.2)
    assert sorted((logs * 64.0).astype(int)) == list(range(64))


def test_a_frame_with_loads(folder: Path) -> None:
    """Half of the live load weighs, and what the file says is mass."""
    text = (
        FILE.partition("[structure]")[0]
        + """
[structure]
kind = "moment frame"
bays = [1, 1]
bay_width = ["6 m", "5 m"]
storeys = 1
storey_height = "3 m"
columns = ROUND
beams = ROUND
base_beams = ROUND
[loads]
dead = "5 kN/m2"
live = "2 kN/m2"
snow = "1 kN/m2"
mass = { dead = 1.0, live = 0.25 }
[bearing]"""
        + FILE.partition("[bearing]")[2]
    )
    round_ = '{ circle = "500 mm", material = { E = "30 GPa", nu = 0.2, density = "0 kg/m3" } }'
    (folder / "loads.toml").write_text(text.replace("ROUND", round_))
    checked = read_campaign(folder / "loads.toml")._work.build("LIR-DCFP", 0).check()
    assert checked.carried == pytest.approx(2 * 30.0 * (5e3 + 0.5 * 2e3))
    assert checked.mass == pytest.approx(2 * 30.0 * (5e3 + 0.25 * 2e3) / 9.80665)


def test_a_file_with_saltellis_sets_has_indices(folder: Path) -> None:
    text = FILE
    for old, new in (
        ('"latin hypercube"\nsize = 4', '"saltelli"\nsize = 8'),
        ('radius = {values = ["1500 mm", "2 m"]}', "modal_damping = {low = 0, high = 0.1}"),
        ('["artificial-1"]', '["artificial-1", "artificial-2"]'),
        ("1.0, 1.5", "1.0"),
    ):
        text = text.replace(old, new)
    (folder / "sets.toml").write_text(text.replace('"LIR-DCFP", "DCFP"', '"DCFP"'))
    done = run(app, ["campaign", "--no-figures", str(folder / "sets.toml")])
    assert done.exit_code == 0, done.output
    assert "64 runs = 1 models x 32 sets" in done.output
    store = folder / "sets-results"
    table = pd.read_csv(store / "campaign-indices.csv")
    own = table[table["quantity"] == "bearing displacement"].set_index("parameter")
    given = {"friction": stats.uniform(0.04, 0.04), "modal_damping": stats.uniform(0.0, 0.1)}
    found = sobol_indices(open_campaign(store), given, samples=8, seed=3, widest=9.0)
    for name in given:
        assert own.loc[name, "share of"] == "variance within records"
        assert own.loc[name, "total, high [-]"] == pytest.approx(
            found.table.loc[name, "total, high"]
        )
    assert own.loc["record", "share of"] == "whole variance"
    assert "not known (" in (store / "campaign.html").read_text()
