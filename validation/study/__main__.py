"""Run the whole study, part after part: `python -m validation.study --store study-runs`.

Each part keeps its runs in a folder of its own within the store, goes on with what is there, and
writes its page.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from frames.risk import archive_campaign
from validation.page import FOLDER
from validation.study import summary
from validation.study.runner import PARTS, name_of, run, write

if TYPE_CHECKING:
    from collections.abc import Sequence


def main(given: Sequence[str] | None = None) -> None:
    """Run the parts that are named, or all."""
    parser = argparse.ArgumentParser(prog="python -m validation.study")
    add, known = parser.add_argument, (*PARTS, "summary")
    add("parts", nargs="*", metavar="part", help=f"of: {', '.join(known)}", default=known)
    add("--store", type=Path, help="folder for the runs, kept", default=Path("study-runs"))
    add("--workers", type=int, default=1, help="runs at a time")
    add("--again", action="store_true", help="run nothing: write the pages from their numbers")
    add("--trial", type=int, help="so many records and intensities of each set")
    add("--to", type=Path, default=FOLDER, help="folder for the pages")
    add("--archive", type=Path, help="run nothing: folder for archives of the results in the store")
    options = parser.parse_args(given)
    if options.trial is not None and options.to == FOLDER:
        parser.error("--trial N is no result: --to FOLDER says where its pages go")
    unknown = [part for part in options.parts if part not in known]
    if unknown:
        parser.error(f"no part {unknown[0]!r}: one of {', '.join(known)}")
    for part in options.parts:
        if options.archive is not None:
            archived(part, options.store / part, options.archive)
        elif part == "summary":
            summary.main(again=options.again)
        elif options.again:
            write(part, options.to)
        else:
            run(part, options.store, options.to, options.workers, options.trial)


def archived(part: str, store: Path, to: Path) -> None:
    """Write the campaigns of a part as one archive, if it has any."""
    found = sorted(path.parent for path in store.rglob("plan.json"))
    if not found:
        print(f"{part}: no campaign in {store}")
        return
    named = {"" if each == store else each.relative_to(store).as_posix(): each for each in found}
    command = f"python -m validation.study {part}"
    print(archive_campaign(named, to / f"{name_of(part)}.zip", command=command))


if __name__ == "__main__":
    main()
