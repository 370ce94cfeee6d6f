"""A design project as a file: what it says, checked, and what it becomes."""
