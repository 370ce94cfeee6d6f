"""What is shown of a formula is that formula: small ones, read back from text and from MathML."""

import math
from collections.abc import Iterator
from itertools import product
from xml.dom.minidom import Element, Text, parseString  # noqa: S408

import pytest

from frames.design.calculation.rendering import Style, evaluate, mathml, parse, text

VALUES = {"a": 1.25, "b": 2.5, "c": 0.75}
DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
OPERATORS = ["+", "-", "*", "/", "**"]
FUNCTIONS = {"sqrt": math.sqrt, "min": min, "max": lambda x: x}


def trees(leaves: str) -> Iterator[str]:
    """Yield all formulas with these leaves in order, every part in brackets."""
    if len(leaves) == 1:
        yield leaves
    for cut in range(1, len(leaves)):
        for left, sign, right in product(trees(leaves[:cut]), OPERATORS, trees(leaves[cut:])):
            yield f"({left} {sign} {right})"


def wrapped(formula: str) -> Iterator[str]:
    """Yield a formula with a sign or a function around each of its parts in turn."""
    for start, sign in enumerate(formula):
        if sign == "(" or sign.isalpha():
            end = start + 1
            while formula[start:end].count("(") != formula[start:end].count(")"):
                end += 1
            for head in ("-", "sqrt", "max"):
                yield f"{formula[:start]}({head}({formula[start:end]})){formula[end:]}"


def value(formula: str) -> float | complex:
    """Return the value by Python itself, NaN where there is none."""
    try:
        return eval(formula, FUNCTIONS | VALUES)  # noqa: S307
    except (ZeroDivisionError, OverflowError, ValueError, TypeError):  # of complex numbers, too
        return math.nan


def same(first: float | complex, second: float | complex) -> bool:
    """Return whether two numbers are equal but for round-off."""
    return abs(first - second) <= 1e-9 * abs(second) + 1e-12


def from_text(shown: str) -> str:
    """Return a line of text as a formula of Python."""
    found, raised = "", ""
    for sign in [*shown, " "]:
        if sign in "⁰¹²³⁴⁵⁶⁷⁸⁹⁻":
            raised += sign
            continue
        found += f"**({raised.translate(DIGITS)})" if raised else ""
        found, raised = found + sign, ""
    return found.replace("·", "*").replace("^", "**").replace("√", "sqrt").strip()


def from_mathml(node: Element | Text) -> str:
    """Return MathML as a formula of Python."""
    if isinstance(node, Text):
        return str(node.data).replace("·", "*").replace("\u2062", "*")
    parts = [from_mathml(child) for child in node.childNodes]
    if node.tagName == "mfrac":
        return f"(({parts[0]})/({parts[1]}))"
    if node.tagName == "msup":
        # The base as it stands, so that brackets that are missing are found.
        bare = node.firstChild.firstChild.tagName in {"mi", "mn"}  # type: ignore[union-attr]
        assert bare or parts[0].startswith(("(", "sqrt", "max"))
        return f"{parts[0]}**({parts[1]})"
    return f"sqrt({''.join(parts)})" if node.tagName == "msqrt" else "".join(parts)


@pytest.mark.parametrize("leaves", ["a", "ab", "abc", "abca"])
def test_text_and_mathml_are_the_formula(leaves: str) -> None:
    count = 0
    for plain in trees(leaves):
        for formula in (plain, *(wrapped(plain) if len(leaves) < 4 else ())):
            count += check(formula)
    assert count >= {"a": 3, "ab": 40, "abc": 600, "abca": 500}[leaves]


def check(formula: str) -> bool:
    """Compare what is shown with the formula; return whether it has a value to compare."""
    tree = parse(formula)
    expected = value(formula)
    found = evaluate(tree, VALUES)
    assert isinstance(found, float)
    if isinstance(expected, complex) or not math.isfinite(expected):
        return False
    assert same(found, expected)
    back = from_text(text(tree, Style(str, True)))
    assert same(value(back), expected), back
    document = parseString(f"<math>{mathml(tree)}</math>")  # noqa: S318
    back = from_mathml(document.documentElement)
    assert same(value(back), expected), back
    return True
