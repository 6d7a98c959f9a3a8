"""The bounces of a ball in a record: touches, the chain among them whose intervals shrink
by a restitution, and their times.
"""
