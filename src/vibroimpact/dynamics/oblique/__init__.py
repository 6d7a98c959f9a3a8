"""Motion of a sphere along the plate and its spin: oblique impacts with friction."""
