"""Export to other programs: multibody and discrete-element codes, data formats, audio and
visualization.
"""
