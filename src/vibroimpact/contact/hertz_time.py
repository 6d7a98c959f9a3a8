r"""The time of an elastic contact whose force grows with the power 3/2 of the indentation, as Hertz's does."""

from __future__ import annotations

import math

HERTZ_TIME = 0.8 * math.gamma(0.4) * math.gamma(0.5) / math.gamma(0.9)
r"""Duration of the contact over the largest indentation over the approach speed [-], 2.9433.

:math:`2 \int_0^1 dx / \sqrt{1 - x^{5/2}} = \tfrac45 \Gamma(\tfrac25) \Gamma(\tfrac12) / \Gamma(\tfrac{9}{10})`
(H. Hertz, J. reine angew. Math. 92:156, 1881; K. L. Johnson, Contact Mechanics, 1985, eq. 11.24 rounds it to 2.94).
"""
