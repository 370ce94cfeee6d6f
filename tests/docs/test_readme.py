"""The code of the pages runs: each python block in order, its output as the text block shows.

Numbers are compared to the digits shown: one unit of the last digit is allowed, for another
processor may round the other way.
"""

import contextlib
import io
import linecache
import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from validation.page import table
from validation.study import near_fault as pulses
from validation.study.device import LIR, REFERENCE, RIMS
from validation.study.shown import interval
from validation.study.summary import DCFP, LIMITS, collapses, pairs, parts_of

ROOT = Path(__file__).parents[2]
PAGES = (
    "README.md",
    "docs/guide.md",
    "docs/guide_building.md",
    "docs/guide_results.md",
    "docs/how_it_works.md",
    "docs/walls.md",
    "docs/motions.md",
    "docs/opensees.md",
    "docs/own_driver.md",
    "docs/fragility.md",
    "docs/campaigns.md",
    "docs/test_programme.md",
    "docs/view.md",
)
GUIDE = PAGES[1:4]
"""Each page continues the one before."""
AT_NIGHT = ("docs/motions.md", "docs/fragility.md", "docs/campaigns.md")
"""Five seconds each."""
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?", re.IGNORECASE)


def blocks(page: str) -> list[tuple[str, str]]:
    """Return code and expected output of each block."""
    found = [(m[1], m[2] or "") for m in BLOCK.finditer((ROOT / page).read_text(encoding="utf-8"))]
    has_opensees = find_spec("openseespy") is not None
    return [block for block in found if has_opensees or "opensees" not in block[0]]


def unit_of(number: str) -> float:
    """Return one unit of the last digit shown."""
    mantissa, _, exponent = number.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)


def assert_same_output(printed: str, shown: str) -> None:
    words = [" ".join(NUMBER.sub("#", text).split()) for text in (printed, shown)]
    assert words[0] == words[1], f"printed:\n{printed}\nshown:\n{shown}"
    for got, expected in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
        assert abs(float(got) - float(expected)) <= 1.01 * unit_of(expected), (got, expected)


@pytest.mark.parametrize(
    "pages",
    [
        pytest.param(
            GUIDE if page in GUIDE else (page,),
            id=page,
            marks=[pytest.mark.nightly] if page in AT_NIGHT else [],
        )
        for page in PAGES
        if page not in GUIDE[1:]
    ],
)
def test_blocks_print_what_the_pages_show(
    pages: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert all(blocks(page) for page in pages)
    found = [(page, *block) for page in pages for block in blocks(page)]
    namespace: dict[str, object] = {"__name__": "page"}
    for k, (page, code, shown) in enumerate(found):
        name, output = f"{page}, block {k}", io.StringIO()
        # as a notebook does: the source of functions can be read
        monkeypatch.setitem(linecache.cache, name, (len(code), None, code.splitlines(True), name))
        with contextlib.redirect_stdout(output):
            exec(compile(code, name, "exec"), namespace)  # the page's own code  # noqa: S102
        assert_same_output(output.getvalue(), shown)


def test_numbers_are_compared_to_the_digits_shown() -> None:
    assert_same_output("a 1.234 mm, -3e-05", "a 1.235 mm, -3e-05")
    for printed in ("a 1.24 mm", "a 1.23 m", "a 1.23 mm 4"):
        with pytest.raises(AssertionError):
            assert_same_output(printed, "a 1.22 mm")


@pytest.mark.parametrize("page", PAGES)
def test_every_code_block_has_a_language(page: str) -> None:
    """A fence without one would hide code from the test above."""
    fences = re.findall(r"^```(.*)$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE)
    assert set(fences[::2]) <= {"python", "text"}
    assert not any(fences[1::2])


def when_it_helps() -> str:
    """Return the table of the README and the words after it, from the numbers of the study."""
    parts = parts_of()
    near, cost = parts["near_fault"]["own"], parts["device"]["own"]["devices"]
    contact, held = (parts["device"]["campaigns"][name] for name in ("contact", "held"))
    words, lines = {"better": "helps", "worse": "worse"}, []
    ends = {
        f"equal {terms}, rims {text}": (group, rims)
        for terms, group in (("plan", f"plan, {REFERENCE}"), ("moat", "moat"))
        for text, rims in (("of W", RIMS[0]), ("unbreakable", RIMS[1]))
    }
    for limit in LIMITS:
        rows = [pairs(contact, limit, *end)[0] for end in ends.values()]
        cells = (f"{words.get(r['verdict'], 'alike')}: {interval(r, 'ratio')}" for r in rows)
        lines.append([limit, *cells])
    shut = " and ".join(
        interval(pairs(held, group=f"plan, {REFERENCE}", over=rims)[0], "ratio")
        for rims in RIMS[:2]
    )
    cells = pulses.counts(near, pulses.PLAN)
    price = sum(cost[LIR]["cost"].values()) / sum(cost[DCFP]["cost"].values())
    better, worse = cells[pulses.LIR_BETTER], cells[pulses.PLAIN_BETTER]
    one, two = (collapses(contact, name) for name in (LIR, DCFP))
    return f"""{table(["limit", *ends], lines)}

At the maximum considered earthquake {one} % collapse on the LIR-DCFP, {two} % on the DCFP with rims
of W. If 1 kN holds unloaded halves, collapse at equal plan is {shut}. Of
{sum(cells.values())} near-fault pulses both devices survive {pulses.both(cells)} at equal plan: the
LIR-DCFP is better in {better}, the DCFP in {worse}. The DCFP alone survives
{cells[pulses.PLAIN_ONLY]}. The LIR-DCFP costs {price:.2f} times as much, by assumed prices."""


def test_the_readme_says_when_it_helps_by_the_numbers_of_the_study() -> None:
    found = when_it_helps()
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert " ".join(found.split()) in " ".join(text.split()), found
