"""The frequency response assurance criterion: how much two frequency responses are alike."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError


def frac(measured: object, simulated: object) -> Floats:
    r"""Return the frequency response assurance criterion of frequency responses, or of spectra.

    .. math:: \mathrm{FRAC} = \frac{|\sum_k H_m^* H_s|^2}{\sum_k |H_m|^2 \sum_k |H_s|^2}

    It is 1 if one is a multiple of the other at all frequencies, and 0 if they have nothing in
    common. It does not tell a wrong size, and shifted resonances lower it much: of two light
    resonances whose frequencies are a half-power bandwidth apart it is 0.5.

    Parameters
    ----------
    measured, simulated : array of complex, shape (..., frequencies)
        The responses at the same frequencies.

    Returns
    -------
    array, shape (...)
        The criterion; NaN where one of the responses is zero throughout.

    Raises
    ------
    InputError
        If the shapes differ.

    References
    ----------
    Heylen, W. and Lammens, S. (1996). FRAC: a consistent way of comparing frequency response
    functions. Proceedings of the Conference on Identification in Engineering Systems, Swansea,
    48-57. Allemang, R. J. (2003). The modal assurance criterion: twenty years of use and abuse.
    Sound and Vibration 37(8), 14-21.

    Examples
    --------
    >>> response = np.array([1.0, 2.0j, -1.0])
    >>> float(frac(response, -3.0 * response)), round(float(frac(response, [1.0, 1.0j, 1.0])), 6)
    (1.0, 0.222222)
    """
    first = np.asarray(measured)
    second = np.asarray(simulated)
    if first.shape != second.shape or first.ndim == 0:
        raise InputError(
            f"responses of the shapes {first.shape} and {second.shape} can't be compared; "
            "give arrays of one shape, at the same frequencies"
        )
    with np.errstate(invalid="ignore", divide="ignore"):
        # sizes do not count: scaled, so that no square overflows or vanishes
        first = first / _largest(first)
        second = second / _largest(second)
        in_common = np.abs(np.sum(first.conj() * second, axis=-1)) ** 2
        energies = np.sum(np.abs(first) ** 2, axis=-1) * np.sum(np.abs(second) ** 2, axis=-1)
        return np.asarray(in_common / energies)


def _largest(response: NDArray[Any]) -> Floats:
    """Return the largest magnitude of each response, (..., 1)."""
    return np.asarray(np.max(np.abs(response), axis=-1, keepdims=True, initial=0.0))
