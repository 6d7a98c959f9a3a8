"""Parameter studies: many drops of one case, computed in resumable chunks, with dataset
and report.
"""
