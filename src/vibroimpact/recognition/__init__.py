"""Recognition of what fell on a plate: classifiers, validated against leaks, and applied."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
