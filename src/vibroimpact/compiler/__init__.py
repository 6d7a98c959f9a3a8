"""The compiler of scalar functions: their types, the forces of laws as function values,
and compiled code kept on disk.
"""
