"""Names of the files that commands write among the results of a project."""

from __future__ import annotations

RESULT_FILES = frozenset(
    {
        *(
            f"{name}.csv"
            for name in (
                "bearings",
                "bench",
                "checks",
                "compare",
                "compare-motions",
                "demands",
                "demands-by-motion",
                "eccentricity",
                "equivalent-linear",
                "friction",
                "links",
                "member-groups",
                "members",
                "members-without-forces",
                "modes",
                "motions",
                "programme",
                "provisions",
                "reactions",
                "storeys",
            )
        ),
        "checks.txt",
        "compare.html",
        "governing.nc",
        "interrupted.nc",
        "project.toml",
        "report.html",
        "report.pdf",
        "run.json",
        "view.html",
    }
)
"""Files of fixed names; time histories are ``runs-<bound>.nc`` and ``moved-<bound>.nc`` besides."""


def is_result(name: str) -> bool:
    """Return whether a file of a name would be written over, on any system."""
    return name.lower() in RESULT_FILES
