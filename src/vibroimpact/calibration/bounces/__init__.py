"""Restitution from the bounces that are heard in a record, without a case."""
