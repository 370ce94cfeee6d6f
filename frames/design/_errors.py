"""Errors of design checks and of projects."""


class CheckError(ValueError):
    """A design check, or a number of it, that cannot be used; the message names the culprit."""


class ProjectError(ValueError):
    """A project's file that cannot be used: a line for each thing that is wrong."""
