"""One script a claim: a statement with its source, computed."""
