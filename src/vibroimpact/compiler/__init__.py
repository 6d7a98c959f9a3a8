"""The compiler of scalar functions, and compiled code kept on disk."""
