"""Qin and Lu's law (Qin Zhiying and Lu Qishao).

It is Lankarani and Nikravesh's damping with a correction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw


@dataclass(frozen=True, kw_only=True)
class ZhiyingQishao(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Qin and Lu 2006).

    .. math::
        F = K \delta^n \left[1 + \tfrac34 (1 - e^2)\, \mathrm{e}^{2 (1 - e)}\, \dot\delta /
        \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    0.7 gives 0.680, 0.3 gives 0.327, and no value gives less than 0.17. The law is called by the
    given names of its authors, Qin Zhiying and Lu Qishao.

    References
    ----------
    Qin, Z. and Lu, Q. (2006). Analysis of impact process model based on restitution coefficient.
    Journal of Dynamics and Control 4, 294-298 (in Chinese).

    Examples
    --------
    >>> law = ZhiyingQishao(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 24.464536)
    """

    name = "zhiying-qishao"
    equation = "F = K delta^n [1 + 3/4 (1 - e^2) exp(2 (1 - e)) delta_dot / v0]"
    source = "Qin & Lu 2006, J. Dynamics and Control 4:294"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return (
            0.75
            * (1.0 - self.restitution * self.restitution)
            * np.exp(2.0 * (1.0 - self.restitution))
        )
