"""Texts of the report in other languages: each has its translation; numbers and clauses stay."""

import ast
import json
import re
import warnings
from copy import deepcopy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

pytest.importorskip("typer")

from babel.messages.extract import extract_from_dir
from typer.testing import CliRunner

from frames._errors import AuditWarning, ModelWarning, MotionWarning
from frames.command.app import app
from frames.design._errors import ProjectError
from frames.design.codes.registry import code_named
from frames.design.devices.bearing_numbers import by_equation
from frames.design.hazard.plot_hazard import motion_spectra
from frames.design.project import example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.project.structure_statement import structure_rows
from frames.design.report.page import LANGUAGES, Words, catalogue
from frames.design.report.tables import Table
from frames.design.report.writing import SECTIONS
from frames.plots import plot_style as ps
from frames.results.findings import Findings, finding, findings_from
from lir_element.device.bearing_checks import DesignWarning
from lir_element.texts import Text, TextWarning, joined, text_from, worded
from tests.spanish import PLACES, untold

ROOT = Path(__file__).parents[2]
DESIGN = ROOT / "frames" / "design"
GETTEXT = re.compile(r"%\((\w+)\)s")
OTHERS = [language for language in LANGUAGES if language != "en"]


@pytest.mark.parametrize("language", OTHERS)
def test_every_message_of_the_templates_is_translated(language: str) -> None:
    options = {"**.html.j2": {"trimmed": "true"}}
    found = extract_from_dir(
        DESIGN / "report",
        [(f"{name}.html.j2", "jinja2") for name in ("report", "macros", "tender")],
        options_map=options,
    )
    messages = {" ".join(str(m[2] if isinstance(m[2], str) else m[2][0]).split()) for m in found}
    assert len(messages) > 40
    texts = catalogue(language)
    assert messages - set(texts) == set()
    assert {title for _, title in SECTIONS} <= set(texts)


ROOMS = [path for room in ("frames", "lir_element") for path in (ROOT / room).rglob("*.py")]


def templates() -> set[str]:
    """Return the templates of all calls of the function that makes texts, and notes of checks."""
    found = set()
    for path in ROOMS:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "worded":
                template = node.args[0]
                if path.name != "texts.py":
                    assert isinstance(template, ast.Constant), (path, node.lineno)
                    found.add(template.value)
            is_note = (
                isinstance(node, ast.keyword) and node.arg == "note" and "design" in path.parts
            )
            if is_note and isinstance(node.value, ast.Constant):
                found.add(node.value.value)
            assert not (is_note and isinstance(node.value, ast.JoinedStr)), (
                path,
                node.value.lineno,
            )
    return found - {""}


@pytest.mark.parametrize("language", OTHERS)
def test_every_template_is_translated(language: str) -> None:
    """Found in the sources by the calls that make texts; those of places and units alone aside."""
    words, every = Words(language), templates()
    assert len(every) > 400
    for template in every:
        words.gettext(template)
    assert untold(words) == set()


@pytest.mark.parametrize("language", OTHERS)
def test_places_of_translations_are_those_of_the_messages(language: str) -> None:
    known = catalogue(language)
    assert len(known) > 1000
    for message, text in known.items():
        assert text, message
        assert sorted(PLACES.findall(message)) == sorted(PLACES.findall(text)), message
        assert sorted(GETTEXT.findall(message)) == sorted(GETTEXT.findall(text)), message


@pytest.mark.parametrize("name", ["office", "near-fault"])
def test_structures_of_whole_buildings_are_translated(name, tmp_path, monkeypatch):
    """Walls, braces, cracked sections by storey, loads; clauses keep their points."""
    monkeypatch.setattr(example, "PULSES", {"artificial-1": 1.9})  # one motion
    assert CliRunner().invoke(app, ["new", str(tmp_path), "--example", name]).exit_code == 0
    parts = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path)
    frame = parts.frame()
    words = Words("es", ",", frame.bearings)
    said = {words.say(what): words.say(how) for what, how in structure_rows(parts.file, frame)}
    assert untold(words) == set()
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
    assert untold(words) == set()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("264.2 mm", "264,2 mm"),
        ("storey drift ratio", "deriva de entrepiso"),
        (
            joined("bearing-0-0", worded("{name} rim", name="bottom"), "lower", by=", "),
            "bearing-0-0, anillo inferior, inferior",
        ),
        (worded("{value} before failure", value="0.45"), "0,45 antes de la falla"),
        (worded("largest of each of {n} runs", n=7), "máximo de cada uno de 7 análisis"),
        ("displacement [mm]", "desplazamiento [mm]"),
        (joined("margin", "a proposal"), "margen; una propuesta"),
        ("1.257e+07", "1,257e+07"),
        ("-0.5", "-0,5"),
        ("more than 1000 %", "más de 1000 %"),
        (worded("smallest N {least:.2f} W", least=np.float64(-1.5)), "N mínima -1,50 W"),
        (
            worded("The bearing, type {kind}, to scale", kind="wall"),
            "El aislador, tipo wall, a escala",
        ),
        (by_equation("2.7"), "sin norma: docs/theory.md (2.7)"),
    ],
)
def test_texts_in_spanish_with_decimal_commas(text: str, said: str) -> None:
    """Of the text itself, after a table, a file of findings, and another process."""
    words = Words("es", ",", ["wall"])
    say = words.cited if text.startswith("no code") else words.say
    kept = pd.Series([text], dtype=object).to_numpy()[0]
    stored = text_from(json.loads(json.dumps(text.plain() if isinstance(text, Text) else text)))
    for one in (text, str(text), kept, stored, deepcopy(text)):
        assert one == text
        assert say(one) == said
    assert untold(words) == set()


def test_findings_keep_their_templates_through_a_file() -> None:
    text = worded("met by {whom}", whom=worded("{count} of {all} bearings", count=2, all=9))
    found = Findings((finding("rims", False, True, 1.0, text),))
    again = findings_from(json.loads(found.json()))
    assert again == found
    assert again[0].sentence == "rims: met by 2 of 9 bearings"
    assert Words("es").say(again.lines()[0]) == "  anillos: tocados por 2 de 9 aisladores"


@pytest.mark.parametrize("kind", [AuditWarning, DesignWarning, ModelWarning, MotionWarning])
def test_warnings_go_to_other_processes_as_plain_strings(kind: type[TextWarning]) -> None:
    text = worded("{count} of {all} bearings", count=2, all=9)
    with pytest.warns(kind) as caught:
        warnings.warn(text, kind, stacklevel=1)
    heard = caught[0].message
    assert type(heard.args[0]) is type(str(heard)) is str
    assert str(heard) == heard.text == text


def test_names_of_the_user_stay() -> None:
    words = Words("es", ",", ["wall 1.5"])
    assert words.say(worded("{where} at {bound}", where="wall 1.5", bound="lower")) == (
        "wall 1.5 en inferior"
    )


def test_what_is_not_known_stays_and_is_told() -> None:
    words = Words("es", ",")
    assert words.say("a sentence of another package") == "a sentence of another package"
    assert words.say(joined("a proposal", "a word")) == "una propuesta; a word"
    assert untold(words) == {"a sentence of another package", "a word"}


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
    with pytest.raises(
        ProjectError, match="language = 'fr' is not a language of reports: choose one of"
    ):
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
    assert untold(words) == set()
