"""What drives OpenSees."""
