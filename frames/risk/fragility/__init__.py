"""From many time histories to fragility, risk and what decides them."""
