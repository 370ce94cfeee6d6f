"""What of a page in another language is not in it: texts without an entry in the catalogue."""

import re
from collections.abc import Iterable
from html import unescape

from frames.design.report.page import Words, catalogue

UNITS = r"mm|m²|kN/m²|MPa|GPa|kN/m|kN/mm|s/m|m/s2?²?|kg|kg/m[23²³]"
WORDLESS = "|".join(
    (
        r"\S*\d\S*",
        r"\S*_\S*",
        r"[^a-zA-Z\s]+",
        r"[a-zA-Z]{1,2}",
        r"[A-Z-]{2,}\S*",
        r"[+-][xyz]|[xyz][+-]",
        r"\S+\.md",
        r'"[^"]*"',  # a name of the user's
        r"\w+ ?= ?(?:\"[^\"]*\"|\{[^}]*\})",  # a key with its value
        r"\[[^\]]*\](?: [a-z_]+(?= |$))?",  # a section, and its key
        UNITS,
    )
)
NAME = re.compile(rf"(?:{WORDLESS})(?: (?:{WORDLESS}))*|")
ASIDE = re.compile(r"<(style|code|title|math)\b.*?</\1>|<[^>]*>", re.S)
KEY = re.compile(r"\[\w+\] \w+|\w+ = ")
WORD = re.compile(r"(?<![\w.{])[^\W\d_]{3,}(?![\w.(}]*[_\d}=])")
PLACES = re.compile(r"\{(\w+)([^{}]*(?:\{\w+\})?[^{}]*)\}")


def untold(words: Words) -> set[str]:
    """Return the texts that had no entry and have words: no names, numbers or units alone."""
    plain = {
        one: " ".join(PLACES.sub("1", one).replace(", ", " ").split()) for one in words.missing
    }
    return {one for one, text in plain.items() if not NAME.fullmatch(text)}


def english_words(page: str, names: Iterable[str], language: str = "es") -> set[str]:
    """Return the words of a page that messages of the catalogue have in English alone.

    Names of the user, keys of the file, and the file as it was given are aside.
    """
    known = catalogue(language)
    told = {one: said for one, said in known.items() if one != said}
    ours, theirs = (set(WORD.findall(" ".join(part).lower())) for part in (told, told.values()))
    names = [*names, *(one for one, said in known.items() if one == said and " " in one)]  # titles
    shown = unescape(ASIDE.sub(" ", page.partition('<h2 id="input">')[0]))
    for name in sorted(names, key=len, reverse=True):
        shown = shown.replace(name, " ")
    return set(WORD.findall(KEY.sub(" ", shown).lower())) & (ours - theirs)
