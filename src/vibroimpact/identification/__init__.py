"""From records of sensors on a plate: the force, its position, and the sphere, with intervals.

Of the sphere it is the size and the speed.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
