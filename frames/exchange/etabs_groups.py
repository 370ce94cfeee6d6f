"""Groups of an ETABS text file, by which bearings are placed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.exchange.e2k_text import TEXT

if TYPE_CHECKING:
    from frames.exchange.building import Building
    from frames.exchange.tables import Row, Tables

SECTION = "GROUPS"
_AT_STORIES = {"POINT": "joint", "LINE": "frame", "AREA": "area"}


def read_groups(tables: Tables, building: Building) -> None:
    """Read the groups into a building that has its objects and links.

    A line names a group and an object of it: GROUP "ISO" POINT "12" "Base", GROUP "ISO" LINK "K1".
    A point that stands on a link brings this link along.
    """
    odd = []
    for row in tables.rows("GROUP"):
        name = row.text("Group")
        members = building.groups.setdefault(name, [])
        found = _members(row, building)
        if found is None:
            odd.append(name)
        else:
            members += found
    building.account.read(SECTION, "groups", len(building.groups))
    what = "objects of groups on lines of another form: bearings are not placed by them"
    building.account.left_out(SECTION, what, list(dict.fromkeys(odd)))


def _members(row: Row, building: Building) -> list[tuple[str, str]] | None:
    # Objects of a line by kind; none of a line that only defines a group, None of another form.
    kinds = [word for word in (*_AT_STORIES, "LINK") if row.has(word)]
    if not kinds:
        return []
    if len(kinds) > 1:
        return None
    names = row.text(kinds[0]).split("\n")
    if kinds[0] == "LINK":
        known = all(name in building.links for name in names)
        return [("link", name) for name in names] if known else None
    stories = row.text(TEXT, "").split("\n")
    if len(stories) != len(names) or "" in stories:
        return None
    labels = [f"{name}-{story}" for name, story in zip(names, stories, strict=True)]
    found = [(_AT_STORIES[kinds[0]], label) for label in labels]
    under = [f"link-{label}" for label in labels if kinds[0] == "POINT"]
    return found + [("link", link) for link in under if link in building.links]
