"""Models of other programs: their tables read into one neutral building, and made into frames."""
