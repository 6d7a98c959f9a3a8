"""The prescribed motion of a plate's supports, as a sum of harmonic motions along one direction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from vibroimpact.arrays import Array, Complex, Floats
from vibroimpact.errors import InputError

_UNIT = 1e-9  # largest deviation of the length of a direction from one


@dataclass(frozen=True, kw_only=True, eq=False)
class PlateMotion:
    r"""Base excitation: prescribed motion of the supports of a plate along a direction.

    :math:`s(t) = \sum_k A_k \sin(2 \pi f_k t + \varphi_k)`

    Parameters
    ----------
    amplitude : float or array, shape (k,)
        Amplitude of each harmonic motion [m], >= 0.
    frequency : float or array, shape (k,)
        Their frequencies [Hz], > 0.
    phase : float or array, shape (k,), default 0
        Their phases at the start [rad]; at 0 the plate passes its mean position along the
        direction.
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector of the motion along x and y, in the plate, and its normal z.

    Raises
    ------
    InputError
        If a value is not finite or out of its range, or the direction is not of length 1.

    Examples
    --------
    >>> table = PlateMotion(amplitude=2e-3, frequency=25.0)
    >>> # displacement, velocity and acceleration a quarter of a period later
    >>> table.at(0.01).round(6).tolist()
    [0.002, 0.0, -49.348022]
    """

    amplitude: Array
    frequency: Array
    phase: Array = 0.0
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        self._check("amplitude", "not be negative", 0.0)
        self._check("frequency", "be greater than 0 Hz", 1e-300)
        self._check("phase", "", -np.inf)
        names = ("amplitude", "frequency", "phase")
        values = [np.atleast_1d(np.asarray(getattr(self, name), dtype=float)) for name in names]
        try:
            harmonics = np.broadcast_arrays(*values)
        except ValueError:
            raise InputError(
                "amplitude, frequency and phase of the plate's motion must agree in number, "
                "one for each harmonic"
            ) from None
        for name, value in zip(names, harmonics, strict=True):
            object.__setattr__(self, name, value)
        direction: Any = np.asarray(self.direction)
        if (
            direction.shape != (3,)
            or direction.dtype.kind not in "iuf"
            or not abs(np.linalg.norm(direction) - 1.0) <= _UNIT
        ):
            raise InputError(
                "direction of the plate's motion must be a vector of length 1 along x, y "
                f"and z, not {self.direction!r}"
            )
        object.__setattr__(self, "direction", tuple(direction.astype(float).tolist()))

    def _check(self, name: str, requirement: str, least: float) -> None:
        """Raise InputError unless a value, or a row of them, is finite and not below the least."""
        value = getattr(self, name)
        if (
            np.asarray(value).dtype.kind not in "iuf"
            or np.ndim(value) > 1
            or not np.all(np.isfinite(value))
        ):
            raise InputError(
                f"{name} of the plate's motion must be a finite number in SI, or a row "
                f"of them, not {value!r}"
            )
        if not np.all(np.asarray(value) >= least):
            raise InputError(f"{name} of the plate's motion must {requirement}")

    @cached_property
    def angular_frequency(self) -> Floats:
        """Angular frequencies [rad/s] (k,)."""
        return np.asarray(2.0 * np.pi * np.asarray(self.frequency))

    @cached_property
    def phasors(self) -> Complex:
        """Complex amplitudes C of the motion [m] (k,).

        The motion is the imaginary part of the sum of C exp(i omega t).
        """
        return np.asarray(np.asarray(self.amplitude) * np.exp(1j * np.asarray(self.phase)))

    def at(self, time: Array, phasors: Complex | None = None) -> Floats:
        """Return displacement, velocity and acceleration at times [s] (...), (3, ...).

        They are in m, m/s and m/s^2. `phasors`: of another motion of these frequencies, (k,); by
        default those of the supports along the direction.
        """
        if phasors is None:
            phasors = self.phasors
        omega = self.angular_frequency
        rotating = phasors * np.exp(1j * omega * np.asarray(time, dtype=float)[..., None])
        displacement = rotating.imag.sum(axis=-1)
        velocity = (omega * rotating.real).sum(axis=-1)
        acceleration = -(omega**2 * rotating.imag).sum(axis=-1)
        return np.array([displacement, velocity, acceleration])
