"""Presentation of the contact laws: sheets in the terminal, curves, and documentation pages."""
