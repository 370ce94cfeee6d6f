"""Rolled shapes that a model only names, by the property files of ETABS and SAP2000."""

from __future__ import annotations

import contextlib
import random
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError
from frames.design._errors import ProjectError
from frames.exchange.properties import read_libraries
from tests import etabs_models
from tests.refusals import refused
from tests.unit.test_exchange_project import project

# the layout of these files; numbers of a W24X55 in inches, as in AISC's tables, and of an HEB 300
FILE = """<?xml version="1.0" encoding="utf-8" ?>
<PROPERTY_FILE xmlns="http://www.csiamerica.com">
  <CONTROL>
      <FILE_ID>CSI Frame Properties</FILE_ID>
      <LENGTH_UNITS>in</LENGTH_UNITS>
  </CONTROL>
  <STEEL_I_SECTION>
      <LABEL>W24X55</LABEL>
      <D>23.6</D>
      <BF>7.01</BF>
      <A>16.2</A>
      <AS2>9.322</AS2>
      <AS3>5.9</AS3>
      <I33>1350</I33>
      <I22>29.1</I22>
      <J>1.18</J>
  </STEEL_I_SECTION>
  <STEEL_BOX><LABEL>HSS8X8X1/2</LABEL><HT>8</HT><B>8</B><A>13.5</A><I33>125</I33><I22>125</I22>
  <J>204</J></STEEL_BOX>
</PROPERTY_FILE>
"""
INCH = 0.0254


def beams_of(shape: str) -> str:
    """Return the text of a building whose beams have a shape by its name."""
    lines = etabs_models.building(bays=(1, 1)).splitlines()
    at = next(k for k, line in enumerate(lines) if '"BEAM"' in line and "SHAPE" in line)
    lines[at] = f'  FRAMESECTION  "BEAM"  MATERIAL "C30"  SHAPE "{shape}"  I3MOD 0.5'
    return "\n".join(lines)


def files(tmp_path: Path, shape: str = "w24x55", library: str = FILE) -> tuple[Path, Path]:
    model, file = tmp_path / "model.e2k", tmp_path / "AISC14.xml"
    model.write_text(beams_of(shape), encoding="utf-8")
    file.write_text(library, encoding="utf-8")
    return model, file


def test_shapes_have_the_constants_of_their_library(tmp_path: Path) -> None:
    model, file = files(tmp_path)
    with pytest.raises(ModelError, match=r'is a "w24x55" without Area.*library=\["AISC14.xml"\]'):
        Frame.from_etabs(model)
    frame = Frame.from_etabs(model, library=file)
    beam = frame.members["X1-Story1"].section
    assert_allclose(beam.area, 16.2 * INCH**2)
    assert_allclose((beam.inertia_y, beam.inertia_z), (0.5 * 1350 * INCH**4, 29.1 * INCH**4))
    assert_allclose((beam.shear_area_z, beam.shear_area_y), (9.322 * INCH**2, 5.9 * INCH**2))
    assert_allclose(beam.torsion_constant, 1.18 * INCH**4)
    assert_allclose(beam.elastic_modulus, 30e9)
    assert "with the constants of the library: BEAM" in str(frame.imported)


def test_a_tube_has_its_depth_for_insertion_points(tmp_path: Path) -> None:
    shape = read_libraries(files(tmp_path)[1])["HSS8X8X1/2"]
    assert (shape.row.number("D"), shape.row.number("B"), shape.length) == (8.0, 8.0, INCH)
    assert "line 18" in shape.row.place


BAD = {
    "cut": (FILE[:400], r"AISC14.xml, line \d+ is not valid XML"),
    "encoding": (
        FILE.replace("utf-8", "utf-88", 1),
        r"AISC14.xml is not valid XML .unknown encoding: utf-88",
    ),
    "other": (
        "<html></html>",
        r"is not a property file of ETABS or SAP2000, which begins with PROPERTY",
    ),
    "units": (FILE.replace("UNITS>in", "UNITS>ell"), r"LENGTH_UNITS of MM, CM, M"),
    "number": (FILE.replace(">16.2<", ">many<"), r'line 7, table "STEEL_I_.*AREA = "many" is'),
    "unused": (FILE.replace("W24X55", "W24X56"), r'is a "w24x55" without Area'),
}


@pytest.mark.parametrize(("library", "message"), BAD.values(), ids=list(BAD))
def test_bad_libraries_are_refused(tmp_path: Path, library: str, message: str) -> None:
    model, file = files(tmp_path, library=library)
    refused(ModelError, message, Frame.from_etabs, model, library=file)


def test_mutated_libraries_end_in_shapes_or_messages(tmp_path: Path) -> None:
    path = tmp_path / "library.xml"
    for seed in range(500):
        rng = random.Random(seed)  # noqa: S311
        letters = list(FILE)
        for _ in range(rng.randint(1, 4)):
            letters[rng.randrange(len(letters))] = rng.choice('<>&x0"/\0\n')
        path.write_text("".join(letters), encoding="utf-8")
        with contextlib.suppress(ModelError):
            assert all(isinstance(label, str) for label in read_libraries(path))


def test_a_library_that_nothing_needs_is_refused(tmp_path: Path) -> None:
    model, file = files(tmp_path, shape="IPE300")
    for words, library in (
        ("no frame of model.e2k has a section that it names", file),
        ("none.xml cannot be read .No such file", tmp_path / "none.xml"),
    ):
        refused(ModelError, words, Frame.from_etabs, model, library=library)


def test_a_project_names_its_library(tmp_path: Path) -> None:
    own = 'kind = "etabs"\nfile = "model.e2k"\nlibrary = ["AISC14.xml"]'
    parts = project(tmp_path, own)
    files(tmp_path)
    assert_allclose(parts.frame().members["X1-Story1"].section.area, 16.2 * INCH**2)
    with pytest.raises(ProjectError, match="SAP2000 files have them"):
        project(tmp_path, own.replace("etabs", "sap2000"))
