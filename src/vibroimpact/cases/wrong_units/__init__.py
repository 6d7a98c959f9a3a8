"""Slips of units: detection of implausible values in a case, with the unit that was
likely meant.
"""
