"""A design project as a file: its contents, their checks, and the objects made of it."""
