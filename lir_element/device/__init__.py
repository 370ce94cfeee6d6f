"""What the engineer specifies: the bearing, its friction, what of it is modelled."""
