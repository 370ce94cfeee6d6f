"""Claims of the project, one script each: source on top, numbers and figures out."""
