"""Restitutions at several approach speeds from a table: their fits over the speed, as
data, text and a page.
"""
