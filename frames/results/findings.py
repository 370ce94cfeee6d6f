"""Findings of the assumption check, as objects; text for display."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lir_element.device.features import Features
from lir_element.texts import Text, html_table, text_from, worded

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

    import xarray as xr

    from frames.results.peak_response import Extreme


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A finding of the assumption check on one feature.

    Attributes
    ----------
    feature : str
        One of `Features.names()`; or "full_contact": the assumption of the level 'pendulum';
        "slip_stability": stability of the residual slip; "impacts": rim contact with a slip;
        "yield_displacement": effect of elastic sliding before slip; "yielding": rotation of hinges
        beyond their strength; "equilibrium", "accelerations" and "time_step": consistency of the
        run's numbers.
    left_out : bool
        True if the run left it out.
    mattered : bool
        Left out: whether that spoils the run. Modelled: whether it came into play.
    number : float
        Number behind the finding; the sentence defines it.
    sentence : str
        Statement of the finding for readers.
    doubtful : bool
        True if an effect in play needs attention.
    bearings : tuple of str
        Bearings at the level "pendulum" that need the level "contact".

    Examples
    --------
    >>> from frames import audit, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> found = audit(data)[1]
    >>> found.feature, found.left_out, found.mattered
    ('interface', False, False)
    """

    feature: str
    left_out: bool
    mattered: bool
    number: float
    sentence: str
    doubtful: bool = False
    bearings: tuple[str, ...] = ()

    @property
    def is_missing(self) -> bool:
        """True if the run should be repeated with the omitted effect."""
        return self.left_out and self.mattered

    @property
    def is_marked(self) -> bool:
        """True if it needs attention."""
        return self.is_missing or self.doubtful

    @property
    def line(self) -> str:
        """Its text; a marked one begins with "!"."""
        return worded(
            "{mark} {sentence}", mark="!" if self.is_marked else " ", sentence=self.sentence
        )


class Findings(tuple[Finding, ...]):
    """Findings of a run, which print as text and as a table in a notebook."""

    __slots__ = ()

    def lines(self) -> list[str]:
        """Return a line a finding: omitted effects first, then modelled ones."""
        return [found.line for found in self._in_order()]

    def doubts(self) -> tuple[str, ...]:
        """Return the sentences of those that are marked, in the same order."""
        return tuple(found.sentence for found in self._in_order() if found.is_marked)

    def _in_order(self) -> list[Finding]:
        return sorted(self, key=lambda found: not found.left_out)

    def missing(self) -> tuple[str, ...]:
        """Return the features whose omission spoils the run."""
        return tuple(f.feature for f in self if f.is_missing and f.feature in Features.names())

    def attrs(self) -> dict[str, str]:
        """Return them as attributes of a Dataset: as text for people, and to be read again."""
        return {"audit": repr(self), "findings": self.json()}

    def json(self) -> str:
        """Return them as a text that is read again."""
        return json.dumps(self.plain())

    def plain(self) -> list[dict[str, Any]]:
        """Return them for JSON, without false entries: `findings_from` reads it."""
        return [
            {k: v.plain() if isinstance(v, Text) else v for k, v in vars(one).items() if v}
            for one in self
        ]

    def __repr__(self) -> str:
        """Return a line a finding; "!" begins warnings."""
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        rows = [tuple(line.split(": ", 1)) for line in self.lines()]
        return html_table("check of modelling assumptions", rows)


def findings_of(data: xr.Dataset) -> Findings:
    """Return the findings of the assumption check made with a result."""
    row = {n: data[n].item() for n in ("findings", "audit") if n in data and not data[n].ndim}
    own = row or data.attrs  # of a row of many runs, or of one alone
    return _read(own.get("findings"), own.get("audit", ""))


def findings_by_run(data: xr.Dataset) -> list[Findings]:
    """Return the findings of the assumption checks of many runs, or of one alone."""
    if "run" not in data.dims:
        return [findings_of(data)]
    audits = data["audit"].to_numpy().tolist()
    kept = data["findings"].to_numpy().tolist() if "findings" in data else [None] * len(audits)
    return list(map(_read, kept, audits))


def _read(kept: str | None, audit: object) -> Findings:
    # As JSON, or of a file from before findings were kept beside their text.
    if kept is not None:
        return findings_from(json.loads(kept))
    return Findings(map(_of_line, str(audit).splitlines()))


def findings_from(found: Iterable[dict[str, Any]]) -> Findings:
    """Return findings from the output of `Findings.plain`, through JSON or not."""
    nothing = {"left_out": False, "mattered": False, "number": 0.0, "bearings": ()}
    whole = ({**nothing, **one} for one in found)
    return Findings(
        Finding(
            **one | {"sentence": text_from(one["sentence"]), "bearings": tuple(one["bearings"])}
        )
        for one in whole
    )


def doubts_of(data: xr.Dataset) -> tuple[str, ...]:
    """Return the marked findings of a result's assumption check, a sentence each."""
    return findings_of(data).doubts()


def _of_line(line: str) -> Finding:
    sentence, is_marked = line[2:], line.startswith("! ")
    head = sentence.partition(":")[0]
    name = head.removesuffix(" left out")
    return Finding(
        feature=name.replace(" ", "_"),
        left_out=name != head,
        mattered=name != head and is_marked,
        number=float("nan"),
        sentence=sentence,
        doubtful=is_marked,
    )


def finding(
    feature: str,
    out: bool,
    mattered: bool,
    number: float,
    text: str,
    *,
    doubtful: object = False,
    bearings: Iterable[object] = (),
) -> Finding:
    """Return the finding on a feature that was left out or not, in a sentence with its name."""
    label = feature.replace("_", " ")
    if out:
        sentence = worded("{feature} left out: {what}", feature=label, what=text)
    elif mattered:
        sentence = worded("{feature}: {what}", feature=label, what=text)
    else:
        sentence = worded("{feature}: not needed, {what}", feature=label, what=text)
    return Finding(
        feature=feature,
        left_out=out,
        mattered=bool(mattered),
        number=number,
        sentence=sentence,
        doubtful=bool(doubtful),
        bearings=tuple(str(name) for name in bearings),
    )


def remark(feature: str, number: float, sentence: str, *, doubtful: bool) -> Finding:
    """Return a finding on the numbers of a run, not on an omission."""
    return Finding(
        feature=feature,
        left_out=False,
        mattered=doubtful,
        number=number,
        sentence=sentence,
        doubtful=doubtful,
    )


def by_whom(happened: Extreme) -> str:
    """Return in words where a quantity (bearing,) is 1: "3 of 9 bearings, first at 4.17 s"."""
    those = happened.values > 0.0
    first = float(happened.at[those].min())
    return worded(
        "{count} of {all} bearings, first at {time:.2f} s",
        count=those.sum(),
        all=len(those),
        time=first,
    )


def percent(value: float, digits: int = 0) -> str:
    """Return a share in words."""
    if value >= 10.0:
        return worded("more than 1000 %")
    return worded("{share:.{digits}f} %", share=100.0 * value, digits=digits)
