"""The result of a run as plain data, and the folder that holds it."""
