"""Measured frequency responses beside those of a case, and the modes of both."""
