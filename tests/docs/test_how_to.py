"""Pages that name what the program says: its messages, its statuses, the sections of its report."""

import ast
import re
from pathlib import Path

import pytest

from lir_element import RunStatus
from tests.spanish import PLACES

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| `([^`]+)` \|", re.MULTILINE)


def messages() -> list[str]:
    """Return the messages that the page on troubleshooting explains."""
    return ROW.findall((ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8"))


def said() -> list[str]:
    """Return all texts of both packages, their numbers and names as an ellipsis."""
    found = []
    for package in ("lir_element", "frames"):
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.JoinedStr):
                    parts = (getattr(part, "value", "…") for part in node.values)
                    found.append("".join(p if isinstance(p, str) else "…" for p in parts))
                elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                    found.append(PLACES.sub("…", node.value))
    return found


def test_messages_are_those_of_the_program() -> None:
    texts = said()
    assert len(messages()) > 30
    assert [m for m in messages() if not any(m in text for text in texts)] == []


def test_every_status_is_explained() -> None:
    for status in set(RunStatus) - {RunStatus.OK}:
        assert any(message in status.meaning for message in messages()), status


def test_sections_are_those_of_the_report() -> None:
    writing = pytest.importorskip("frames.design.report.writing", reason="needs the extra cli")
    heads = [title for _, title in writing.SECTIONS]
    page = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    table = page.partition("## Section by section")[2].partition("##")[0]
    assert heads
    assert re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE)[1:] == heads


def test_panels_are_those_of_the_view() -> None:
    template = ROOT / "frames" / "viewer" / "assets" / "view.html"
    heads = re.findall(r"<h2>([^<]+)</h2>", template.read_text(encoding="utf-8"))
    page = (ROOT / "docs" / "view.md").read_text(encoding="utf-8")
    table = page.partition("## Parts of the page")[2].partition("\n\n")[2].partition("\n\n")[0]
    assert heads
    assert re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE)[1:] == heads
