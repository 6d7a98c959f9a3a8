"""A plate that is struck and an instrument on it, computed by brute force at two million samples a
second (an oracle: imports nothing of vibroimpact).

Every mode of a simply supported plate, by Kirchhoff's theory in closed form and many times more of
them than are asked of the program, is driven by the contact force, straight between its samples;
the motion of the point goes through SciPy's filters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import signal
from scipy.linalg import expm

Floats = NDArray[np.float64]

RATE = 2e6


class SimplySupported:
    """All modes of a simply supported thin plate up to a frequency: `omega` [rad/s], and
    shapes of unit modal mass at points.
    """

    def __init__(
        self,
        size: tuple[float, float, float],
        density: float,
        modulus: float,
        poisson: float,
        highest: float,
    ) -> None:
        self.size = length, width, thickness = size
        rigidity = modulus * thickness**3 / (12.0 * (1.0 - poisson**2))
        m, n = (
            part.ravel()
            for part in np.meshgrid(np.arange(1, 400), np.arange(1, 400), indexing="ij")
        )
        omega = (
            np.sqrt(rigidity / (density * thickness))
            * np.pi**2
            * ((m / length) ** 2 + (n / width) ** 2)
        )
        keep = omega < 2.0 * np.pi * highest
        assert m[keep].max() < 399 > n[keep].max()
        self.omega, self.m, self.n = omega[keep], m[keep], n[keep]
        self.mass = density * length * width * thickness

    def at(self, x: float, y: float) -> Floats:
        """The shapes at a place from the plate's centre."""
        length, width, _ = self.size
        return np.asarray(
            2.0
            / np.sqrt(self.mass)
            * np.sin(self.m * np.pi * (x / length + 0.5))
            * np.sin(self.n * np.pi * (y / width + 0.5))
        )


def driven(
    omega: Floats, ratio: float, contact: Floats, points: Floats, force: Floats
) -> dict[str, Floats]:
    """What points (P, n) do under a force that pushes down at the contact, all at rest
    before: (P, samples) each.
    """
    step, damping = 1.0 / RATE, 2.0 * ratio * omega
    # straight between samples: the exponential of each mode's matrix, with the push and its slope
    # as further states
    whole = np.zeros((len(omega), 4, 4))
    whole[:, 0, 1], whole[:, 1, 0], whole[:, 1, 1], whole[:, 1, 2], whole[:, 2, 3] = (
        1.0,
        -(omega**2),
        -damping,
        1.0,
        1.0,
    )
    maps = expm(whole * step)
    found = {
        name: np.zeros((len(points), len(force)))
        for name in ("displacement", "velocity", "acceleration")
    }
    q, v = np.zeros(len(omega)), np.zeros(len(omega))
    for sample in range(len(force)):
        push = -contact * force[sample]
        moved = points @ np.stack([q, v, push - damping * v - omega**2 * q], axis=1)
        for name, value in zip(found, moved.T, strict=True):
            found[name][:, sample] = value
        slope = (
            (-contact * force[sample + 1] - push) / step if sample + 1 < len(force) else 0.0 * push
        )
        q, v = (
            maps[:, row, 0] * q
            + maps[:, row, 1] * v
            + maps[:, row, 2] * push
            + maps[:, row, 3] * slope
            for row in (0, 1)
        )
    return found


def seismic(value: Floats, resonance: float, ratio: float) -> Floats:
    """What a mass on a spring puts out."""
    omega = 2.0 * np.pi * resonance
    numerator, denominator, _ = signal.cont2discrete(
        ([omega**2], [1.0, 2.0 * ratio * omega, omega**2]), 1.0 / RATE, method="foh"
    )
    return np.asarray(signal.lfilter(np.ravel(numerator), denominator, value))


def sampled(value: Floats, rate: float, kind: str) -> Floats:
    """Filter and sample."""
    fewer = round(RATE / rate)
    if kind == "butterworth":
        value = signal.sosfilt(signal.butter(8, 0.4 * rate, fs=RATE, output="sos"), value)
    if kind == "sigma-delta":
        taps = signal.firwin(2 * 33 * fewer + 1, 0.5 * rate, window=("kaiser", 10.4), fs=RATE)
        value = signal.fftconvolve(np.pad(value, 33 * fewer), taps, "valid")
    return np.asarray(value[::fewer])


def rms(values: Floats) -> float:
    return float(np.sqrt((values**2).mean()))
