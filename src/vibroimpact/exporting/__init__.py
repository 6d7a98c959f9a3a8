"""What is written for other programs: multibody and discrete-element codes, data formats, sound and pictures."""
