"""Reading and writing mesh files of other programs, and meshing geometry files."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
