"""Recompute what a project's run reported, from its files alone.

    python recompute.py FOLDER [--json]

FOLDER holds a project as `lir run` leaves it: motions, and results/ with the histories of all runs
(``[analysis] histories = "all"``). Nothing of the package is imported. Printed is a table by
category: number of values compared, worst relative difference, tolerance with its reason; then what
disagrees, and what was reported and not recomputed. The exit code is 1 where something disagrees.
"""

import json
import sys

import building
import checks
import codes
import demands
import forces
import histories
import motions
import report
from reading import Project
from tally import Tally


def review(folder):
    """Return the comparisons of a project's folder."""
    project, tally = Project(folder), Tally()
    project.peaks = histories.compare(project, project.runs, tally)
    project.moved_peaks = histories.compare(project, project.moved, tally)
    building.compare(project, tally)
    project.linear = codes.compare(project, tally)
    project.suites = demands.compare(project, tally)
    forces.compare(project, tally)
    motions.compare(project, tally)
    checks.compare(project, tally)
    report.compare(project, tally)
    return tally


def main(arguments):
    """Review the folder; return 1 where something disagrees."""
    tally = review(arguments[0])
    if "--json" in arguments:
        print(
            json.dumps(
                {
                    "counts": tally.counts,
                    "worst": tally.worst,
                    "tolerances": {name: list(pair) for name, pair in tally.why.items()},
                    "bad": [list(map(str, each)) for each in tally.bad],
                    "missing": [list(each) for each in tally.missing],
                }
            )
        )
    else:
        show(tally)
    return 1 if tally.bad else 0


def show(tally, most=40):
    """Print the table of comparisons."""
    for name, count in tally.counts.items():
        tolerance, why = tally.why[name]
        print(f"{name:<58}{count:>8}{tally.worst.get(name, 0.0):>10.1e}{tolerance:>9.0e}  {why}")
    print(
        f"{sum(tally.counts.values())} values, {len(tally.bad)} disagree,"
        f" {len(tally.missing)} not recomputed"
    )
    for each in tally.bad[:most]:
        print("DISAGREES", *each)
    for each in sorted(set(tally.missing))[:most]:
        print("not recomputed:", *each)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
