"""A building of SAP2000 or ETABS in a project's file: loads by the code, and its account."""

from __future__ import annotations

from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from frames.design._errors import ProjectError
from frames.design.project import example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.structure_statement import structure_rows
from tests import etabs_models, sap2000_models


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
    whole, average = parts.loaded_frame(), parts.frame()
    assert whole.load_cases == ("D", "L")
    live = 2 * 60.0 * 3e3  # two floors of 60 m2
    assert_allclose(whole.check().weight - average.check().weight, 0.5 * live, rtol=1e-9)
    assert_allclose(whole.check().mass, average.check().mass, rtol=1e-12)
    rows = structure_rows(parts.file, average)
    assert ("import", f"of {file}") in rows
    assert any(what.startswith("read as") and "slabs in rigid" in how for what, how in rows)


def test_what_cannot_be_is_an_error_of_the_section(tmp_path: Path) -> None:
    with pytest.raises(ProjectError, match=r"file = model\.s3k is no file in"):
        project(tmp_path, 'kind = "sap2000"\nfile = "model.s3k"').frame()
    with pytest.raises(ProjectError, match=r'\[structure\] "CORE" is no group'):
        project(tmp_path, 'kind = "etabs"\nfile = "model.e2k"\nbearings_at = ["CORE"]').frame()
    with pytest.raises(ProjectError, match=r"mesh"):
        project(tmp_path, 'kind = "etabs"\nfile = "model.e2k"\nmesh = "-1 m"')


def test_types_of_bearings_by_groups_of_the_model(tmp_path: Path) -> None:
    parts = project(tmp_path, 'kind = "sap2000"\nfile = "model.s2k"')
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
    with pytest.raises(ProjectError, match="no column with a bearing"):
        typed("RIM").types()
