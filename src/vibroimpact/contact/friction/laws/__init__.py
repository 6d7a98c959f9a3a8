"""The friction laws of this package, one a file."""
