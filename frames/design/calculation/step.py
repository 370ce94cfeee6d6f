"""A line of a calculation, as text and as MathML."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import NamedTuple

from frames.design.calculation.rendering import (
    Style,
    Value,
    mathml,
    parse,
    quantity,
    symbol_mathml,
    symbol_text,
    text,
)


class Quantity(NamedTuple):
    """A value by its symbol.

    Attributes
    ----------
    symbol : str
        Its name, as formulas have it.
    value : float or tuple of float
        In `unit`; a tuple for what there are several of.
    unit : str
        Unit it is kept in, "-" for a pure number.
    shown : str
        Unit it is shown in.
    """

    symbol: str
    value: Value
    unit: str
    shown: str

    def __str__(self) -> str:
        """Return value and unit, as people read them."""
        return quantity(self.value, self.unit, self.shown)


@dataclass(frozen=True)
class Step:
    """A line of a calculation: what was given, looked up, or follows by a formula.

    Attributes
    ----------
    result : Quantity
        What it gives.
    formula : str
        The formula that was evaluated; empty for what was given or looked up.
    entered : tuple of Quantity
        What entered it.
    source : str
        Clause, equation or table.
    note : str
        What else a reader should know.
    """

    result: Quantity
    formula: str = ""
    entered: tuple[Quantity, ...] = ()
    source: str = ""
    note: str = ""

    @property
    def symbol(self) -> str:
        """Its symbol."""
        return self.result.symbol

    @property
    def value(self) -> Value:
        """Its value, in `unit`."""
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
        """Its source and note in brackets, empty if it has none."""
        said = "; ".join(part for part in (self.source, self.note) if part)
        return f"[{said}]" if said else ""
