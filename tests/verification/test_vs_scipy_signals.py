"""Envelope, moments, cubics and intrinsic modes beside SciPy, one signal at a time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.fft import dct, next_fast_len
from scipy.interpolate import PchipInterpolator
from scipy.signal import find_peaks, hilbert
from scipy.stats import kurtosis, skew

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.signals.cubic_through import cubic_through
from vibroimpact.signals.envelope import hilbert_envelope
from vibroimpact.signals.features.intrinsic_modes import intrinsic_modes

AGAINST = Against(
    "SciPy and NumPy, signal features",
    "other program",
    "sensors and signals",
    "scipy.signal.hilbert, scipy.stats, PchipInterpolator, scipy.fft.dct",
)


@pytest.fixture
def random() -> np.random.Generator:
    """Random numbers of each test, whichever runs first."""
    return np.random.default_rng(5)


@pytest.mark.parametrize("samples", [1, 2, 3, 100, 1001])
def test_the_envelope(agrees: Agrees, samples: int, random: np.random.Generator) -> None:
    signals = random.standard_normal((4, samples))
    padded = next_fast_len(2 * samples, real=True)
    exact = np.abs(hilbert(signals, N=padded + padded % 2))[:, :samples]
    agrees(
        "1 to 1001 samples of white noise",
        "Hilbert envelope",
        hilbert_envelope(signals),
        exact,
        relative=1e-12,
    )


def test_the_envelope_is_that_between_silences(random: np.random.Generator) -> None:
    signals = random.standard_normal((4, 2000))
    silent = np.abs(hilbert(signals, N=400_000))[:, :2000]
    np.testing.assert_allclose(hilbert_envelope(signals), silent, atol=0.02 * silent.max())


def test_the_moments(agrees: Agrees, random: np.random.Generator) -> None:
    signals = random.gamma(2.0, size=(6, 700))
    table = vi.signals.feature_table(signals, 1.0)
    agrees(
        "six random signals", "skewness", table["skewness"], skew(signals, axis=1), relative=1e-12
    )
    agrees(
        "six random signals",
        "kurtosis",
        table["kurtosis"],
        kurtosis(signals, axis=1, fisher=False),
        relative=1e-12,
    )


def test_the_cubic(agrees: Agrees, random: np.random.Generator) -> None:
    signals, knots = random.standard_normal((5, 300)), np.zeros((5, 300), dtype=bool)
    for number in range(5):
        knots[number, random.choice(300, 1 + 20 * number, replace=False)] = True
    found = cubic_through(signals, np.flatnonzero(knots))
    for signal, chosen, cubic in zip(signals, knots, found, strict=True):
        agrees(
            "five random signals",
            "monotone cubic interpolation",
            cubic,
            _cubic(signal, np.flatnonzero(chosen)),
            absolute=1e-13,
        )


def _cubic(signal: np.ndarray, knots: np.ndarray) -> np.ndarray:
    """Return SciPy's cubic, held constant at the ends by two knots on each side."""
    place = np.concatenate([[-2, -1], knots, [len(signal), len(signal) + 1]])
    height = np.concatenate([2 * [signal[knots[0]]], signal[knots], 2 * [signal[knots[-1]]]])
    return PchipInterpolator(place, height)(np.arange(len(signal)))


def test_the_intrinsic_modes(agrees: Agrees, random: np.random.Generator) -> None:
    signals = random.standard_normal((4, 500)).cumsum(axis=1)
    found = intrinsic_modes(signals, modes=3, siftings=5)
    for number, signal in enumerate(signals):
        rest, least = signal.copy(), 1e-10 * np.abs(signal).max()
        for mode in found[:, number]:
            sifted = rest.copy()
            for _ in range(5):
                tops, bottoms = (
                    _cubic(sifted, find_peaks(side, prominence=least)[0])
                    for side in (sifted, -sifted)
                )
                sifted -= 0.5 * (tops + bottoms)
            largest = float(np.abs(signal).max())
            agrees(
                "four random walks",
                "intrinsic mode functions, normalized by the maximum of the signal",
                mode / largest,
                sifted / largest,
                absolute=1e-9,
            )
            rest -= sifted


def test_the_cepstrum(agrees: Agrees, random: np.random.Generator) -> None:
    signal = random.standard_normal(640)
    power = np.abs(np.fft.rfft(signal)) ** 2
    power[1:-1] *= 2.0
    centres = np.linspace(0.0, 320.0, 22)
    bands = [
        np.interp(
            np.arange(321), centres[number : number + 3], [0.0, 1.0, 0.0], left=0.0, right=0.0
        )
        for number in range(20)
    ]
    level = np.log([band @ power / power.sum() + 1e-10 for band in bands])
    table = vi.signals.feature_table(
        signal[None], 1.0, [f"cepstrum_{number}" for number in range(1, 9)]
    )
    agrees(
        "640 samples of white noise",
        "cepstral coefficients",
        table.values[0],
        dct(level, norm="ortho")[1:9],
        relative=1e-10,
    )
