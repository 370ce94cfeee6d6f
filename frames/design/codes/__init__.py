"""Design codes: equivalent-linear analysis, rules of histories, property bounds."""
