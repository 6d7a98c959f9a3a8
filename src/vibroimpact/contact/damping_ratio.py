"""Between a damping ratio and the restitution it gives, where the motion is that of a damped oscillator."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array


def damping_ratio_of(restitution: Array) -> Array:
    r"""Return the damping ratio :math:`\beta = -\ln e/\sqrt{\pi^2 + \ln^2 e}` [-] that gives a restitution.

    The contact ends at zero indentation, after half a period of the damped oscillation.

    Examples
    --------
    >>> round(float(damping_ratio_of(0.5)), 6)
    0.215454
    """
    log = np.log(np.asarray(restitution, dtype=float))
    return -log / np.sqrt(np.pi**2 + log * log)


def restitution_of(damping_ratio: Array) -> Array:
    r"""Return the restitution :math:`e = \exp(-\pi\beta/\sqrt{1 - \beta^2})` [-]; zero from critical damping on.

    Examples
    --------
    >>> round(float(restitution_of(0.215453)), 5)
    0.5
    """
    ratio = np.asarray(damping_ratio, dtype=float)
    under = np.minimum(ratio, 1.0)
    with np.errstate(divide="ignore"):
        return np.exp(-np.pi * under / np.sqrt((1.0 - under) * (1.0 + under)))[()]
