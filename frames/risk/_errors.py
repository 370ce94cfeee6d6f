"""Errors of fragility, risk and campaigns."""


class FragilityError(ValueError):
    """Demands, capacities or a hazard of which no fragility or risk can be made."""


class CampaignError(ValueError):
    """A campaign, or a database of one, that cannot be used; the message names the culprit."""
