"""Formulas as strings: what is shown is what is computed."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from functools import lru_cache

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
"""Names that formulas know by themselves."""


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


def names(tree: ast.expr) -> tuple[str, ...]:
    """Return the names that enter a formula, in the order in which they appear."""
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    found.sort(key=lambda node: node.col_offset)
    return tuple(dict.fromkeys(node.id for node in found if node.id not in RESERVED))


def call(node: ast.expr) -> tuple[str, list[ast.expr]]:
    """Return function and arguments of a part of a formula that is a call."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return node.func.id, node.args
    msg = f"{ast.dump(node)} is no part of a formula"
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
