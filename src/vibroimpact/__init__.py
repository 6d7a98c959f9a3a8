"""What happens when a particle hits a plate: contact, energy and vibration.

>>> import vibroimpact as vi
>>> response = vi.simulate(vi.load_case("paper:type1-theory"))
>>> response.impacts["rebound_height_m"].round(4).tolist()
[2.4111, 1.4572, 0.8846, 0.5409, 0.3346]

Names are loaded when they are first asked for, so that `vibroimpact --help` is quick; they are
listed in the stub `__init__.pyi`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
