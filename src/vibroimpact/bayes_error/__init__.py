"""Bounds on recognition: the least error of any classifier of stated quantities.

They hold for a stated population, and for a stated scatter of what is observed.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
