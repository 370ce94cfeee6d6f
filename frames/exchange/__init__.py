"""Models of other programs: their tables read into one neutral building, and frames made of it."""
