"""Slips of units: numbers of a case that are not plausible as they stand, and the unit that was likely meant."""
