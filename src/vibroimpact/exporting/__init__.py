"""Export to multibody and discrete-element programs, data formats, audio and visualization."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
