"""What is asked of a simulation: bodies, laws, the drop and its surroundings, and when it ends."""
