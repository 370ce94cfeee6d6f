"""The command ``lir``: a design project from its file to results."""
