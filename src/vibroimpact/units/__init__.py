"""Quantities and units: parsing, conversion and formatting."""
