"""Input of the engineer: the bearing, its friction, and its modelled features."""
