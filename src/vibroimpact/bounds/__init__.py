"""Bounds on recognition: what a stated population lets any classifier tell, whatever it computes from the signal."""
