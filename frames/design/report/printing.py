"""The report as a PDF: printed by the system's Chromium, page numbers in its contents."""

from __future__ import annotations

import re
import shutil
import subprocess  # our own file, by a browser found on PATH  # noqa: S404
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from frames.design._errors import ProjectError
from lir_element.results.dataset import package_version

if TYPE_CHECKING:
    from pypdf import PdfReader

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
"""Programs that print, as they are looked for on PATH."""

PASSES = 4
"""How often the report is printed at most until its contents name the pages that it has."""

_LONGEST = 300.0  # s that a print may take
_PLACE = re.compile(r'(<span class="page" data-page="([^"]*)">)[^<]*(</span>)')


def print_report(page: Path, paper: Path) -> Path:
    """Print a report.

    Contents are filled with the numbers of pages that the print before gave, until they agree.
    """
    browser = _browser()
    try:
        from pypdf import PdfReader, PdfWriter
    except ImportError as cause:
        msg = 'a PDF with page numbers needs pypdf: pip install "lir-dcfp[pdf]"'
        raise ProjectError(msg) from cause
    text, numbers = page.read_text(encoding="utf-8"), dict[str, int]()
    with tempfile.TemporaryDirectory(prefix="lir-report-") as folder:
        for _ in range(PASSES):
            filled, made = Path(folder) / "report.html", Path(folder) / "report.pdf"
            filled.write_text(with_pages(text, numbers), encoding="utf-8")
            _print(browser, filled, made)
            found = pages_of(PdfReader(made))
            if found == numbers:
                writer = PdfWriter(made, incremental=True)  # what Chromium wrote stays
                writer.add_metadata({"/Producer": f"lir-dcfp {package_version()}, Chromium"})
                writer.write(paper)
                return paper
            numbers = found
    msg = (
        f"{page}: after {PASSES} prints the contents still name other pages than the PDF has: "
        "print the page from a browser instead"
    )
    raise ProjectError(msg)


def with_pages(text: str, numbers: dict[str, int]) -> str:
    """Return a report whose contents name pages."""
    return _PLACE.sub(lambda found: f"{found[1]}{numbers.get(found[2], '')}{found[3]}", text)


def pages_of(reader: PdfReader) -> dict[str, int]:
    """Return the pages of a PDF's named places, from 1 on."""
    places = {
        name.removeprefix("/"): reader.get_destination_page_number(place)
        for name, place in reader.named_destinations.items()
    }
    return {name: number + 1 for name, number in places.items() if number is not None}


def _browser() -> str:
    for name in BROWSERS:
        if found := shutil.which(name):
            return found
    msg = (
        f"no browser is found on PATH that prints ({', '.join(BROWSERS)}): install Chromium, or "
        "print report.html from any browser"
    )
    raise ProjectError(msg)


def _print(browser: str, page: Path, paper: Path) -> None:
    command = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={paper.parent / 'profile'}",
        "--no-pdf-header-footer",
        "--generate-pdf-document-outline",
        f"--print-to-pdf={paper}",
        page.as_uri(),
    ]
    try:
        done = subprocess.run(  # noqa: S603
            command, capture_output=True, text=True, timeout=_LONGEST, check=False
        )
    except subprocess.TimeoutExpired as cause:
        msg = f"{browser} did not print within {_LONGEST:g} s: print report.html from a browser"
        raise ProjectError(msg) from cause
    if done.returncode or not paper.is_file():
        told = (done.stderr.strip().splitlines() or ["no message"])[-1]
        msg = f"{browser} did not print ({told}): print report.html from a browser"
        raise ProjectError(msg)
