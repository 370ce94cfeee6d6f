"""A calculation as an engineer writes it: each formula once, which is shown and evaluated."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.rendering import (
    RESERVED,
    Style,
    Value,
    evaluate,
    mathml,
    names,
    parse,
    quantity,
    scale,
    symbol_mathml,
    symbol_text,
    text,
    usual_unit,
)
from lir_element.texts import joined


class Trace:
    """A calculation in order: each line follows from the lines above it.

    Parameters
    ----------
    steps : iterable of Step
        Lines to begin with; none for a new calculation.

    Examples
    --------
    >>> t = Trace()
    >>> W = t.given("W", 1500e3, "N")
    >>> R = t.given("R", 2.5, "m")
    >>> D = t.given("D", 0.30, "m")
    >>> mu = t.given("mu", 0.06)
    >>> F = t("F", "W * (D / R + mu)", "N", source="force of a friction pendulum")
    >>> print(t["F"].text())
    F = W · (D / R + μ) = 1500 kN · (0.3 m / 2.5 m + 0.06) = 270 kN
    """

    def __init__(self, steps: Iterable[Step] = ()) -> None:
        self._steps = {step.symbol: step for step in steps}

    def given(
        self,
        symbol: str,
        value: float,
        unit: str = "-",
        *,
        source: str = "",
        note: str = "",
        shown: str = "",
    ) -> float:
        """Enter a number that does not follow from others, and return it.

        Parameters
        ----------
        symbol : str
            Name of the number: letters, digits and underscores; ``beta_M`` is shown as β_M.
        value : float
            The number, in `unit`.
        unit : str
            SI unit, or the unit of the clause; "-" for a pure number.
        source, note : str
            Source of the number, and a remark for the reader.
        shown : str
            Unit shown: by default forces in kN and stresses in MPa; "mm" for a length in mm, "%"
            for a ratio in per cent.

        Returns
        -------
        float
            The number.

        Raises
        ------
        CheckError
            If the symbol is in use or no name, or the value is NaN.
        """
        return _single(self._add(symbol, float(value), unit, source=source, note=note, shown=shown))

    def given_each(
        self,
        symbol: str,
        values: Sequence[float],
        unit: str = "-",
        *,
        source: str = "",
        note: str = "",
        shown: str = "",
    ) -> tuple[float, ...]:
        """Enter a number for each of several bearings or storeys, as `given`, and return them."""
        found = tuple(map(float, values))
        return _several(self._add(symbol, found, unit, source=source, note=note, shown=shown))

    def looked_up(
        self,
        symbol: str,
        value: float,
        at: Sequence[str],
        unit: str = "-",
        *,
        source: str = "",
        note: str = "",
        shown: str = "",
    ) -> float:
        """Enter a number that a table or a spectrum has at earlier values, as `given`.

        Parameters
        ----------
        symbol, value, unit, source, note, shown
            As in `given`.
        at : sequence of str
            Symbols of the values at which it was looked up.

        Returns
        -------
        float
            The number.
        """
        found = self._add(
            symbol, float(value), unit, entered=at, source=source, note=note, shown=shown
        )
        return _single(found)

    def __call__(
        self,
        symbol: str,
        formula: str,
        unit: str = "-",
        *,
        source: str = "",
        note: str = "",
        shown: str = "",
    ) -> float:
        """Evaluate a formula, enter its line and return its value."""
        return _single(self._formed(symbol, formula, unit, source, note, shown))

    def each(
        self,
        symbol: str,
        formula: str,
        unit: str = "-",
        *,
        source: str = "",
        note: str = "",
        shown: str = "",
    ) -> tuple[float, ...]:
        """Evaluate a formula for each of several, as `__call__` for one, and return the values."""
        return _several(self._formed(symbol, formula, unit, source, note, shown))

    def of(self, *symbols: str) -> Trace:
        """Return the calculation of some symbols alone: them, and all that they follow from."""
        wanted, queue = set[str](), list(symbols)
        while queue:
            name = queue.pop()
            if name not in wanted:
                wanted.add(name)
                queue += [e.symbol for e in self[name].entered]
        return Trace(step for step in self if step.symbol in wanted)

    def copy(self) -> Trace:
        """Return the same calculation, to be continued apart."""
        return Trace(self)

    def value(self, symbol: str) -> float:
        """Return the number of a symbol."""
        return _single(self[symbol])

    def values(self, symbol: str) -> tuple[float, ...]:
        """Return the numbers of a symbol of several."""
        return _several(self[symbol])

    def text(self) -> str:
        """Return all lines, each with its source and note."""
        return "\n".join(
            "   ".join(part for part in (step.text(), step.said) if part) for step in self
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td style='text-align: left'>{step.mathml()}</td>"
            f"<td style='text-align: left'>{escape(step.said)}</td></tr>"
            for step in self
        )
        return f"<table>{rows}</table>"

    def __getitem__(self, symbol: str) -> Step:
        """Return the line of a symbol."""
        if symbol not in self._steps:
            msg = (
                f"symbol {symbol!r} is not in the calculation, which has "
                f"{', '.join(self._steps) or 'nothing'}"
            )
            raise CheckError(msg)
        return self._steps[symbol]

    def __contains__(self, symbol: object) -> bool:
        return symbol in self._steps

    def __iter__(self) -> Iterator[Step]:
        return iter(self._steps.values())

    def __len__(self) -> int:
        return len(self._steps)

    def __repr__(self) -> str:
        """Return the symbols."""
        return f"Trace of {', '.join(self._steps) or 'nothing'}"

    def _formed(
        self, symbol: str, formula: str, unit: str, source: str, note: str, shown: str
    ) -> Step:
        tree = parse(formula)
        entered = names(tree)
        values = {name: self[name].value for name in entered}
        try:
            found = evaluate(tree, values)
        except ValueError as cause:
            msg = (
                f"{symbol} = {formula} combines lists of different lengths ({cause}): use lists "
                "of one length"
            )
            raise CheckError(msg) from cause
        numbers = found if isinstance(found, tuple) else (found,)
        if not all(map(math.isfinite, numbers)):
            where = ", ".join(f"{name} = {self[name].result}" for name in entered)
            msg = f"{symbol} = {formula} is not finite at {where}: check its input values"
            raise CheckError(msg)
        return self._add(
            symbol, found, unit, formula, entered, source=source, note=note, shown=shown
        )

    def _add(
        self,
        symbol: str,
        value: Value,
        unit: str,
        formula: str = "",
        entered: Sequence[str] = (),
        *,
        source: str,
        note: str,
        shown: str,
    ) -> Step:
        if not symbol.isidentifier() or symbol in RESERVED or symbol in self._steps:
            why = "is in use" if symbol in self._steps else "is not a name for a formula"
            msg = f"symbol {symbol!r} {why}: choose a new name of letters, digits and _"
            raise CheckError(msg)
        if any(map(math.isnan, value if isinstance(value, tuple) else (value,))):
            msg = f"{symbol} = {value} is not a number: give a number in {unit}"
            raise CheckError(msg)
        shown = shown or usual_unit(unit)
        try:
            scale(unit, shown)
        except KeyError as cause:
            msg = f"{symbol} is in {unit}, which cannot be shown in {shown!r}: leave `shown` out"
            raise CheckError(msg) from cause
        quantities = tuple(self[name].result for name in entered)
        step = Step(Quantity(symbol, value, unit, shown), formula, quantities, source, note)
        self._steps[symbol] = step
        return step


def _single(step: Step) -> float:
    if isinstance(step.value, tuple):
        msg = f"{step.symbol} has {len(step.value)} values: use sum, min or max, or `each`"
        raise CheckError(msg)
    return step.value


def _several(step: Step) -> tuple[float, ...]:
    if isinstance(step.value, float):
        msg = (
            f"{step.symbol} has one value, and `each` needs a list: call the calculation without "
            "`each`"
        )
        raise CheckError(msg)
    return step.value


class Quantity(NamedTuple):
    """A value by its symbol."""

    symbol: str  # its name, as formulas have it
    value: Value  # in `unit`; a tuple if there are several
    unit: str  # unit it is kept in, "-" for a pure number
    shown: str  # unit it is shown in

    def __str__(self) -> str:
        """Return value and unit, as people read them."""
        return quantity(self.value, self.unit, self.shown)


@dataclass(frozen=True)
class Step:
    """A line of a calculation: given, looked up, or the result of a formula."""

    result: Quantity  # its result
    formula: str = ""  # the formula; empty for a value that was given or looked up
    entered: tuple[Quantity, ...] = ()  # its inputs
    source: str = ""  # clause, equation or table
    note: str = ""  # remark for the reader

    @property
    def symbol(self) -> str:
        """Symbol of the result."""
        return self.result.symbol

    @property
    def value(self) -> Value:
        """Value in `unit`."""
        return self.result.value

    @property
    def unit(self) -> str:
        """Unit of its value."""
        return self.result.unit

    def text(self) -> str:
        """Return the line as text: symbol, formula, numbers, value and unit."""
        if not self.formula:
            at = ", ".join(f"{symbol_text(e.symbol)} = {e}" for e in self.entered)
            return f"{symbol_text(self.symbol)} = {self.result}{f' at {at}' if at else ''}"
        tree = parse(self.formula)
        parts = {e.symbol: e for e in self.entered}
        units = any(e.shown != e.unit for e in (*self.entered, self.result))

        def shown(name: str) -> str:
            e = parts[name]
            if isinstance(e.value, tuple):
                return symbol_text(name)
            return quantity(e.value, e.unit, e.shown, units=units)

        lines = [symbol_text(self.symbol), text(tree, Style(symbol_text, False))]
        lines += [text(tree, Style(shown, True)), str(self.result)]
        if all(isinstance(e.value, tuple) for e in self.entered):
            del lines[2]
        return " = ".join(dict.fromkeys(lines))

    def mathml(self) -> str:
        """Return symbol, formula and value as a `math` element of MathML Core."""
        parts = [symbol_mathml(self.symbol)]
        if self.formula:
            parts.append(f"<mrow>{mathml(parse(self.formula))}</mrow>")
        parts.append(f"<mtext>{escape(str(self.result))}</mtext>")
        return f"<math>{'<mo>=</mo>'.join(parts)}</math>"

    @property
    def said(self) -> str:
        """Source and note in brackets, empty if there is none."""
        said = joined(self.source, self.note)
        return f"[{said}]" if said else ""
