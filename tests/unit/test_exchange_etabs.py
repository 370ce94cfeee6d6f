"""ETABS' text: the same building as from SAP2000's tables; bad files are refused with a remedy."""

from __future__ import annotations

import contextlib
import re
from dataclasses import astuple
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, ModelWarning
from frames.demo import bearing_for
from frames.design.report.page import Words
from frames.exchange.etabs import read_etabs
from frames.exchange.fields import Refusal, has, is_none_of, lacks
from frames.exchange.tables import Row
from lir_element.opensees import opensees
from tests import etabs_models, sap2000_models
from tests.patience import fresh
from tests.refusals import mutated, refused
from tests.spanish import untold

TEXT = etabs_models.building(bays=(1, 1))
BEARING = bearing_for(400e3)


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "model.e2k"
    path.write_text(text, encoding="utf-8")
    return path


def changed(old: str, new: str) -> str:
    assert old in TEXT, old
    return TEXT.replace(old, new, 1)


def more(*lines: str) -> tuple[str, str]:
    """Return a place of the text, and lines before it in a table of their own."""
    return "$ MASS SOURCE", "\n".join(["$ MORE", *lines, "", "$ MASS SOURCE"])


@pytest.mark.parametrize("walls", [False, True])
@pytest.mark.parametrize("units", [("KN", "M"), ("KIP", "IN")])
def test_both_formats_give_one_frame(tmp_path: Path, walls: bool, units: tuple[str, str]) -> None:
    opensees().wipe()
    one = Frame.from_etabs(written(tmp_path, etabs_models.building(units, walls=walls)))
    path = tmp_path / "model.s2k"
    path.write_text(sap2000_models.text(sap2000_models.building(walls=walls)), encoding="utf-8")
    two = Frame.from_sap2000(path)
    assert len(one.nodes) == len(two.nodes)
    assert len(one.members) == len(two.members)
    by_place = {tuple(round(x, 6) for x in n.position): name for name, n in two.nodes.items()}
    for name, node in one.nodes.items():
        other = by_place[tuple(round(x, 6) for x in node.position)]
        for group in ("masses", "loads"):
            found, expected = (getattr(f, group).get(n) for f, n in ((one, name), (two, other)))
            assert (found is None) == (expected is None)
            if found is not None:
                assert_allclose(found, expected, rtol=1e-9, atol=1e-6)
    sections = [sorted({astuple(m.section) for m in f.members.values()}) for f in (one, two)]
    assert_allclose(sections[0], sections[1], rtol=1e-9)
    assert_allclose(one.check().weight, two.check().weight, rtol=1e-9)
    assert [level.name for level in one.levels] == ["Base", "Story1", "Story2"]
    assert ("shells" in one.superelements) == walls


LINE_OF_U = TEXT[: TEXT.index("U 0.2")].count("\n") + 1
STAGES = 'LOADCASE "Seq"  TYPE  "Nonlinear Static Staged Construction"'
LOAD_SET = 'AREALOAD  "F1"  "Story1"  TYPE "UNIFLOADSET"  "U1"'
BARE = re.sub(r"^  (LINE|AREA|POINT)(ASSIGN|LOAD) .*\n", "", TEXT, flags=re.MULTILINE)

BAD = {
    "truncated": (TEXT[len(TEXT) // 2 :], "", r"may be cut off|is not closed|needs its name"),
    "no end": ("$ END OF MODEL FILE", "", r"without the line \$ END OF MODEL FILE"),
    "not a model": (TEXT, "hello", r"is not an ETABS text file"),
    "decimal comma": ("HEIGHT 3.0", "HEIGHT 3,0", r'line \d+, table "STORIES.*decimal=","'),
    "story twice": ('"Story2"  HEIGHT', '"Story1"  HEIGHT', r"two stories have the same name"),
    "unknown story": ('"C1"  "Story1"', '"C1"  "Roof"', r'story "Roof" is not defined'),
    "unknown section": ('SECTION "COL"', 'SECTION "COX"', r'"COX" of line "C1" is not def'),
    "unknown point": ('BEAM  "1"', 'BEAM  "77"', r'point "77" is not defined'),
    "point twice": ('POINT "2"', 'POINT "1"', r'point "1" occurs twice'),
    "below the base": ('"1"  "1"  1', '"1"  "1"  3', r"there are no 3 stories below"),
    "no mass source": ("  MASSSOURCE  ", "  MASSSAUCE  ", r"has no mass source"),
    "units": ('"KN"  "M"', '"stone"  "M"', r'UNITS = "stone, M" must be a force'),
    "bound": ("U 0.2", "U 0.7", rf'line {LINE_OF_U}, .*: U = 0.7 of material "C30"'),
    "shape": ("AREA 0.2", "AREB 0.2", r'is a "General" without Area'),
    "restraint": ("UX UY UZ", "UX UY UX9", r'RESTRAINT "UX9" must be of'),
    "stages": (*more(f"  {STAGES}"), r'of construction.*\(Seq\).*allow=\["staged construction"\]'),
    "hinges": (*more('  HINGEASSIGN "C1" "Story1"'), r'allow=\["hinges"\]'),
    "links": (*more('  LINK "K1" POINT "1" "2"'), r'allow=\["links"\]'),
    "towers": (*more('  TOWER "T1"', '  TOWER "T2"'), r"several towers are not read"),
    "ties": ('SECTION "COL"', 'LIMITTENSION 0  SECTION "COL"', r'\["tension limits"\]'),
    "area": ("FLOOR  4", "FLOOR  5", r"an area needs its name, kind, number of corners"),
    "load set": (*more(f"  {LOAD_SET}"), r'uniform load set "U1" is not defined: there are none'),
    "nothing": (TEXT, BARE, r"has no frame, area or link, and nothing on a joint"),
    "plane": (*more('  ACTIVEDOF "UX UZ RY"'), r'table "MORE": UY, RX, RZ is not active: bea'),
    "quote": ('SECTION "COL"', 'SECTION "COL', r"a quotation mark is not closed"),
}


@pytest.mark.parametrize(("old", "new", "message"), BAD.values(), ids=list(BAD))
def test_bad_files_are_refused_with_a_remedy(tmp_path, old, new, message):
    refused(ModelError, message, Frame.from_etabs, written(tmp_path, changed(old, new)))


def test_all_reasons_against_a_file_are_said_at_once(tmp_path: Path) -> None:
    text = changed('SECTION "COL"', 'LIMITTENSION 0  SECTION "COL"')
    text = text.replace('SECTION "COL"  ', 'HINGE "M3"  SECTION "COL"  ', 2)
    source = re.compile(r"^  MASSSOURCE.*\n", re.MULTILINE)
    text = text.replace("FVAL 3.0", "FVAL many", 1)
    path = written(tmp_path, source.sub("", text))
    words = (
        r"cannot be read, for 4 reasons:\n\(1\) .*FVAL = \"many\".*\n\(2\) .*no mass "
        r".*\n\(3\) .*limits of axial force.*\n\(4\) .*plastic hinges.*\nIf left out, tension "
        r'limits, hinges would .*allow=\["hinges", "tension limits"\]'
    )
    refused(ModelError, words, Frame.from_etabs, path)


def test_words_of_etabs_9(tmp_path: Path) -> None:
    # tonnes as forces, a mass source without a name, pipes of a thickness T, NUL in the log
    source = re.compile(r"^  MASSSOURCE .*\n  MASSSOURCELOAD .*\n", re.MULTILINE)
    old = '  MASSOPTIONS  GRAVITY 9.81  SOURCE "LOADS"  LATERALONLY "YES"    STORYLEVELONLY "YES"\n'
    old += '  MASSOPTIONS  LOAD "Dead"  FACTOR 1\n  MASSOPTIONS  LOAD "Live"  FACTOR 0.3\n'
    text = source.sub(old, TEXT).replace('"KN"', '"TON"')
    text = text.replace("$ END OF MODEL", "$ LOG\n  STARTCOMMENTS\n\0\n$ END OF MODEL")
    pipe = '  FRAMESECTION  "COL"  MATERIAL "C30"  SHAPE "Pipe"  D 0.8  T 0.028'
    text = re.sub(r'  FRAMESECTION +"COL".*', pipe, text, count=1)
    building = read_etabs(written(tmp_path, text))
    assert building.mass_source is not None
    assert not building.mass_source.elements
    assert building.mass_source.patterns == {"Dead": 1.0, "Live": 0.3}
    assert_allclose(building.units.force, 9806.65)
    assert_allclose(building.sections["COL"].area, np.pi * (0.8 - 0.028) * 0.028, rtol=1e-12)


def test_a_part_of_a_load_without_length_is_none(tmp_path: Path) -> None:
    # as ETABS writes the parts of a trapezoidal load that are left free
    line = '  LINELOAD  "X1"  "Story1"  TYPE "TRAPF"  DIR "GRAV"  LC "Dead"  FSTART 4  FEND 4 '
    path = written(tmp_path, TEXT.replace(*more(f"{line} RDSTART 1  RDEND 1"), 1))
    assert not read_etabs(path).line_loads
    Frame.from_etabs(path)


NULL = '  LINE  "N1"  LINE  "1"  "4"  0'
WALL = '  LINELOAD  "N1"  "Story1"  TYPE "TRAPF"  DIR "GRAV"  LC "Dead"  FSTART 4  FEND 8'


@pytest.mark.parametrize("ends", ["0 1", "0.25 0.75"])
def test_loads_of_lines_without_a_section_go_to_the_areas_under_them(tmp_path, ends):
    start, end = ends.split()
    text = TEXT.replace("$ AREA CONN", f"{NULL}\n\n$ AREA CONN", 1)
    text = text.replace(
        "$ AREA ASSIGNS", '  LINEASSIGN  "N1"  "Story1"  SECTION "NONE"\n\n$ AREA ASSIGNS'
    )
    load = f"{WALL}  RDSTART {start}  RDEND {end}"
    one, two = (
        Frame.from_etabs(written(tmp_path, t)) for t in (text, text.replace(*more(load), 1))
    )
    length = (float(end) - float(start)) * np.hypot(6.0, 5.0)  # across the bay
    assert_allclose(two.check().weight - one.check().weight, 6e3 * length, rtol=1e-9)
    assert "spread over the areas that they cross: N1-Story1" in str(two.imported)
    off = text.replace(*more(load), 1).replace('"N1"  LINE  "1"  "4"  0', '"N1"  LINE  "1"  "5"  0')
    off = off.replace("\n\n$ LINE CONN", '\n  POINT "5"  20.0 20.0\n\n$ LINE CONN', 1)
    refused(
        ModelError,
        r'no area under them.*"loads on nothing"',
        Frame.from_etabs,
        written(tmp_path, off),
    )


def test_a_case_adds_up_its_patterns(tmp_path: Path) -> None:
    # its first one too, if the case has the name of that pattern
    text = changed(
        'LOADPAT  "Dead"  SF  1 ',
        'LOADPAT  "Dead"  SF  1\n  LOADCASE "Dead"  LOADPAT  "Live"  SF  0.5',
    )
    building = read_etabs(written(tmp_path, text))
    assert building.combinations["G"] == pytest.approx({"Dead": 1.0, "Live": 0.5 + 0.7})


def test_assignments_become_what_members_have(tmp_path: Path) -> None:
    text = changed(
        'LINEASSIGN  "Y1"  "Story1"  SECTION "BEAM"',
        'LINEASSIGN  "Y1"  "Story1"  SECTION "BEAM"  RELEASE "PINNED" LENGTHOFFI 0.2 RIGIDZONE 0.5 '
        "PROPMODI33 0.35 CARDINALPT 8",
    )
    lines = [
        '  LINELOAD  "X1"  "Story1"  TYPE "TRAPF"  DIR "GRAV"  LC "Dead"  FSTART 4  FEND 8 '
        " RDSTART 0  RDEND 0.5",
        '  LINELOAD  "X3"  "Story1"  TYPE "POINTF"  DIR "GRAV"  LC "Dead"  FVAL 15  RDIST 0.4',
        '  POINTLOAD  "1"  "Story2"  TYPE "FORCE"  LC "Dead"  FX 7',
    ]
    frame = Frame.from_etabs(written(tmp_path, text.replace(*more(*lines), 1)))
    member = frame.members["Y1-Story1"]
    assert member.releases == (("My", "Mz"), ("My", "Mz"))
    assert_allclose(member.offsets[0], (0.0, 0.1, 0.0))  # the insertion point moves nothing
    assert_allclose(member.section.inertia_y, 0.35 * 0.3 * 0.6**3 / 12)
    (load,) = [x for x in frame.tapered_loads["X1-Story1"] if x.start == (0.0, 0.0, -4e3)]
    assert (load.a, load.b, load.end) == (0.0, 3.0, (0.0, 0.0, -8e3))
    assert_allclose(frame.loads["X3-Story1@0.4"], [0, 0, -15e3, 0, 0, 0])
    assert_allclose(frame.loads["1-Story2"][0], 7e3)
    assert "insertion points that do not transform" in str(frame.imported)


def test_stiff_zones_end_before_the_next_joint(tmp_path: Path) -> None:
    # 0.3 m are stiff, and a beam meets this one after 0.1 m
    text = changed(
        'LINEASSIGN  "X1"  "Story1"  SECTION "BEAM"',
        'LINEASSIGN  "X1"  "Story1"  SECTION "BEAM"  LENGTHOFFI 0.3 LENGTHOFFJ 0.2 RIGIDZONE 1 '
        'SELFWEIGHTOPTION "Clear Length" ',
    )
    for before, line in {
        "$ LINE CONN": '  POINT "9"  0.1 0.0\n  POINT "8"  0.1 5.0',
        "$ AREA CONN": '  LINE  "T"  BEAM  "9"  "8"  0',
        "$ AREA ASS": '  LINEASSIGN  "T"  "Story1"  SECTION "BEAM"',
    }.items():
        text = text.replace(before, f"{line}\n\n{before}", 1)
    frame = Frame.from_etabs(written(tmp_path, text))
    first, last = (frame.members[f"X1-Story1/{k}"] for k in (1, 2))
    assert_allclose(first.offsets, [(0.095, 0.0, 0.0), (0.0, 0.0, 0.0)], atol=1e-12)
    assert_allclose(last.offsets, [(0.0, 0.0, 0.0), (-0.2, 0.0, 0.0)], atol=1e-12)
    assert "cut before it: X1-Story1" in str(frame.imported)
    assert "where the file has it between end zones: X1-Story1" in str(frame.imported)


def test_a_semirigid_floor_is_shells(tmp_path: Path) -> None:
    opensees().wipe()
    frame = Frame.from_etabs(written(tmp_path, changed("TYPE RIGID", "TYPE SEMIRIGID")), mesh=3.0)
    assert not frame.diaphragms
    assert "shells" in frame.superelements
    assert "semi-rigid diaphragms, by their shells: D1" in str(frame.imported)
    rigid = Frame.from_etabs(written(tmp_path, TEXT))
    assert_allclose(frame.check().weight, rigid.check().weight, rtol=1e-9)


def test_the_foot_of_a_wall_is_held_between_its_corners(tmp_path: Path) -> None:
    opensees().wipe()
    path = written(tmp_path, etabs_models.building(walls=True))
    frame = Frame.from_etabs(path, mesh=1.5)
    feet = [name for name, node in frame.nodes.items() if node.z == 0.0 and "~" in name]
    assert len(feet) == 2 * 3  # two walls 6 m long, in four parts
    assert all(len(frame.fixed_dofs[name]) == 6 for name in feet)
    isolated = Frame.from_etabs(path, BEARING, mesh=1.5)
    assert not set(feet) & set(isolated.fixed_dofs)
    assert "corners stand on bearings, free between these" in str(isolated.imported)


def test_the_frame_does_not_depend_on_the_hashes_of_a_process(tmp_path: Path) -> None:
    # results of another process are compared with the frame, node by node
    path = written(tmp_path, etabs_models.building(walls=True))
    code = (
        "import sys; from frames import Frame; frame = Frame.from_etabs(sys.argv[1], mesh=1.5); "
        "print(list(frame.nodes), list(frame.members), frame.imported)"
    )
    said = [fresh(code, str(path), PYTHONHASHSEED=seed).stdout for seed in ("1", "2")]
    assert said[0] == said[1]


def test_bearings_stand_under_the_supports(tmp_path: Path) -> None:
    frame = Frame.from_etabs(written(tmp_path, TEXT), BEARING, loads="G")
    assert list(frame.bearings) == [f"bearing-{k}-Base" for k in range(1, 5)]
    assert frame.load_cases == ("D", "L")
    whole = Frame.from_etabs(written(tmp_path, TEXT), BEARING, loads="all")
    live = 2 * 30.0 * 3e3
    assert_allclose(whole.check().weight - frame.check().weight, 0.3 * live, rtol=1e-9)


def test_bearings_stand_under_the_points_of_groups(tmp_path: Path) -> None:
    lines = [f'  GROUP "{g}"  POINT "{k}"  "Base"' for k, g in ((1, "IN"), (2, "IN"), (4, "OUT"))]
    lines += ['  GROUP "IN"  LINE "C1"  "Story1"', '  GROUP "IN"  AREA "F1"  "Story1"']
    path = written(tmp_path, changed(*more(*lines)))
    other = bearing_for(900e3)
    frame = Frame.from_etabs(path, {"IN": BEARING, "OUT": other})
    types = {name: part.bearing for name, part in frame.bearings.items()}
    assert types == {"bearing-1-Base": BEARING, "bearing-2-Base": BEARING, "bearing-4-Base": other}
    assert len(frame.fixed_dofs["3-Base"]) == 6


def old(text: str) -> str:
    """Return a file as ETABS 8 and 9 write it: mass and weight by M and W, combinations by LOAD."""
    lines = re.sub(r"WEIGHTPERVOLUME (\S+)  MASSPERVOLUME (\S+)", r"M \2  W \1", text)
    lines = re.sub(r'(COMBO "G"  )LOADCASE', r"\1LOAD", lines).replace('"Linear Add"', '"ADD"')
    return lines.replace("  SLABTHICKNESS", '  TYPE "SHELL"  PLATETYPE "THIN"  TM')


def test_etabs_8_and_9_have_mass_and_weight_by_letters(tmp_path: Path) -> None:
    one = Frame.from_etabs(written(tmp_path, TEXT), BEARING, loads="G")
    text = old(TEXT)
    assert "WEIGHTPERVOLUME" not in text
    two = Frame.from_etabs(written(tmp_path, text), BEARING, loads="G")
    assert two.check().weight == one.check().weight
    assert two.check().mass == one.check().mass


def test_a_word_that_is_not_known_is_told_once_with_its_line(tmp_path: Path) -> None:
    text = changed("  MASSPERVOLUME", "  ORTHOFACTOR 0.3  MASSPERVOLUME")
    text = text.replace('AUTOMESH "YES"', 'AUTOMESH "YES"  SWAY 1')
    line = 1 + text[: text.index("ORTHOFACTOR")].count("\n")
    with pytest.warns(ModelWarning) as told:
        frame = Frame.from_etabs(written(tmp_path, text))
    said = [str(each.message) for each in told]
    assert len(said) == 2  # one for each first word
    assert any(
        f'MATERIAL: unknown words were not read: ORTHOFACTOR = "0.3" (line {line})' in each
        for each in said
    )
    assert any('SWAY = "1"' in each and "more" in each for each in said)
    assert "words that are not known here" in str(frame.imported)


IDLE = """
  MATERIAL  "BAD"  TYPE "Steel"  SYMTYPE "Isotropic"  E -1  U 7  MAGIC 3
  FRAMESECTION  "IDLE"  MATERIAL "nowhere"  SHAPE "Auto Select List"  MAGIC 3
  SHELLPROP  "IDLE"  MATERIAL "nowhere"  MAGIC 3
  SHELLUNIFORMLOADSET "IDLE"  LOADPAT "nowhere"  VALUE many
  LINKPROP  "IDLE"  TYPE "MAGIC"  DOF "U9"
  POINTSPRING  "IDLE"  UX soft
  LOADPATTERN "IDLE"  TYPE  "Magic"  SELFWEIGHT  0"""


def test_what_nothing_has_never_stops_an_import(tmp_path: Path) -> None:
    frame = Frame.from_etabs(written(tmp_path, changed(*more(IDLE))))
    assert "which nothing has" in str(frame.imported)


@pytest.mark.parametrize(("held", "acting"), [("UX UY UZ RX RY RZ", 0), ("UZ", 1)])
def test_a_spring_of_a_held_displacement_is_none_on_a_bearing(tmp_path, held, acting) -> None:
    old = 'POINTASSIGN  "1"  "Base"  RESTRAINT "UX UY UZ RX RY RZ"'
    text = changed(old, f'POINTASSIGN  "1"  "Base"  SPRINGPROP "S"  RESTRAINT "{held}"')
    text = text.replace(*more('  POINTSPRING  "S"  UX 200000  UZ 300000'), 1)
    frame = Frame.from_etabs(written(tmp_path, text), bearing_for(400e3))
    assert [spring.stiffness for spring in frame.springs.values()] == acting * [
        (200000e3, 0.0, 0.0, 0.0, 0.0, 0.0)
    ]
    assert "springs of displacements that supports hold" in str(frame.imported)


def test_material_without_weight_is_doubted(tmp_path: Path) -> None:
    text = re.sub(r"WEIGHTPERVOLUME \S+ ", "", TEXT)
    with pytest.warns(ModelWarning) as told:
        Frame.from_etabs(written(tmp_path, text))
    said = " ".join(str(each.message) for each in told)
    words = Words("es")
    for each in told:
        words.say(each.message.text)
    assert untold(words) == set()
    assert 'material "C30" has no weight, so 100 %' in said
    assert "of the mass has no weight" in said


@pytest.mark.filterwarnings("ignore::frames.ModelWarning")  # words that are not known
def test_mutated_files_end_in_models_or_messages(tmp_path: Path) -> None:
    junk = ('"', "$", "-", "0", "x", " ", ",", "9e99", "\0", "nan")
    for seed in range(250):
        with contextlib.suppress(ModelError):
            assert Frame.from_etabs(written(tmp_path, mutated(seed, TEXT, junk))).members


@pytest.mark.parametrize(
    ("when", "text", "odd"),
    [
        (None, "Yes", True),
        (None, "No", False),
        (has("layered"), "Shell-Layered/Nonlinear", True),
        (has("layered"), "Shell-Thin", False),
        (is_none_of("none"), "NONE", False),
        (is_none_of("no", "none"), "None of them", True),
        (lacks("z"), "Local-Z", False),
        (lacks("z"), "X", True),
    ],
)
def test_a_field_matters_by_its_whole_text_or_by_a_word(when, text: str, odd: bool) -> None:
    row = Row("m.e2k", "T", 1, {"WORD": text})
    refusal = Refusal("OTHER|WORD", "key", "what", when)
    assert refusal.odd(row) == (text if odd else None)
    assert refusal.odd(Row("m.e2k", "T", 1, {})) is None


def test_a_flag_is_yes_or_no() -> None:
    with pytest.raises(ModelError, match=r'line 7.*WORD = "perhaps" must be Yes or No'):
        Refusal("WORD", "key", "what").odd(Row("m.e2k", "T", 7, {"WORD": "perhaps"}))
