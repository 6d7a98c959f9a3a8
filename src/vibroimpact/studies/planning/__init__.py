"""What a study asks for: its section of the case, axes, populations, design and outputs."""
