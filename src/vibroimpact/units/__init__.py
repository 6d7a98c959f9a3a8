"""Quantities and their units: read where people write them, and shown as people read them."""
