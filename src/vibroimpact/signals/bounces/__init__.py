"""The bounces of a ball in a record: touches, the chain of bounces among them, and their times."""
