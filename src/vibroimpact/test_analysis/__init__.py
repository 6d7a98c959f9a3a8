"""Test-analysis correlation: records of an impact or of a hammer beside the simulation.

The modes of both are compared, too.
"""
