"""Observations from records and tables: of force, position and bounces."""
