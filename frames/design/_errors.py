"""Errors of design checks and of projects."""


class CheckError(ValueError):
    """Raised if a design check or one of its numbers is unusable; the message names the cause.

    Examples
    --------
    >>> from frames.design import PropertyModificationFactors
    >>> try:
    ...     PropertyModificationFactors(1.2, 1.5)
    ... except CheckError as error:
    ...     print(str(error).split(":")[0])
    lower factor of properties = 1.2 must be positive and at most 1
    """


class ProjectError(ValueError):
    """A project's file that cannot be used: a line for each thing that is wrong.

    Examples
    --------
    >>> from frames.design.project.reading import read_project
    >>> try:
    ...     read_project("nowhere.toml")
    ... except ProjectError as error:
    ...     print(error)
    nowhere.toml: No such file or directory: name an existing file, `lir new` shows how
    """
