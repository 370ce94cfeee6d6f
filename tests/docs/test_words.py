"""How pages and docstrings read: words a sentence, long sentences, 'what' and 'where' as nouns.

A thermometer, not the aim: a sentence that must be read twice is wrong at any length.
"""

import ast
import inspect
import re
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
DOCS = sorted((ROOT / "docs").glob("*.md")) + sorted((ROOT / "docs/validation").glob("[!s]*.md"))
DOCS += [
    ROOT / f"docs/validation/{name}.md"
    for name in ("shake_table", "slip", "speed_error", "static_test")
]
PAGES = ["README.md"] + [path.relative_to(ROOT).as_posix() for path in DOCS]
"""All but those of the study."""


class Measure(NamedTuple):
    """Words a sentence, share of long sentences, words but their first per 1,000 words."""

    mean: float
    long: float
    what: float
    where: float


def prose_of(text: str) -> str:
    """Return the prose of a page: no code, table, heading, picture or formula."""
    text = re.sub(r"^(```|:::).*?^\1`*:*\s*$", "\n\n", text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    kept = [x for x in text.splitlines() if not re.match(r"\s*(\||#|!\[|\$\$)| {4}(?! *[-*])", x)]
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", "\n".join(kept))
    return re.sub(r"`[^`]*`|\$[^$]*\$", "x", text)


def measure(text: str) -> Measure:
    sizes = []
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        plain = re.sub(r"[*_]", "", " ".join(paragraph.split()))
        # lists of names in code marks are no sentence
        plain = re.sub(r"(?:x, ){3,}x", "x", plain)
        sentences = re.split(r"(?<=[.!?:])[\"')]*\s+(?=[A-Z0-9x\"'(])", plain)
        sizes += [len(re.findall(r"[A-Za-z][\w'-]*", sentence)) for sentence in sentences]
    sizes = [size for size in sizes if size > 2]
    words, count = max(1, sum(sizes)), max(1, len(sizes))
    of = [
        1e3 * max(0, len(re.findall(rf"\b{word}\b", text, re.IGNORECASE)) - 1) / words
        for word in WORDS
    ]
    return Measure(words / count, sum(size > 35 for size in sizes) / count, *of)


WORDS = ("what", "where")
LONGEST = 2500
BOUNDS = Measure(mean=19.0, long=0.08, what=2.0, where=2.0)


def test_the_measure_counts_prose_alone() -> None:
    prose = "It moves far. What, what, where, where it can."
    page = f"# Head\n\n{prose}\n\n| what | where |\n\n```\nwhat\n```\n"
    assert measure(prose_of(page)) == (4.5, 0.0, 1e3 / 9.0, 1e3 / 9.0)


@pytest.mark.parametrize("page", PAGES)
def test_pages_read_in_one_go(page: str) -> None:
    found = measure(prose_of((ROOT / page).read_text(encoding="utf-8")))
    over = {
        name: (round(value, 3), bound)
        for name, value, bound in zip(Measure._fields, found, BOUNDS, strict=True)
        if value > bound
    }
    assert not over


FRAGMENT = re.compile(r"(?:\A| : .*\n *)(?:Of|What|Whether|Where|How|Those|Who)\b")
"""Start of a docstring, or of a parameter's description, that names no action and no quantity."""


@pytest.mark.parametrize("package", ["lir_element", "frames"])
def test_docstrings_begin_with_an_action_or_a_quantity(package: str) -> None:
    texts = [
        inspect.cleandoc(node.value.value)
        for path in (ROOT / package).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)
    ]
    assert [text for text in texts if FRAGMENT.search(text)] == []
    found = measure(prose_of("\n\n".join(texts)))
    assert found.long <= 0.02
    assert max(found.what, found.where) <= 0.5


def test_pages_are_short():
    """At most 2,500 words but for theory, tables that are generated, and the study."""
    free = ("theory", "provisions", "standings")
    long = {
        page: count
        for page in PAGES
        if (count := len((ROOT / page).read_text(encoding="utf-8").split())) > LONGEST
        and not Path(page).name.startswith(free)
    }
    assert not long
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 110
