"""Rolled shapes against what their catalogues print."""

import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import ModelError, Section
from frames.model.shapes import SERIES

INCH = 0.0254

# h, b, tf, tw, r [mm]; A [cm2], Iy, Iz, It [cm4], of ArcelorMittal, Sections and merchant bars
EUROPE = {
    "HEB 300": ((300, 300, 19, 11, 27), (149.1, 25170, 8563, 185.0)),
    "HEA 200": ((190, 200, 10, 6.5, 18), (53.83, 3692, 1336, 20.98)),
    "HEM 400": ((432, 307, 40, 21, 27), (325.8, 104100, 19340, 1515)),
    "IPE 300": ((300, 150, 10.7, 7.1, 15), (53.81, 8356, 603.8, 20.12)),
}
# d, bf, tf, tw, k [in]; A [in2], Ix, Iy, J [in4], of the AISC Steel Construction Manual, table 1-1
AMERICA = {
    "W14x90": ((14.0, 14.5, 0.710, 0.440, 1.31), (26.5, 999, 362, 4.06)),
    "W24x55": ((23.6, 7.01, 0.505, 0.395, 1.01), (16.2, 1350, 29.1, 1.18)),
}


def constants(section):
    return [getattr(section, x) for x in ("area", "inertia_y", "inertia_z", "torsion_constant")]


@pytest.mark.parametrize("name", EUROPE)
def test_european_shapes(name):
    sides, printed = EUROPE[name]
    found = constants(Section.rolled_i(*(1e-3 * x for x in sides)))
    assert_allclose(found * np.array([1e4, 1e8, 1e8, 1e8]), printed, rtol=2e-3)


@pytest.mark.parametrize("name", AMERICA)
def test_american_shapes(name):
    """They are printed with three figures of rounded dimensions."""
    (*sides, k), printed = AMERICA[name]
    found = constants(Section.rolled_i(*(INCH * x for x in (*sides, k - sides[2]))))
    units = [INCH**2, INCH**4, INCH**4, INCH**4]
    assert_allclose(found[:3] / np.array(units[:3]), printed[:3], rtol=1e-2)
    assert found[3] / units[3] == pytest.approx(printed[3], rel=0.05)


def test_fillets_by_counting_points():
    """Area and second moments, from a grid of a quarter of the shape."""
    d, b, tf, tw, r = 0.3, 0.2, 0.02, 0.012, 0.03
    n = 2100  # its cells end where web and flange do
    y, z = (side * (np.arange(n) + 0.5) / n for side in (0.5 * b, 0.5 * d))
    y, z = np.meshgrid(y, z, indexing="ij")
    inside = (z > 0.5 * d - tf) | (y < 0.5 * tw)
    centre = (0.5 * tw + r, 0.5 * d - tf - r)
    square = (y < centre[0]) & (z > centre[1])
    inside |= square & (np.hypot(y - centre[0], z - centre[1]) > r)
    cell = 0.25 * b * d / n**2
    expected = [4.0 * cell * values[inside].sum() for values in (np.ones((n, n)), z**2, y**2)]
    found = constants(Section.rolled_i(d, b, tf, tw, r))[:3]
    assert_allclose(found, expected, rtol=1e-5)
    welded = constants(Section.i_shape(d, b, tf, tw))[:3]
    assert_allclose(constants(Section.rolled_i(d, b, tf, tw, 0.0))[:3], welded, rtol=1e-12)


@pytest.mark.parametrize(
    ("sides", "words"),
    [
        ((300, 300, 19, 11, 27), "depth = 300 m, at most 100 m"),
        ((0.3, 0.3, 0.019, 0.011, -1), "at least 0"),
        ((0.3, 0.3, 0.15, 0.011, 0.0), "exceed the depth"),
        ((0.3, 0.05, 0.01, 0.01, 0.03), "exceed"),
    ],
)
def test_shapes_that_cannot_be(sides, words):
    with pytest.raises(ModelError, match=words):
        Section.rolled_i(*sides)


@pytest.mark.parametrize("series", SERIES)
def test_every_shape_of_the_catalogue(series):
    """Against the areas, second moments and masses that its own tables have."""
    tables = pytest.importorskip("steel_sections")
    rows = tables.series(series)
    assert len(rows) > 15
    for row in rows:
        section = Section.catalogue(row.section)
        found = np.array(constants(section)[:3]) * [1e4, 1e8, 1e8]
        printed = [row.area_cm2, row.iy_cm4, row.iz_cm4]
        assert_allclose(found, printed, rtol=2e-3, atol=0.06, err_msg=row.section)
        assert section.area * section.density == pytest.approx(row.mass_kg_m, rel=2e-3)


def test_names_of_the_catalogue():
    pytest.importorskip("steel_sections")
    assert Section.catalogue("he 300 b") == Section.catalogue("HEB300")
    assert_allclose(constants(Section.catalogue("HEB 300"))[3], 185e-8, rtol=2e-3)
    with pytest.raises(ModelError, match=r'no rolled shape "HEB 310".*did you mean'):
        Section.catalogue("HEB 310")
    softer = Section.catalogue("IPE 300", elastic_modulus=70e9, density=2700.0)
    assert (softer.elastic_modulus, softer.density) == (70e9, 2700.0)


def test_without_the_tables(monkeypatch):
    monkeypatch.setitem(sys.modules, "steel_sections", None)
    with pytest.raises(ImportError, match=r"lir-dcfp\[sections\].*Section.rolled_i"):
        Section.catalogue("HEB 300")
