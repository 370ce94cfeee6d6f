"""OpenSees' own elements as the same bearing, to compare with."""
