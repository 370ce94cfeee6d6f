"""Errors of fragility, risk and campaigns."""


class FragilityError(ValueError):
    """Demands, capacities or a hazard of which no fragility or risk can be made.

    Examples
    --------
    >>> from frames.risk import lognormal_fragility
    >>> try:
    ...     lognormal_fragility(-2.0, 0.4)
    ... except FragilityError as error:
    ...     print(error)
    median = -2 [m/s2] must be positive and finite: give it in m/s2 (SI)
    """


class CampaignError(ValueError):
    """A campaign, or a database of one, that cannot be used; the message names the culprit.

    Examples
    --------
    >>> from frames.risk import open_campaign
    >>> try:
    ...     open_campaign("nowhere")
    ... except CampaignError as error:
    ...     print(error)
    nowhere holds no campaign: name the folder that one was run in
    """
