"""Formulas and numbers in a report: text, and MathML for pages."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from html import escape
from typing import NamedTuple

import numpy as np

from frames._types import FloatArray
from frames.design._errors import CheckError

Value = float | tuple[float, ...]
"""A number, or one for each of several (bearings, storeys)."""

_OPERATORS: dict[type[ast.operator], Callable[[FloatArray, FloatArray], FloatArray]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.true_divide,
    ast.Pow: np.power,
}
_ONE: dict[str, Callable[[FloatArray], FloatArray]] = {
    "sqrt": np.sqrt,
    "abs": np.abs,
    "exp": np.exp,
    "log": np.log,
    "acos": np.arccos,
    "sum": np.sum,
    "above": lambda values: np.cumsum(np.atleast_1d(values)[::-1])[::-1],
}
_MANY: dict[str, np.ufunc] = {"min": np.minimum, "max": np.maximum}
RESERVED = frozenset({"pi", *_ONE, *_MANY})
"""Names that formulas have by themselves."""


@lru_cache(maxsize=1024)
def parse(formula: str) -> ast.expr:
    """Return a formula as a tree."""
    try:
        tree = ast.parse(formula, mode="eval").body
    except SyntaxError as cause:
        msg = f"formula {formula!r} cannot be read ({cause.msg}): write it as in Python"
        raise CheckError(msg) from cause
    functions = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        bare = isinstance(node, ast.Name) and node.id in RESERVED - {"pi"}
        if not _known(node) or (bare and id(node) not in functions):
            msg = (
                f"formula {formula!r} has {ast.unparse(node) or type(node).__name__!r}: use "
                f"numbers, names, + - * / ** and {', '.join(sorted(RESERVED))}"
            )
            raise CheckError(msg)
    return tree


def _known(node: ast.AST) -> bool:
    if isinstance(node, ast.Constant):
        return type(node.value) in {int, float}
    if isinstance(node, ast.BinOp):
        return type(node.op) in _OPERATORS
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.USub)
    if isinstance(node, ast.Call):
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        one = name in _ONE and len(node.args) == 1
        return (one or (name in _MANY and len(node.args) > 0)) and not node.keywords
    return isinstance(node, (ast.Name, ast.expr_context, ast.operator, ast.unaryop))


@lru_cache(maxsize=1024)
def names(tree: ast.expr) -> tuple[str, ...]:
    """Return the names that enter a formula, in the order in which they appear."""
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    found.sort(key=lambda node: node.col_offset)
    return tuple(dict.fromkeys(node.id for node in found if node.id not in RESERVED))


def call(node: ast.expr) -> tuple[str, list[ast.expr]]:
    """Return function and arguments of a part of a formula that is a call."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return node.func.id, node.args
    msg = f"{ast.dump(node)} is not supported in a formula"
    raise CheckError(msg)


def evaluate(tree: ast.expr, values: Mapping[str, Value]) -> Value:
    """Return the value of a formula."""
    with np.errstate(all="ignore"):
        found = _value(tree, {name: np.asarray(v, float) for name, v in values.items()})
    return tuple(map(float, found)) if found.ndim else float(found)


def _value(node: ast.expr, values: Mapping[str, FloatArray]) -> FloatArray:
    if isinstance(node, ast.Constant):
        return np.asarray(node.value, float)
    if isinstance(node, ast.Name):
        return np.asarray(math.pi) if node.id == "pi" else values[node.id]
    if isinstance(node, ast.UnaryOp):
        return np.negative(_value(node.operand, values))
    if isinstance(node, ast.BinOp):
        left, right = _value(node.left, values), _value(node.right, values)
        return np.asarray(_OPERATORS[type(node.op)](left, right))
    name, parts = call(node)
    arguments = [_value(argument, values) for argument in parts]
    if name in _ONE:
        return np.asarray(_ONE[name](arguments[0]))
    reduce = _MANY[name]
    found = arguments[0] if len(arguments) > 1 else np.asarray(reduce.reduce(arguments[0]))
    for other in arguments[1:]:
        found = np.asarray(reduce(found, other))
    return found


class Style(NamedTuple):
    """Style of a written formula."""

    show: Callable[[str], str]  # text for a name: its symbol, or its number
    dots: bool  # whether products have a dot, as between numbers


_GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "epsilon": "ε",
    "zeta": "ζ",
    "eta": "η",
    "theta": "θ",
    "kappa": "κ",
    "lambda": "λ",
    "mu": "μ",
    "nu": "ν",
    "xi": "ξ",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "phi": "φ",
    "psi": "ψ",
    "omega": "ω",
    "Delta": "Δ",
    "Theta": "Θ",
    "Sigma": "Σ",
    "Phi": "Φ",
    "Psi": "Ψ",
    "Omega": "Ω",
    "pi": "π",
}
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_USUAL = {"N": "kN", "N/m": "kN/m", "Pa": "MPa", "J": "kJ", "N m": "kN m"}
_SCALE = {
    ("N", "kN"): 1e3,
    ("N", "MN"): 1e6,
    ("N/m", "kN/m"): 1e3,
    ("N/m", "kN/mm"): 1e6,
    ("Pa", "kPa"): 1e3,
    ("Pa", "MPa"): 1e6,
    ("J", "kJ"): 1e3,
    ("N m", "kN m"): 1e3,
    ("m", "mm"): 1e-3,
    ("m", "cm"): 1e-2,
    ("-", "%"): 1e-2,
    ("kg", "t"): 1e3,
    ("m/s2", "g"): 9.80665,
}
_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(1, 6)


def usual_unit(unit: str) -> str:
    """Return the unit in which engineers read a quantity that is kept in `unit`."""
    return _USUAL.get(unit, unit)


def scale(unit: str, shown: str) -> float:
    """Return the size of the shown unit in the kept unit; KeyError if there is no such pair."""
    return 1.0 if unit == shown else _SCALE[unit, shown]


def number(value: float) -> str:
    """Return a number with four significant digits, with a power of ten if it needs one."""
    value += 0.0  # no -0
    if not (1e-4 <= abs(value) < 1e6 or abs(value) <= 0.0):
        mantissa, _, exponent = f"{value:.3e}".partition("e")
        short = mantissa.rstrip("0").rstrip(".")
        return f"{short}·10{str(int(exponent)).translate(_RAISED)}" if exponent else short
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def quantity(value: Value, unit: str, shown: str, *, units: bool = True) -> str:
    """Return a value in the unit shown, four entries of several at most."""
    factor = scale(unit, shown)
    if isinstance(value, float):
        text = number(value / factor)
    else:
        entries = [number(v / factor) for v in value]
        more = [*entries[:2], "…", entries[-1]] if len(entries) > 4 else entries
        text = f"({', '.join(more)})"
    return f"{text} {shown.translate(_RAISED)}" if units and shown != "-" else text


def symbol_text(name: str) -> str:
    """Return a name with Greek letters: ``beta_M`` as β_M."""
    return "_".join(_GREEK.get(part, part) for part in name.split("_")).replace("_prime", "′")


def symbol_mathml(name: str) -> str:
    """Return a name as MathML; the part after the first underscore is a subscript."""
    head, _, tail = symbol_text(name).partition("_")
    plain = f"<mi>{escape(head)}</mi>"
    return f"<msub>{plain}<mi>{escape(tail.replace('_', ','))}</mi></msub>" if tail else plain


def text(tree: ast.expr, style: Style) -> str:
    """Return a formula as a line of text."""
    return _text(tree, style)[0]


def _text(node: ast.expr, style: Style) -> tuple[str, int]:
    # Text of a part of a formula, and how strongly it binds.
    if isinstance(node, ast.Constant):
        return number(float(str(node.value))), _ATOM
    if isinstance(node, ast.Name):
        found = "π" if node.id == "pi" else style.show(node.id)
        return found, _POWER if found.startswith("-") or "·" in found or " " in found else _ATOM
    if isinstance(node, ast.UnaryOp):
        return f"-{_held(node.operand, style, _SIGN)}", _SIGN
    if isinstance(node, ast.BinOp):
        return _operation(node, style)
    name, arguments = call(node)
    inner = ", ".join(text(argument, style) for argument in arguments)
    if name in {"abs", "sqrt", "sum"}:
        around = {"abs": "|{}|", "sqrt": "√({})", "sum": "Σ({})"}[name]
        return around.format(inner), _ATOM
    return f"{name}({inner})", _ATOM


def _held(node: ast.expr, style: Style, least: int) -> str:
    found, strength = _text(node, style)
    return found if strength >= least else f"({found})"


def _operation(node: ast.BinOp, style: Style) -> tuple[str, int]:
    if isinstance(node.op, (ast.Add, ast.Sub)):
        sign = "+" if isinstance(node.op, ast.Add) else "-"
        least = _SUM if sign == "+" else _PRODUCT
        right = _held(node.right, style, least)
        right = f"({right})" if right.startswith("-") else right
        return f"{_held(node.left, style, _SUM)} {sign} {right}", _SUM
    if isinstance(node.op, ast.Mult):
        left, right = _held(node.left, style, _PRODUCT), _held(node.right, style, _PRODUCT)
        right = f"({right})" if right.startswith("-") else right
        divides = isinstance(node.left, ast.BinOp) and isinstance(node.left.op, ast.Div)
        dot = divides or right[0].isdigit() or right[0] == "("
        dot |= style.dots and right[0] != "π"
        return f"{left}{' · ' if dot else ' '}{right}", _PRODUCT
    if isinstance(node.op, ast.Div):
        return f"{_held(node.left, style, _PRODUCT)} / {_held(node.right, style, _SIGN)}", _PRODUCT
    base = _held(node.left, style, _ATOM)
    whole = isinstance(node.right, ast.Constant) and float(str(node.right.value)).is_integer()
    exponent = text(node.right, style)
    return f"{base}{exponent.translate(_RAISED) if whole else f'^({exponent})'}", _POWER


def mathml(tree: ast.expr) -> str:
    """Return a formula as MathML Core, without the element `math` around it."""
    return _mathml(tree, 0)


def _mathml(node: ast.expr, least: int) -> str:
    if isinstance(node, ast.Constant):
        return f"<mn>{number(float(str(node.value)))}</mn>"
    if isinstance(node, ast.Name):
        return symbol_mathml(node.id)
    if isinstance(node, ast.UnaryOp):
        return _fenced(f"<mo>-</mo>{_mathml(node.operand, _SIGN)}", least > _SIGN)
    if isinstance(node, ast.BinOp):
        return _operation_mathml(node, least)
    name, arguments = call(node)
    inner = "<mo>,</mo>".join(_mathml(argument, 0) for argument in arguments)
    if name == "sqrt":
        return f"<msqrt>{inner}</msqrt>"
    if name == "abs":
        return f"<mrow><mo>|</mo>{inner}<mo>|</mo></mrow>"
    head = "<mo>∑</mo>" if name == "sum" else f"<mi>{name}</mi>"
    return f"<mrow>{head}{_fenced(inner, True)}</mrow>"


def _operation_mathml(node: ast.BinOp, least: int) -> str:
    if isinstance(node.op, ast.Div):
        return _fenced(f"<mfrac>{_row(node.left)}{_row(node.right)}</mfrac>", least > _SIGN)
    if isinstance(node.op, ast.Pow):
        inner = f"<msup><mrow>{_mathml(node.left, _ATOM)}</mrow>{_row(node.right)}</msup>"
        return _fenced(inner, least > _POWER)
    if isinstance(node.op, ast.Mult):
        dot = isinstance(node.right, ast.Constant) or isinstance(node.left, ast.Constant)
        sign = "<mo>·</mo>" if dot else "<mo>&#x2062;</mo>"
        inner = f"{_mathml(node.left, _PRODUCT)}{sign}{_right(node.right, _PRODUCT)}"
        return _fenced(inner, least > _PRODUCT)
    minus = isinstance(node.op, ast.Sub)
    right = _right(node.right, _PRODUCT if minus else _SUM)
    inner = f"{_mathml(node.left, _SUM)}<mo>{'-' if minus else '+'}</mo>{right}"
    return _fenced(inner, least > _SUM)


def _right(node: ast.expr, least: int) -> str:
    return _mathml(node, _POWER if isinstance(node, ast.UnaryOp) else least)


def _row(node: ast.expr) -> str:
    return f"<mrow>{_mathml(node, 0)}</mrow>"


def _fenced(inner: str, fence: bool) -> str:
    return f"<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>" if fence else f"<mrow>{inner}</mrow>"
