"""What a limit of the theory is, and the conditions of a drop that it is held to."""
