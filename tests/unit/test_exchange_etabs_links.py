"""Links of ETABS' text: between points and under them, as bearings, springs, gaps and springs that
yield; words that are not known are refused where they count.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, gravity
from frames._errors import in_project_file
from frames.demo import bearing_for
from frames.exchange.links import SLIDER_HEIGHT
from frames.model.laws import Bilinear, Gap
from tests import etabs_models
from tests.refusals import refused

G = 9.80665
FRICTION = {"KE": 900.0, "CE": 20.0, "K": 20e3, "CSLOW": 0.03, "CFAST": 0.06}


def isolator(units: tuple[str, str] = ("KN", "M"), kind: str = "FRICTION ISOLATOR") -> list[str]:
    """Return a pendulum of 2.4 m, Q/W from 0.03 to 0.06, rate 40 s/m; stiffness in kN/m."""
    force, one = etabs_models.UNITS[units[0]] / 1e3, etabs_models.UNITS[units[1]]
    line = [
        f'  LINKPROP  "FP"  TYPE "{kind}"  MASS {0.5 / (force / one)!r} WEIGHT {4.9 / force!r} '
    ]
    line += ['  LINKPROP  "FP"  DOF "U1 U2 U3"  ']
    axial = 1e6 / (force / one)
    line += [f'  LINKPROP  "FP"  U1NONLIN "Yes"  U1KE {axial!r} U1K {axial!r}']
    for dof in ("U2", "U3"):
        parts = {
            word: value / (force / one) if word in {"KE", "CE", "K"} else value
            for word, value in FRICTION.items()
        }
        parts |= {"RATE": 40.0 * one, "RADIUS": 2.4 / one}
        text = "  ".join(f"{dof}{word} {value!r}" for word, value in parts.items())
        line.append(f'  LINKPROP  "FP"  {dof}NONLIN "Yes"  {text}')
    return line


def model(
    tmp_path: Path,
    prop: list[str],
    links: list[str],
    units: tuple[str, str] = ("KN", "M"),
    points: tuple[str, ...] = (),
    assign: str | None = None,
) -> Path:
    """Return the file of one bay on links; supports stand 0.3 m below the columns, or as said."""
    text = etabs_models.building(units, bays=(1, 1))
    one = etabs_models.UNITS[units[1]]
    below = [f'  POINT "10{k}"  {x / one!r} {y / one!r} {0.3 / one!r} ' for k, x, y in PLAN]
    text = text.replace(
        "\n\n$ LINE CONN", "\n" + "\n".join([*below, *points]) + "\n\n$ LINE CONN", 1
    )
    for k, _, _ in PLAN:
        held = f'  POINTASSIGN  "{k}"  "Base"  RESTRAINT "UX UY UZ RX RY RZ"'
        assert held in text
        new = held.replace(f'"{k}"', f'"10{k}"') if assign is None else assign.format(k=k)
        text = text.replace(held, new, 1)
    more = ["$ LINK PROPERTIES", *prop, "", "$ LINK CONNECTIVITIES", *links, "", "$ MASS SOURCE"]
    text = text.replace("$ MASS SOURCE", "\n".join(more), 1)
    path = tmp_path / "model.e2k"
    path.write_text(text, encoding="utf-8")
    return path


PLAN = ((1, 0.0, 0.0), (2, 6.0, 0.0), (3, 0.0, 5.0), (4, 6.0, 5.0))
LINKS = [f'  LINK  "K{k}"  POINT  "Base"  "10{k}"  POINT  "Base"  "{k}"' for k, _, _ in PLAN]
LINKS += [f'  LINKASSIGN  "K{k}"  PROPERTY  "FP"' for k, _, _ in PLAN]


@pytest.mark.parametrize("units", [("KN", "M"), ("KIP", "IN")])
def test_friction_isolators_are_bearings_of_their_radius_and_friction(tmp_path, units):
    frame = Frame.from_etabs(model(tmp_path, isolator(units), LINKS, units))
    assert list(frame.bearings) == ["K1", "K2", "K3", "K4"]
    part = frame.bearings["K2"]
    assert (part.i, part.j) == ("102-Base", "2-Base")  # plates fill the height of the link
    assert_allclose(part.bearing.height, 0.3)
    forces = dict(zip(frame.bearings, gravity(frame).axial_forces, strict=True))
    slid = 0.06 * forces["K2"] / 20e6 / (2.5 / 2.4)  # strength over the stiffness before sliding
    assert_allclose(part.bearing.yield_displacement, slid, rtol=2e-2)
    bearing = part.bearing
    assert_allclose(bearing.effective_radius, 2.4)
    assert_allclose(bearing.radii, 0.5 * (2.4 + SLIDER_HEIGHT))
    assert_allclose(bearing.to_record()["axial_stiffness"], 1e9)
    law = bearing.frictions[0]
    for speed in (0.0, 0.01, 0.05, 1.0):  # Q/W = fast - (fast - slow) exp(-rate v)
        share = bearing.radii[0] / 2.4
        own = 2.0 * share * law.at_speed(speed * share)
        assert_allclose(own, 0.06 - 0.03 * np.exp(-40.0 * speed), rtol=1e-9)
    assert "friction isolators, as DCFP of the same radius" in str(frame.imported)


def test_bearings_stand_where_groups_say(tmp_path: Path) -> None:
    lines = ['  GROUP "All"', '  GROUP "CORE"  COLOR "Red"', '  GROUP "CORE" LINK "K1"']
    lines += ['  GROUP "CORE"  LINK "K4"', '  GROUP "EDGE"  POINT "1"  "Story1"']
    lines += ['  GROUP "ODD"  POINT "1"', '  GROUP "ODD"  LINK "K9"']
    path = model(tmp_path, isolator(), [*LINKS, *lines])
    core = bearing_for(900e3)
    frame = Frame.from_etabs(path, {"CORE": core})
    assert [name for name, part in frame.bearings.items() if part.bearing == core] == ["K1", "K4"]
    assert frame.imported is not None
    groups = {"All": (), "CORE": ("K1", "K4"), "EDGE": ("1-Story1",), "ODD": ()}
    assert frame.imported.groups == groups
    assert "on lines of another form: bearings are not placed by them: ODD" in str(frame.imported)
    words = r'"EDGE" of model.e2k has no restrained joint and no link'
    refused(ModelError, words, Frame.from_etabs, path, core, at=["EDGE"])


def test_half_of_a_link_s_weight_and_mass_is_at_each_of_its_joints(tmp_path: Path) -> None:
    free = [line.replace("MASS 0.5 WEIGHT 4.9", "MASS 0 WEIGHT 0") for line in isolator()]
    without = Frame.from_etabs(model(tmp_path, free, LINKS))
    frame = Frame.from_etabs(model(tmp_path, isolator(), LINKS))
    for k in range(1, 5):
        name = f"{k}-Base"
        assert_allclose(frame.masses[name][0] - without.masses[name][0], 250.0)
        assert_allclose(frame.loads[name][2], -2450.0)
        assert name not in without.loads


def test_a_given_bearing_stands_in_place_of_links_whatever_their_words(tmp_path: Path) -> None:
    prop = [*isolator(kind="TRIPLE PENDULUM ISOLATOR"), '  LINKPROP  "FP"  U2RADIUSOUTERTOP 2']
    path = model(tmp_path, prop, LINKS)
    frame = Frame.from_etabs(path, {"FP": bearing_for(400e3)})
    assert {part.bearing for part in frame.bearings.values()} == {bearing_for(400e3)}
    words = r"(?s)U2RADIUSOUTERTOP.*allow=\[\"link properties\", \"nonlinear links\"\]"
    refused(ModelError, words, Frame.from_etabs, path)


def test_points_stand_on_links(tmp_path: Path) -> None:
    spring = '  POINTSPRING  "S1"  STIFFNESSOPTION "LINKS"  LINKPROP "FP"  AXIALDIR "Z"  ANGLE 0'
    assign = '  POINTASSIGN  "{k}"  "Base"  SPRINGPROP "S1"'
    group = '  GROUP "ISO"  POINT "3"  "Base"'
    path = model(tmp_path, [*isolator(), spring], [group], assign=assign)
    other = bearing_for(900e3)
    named = Frame.from_etabs(path, {"ISO": other}).bearings
    assert [name for name, part in named.items() if part.bearing == other] == ["link-3-Base"]
    frame = Frame.from_etabs(path)
    assert list(frame.bearings) == [f"link-{k}-Base" for k in range(1, 5)]
    assert not frame.springs
    height = frame.bearings["link-1-Base"].bearing.height
    assert_allclose(frame.nodes["ground-link-1-Base"].z, -height)
    path.write_text(path.read_text(encoding="utf-8").replace('AXIALDIR "Z"', 'AXIALDIR "X"'))
    words = r"springs of points by links along X.*allow=\[\"links\"\]"
    refused(ModelError, words, Frame.from_etabs, path)


LINEAR = ['  LINKPROP  "FP"  TYPE "LINEAR"  ', '  LINKPROP  "FP"  DOF "U1 U2 U3"  ']
KINDS = [
    '  LINKPROP  "FP"  TYPE "{}"  ',
    '  LINKPROP  "FP"  DOF "U1 U2 U3"  FIXED "U1"  ',
    '  LINKPROP  "FP"  U2KE 800 U2NONLIN "Yes"  U2K 5000 U2YIELD 40 U2KRATIO 0.1 U2OPEN 0.05',
    '  LINKPROP  "FP"  U3KE 700 U3CE 30 ',
]


def test_rubber_isolators_gaps_and_linear_links(tmp_path: Path) -> None:
    def read(kind: str) -> Frame:
        return Frame.from_etabs(model(tmp_path, [KINDS[0].format(kind), *KINDS[1:]], LINKS))

    frame = read("RUBBER ISOLATOR")
    law = frame.links["K1-U2"].law
    assert isinstance(law, Bilinear)
    assert (law.stiffness, law.yield_force, law.hardening) == (5e6, 40e3, 0.1)
    assert_allclose(np.abs(frame.links["K1-U2"].direction), (1.0, 0.0, 0.0), atol=1e-12)
    assert_allclose(frame.springs["K1-U3"].stiffness, (0, 7e5, 0, 0, 0, 0))
    assert frame.superelements["K1-fixed"].nodes == ("101-Base", "1-Base")
    yielding = [prop.replace("U3KE 700 U3CE 30", "U3NONLIN YES U3K 5 U3YIELD 1") for prop in KINDS]
    lines = [yielding[0].format("RUBBER ISOLATOR"), *yielding[1:]]
    account = str(Frame.from_etabs(model(tmp_path, lines, LINKS)).imported)
    assert "each of their directions for itself: K1, K2, K3, K4" in account  # each once
    law = read("GAP").links["K1-U2"].law
    assert isinstance(law, Gap)
    assert (law.stiffness, law.gap) == (5e6, 0.05)
    assert_allclose(read("LINEAR").springs["K1-U2"].stiffness, (8e5, 0, 0, 0, 0, 0))
    words = r'links of kind "DAMPER - EXPONENTIAL", by their linear'
    refused(ModelError, words, read, "DAMPER - EXPONENTIAL")


def test_a_linear_link_has_its_stiffness_as_the_program_writes_it(tmp_path: Path) -> None:
    prop = [f'  LINKPROP  "FP"  U{k}STIFF {900 + k} ' for k in (1, 2, 3)]
    frame = Frame.from_etabs(model(tmp_path, [*LINEAR, *prop], LINKS))
    assert_allclose(frame.springs["K4-U1"].stiffness, (0, 0, 901e3, 0, 0, 0))
    assert_allclose(frame.springs["K4-U3"].stiffness, (0, 903e3, 0, 0, 0, 0))


def test_the_shear_spring_stands_where_the_file_has_it(tmp_path: Path) -> None:
    # U2 of 900 kN/m at DJ below joint j: a shear V makes the moments V DJ above, V (h - DJ) below
    for away in (0.0, 0.15, 0.3):
        prop = [f'  LINKPROP  "FP"  U{k}STIFF 900 U{k}DJ {away} ' for k in (1, 2, 3)]
        frame = Frame.from_etabs(model(tmp_path, [*LINEAR, *prop], LINKS))
        spring = frame.springs["K1-U2"]
        assert_allclose(frame.nodes[spring.j].z, frame.nodes["1-Base"].z - away, atol=1e-12)
        assert ("K1-U2-place" in frame.nodes) == (away > 0.0)
        if away:
            tie = frame.superelements["K1-U2-place-fixed"]
            assert tie.nodes == ("1-Base", "K1-U2-place")
            rigid = np.zeros(12)  # a turn about y moves the lower end along x
            rigid[[4, 10]], rigid[6] = 1.0, -away
            assert_allclose(tie.equations @ rigid, 0.0, atol=1e-12)


@pytest.mark.parametrize("parallel", [False, True])
def test_a_given_bearing_has_plates_that_fill_the_link(tmp_path: Path, parallel: bool) -> None:
    links = LINKS
    if parallel:  # two links between the same joints
        links = [*links, links[0].replace("K1", "K9"), links[4].replace("K1", "K9")]
    else:  # on a pedestal
        pedestal = '  LINE  "P1"  BEAM  "101"  "102"  0\n\n$ AREA CONN'
        assign = '  LINEASSIGN  "P1"  "Base"  SECTION "BEAM"\n\n$ AREA ASS'
    path = model(tmp_path, isolator(), links)
    if not parallel:
        text = path.read_text(encoding="utf-8").replace("$ AREA CONN", pedestal, 1)
        path.write_text(text.replace("$ AREA ASS", assign, 1), encoding="utf-8")
    device = replace(bearing_for(400e3), slider_height=0.2)
    message = r"plates fill the height of the link, plate_thickness=0.05 of the bearing"
    refused(ModelError, message, Frame.from_etabs, path, {"FP": device})
    with in_project_file():
        refused(ModelError, "0.05 m", Frame.from_etabs, path, {"FP": device})
    frame = Frame.from_etabs(path, {"FP": replace(device, plate_thickness=0.05)})
    assert frame.bearings["K1"].i == "101-Base"
    assert len(Frame.from_etabs(path).bearings) == len(links) // 2  # the assumed ones fit


def replaced(old: str, new: str) -> list[str]:
    return [line.replace(old, new) for line in isolator()]


LACKING = r"of a LINKPROP \({}\).*allow=\[\"links\"\]"
WEN = [KINDS[0].format("PLASTIC (WEN)"), KINDS[1], KINDS[2].replace("YIELD 40", "YIELD 0")]
BAD = {
    "no property": ([], LINKS, LACKING.format("K1, K2, K3, K4")),
    "no assignment": (isolator(), LINKS[:6], LACKING.format("K3, K4")),
    "no such point": (isolator(), [LINKS[0].replace("101", "777"), *LINKS[1:]], r"\(K1\)"),
    "twice": (isolator(), [LINKS[0], *LINKS], r'link "K1" occurs twice'),
    "no radius": (replaced("U3RADIUS 2.4", "U3RADIUS 0"), LINKS, "must have one positive radius"),
    "axis": (replaced("U2 U3", "U2 U4"), LINKS, r'"U4" of link property "FP" must be of U1'),
    "coupled": ([*isolator(), '  LINKPROP "FP" U2U3 5'], LINKS, r"U2U3.*\"link properties\""),
    "no yield force": (WEN, LINKS, r'U2 of link property "FP" needs a positive yield'),
}


@pytest.mark.parametrize(("prop", "links", "message"), BAD.values(), ids=list(BAD))
def test_what_cannot_be_read_is_refused_with_a_remedy(tmp_path, prop, links, message):
    refused(ModelError, message, Frame.from_etabs, model(tmp_path, prop, links))


def test_a_property_that_no_link_has_is_not_looked_at(tmp_path: Path) -> None:
    idle = ['  LINKPROP  "NLPR1"  TYPE "DAMPER - EXPONENTIAL"  ', '  LINKPROP  "NLPR1"  DOF "U9"  ']
    frame = Frame.from_etabs(model(tmp_path, [*isolator(), *idle], LINKS))
    assert "which nothing has: NLPR1" in str(frame.imported)
