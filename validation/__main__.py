"""Run claims, or all, and write docs/validation: ``python -m validation [--only CLAIM]``.

    LIR_RECORDS=<folder of records> python -m validation

Claims that need a record are skipped, with the reason, where it is missing. The exit code is 1 if
a statement does not hold.
"""

from __future__ import annotations

import argparse
from importlib import import_module

from validation.page import CLAIMS, FOLDER, run


def main() -> int:
    """Run the named claims, or all; return how many do not hold."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("--only", choices=CLAIMS, action="append", help="a claim, once or more")
    failed = 0
    for name in parser.parse_args().only or CLAIMS:
        module = import_module(f"validation.claims.{name}")
        page = run(module.CLAIM, module.page)
        failed += page is not None and page.holds != "yes"
    print(f"written to {FOLDER}")
    return failed


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
