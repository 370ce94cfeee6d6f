"""A building of SAP2000 or ETABS in a project's file: loads by the code, and its account."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from frames import Frame, ModelWarning
from frames.command.app import app
from frames.command.console import BAD_INPUT
from frames.design._errors import ProjectError
from frames.design.project import example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.source_files import TOLD
from frames.design.project.structure_statement import structure_rows
from tests import etabs_models, sap2000_models
from tests.refusals import refused
from tests.unit.test_exchange_etabs_links import LINKS, isolator, model

ETABS = 'kind = "etabs"\nfile = "model.e2k"'


def project(tmp_path: Path, structure: str) -> ProjectInputs:
    (tmp_path / "model.e2k").write_text(etabs_models.building(), encoding="utf-8")
    tables = sap2000_models.building()
    (tmp_path / "model.s2k").write_text(sap2000_models.text(tables), encoding="utf-8")
    text = (Path(example.__file__).parent / "examples" / "example.toml").read_text(encoding="utf-8")
    path = tmp_path / "project.toml"
    before, rest = text.split("[structure]", 1)
    after = rest[rest.index("[superstructure]") :]
    path.write_text(f"{before}[structure]\n{structure}\n\n{after}", encoding="utf-8")
    return ProjectInputs(read_project(path), tmp_path)


@pytest.mark.parametrize(("kind", "file"), [("etabs", "model.e2k"), ("sap2000", "model.s2k")])
def test_cases_are_in_full_and_combined_by_the_code(tmp_path: Path, kind: str, file: str) -> None:
    parts = project(tmp_path, f'kind = "{kind}"\nfile = "{file}"')
    whole = parts.loaded_frame()
    (tmp_path / file).unlink()  # a model is read once
    average = parts.frame()
    assert whole.load_cases == ("D", "L")
    live = 2 * 60.0 * 3e3  # two floors of 60 m2
    assert_allclose(whole.check().weight - average.check().weight, 0.5 * live, rtol=1e-9)
    assert_allclose(whole.check().mass, average.check().mass, rtol=1e-12)
    rows = structure_rows(parts.file, average)
    assert ("import", f"of {file}") in rows
    assert any(what.startswith("read as") and "slabs in rigid" in how for what, how in rows)


@pytest.mark.parametrize(
    ("structure", "words"),
    [
        ('kind = "sap2000"\nfile = "model.s3k"', r"file = model\.s3k is not in"),
        (f'{ETABS}\nbearings_at = ["CORE"]', r'\[structure\] "CORE" is not a group'),
        (f'{ETABS}\nmesh = "-1 m"', "mesh"),
    ],
)
def test_what_cannot_be_is_an_error_of_the_section(tmp_path, structure, words):
    refused(ProjectError, words, lambda: project(tmp_path, structure).frame())


def test_remedies_speak_the_language_of_the_file_and_cure(tmp_path: Path) -> None:
    model = tmp_path / "model.e2k"

    def read(text: str, more: str = "") -> str:
        parts = project(tmp_path, f"{ETABS}\n{more}")
        model.write_text(text, encoding="utf-8")
        try:
            parts.frame()
        except ProjectError as error:
            return str(error)
        return ""

    whole = etabs_models.building()
    hinge = whole.replace("$ MASS", '$ MORE\n  HINGEASSIGN "C1" "Story1"\n\n$ MASS', 1)
    said = {
        whole.replace("  MASSSOURCE  ", "  MASSSAUCE  "): 'mass = { "Dead" = 1.0, "Live" = 0.25 }',
        hinge: 'allow = ["hinges"]',
        whole.replace("HEIGHT 3.0", "HEIGHT 3,0"): 'decimal = ","',
        whole.replace("RESTRAINT", "RESTRAINED"): 'bearings_at = ["1-Base", "2-Base", ',
    }
    for text, remedy in said.items():
        assert remedy in read(text)
        line = f"{remedy.rstrip(', ')}{']' if remedy.startswith('bear') else ''}"
        if remedy.startswith("decimal"):
            text = text.replace(".", ",")
            text = text.replace("21,0,0", "21.0.0").replace("model,e2k", "model.e2k")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # words that were misspelled
            found = read(text, line)
        assert "is not a number" not in found if remedy.startswith("decimal") else not found


def test_sections_of_a_catalogue_have_the_constants_of_the_file(tmp_path: Path) -> None:
    own = 'sections = { "BEAM" = { i_shape = ["600 mm", "220 mm", "19 mm", "12 mm"] } }'
    parts = project(tmp_path, f"{ETABS}\n{own}")
    path = tmp_path / "model.e2k"
    lines = path.read_text(encoding="utf-8").splitlines()
    at = next(k for k, line in enumerate(lines) if '"BEAM"' in line and "SHAPE" in line)
    lines[at] = '  FRAMESECTION  "BEAM"  MATERIAL "C30"  SHAPE "W24X62"  FILE "AISC14"'
    path.write_text("\n".join(lines), encoding="utf-8")
    frame = parts.frame()
    beam = frame.members["X1-Story1"].section
    area = 2 * 220.0 * 19.0 + (600.0 - 2 * 19.0) * 12.0  # mm2
    assert_allclose(beam.area, area * 1e-6)
    assert_allclose(beam.elastic_modulus, 30e9)
    assert ("FRAME SECTIONS", "with the constants given") in {
        (entry.table, entry.what) for entry in frame.imported.entries
    }
    rolled = [line.replace("W24X62", "IPE600") for line in lines]
    path.write_text("\n".join(rolled), encoding="utf-8")
    plain = project_of(parts, tmp_path, sections={}).frame()
    assert_allclose(plain.members["X1-Story1"].section.area, 156e-4, rtol=5e-3)  # of the tables
    path.write_text("\n".join(lines), encoding="utf-8")
    words = r'"W24X62" without Area.*sections = \{ "BEAM"'
    refused(ProjectError, words, project_of(parts, tmp_path, sections={}).frame)
    other = parts.file.structure.sections | {"BEAN": parts.file.structure.sections["BEAM"]}
    words = r'no frame of model.e2k has a section "BEAN"'
    refused(ProjectError, words, project_of(parts, tmp_path, sections=other).frame)
    tables = f'kind = "sap2000"\nfile = "model.s2k"\n{own}'
    refused(ProjectError, "SAP2000 files have them", project, tmp_path, tables)


def project_of(parts: ProjectInputs, folder: Path, **changes: object) -> ProjectInputs:
    structure = parts.file.structure.model_copy(update=changes)
    return ProjectInputs(parts.file.model_copy(update={"structure": structure}), folder)


def test_types_of_bearings_by_groups_of_the_model(tmp_path: Path) -> None:
    parts = project(tmp_path, 'kind = "sap2000"\nfile = "model.s2k"')
    said: list[str] = []
    token = TOLD.set(said.append)
    parts.frame()
    TOLD.reset(token)
    assert len(said) == 1  # read once, and said before it is
    assert re.fullmatch(r"reading .*model\.s2k, a model of SAP2000 \(\d+\.\d MB\)", said[0])
    joints = [name.removeprefix("bearing-") for name in parts.frame().bearings]
    tables = sap2000_models.building()
    groups = {"CORE": joints[:2], "EMPTY": []}
    tables["GROUPS 1 - DEFINITIONS"] = [{"GroupName": name} for name in groups]
    tables["GROUPS 2 - ASSIGNMENTS"] = [
        {"GroupName": name, "ObjectType": "Joint", "ObjectLabel": label}
        for name, labels in groups.items()
        for label in labels
    ]
    (tmp_path / "model.s2k").write_text(sap2000_models.text(tables), encoding="utf-8")
    path = tmp_path / "project.toml"
    plain = path.read_text(encoding="utf-8")

    def typed(columns: str) -> ProjectInputs:
        own = f'[bearings.inner]\ncolumns = ["{columns}"]\nfriction = 0.07\n\n[bounds]'
        path.write_text(plain.replace("[bounds]", own, 1), encoding="utf-8")
        return ProjectInputs(read_project(path), tmp_path)

    parts = typed("CORE")
    assert [kind for kind in parts.types().values()][:3] == ["inner", "inner", "standard"]
    device = parts.frame().bearings[f"bearing-{joints[1]}"].bearing
    assert device.frictions[0].f_max == 0.07
    refused(ProjectError, "not a column with a bearing", lambda: typed("RIM").types())


def test_types_of_bearings_by_groups_of_links(tmp_path: Path) -> None:
    parts = project(tmp_path, 'kind = "etabs"\nfile = "model.e2k"\nbearings_at = ["FP"]')
    groups = ['  GROUP "CORE"  LINK "K1"', '  GROUP "CORE"  LINK "K3"']
    model(tmp_path, isolator(), [*LINKS, *groups])
    own = '[bearings.inner]\ncolumns = ["CORE"]\nfriction = 0.07\n\n[bounds]'
    path = tmp_path / "project.toml"
    path.write_text(path.read_text(encoding="utf-8").replace("[bounds]", own, 1), encoding="utf-8")
    parts = ProjectInputs(read_project(path), tmp_path)
    assert list(parts.types().values()) == ["inner", "standard", "inner", "standard"]


@pytest.mark.parametrize("program", ["etabs", "sap2000"])
def test_export_hands_over_what_another_program_confirms(tmp_path, put_example, program):
    """Links add up to the code's stiffness and damping; the spectrum gives its displacement."""
    put_example(tmp_path, "EN 1998", whole=True)
    out = tmp_path / "out"
    told = ["export", str(tmp_path / "project.toml"), "--to", program, "--results", str(out)]
    done = CliRunner().invoke(app, told)
    assert done.exit_code == 0, done.output
    links, spectrum, rows = (
        pd.read_csv(out / f"{name}.csv") for name in ("links", "spectrum", "expected")
    )
    for bound, own in links.groupby("bound"):
        said = rows[rows["bound"] == bound].set_index("quantity")["value"]
        total, d = said["shear of the isolation system [N]"], said["displacement [m]"]
        assert_allclose(own["effective stiffness [N/m]"].sum() * d, total, rtol=1e-9)
        shares = own["damping ratio [-]"] * own["effective stiffness [N/m]"]
        damping = shares.sum() / own["effective stiffness [N/m]"].sum()
        assert_allclose(damping, said["effective damping [-]"], rtol=1e-9)
        period = said["effective period [s]"]
        ordinate = np.interp(period, spectrum["period [s]"], spectrum[f"{bound} [m/s2]"])
        assert_allclose(ordinate * (period / (2.0 * np.pi)) ** 2, d, rtol=5e-3)
        short = spectrum["period [s]"] < 0.79 * period
        columns = (f"{bound} [m/s2]", "5 % [m/s2]")
        assert_allclose(*(spectrum[name][short] for name in columns))
    read = Frame.from_etabs if program == "etabs" else Frame.from_sap2000
    suffix = "e2k" if program == "etabs" else "s2k"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = read(out / f"model-upper.{suffix}")
    assert len(again.bearings) == len(own)


def test_export_refuses_other_programs(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["export", str(tmp_path), "--to", "robot"])
    assert "etabs, sap2000" in done.output.replace("'", "")


def test_a_project_begins_with_a_model(tmp_path: Path) -> None:
    """`lir new --from` copies the model; what `lir design` lacks is said with its remedy."""
    model = tmp_path / "tower.e2k"
    model.write_text(etabs_models.building(), encoding="utf-8")
    folder, run = tmp_path / "project", CliRunner().invoke
    made = run(app, ["new", str(folder), "--from", str(model)])
    assert made.exit_code == 0, made.output
    path = folder / "project.toml"
    text = path.read_text(encoding="utf-8")
    assert 'name = "tower"' in text
    parts = ProjectInputs(read_project(path), folder)  # its supports hold rotations in the file
    assert not parts.system(parts.provisional_frame(), parts.spectrum()).unknown_loads
    remedy = 'base_rotations = "free"'
    path.write_text(text.replace(f"\n{remedy}", f"\n# {remedy}"), encoding="utf-8")
    held = run(app, ["design", str(path), "--results", str(tmp_path / "one")])
    assert held.exit_code == BAD_INPUT
    assert held.output.count(remedy) == 1


@pytest.mark.parametrize(
    ("told", "said"),
    [
        (["--from", "none.e2k"], r"none\.e2k must be a text file exported from SAP2000 or ETABS"),
        (["--from", "a.dwg"], r"\.e2k, \.\$et, \.s2k"),
        (["--from", "a.e2k", "--example", "office"], "leave one out"),
    ],
)
def test_what_is_no_model_is_refused(tmp_path: Path, told: list[str], said: str) -> None:
    done = CliRunner().invoke(app, ["new", str(tmp_path / "p"), *told])
    assert done.exit_code == BAD_INPUT
    assert re.search(said, done.output)
