"""Energies of wavelet packets beside those of PyWavelets."""

from __future__ import annotations

import numpy as np
import pytest
import pywt

from vibroimpact.signals.features.wavelet_packets import wavelet_packet_energies


@pytest.mark.parametrize("samples", [8, 16, 40, 256, 2048])
def test_energies_of_packets(samples: int) -> None:
    signals = np.random.default_rng(samples).standard_normal((5, samples))
    for signal, energies in zip(signals, wavelet_packet_energies(signals), strict=True):
        tree = pywt.WaveletPacket(signal, "db4", mode="periodization", maxlevel=3)
        expected = [float((node.data**2).sum()) for node in tree.get_level(3, "freq")]
        np.testing.assert_allclose(energies, expected, rtol=1e-11)


@pytest.mark.parametrize("samples", [9, 100, 1001])
def test_energy_is_kept(samples: int) -> None:
    signals = np.random.default_rng(samples).standard_normal((5, samples))
    np.testing.assert_allclose(wavelet_packet_energies(signals).sum(axis=1), (signals**2).sum(axis=1), rtol=1e-12)
