"""Parameter studies: many drops of one case, in chunks that can be resumed, with their report."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
