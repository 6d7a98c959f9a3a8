"""Test-analysis correlation: records of an impact or of a hammer beside the simulation.

The modes of both are compared, too.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
