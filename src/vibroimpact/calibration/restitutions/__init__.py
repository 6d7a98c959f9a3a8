"""Restitutions at several approach speeds from a table, and their fits over the speed.

They are written as data, text and a page.
"""
