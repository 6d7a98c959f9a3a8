"""Test-analysis correlation: records of an impact or of a hammer beside the simulation of
the case, and the modes of both.
"""
