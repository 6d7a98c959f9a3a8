"""What sensors on the plate record: from the motion of its points through a measuring
chain to samples.
"""
