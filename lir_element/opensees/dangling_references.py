"""What OpenSees keeps of nodes that were removed: it ends the process when it meets that."""

from __future__ import annotations

from typing import Any

from lir_element.argument_checks import listed


def leftovers(ops: Any) -> str:
    """Look for constraints and elements whose nodes are gone.

    ``ops.remove('node', tag)`` leaves the node's supports, constraints and elements in the model.
    The next analysis then ends the process, mostly without a word.
    """
    nodes = set(ops.getNodeTags() or ())
    fixed = [tag for tag in ops.getFixedNodes() or () if tag not in nodes]
    tied = [
        tag
        for tag in ops.getConstrainedNodes() or ()
        if tag not in nodes or not nodes.issuperset(ops.getRetainedNodes(tag) or ())
    ]
    loose = [
        tag for tag in ops.getEleTags() or () if not nodes.issuperset(map(int, ops.eleNodes(tag)))
    ]
    found = []
    if fixed:
        held = ", ".join(str(dof) for dof in ops.getFixedDOFs(fixed[0]))
        found.append(
            f"nodes {listed(fixed)} were removed, but their fix was not: remove it too, for node "
            f"{fixed[0]} by ops.remove('sp', {fixed[0]}, dof) with dof = {held}"
        )
    if tied:
        found.append(
            f"multi-point constraints of nodes {listed(tied)} name a node that was removed: "
            f"remove them by ops.remove('mp', {tied[0]}) and so on"
        )
    if loose:
        found.append(
            f"elements {listed(loose)} end at a node that was removed: remove them by "
            f"ops.remove('element', {loose[0]}) and so on"
        )
    if not found:
        return ""
    return "; ".join(found) + ". OpenSees would end this process at its next analysis"
