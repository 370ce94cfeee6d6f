"""What of a time history is recorded, and the Dataset made of it."""
