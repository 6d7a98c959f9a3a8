"""Bounds on recognition: what a classifier can tell of a stated population that sees
stated quantities with a stated scatter.
"""
