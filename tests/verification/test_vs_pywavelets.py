"""Energies of wavelet packets beside those of PyWavelets."""

from __future__ import annotations

import numpy as np
import pytest
import pywt

from agreement import Against, Agrees
from vibroimpact.signals.features.wavelet_packets import wavelet_packet_energies

AGAINST = Against(
    "PyWavelets, wavelet packet decomposition",
    "other program",
    "sensors and signals",
    "Lee et al. 2019, J. Open Source Softw. 4(36), 1237, doi 10.21105/joss.01237",
)


@pytest.mark.parametrize("samples", [8, 16, 40, 256, 2048])
def test_energies_of_packets(agrees: Agrees, samples: int) -> None:
    signals = np.random.default_rng(samples).standard_normal((5, samples))
    for signal, energies in zip(signals, wavelet_packet_energies(signals), strict=True):
        tree = pywt.WaveletPacket(signal, "db4", mode="periodization", maxlevel=3)
        expected = [float((node.data**2).sum()) for node in tree.get_level(3, "freq")]
        agrees(
            "8 to 2048 samples of white noise, wavelet db4",
            "energies of eight wavelet packets",
            energies,
            expected,
            relative=1e-11,
        )


@pytest.mark.parametrize("samples", [9, 100, 1001])
def test_energy_is_kept(samples: int) -> None:
    signals = np.random.default_rng(samples).standard_normal((5, samples))
    np.testing.assert_allclose(
        wavelet_packet_energies(signals).sum(axis=1), (signals**2).sum(axis=1), rtol=1e-12
    )
