"""From states to labelled results."""
