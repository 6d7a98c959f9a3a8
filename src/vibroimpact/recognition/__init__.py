"""Recognition: classifiers of what fell on a plate, validated so that they can't fool
themselves, saved and applied.
"""
