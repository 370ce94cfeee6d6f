"""Texts of the report in other languages: each has its translation; numbers and clauses stay."""

import ast
import re
import warnings
from pathlib import Path

import pytest

pytest.importorskip("babel")
pytest.importorskip("jinja2")
pytest.importorskip("pydantic")

from babel.messages.extract import extract_from_dir
from typer.testing import CliRunner

from frames.command.app import app
from frames.design._errors import ProjectError
from frames.design.codes.registry import code_named
from frames.design.hazard.plot_hazard import motion_spectra
from frames.design.project import example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.project.structure_statement import structure_rows
from frames.design.report.tables import Table
from frames.design.report.words import LANGUAGES, Words, catalogue
from frames.design.report.writing import SECTIONS
from frames.plots import plot_style as ps

DESIGN = Path(__file__).parents[2] / "frames" / "design"
PLACES = re.compile(r"\{(\w+)\}|%\((\w+)\)s")
OTHERS = [language for language in LANGUAGES if language != "en"]


@pytest.mark.parametrize("language", OTHERS)
def test_every_message_of_the_templates_is_translated(language: str) -> None:
    options = {"**.html.j2": {"trimmed": "true"}}
    found = extract_from_dir(
        DESIGN / "report",
        [("report.html.j2", "jinja2"), ("macros.html.j2", "jinja2")],
        options_map=options,
    )
    messages = {" ".join(str(m[2] if isinstance(m[2], str) else m[2][0]).split()) for m in found}
    assert len(messages) > 40
    texts, _ = catalogue(language)
    assert messages - set(texts) == set()
    assert {title for _, title in SECTIONS} <= set(texts)


@pytest.mark.parametrize("language", OTHERS)
def test_every_note_of_a_calculation_is_translated(language: str) -> None:
    """Texts that stand as they are in the sources of checks: ``note="..."``."""
    words, notes = Words(language), set()
    for room in ("codes", "devices", "histories"):
        for path in (DESIGN / room).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.keyword) and node.arg == "note":
                    value = getattr(node.value, "value", None)
                    notes |= {value} if isinstance(value, str) and value else set()
    assert len(notes) > 60
    for note in notes:
        words.say(note)
    assert words.missing == set()


@pytest.mark.parametrize("language", OTHERS)
def test_places_of_translations_are_those_of_the_messages(language: str) -> None:
    from babel.messages.pofile import read_po

    file = DESIGN / "report" / "locale" / f"{language}.po"
    with file.open("rb") as opened:
        messages = [m for m in read_po(opened) if m.id]
    assert len(messages) > 400
    for message in messages:
        assert message.string, message.id
        assert not message.fuzzy
        assert sorted(PLACES.findall(message.id)) == sorted(PLACES.findall(message.string))


@pytest.mark.parametrize("name", ["office", "near-fault"])
def test_structures_of_whole_buildings_are_translated(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Walls, braces, cracked sections by storey, loads; clauses keep their points."""
    monkeypatch.setattr(example, "PULSES", {"artificial-1": 1.9})  # one motion
    assert CliRunner().invoke(app, ["new", str(tmp_path), "--example", name]).exit_code == 0
    parts = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path)
    frame = parts.frame()
    words = Words("es", ",", frame.bearings)
    said = {words.say(what): words.say(how) for what, how in structure_rows(parts.file, frame)}
    assert words.missing == set()
    code = {"office": "EN 1998-1:2004, 3.2.4 *: psi_2 = 0,3", "near-fault": "12.7.2 y 17.2.7.1 *"}
    assert code[name] in said["masa sísmica"]
    part = {
        "office": ("muro 2-0 a 3-0, como columna ancha", "fisurado: 0,5 de la rigidez a flexión"),
        "near-fault": ("arriostramientos 1-0 a 2-0", "cruzados, circular 220 x 12 mm"),
    }[name]
    assert part[1] in said[part[0]]


@pytest.mark.parametrize("code", ["ASCE 7-22", "EN 1998", "NCh2745"])
def test_checks_of_every_code_are_translated(code: str, tmp_path: Path, put_example) -> None:
    folder = put_example(tmp_path, code)
    parts = ProjectInputs(read_project(folder / "project.toml"), folder)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the example's own
        known = preliminary(parts)
    words = Words("es", ",", known.frame.bearings)
    for check in known.equivalent.checks:
        assert words.say(check.title) != check.title
        for text in (check.note, check.subject, *(step.note for step in check.trace)):
            words.say(text)
    words.table(Table(known.equivalent.head(), known.equivalent.rows()))
    words.say(code_named(code).title)
    for row in structure_rows(parts.file, known.frame):
        list(map(words.say, row))
    words.figure(motion_spectra(known.motions, known.spectrum))
    assert words.missing == set()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("264.2 mm", "264,2 mm"),
        ("storey drift ratio", "deriva de entrepiso"),
        ("bearing-0-0, bottom rim, lower, MCE_R", "bearing-0-0, anillo inferior, inferior, MCE_R"),
        ("0.45 before failure", "0,45 antes de la falla"),
        ("largest of each of 7 runs", "máximo de cada uno de 7 análisis"),
        ("displacement [mm]", "desplazamiento [mm]"),
        ("margin; a proposal", "margen; una propuesta"),
        ("1.257e+07", "1,257e+07"),
        ("-0.5", "-0,5"),
        ("more than 1000 %", "más de 1000 %"),
        (
            "centre of mass, of the model's masses; that of the bearings' loads: 9.822 m, "
            "the model holds its tilt",
            "centro de masa, de las masas del modelo; el de las cargas de los aisladores: 9,822 m, "
            "el modelo impide su inclinación",
        ),
        ("3 increments, least load, 0.25 D_M", "3 incrementos, carga mínima, 0,25 D_M"),
    ],
)
def test_texts_in_spanish_with_decimal_commas(text: str, said: str) -> None:
    words = Words("es", ",")
    assert words.say(text) == said
    assert words.missing == set()


def test_captions_of_types_of_bearings_are_translated() -> None:
    words = Words("es", ",", ["wall"])
    assert words.say("The bearing, type wall, to scale") == "El aislador, tipo wall, a escala"


def test_what_is_not_known_stays_and_is_told() -> None:
    words = Words("es", ",")
    assert words.say("a sentence of another package") == "a sentence of another package"
    assert words.say("a proposal; a word") == "una propuesta; a word"
    assert words.missing == {"a sentence of another package", "a word"}


@pytest.mark.parametrize("text", ["ASCE 7-22 17.2.4.5", "numpy 2.4.6", "(17.5-1)", "a.b", "v0.2.0"])
def test_clauses_and_versions_keep_their_points(text: str) -> None:
    assert Words("es", ",").number(text) == text
    assert Words("en", ",").cited("ASCE 7-22 17.5 *") == "ASCE 7-22 17.5 *"


def test_english_is_as_it_was() -> None:
    words = Words()
    table = Table(("a", "b [mm]"), [("lower", "1.5")], frozenset({1}))
    assert words.table(table) == Table(["a", "b [mm]"], [["lower", "1.5"]], frozenset({1}))
    assert words.say("no value") == "no value"
    assert Words("en", ",").say("(0.1, 0.2) m") == "(0,1, 0,2) m"
    with pytest.raises(ProjectError, match="language = 'fr' is not one of reports: choose one of"):
        Words("fr")


def test_formulas_have_commas_and_semicolons() -> None:
    formula = "<math><mi>P</mi><mo>=</mo><mn>0.5</mn><mtext>(1.5, 2.5, …, 3.5) kN</mtext></math>"
    said = "<math><mi>P</mi><mo>=</mo><mn>0,5</mn><mtext>(1,5; 2,5; …; 3,5) kN</mtext></math>"
    assert Words("es", ",").formula(formula) == said
    assert Words("es").formula(formula) == formula


def test_figures_have_words_and_commas() -> None:
    figure = ps.new_figure(2.0)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    panel.plot([0.0, 1.0], [0.0, 0.75])
    ps.caption(panel, x="period [s]", title="Storey drift")
    panel.set_yticks([0.0, 0.75], ["lower", "0.75"])
    panel.set_xticks([0.0, 0.5])
    words = Words("es", ",")
    words.figure(figure)
    figure.canvas.draw()
    assert panel.get_xlabel() == "período [s]"
    assert panel.get_title(loc="left") == "Deriva de entrepiso"
    assert [t.get_text() for t in panel.get_xticklabels()] == ["0,0", "0,5"]
    assert [t.get_text() for t in panel.get_yticklabels()] == ["inferior", "0,75"]
    assert words.missing == set()
