"""Inverse problems: from records to the force, its place and the parameters behind it.

This is pure mathematics, without bodies or cases.
"""
