"""The core: scalar code of one system, which numba compiles where it is there; it imports
NumPy and nothing of the rest.
"""
