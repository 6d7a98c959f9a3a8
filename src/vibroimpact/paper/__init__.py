"""Reproduction of the paper: printed values, values computed here, and a verdict on each
difference.
"""
