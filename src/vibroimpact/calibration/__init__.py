"""Calibration of a parameter of a contact law, or a modal damping, to measured impacts.

The impacts may be specified by another law, too.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
