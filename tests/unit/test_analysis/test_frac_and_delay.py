"""The frequency response assurance criterion, and the delay between signals."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.signals.delay import band_limited, delay_between


def resonance(frequency: np.ndarray, natural: float, ratio: float) -> np.ndarray:
    return np.asarray(1.0 / (natural**2 - frequency**2 + 2j * ratio * natural * frequency))


def test_frac_of_shifted_resonances() -> None:
    """Of two light resonances, wide apart from the band's ends: 4 d1 d2 / ((d1 + d2)^2 +
    shift^2) with half widths d.
    """
    frequency = np.linspace(500.0, 1500.0, 400_001)
    for shift, one, other in (
        (0.0, 0.001, 0.001),
        (2.0, 0.001, 0.001),
        (0.0, 0.001, 0.004),
        (3.0, 0.002, 0.001),
    ):
        found = vi.signals.frac(
            resonance(frequency, 1000.0, one), resonance(frequency, 1000.0 + shift, other)
        )
        widths = 1000.0 * one, 1000.0 * other
        assert found == pytest.approx(
            4.0 * widths[0] * widths[1] / (sum(widths) ** 2 + shift**2), rel=0.01
        )


def test_frac_knows_no_scale() -> None:
    response = resonance(np.linspace(500.0, 1500.0, 1001), 1000.0, 0.01)
    other = resonance(np.linspace(500.0, 1500.0, 1001), 1010.0, 0.02)
    assert vi.signals.frac(response, response) == pytest.approx(1.0, abs=1e-12)
    for factor in (1e-200, -3.0, 2.0j, 1e200):
        assert vi.signals.frac(response, factor * other) == pytest.approx(
            float(vi.signals.frac(response, other)), rel=1e-12
        )
    assert vi.signals.frac(np.stack([response, other]), np.stack([other, other])).shape == (2,)
    assert np.isnan(vi.signals.frac(np.zeros(3), np.ones(3)))


def test_frac_of_different_frequencies_is_refused() -> None:
    with pytest.raises(vi.InputError, match="can't be compared"):
        vi.signals.frac(np.ones(3), np.ones(4))


@pytest.mark.parametrize("shift", [-7.3, 0.0, 0.25, 12.49])
def test_the_delay_of_noisy_signals(shift: float) -> None:
    """Of two channels, one upside down, in noise 40 dB down: a hundredth of a sample."""
    rate, random = 10e3, np.random.default_rng(5)

    def ringing(at: float) -> np.ndarray:
        since = np.arange(1000) - 300.0 - at
        # a smooth beginning, so that it has no frequencies above half the rate
        return np.asarray(
            np.exp(-since / 100.0) * np.sin(0.8 * since) / (1.0 + np.exp(-0.5 * since))
        )

    earlier = np.stack([ringing(0.0), np.roll(ringing(0.0), 20)])
    later = np.stack([ringing(shift), -2.0 * np.roll(ringing(shift), 20)])
    later += 0.01 * np.sqrt(np.mean(later**2)) * random.standard_normal(later.shape)
    found = delay_between(later, earlier, rate, (100.0, 4000.0), 5e-3)
    assert found.time * rate == pytest.approx(shift, abs=0.01)
    assert found.polarity.tolist() == [1.0, -1.0]
    assert (found.correlation > 0.99).all()


def test_a_band_has_no_delay() -> None:
    time = np.arange(2000) / 10e3
    burst = np.exp(-(((time - 0.1) / 5e-3) ** 2)) * np.cos(2.0 * np.pi * 1000.0 * (time - 0.1))
    assert band_limited(burst, 10e3, (500.0, 2000.0)) == pytest.approx(burst, abs=1e-6)
    assert np.abs(band_limited(burst, 10e3, (2000.0, 3000.0))).max() < 1e-6
