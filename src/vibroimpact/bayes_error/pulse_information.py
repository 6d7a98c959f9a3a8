r"""Fisher information of a Hertzian force pulse in white noise.

It tells how well impulse and duration of the pulse can be measured. A pulse of impulse J and
duration T about an unknown instant has the spectrum :math:`J\,\Phi(fT)\,e^{-2\pi i f t_0}` with the
spectrum :math:`\Phi` of the pulse of unit impulse and duration. In noise of the one-sided power
spectral density :math:`N_0` and a band from 0 to B the information on :math:`(\ln J, \ln T)` is
(Kay, Fundamentals of Statistical Signal Processing I, 1993, eq. 3.31 and 15.52)

.. math::

    I = \frac{4 J^2}{N_0 T} \int_0^{BT} \begin{pmatrix} \Phi^2 & u\Phi\Phi' \\ u\Phi\Phi' &
    u^2\Phi'^2 \end{pmatrix} du

The instant does not enter, since the pulse is symmetric about its middle.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.inverse.hertz_pulse import hertz_pulse

# step and end of u = f T
_STEP = 0.005
_LAST = 40.0


@cache
def _integrals() -> tuple[Floats, Floats]:
    """Return the limits BT, and the integrals of the information up to them.

    They are those of Phi^2, of u Phi Phi' and of (u Phi')^2, (3, limits).
    """
    from scipy.integrate import cumulative_simpson

    nodes, weights = np.polynomial.legendre.leggauss(400)
    # half of the pulse, which is symmetric, from first touch to the middle
    time = 0.25 * (1.0 + nodes)
    weights = 0.25 * weights
    force = hertz_pulse(time) * weights * 2.0
    u = np.arange(0.0, _LAST + _STEP, _STEP)
    # the cosine transform about the middle: the spectrum of a symmetric pulse is real
    phase_per_u = 2.0 * np.pi * (0.5 - time)
    phase = np.outer(u, phase_per_u)
    spectrum = np.cos(phase) @ force
    slope = -np.sin(phase) @ (force * phase_per_u)
    integrands = np.stack([spectrum**2, u * spectrum * slope, (u * slope) ** 2])
    return u, np.asarray(cumulative_simpson(integrands, x=u, axis=1, initial=0.0))


def pulse_uncertainty(
    impulse: Floats, duration: Floats, bandwidth: float, noise_density: float
) -> Floats:
    r"""Return the least deviations with which impulse and duration of a pulse can be measured.

    They are those of Cramér and Rao: square roots of the diagonal of the inverse of the
    information.

    Parameters
    ----------
    impulse : array, shape (n,)
        Impulse of the contact force [N s].
    duration : array, shape (n,)
        Duration of the contact [s].
    bandwidth : float
        Upper end of the band that is heard [Hz].
    noise_density : float
        One-sided power spectral density of the noise as a force [N^2/Hz].

    Returns
    -------
    array, shape (2, n)
        Standard deviations of ln J and ln T, if neither is known, nor the instant.

    Examples
    --------
    A pulse of 1 N s in 300 us, heard up to 10 kHz, whose peak of 6.13 kN is 100 times the noise:

    >>> noise = (6131.8 / 100.0) ** 2 / 10e3
    >>> pulse_uncertainty(np.array([1.0]), np.array([300e-6]), 10e3, noise).round(4).tolist()
    [[0.0074], [0.0075]]
    """
    u, integrals = _integrals()
    limit = np.minimum(np.asarray(duration) * bandwidth, u[-1])
    impulse_term, mixed_term, duration_term = (
        np.interp(limit, u, integral) for integral in integrals
    )
    scale = 4.0 * np.asarray(impulse) ** 2 / (noise_density * np.asarray(duration))
    # the inverse of a symmetric matrix of two rows
    determinant = impulse_term * duration_term - mixed_term**2
    with np.errstate(divide="ignore"):  # without a band nothing is known
        variances = np.stack([duration_term, impulse_term]) / (scale * determinant)
    return np.asarray(np.sqrt(variances))
