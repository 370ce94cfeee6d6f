"""What is read off a Dataset."""
