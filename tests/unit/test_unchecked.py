"""What is not checked for want of a number, and what of a code is from memory: both are said."""

from dataclasses import replace
from types import SimpleNamespace

from frames.design import Standing, code_named
from frames.design.codes.code_values import CodeValue
from frames.design.project.unchecked import from_memory, unchecked


def said(
    wind: float = 0.0, service: float = 0.0, gap: float | None = None, moat: object = None
) -> str:
    above = SimpleNamespace(wind_shear=wind, service_displacement=service)
    limits = SimpleNamespace(moat_gap=gap)
    file = SimpleNamespace(superstructure=above, limits=limits, moat=moat)
    return "; ".join(unchecked(file))


def test_what_is_not_checked_names_the_key_that_is_missing() -> None:
    for key in ("wind_shear", "service_displacement", "moat_gap"):
        assert key in said()
    assert "sliding under wind: not checked, since no wind shear is given" in said()
    assert "wind" not in said(wind=1e5)
    assert "service" not in said(service=0.01)
    assert "moat_gap" not in said(gap=0.5)
    assert "moat_gap" not in said(moat=SimpleNamespace(gap=0.5))  # the runs have its walls
    assert said(wind=1e5, service=0.01, gap=0.5) == ""
    limits = SimpleNamespace(moat_gap=0.5)
    bare = unchecked(SimpleNamespace(superstructure=None, limits=limits, moat=None))
    assert "overturning" in bare[0]


def test_values_from_memory_are_named_with_their_clause() -> None:
    known = CodeValue("A 1", "one", Standing("agrees", "C 3"))
    code = replace(
        code_named("ASCE 7-22"), values={"one": known, "two": CodeValue("B 2", "two, of three")}
    )
    (sentence,) = from_memory(code)
    assert sentence == "from memory, not read in the standard: B 2 (two, of three)"
    assert from_memory(replace(code, values={"one": known})) == ()
    for name in ("ASCE 7-22", "EN 1998", "NCh2745"):
        assert "(of the whole structure, safety 1.0)" in from_memory(code_named(name))[0]
