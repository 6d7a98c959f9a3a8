"""The fit of a parameter to observations, impact by impact, with its uncertainty."""
