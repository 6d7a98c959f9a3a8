"""Comparison of one case under several contact laws."""
